// What the menus start as jobs: exposures to begin with, found in the capture and then edited like any other, and
// pictures that are written.
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "features/study/study.hpp"
#include "session/session.hpp"
#include "studio/document/document.hpp"
#include "studio/live/jobs.hpp"
#include "studio/window/project_file.hpp"

namespace nutik::studio {

struct StartingPoint {
  StudyStyle style;
  const char* name;  // in the menu; to be translated
  const char* tip;
};
[[nodiscard]] std::span<const StartingPoint> starting_points();

// Both look at what lies between the document's marks.

// The document gets the study's regions, functions and mask as one step; `told` its notes.
[[nodiscard]] Jobs::Work studying(Document& document, std::shared_ptr<Session> session, StudyStyle style, Told told);
// The scene without what moves, as a picture file.
[[nodiscard]] Jobs::Work writing_plate(const Document& document, std::shared_ptr<Session> session,
                                       const QString& picture, Told told);

// The picture of a document, with the bytes and the recipe that nutik-cl gives it. `files` hold its mask and functions.
[[nodiscard]] Jobs::Work exporting(const Document& document, std::shared_ptr<Session> session,
                                   const CommandFiles& files, const QString& picture, Told told);

}  // namespace nutik::studio
