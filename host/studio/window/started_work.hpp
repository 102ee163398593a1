// What the menus start as jobs: exposures to begin with, found in the capture and then edited like any other, and
// pictures that are written.
#pragma once

#include <QImage>
#include <functional>
#include <memory>
#include <span>

#include "features/film/film_request.hpp"
#include "features/schema/options.hpp"
#include "features/study/study.hpp"
#include "session/session.hpp"
#include "studio/document/document.hpp"
#include "studio/live/jobs.hpp"
#include "studio/window/project_file.hpp"

namespace nutik::studio {

struct StartingPoint {
  std::optional<StudyStyle> style;  // none: all of the time is exposed
  const char* name;  // in the menu; to be translated
  const char* tip;
};
[[nodiscard]] std::span<const StartingPoint> starting_points();

// These look at what lies between marks: the document's, or those that are given.

// The document gets the study's regions, functions and mask as one step; `told` its notes.
[[nodiscard]] Jobs::Work studying(Document& document, std::shared_ptr<Session> session,
                                  const StudyRequest& request, Told told);
// A style as it is usual here.
[[nodiscard]] StudyRequest usual_study(StudyStyle style);
// The scene without what moves, to be looked at, and the marks that it was found between.
[[nodiscard]] Jobs::Work making_plate(const Document& document, std::shared_ptr<Session> session,
                                      std::function<void(QImage, Marks)> show);
// The same as a picture file.
[[nodiscard]] Jobs::Work writing_plate(const Marks& marks, std::shared_ptr<Session> session,
                                       const QString& picture, Told told);

// A clip's files, each of its stills among them: no picture replaces one. Throws UsageError where the picture, in the
// folder of the stills, would be taken for one.
std::vector<std::string> clip_files(const QString& clip, const QString& picture);

// The picture of a document, with the bytes and the recipe that nutik-cl gives it. `files` hold its mask and functions.
[[nodiscard]] Jobs::Work exporting(const Document& document, std::shared_ptr<Session> session,
                                   const CommandFiles& files, const QString& picture, const Stated& written,
                                   Told told);

// The interval on its way through the capture, or the regions' functions; as `options` of the command for videos say.
[[nodiscard]] FramesRequest film_request(const DocumentState& state, const Options& options);
// Asks whether pictures that are there may be replaced by the film's; empty where none are.
[[nodiscard]] QString stills_question(const Document& document, const Session& session, const QString& film,
                                      const Options& options);
// Whether its pictures carry recipes, which name a project's files.
[[nodiscard]] bool holds_recipes(const QString& film, const Stated& written);
// Stills have the recipes that nutik-cl gives them. `end` is told of a signal that ended the film early.
[[nodiscard]] Jobs::Work filming(const Document& document, std::shared_ptr<Session> session,
                                 std::shared_ptr<Devices> devices, const CommandFiles& files, const QString& film,
                                 const Stated& written, Told told, std::function<void(int signal)> end);

}  // namespace nutik::studio
