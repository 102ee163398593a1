// Exposures to begin with, found in the capture: each is then edited like any other.
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "features/study/study.hpp"
#include "session/session.hpp"
#include "studio/document/document.hpp"
#include "studio/live/jobs.hpp"

namespace nutik::studio {

struct StartingPoint {
  StudyStyle style;
  const char* name;  // in the menu; to be translated
  const char* tip;
};
[[nodiscard]] std::span<const StartingPoint> starting_points();

// Jobs' work. The document gets the study's regions, functions and mask as one step; `told` its notes.
[[nodiscard]] Jobs::Work studying(Document& document, std::shared_ptr<Session> session, StudyStyle style,
                                  std::function<void(const QString&)> told);
// The scene without what moves, as a picture file.
[[nodiscard]] Jobs::Work writing_plate(std::shared_ptr<Session> session, const QString& picture,
                                       std::function<void(const QString&)> told);

}  // namespace nutik::studio
