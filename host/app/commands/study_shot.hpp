// What of a clip a study shows: one shot, its pictures moved back where the camera moved.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/command_line/options.hpp"
#include "session/clips/camera_check.hpp"
#include "session/making/study_request.hpp"
#include "session/session.hpp"

namespace nutik::app {

struct PlannedStudy {
  Session session;
  Study study;
  std::optional<MovedCamera> moved;  // by little, so that the pictures are as they were filmed
};

// `options` get what the clip is read with beside what was stated. Throws InputError where no shot makes a study.
[[nodiscard]] PlannedStudy plan_study(Options& options, const StudyRequest& request);

}  // namespace nutik::app
