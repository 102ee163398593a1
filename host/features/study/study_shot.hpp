// What of a clip a study shows: one shot, its pictures moved back where the camera moved.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "align/alignment.hpp"
#include "capture/error.hpp"
#include "features/study/study.hpp"
#include "session/requests/output_request.hpp"
#include "session/requests/source_request.hpp"
#include "session/session.hpp"

namespace nutik {

struct StudyTerms {
  std::shared_ptr<Devices> devices;
  OutputRequest output;  // of the picture in the end: what that takes is there before the work begins
  std::function<ReportedProgress(std::string what)> progress;  // of each step; empty: it is not told
};

struct PlannedStudy {
  Session session;
  Study study;
  std::optional<MovedCamera> moved;  // by little, so that the pictures are as they were filmed
  std::vector<Note> notes = {};
  // What a clip is read with beside what was stated.
  std::optional<SampleRange> part = {};          // pictures that were taken of it
  std::optional<std::uint64_t> aligned_to = {};  // the picture of them that the others were moved onto
  std::optional<std::string> between = {};       // which samples were made, where nobody stated that
  // What the study counts: pictures of a clip, whatever was made between them, and all samples of a capture.
  [[nodiscard]] const Timeline& timeline() const {
    return session.is_clip() ? session.timeline().pictures() : session.timeline();
  }
};

// Shorter shots show nothing that goes anywhere.
inline constexpr std::uint64_t kMinSamples = 8;
// And a part of a shot that is less than one of so many pictures is not what it shows.
inline constexpr std::uint64_t kMinOfSamples = 4;

// The pictures of a shot that each show one scene, apart from each other, the longest and those half as long or more.
// None where all of the shot shows one, too little of it has texture, or all are short. `shot` counts the clip's
// pictures.
[[nodiscard]] std::vector<SampleRange> scenes_of(const SourceRequest& source, SampleRange shot);

// How pictures are moved where nobody stated that.
inline constexpr CameraMotion kStudyMotion = CameraMotion::automatic;

// Subject and moments are looked for in the pictures that were filmed. Where the study has a trail, samples that are
// made between them are part of the capture that is exposed: as the source asks, or along the subject's way.
//
// Throws InputError where no shot makes a picture that holds, and what Session and plan_study() of a capture throw.
[[nodiscard]] PlannedStudy plan_study(const SourceRequest& source, const StudyRequest& request,
                                      const StudyTerms& terms);

}  // namespace nutik
