// Which of the things that move a study shows, and how.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "features/study/study.hpp"
#include "features/study/study_regions.hpp"
#include "scene/subject.hpp"

namespace nutik {

[[nodiscard]] bool shows_one(StudyStyle style);

// region x,y,width,height: as it is stated.
[[nodiscard]] std::string text_of(const Rectangle& region);

// How a track can be shown: as it was asked for, at one moment, or not at all; and why not as it was asked for.
struct SubjectVerdict {
  enum class Shows { all, one, nothing } shows = Shows::all;
  std::string why = {};
  bool stays = false;  // it goes nowhere
};

// A track, and in what it was looked for.
struct FollowedSubject {
  SubjectTrack track;
  Rectangle region;
  SubjectVerdict verdict = {};
  std::vector<SubjectPlace> refused = {};  // of its places: not to be chosen
  Exchange exchange = {};                  // on its whole way
};

// Subjects in the order of regions. Where no region is stated, what goes its way beside the subject is one, too; what
// is left out is told. Throws NoSubject where two regions hold the same.
[[nodiscard]] std::vector<FollowedSubject> followed_in(
    std::vector<SubjectTrack> tracks, const std::vector<Rectangle>& regions, const StudyRequest& request,
    std::uint32_t by_codes, const std::string& name, std::vector<std::string>& notes);

}  // namespace nutik
