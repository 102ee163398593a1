// The gain functions of a study: one for each moment, and what is shown where the subject is at none of them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "capture/timeline.hpp"
#include "features/study/study.hpp"
#include "imev/capture_source.hpp"
#include "scene/subject.hpp"

namespace nutik {

// A slit-scan: strips side by side, each later than the one before, at moments spread over all of the time. Their
// number is `wanted`, that of pictures or of pixels across, the least of them. Throws InputError where that is one.
[[nodiscard]] Study slit_study(CaptureSource& capture, const std::string& name, std::uint32_t wanted,
                               SlitFrom from);

// All of the time, evenly, where the mask's value is 0.
[[nodiscard]] FunctionSet whole_time(const Timeline& timeline);

// What is shown between moments: as stated, or as the style has it.
[[nodiscard]] TrailShape trail_shape(const StudyRequest& request);

// When the ground of a place, and of so many pixels around it, is seen bare, and at most so many codes darker than at
// the place's own sample: cameras change their exposure. Empty where there is no such time.
[[nodiscard]] SampleRange bare_time(CaptureSource& capture, const SubjectTrack& track, const SubjectPlace& place,
                                    std::uint32_t pixels, double most_codes);

// Sets the study's functions for the chosen moments, how strong its trail is and when nothing is there.
void add_functions(Study& study, const StudyRequest& request, const Timeline& timeline,
                   const std::vector<SubjectTrack>& tracks);

}  // namespace nutik
