// The gain functions of a study: one for each moment, and what is shown where the subject is at none of them.
#pragma once

#include <vector>

#include "capture/timeline.hpp"
#include "scene/subject.hpp"
#include "session/making/study_request.hpp"

namespace nutik {

// Of the moments that were chosen. Sets the study's functions, how strong its trail is and when nothing is there.
void add_functions(Study& study, const StudyRequest& request, const Timeline& timeline,
                   const std::vector<SubjectTrack>& tracks);

}  // namespace nutik
