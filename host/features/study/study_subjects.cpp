#include "features/study/study_subjects.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include "capture/format.hpp"
#include "scene/moments.hpp"

namespace nutik {

bool shows_one(StudyStyle style) { return style == StudyStyle::rear_curtain || style == StudyStyle::frozen; }

std::string text_of(const Rectangle& region) {
  return format("region {},{},{},{}", region.x, region.y, region.width, region.height);
}

namespace {

// A thing among many others that fills so much of its box and goes further than it is long is no scrap.
constexpr double kMinFillOfMany = 0.4;
// One that fills less, and is so much of what differs, may be seen at one moment: an arm, or glass. Measured: 0.45 of a
// bottle, at most 0.1 of edges of what stays.
constexpr double kMinShareOfOne = 0.25;
constexpr std::string_view kNameIt = "Name a region to show what moves in it";
constexpr std::size_t kMinLooks = 8;
constexpr double kMinExtent = 1.0 / 16;  // of the picture's longer side, that a subject goes

// The box round all places of a subject.
Rectangle box_of(const std::vector<SubjectPlace>& places) {
  std::uint32_t left = places[0].box.x, top = places[0].box.y, right = 0, bottom = 0;
  for (const SubjectPlace& place : places) {
    left = std::min(left, place.box.x);
    top = std::min(top, place.box.y);
    right = std::max(right, place.box.x + place.box.width);
    bottom = std::max(bottom, place.box.y + place.box.height);
  }
  return {left, top, right - left, bottom - top};
}

// Where another thing goes, as regions are stated: x,y,width,height. And what shows it, if a region can hold it alone.
std::string within_text(const SubjectTrack& other, const SubjectTrack& shown, std::string_view remedy) {
  const Rectangle a = box_of(other.places), b = box_of(shown.places);
  const bool are_apart = a.x + a.width <= b.x || b.x + b.width <= a.x || a.y + a.height <= b.y || b.y + b.height <= a.y;
  return format("within {},{},{},{}. {}", a.x, a.y, a.width, a.height,
                are_apart
                    ? remedy
                    : "Their ways overlap, so no region holds one alone: take a part of the time in which they lie "
                      "apart");
}

// What of a track makes a study. Moments that are stated are shown wherever the subject goes.
SubjectVerdict verdict_of(const SubjectTrack& track, std::uint32_t by_codes, std::uint32_t side, StudyStyle style,
                   bool is_stated) {
  using Shows = SubjectVerdict::Shows;
  if (is_stated) return {};
  if (track.places.empty()) {
    return {Shows::nothing,
            format("nothing moves: no part of it differs from the rest of the time by more than {} codes. State fewer "
                   "to find what hardly stands out",
                   by_codes)};
  }
  if (track.looked_at.size() == 2) {
    return {Shows::nothing,
            "two pictures cannot tell what moves from the scene at rest: take a longer part of the clip"};
  }
  const double length = track.length();
  if (kMinExtent * side > track.extent && !shows_one(style)) {
    return {kMinExtent * side > length ? Shows::nothing : Shows::one,
            format("nothing seen goes anywhere: what could be followed best is {:.0f} pixels large, and went "
                   "{:.0f} pixels of {}{}{}",
                   track.size(), track.extent, side,
                   track.looked_at.size() < kMinLooks ? format(", in {} pictures", track.looked_at.size()) : "",
                   track.extent < track.cell_side ? ". It comes and goes in its place" : ""),
            true};
  }
  if (track.is_scraps() && (track.fill < kMinFillOfMany || track.extent < length || track.flickers)) {
    return {
        track.share < kMinShareOfOne || track.extent < length ? Shows::nothing : Shows::one,
        format("nothing seen moves as one whole thing. What goes furthest fills {:.0f} % of its box, and is "
               "{:.0f} % of what differs from the scene at rest; one of the two must be half or more. {} shows its "
               "edges only, and cannot be shown twice. Take a clip in which it goes further, name a region with a "
               "single subject, or the moments to show",
               100 * track.fill, 100 * track.share,
               track.extent < length
                   ? format("Its box is {:.0f} pixels long and goes {:.0f}: a thing that goes less than its own size",
                            length, track.extent)
                   : "A thing that shakes, grows or shines")};
  }
  if (track.flickers) {
    return {Shows::one,
            format("nothing seen moves as one whole thing. What differs from the scene at rest is scattered "
                   "over {:.0f} pixels: from picture to picture it lies here and there, on no way of its own",
                   track.extent)};
  }
  return {};
}

void tell_of_left_out(std::vector<SubjectTrack> tracks, const std::vector<FollowedSubject>& shown,
                      const StudyRequest& request, std::uint32_t by_codes, std::vector<std::string>& notes) {
  const Rectangle& all = shown.front().region;
  std::erase_if(tracks, [&](const SubjectTrack& track) {
    return verdict_of(track, by_codes, std::max(all.width, all.height), request.style, false).shows !=
               SubjectVerdict::Shows::all ||
           std::ranges::any_of(shown, [&](const FollowedSubject& each) {
             return are_of_one_thing(each.track.places, track.places);
           });
  });
  if (tracks.empty()) return;
  notes.push_back(format("{} {}",
                         tracks.size() == 1 ? "another thing goes its way and is not shown,"
                                            : format("{} more things go their way and are not shown, the largest",
                                                     tracks.size()),
                         within_text(tracks.front(), shown.front().track, kNameIt)));
}

// Regions that overlap may hold a single thing, which cannot be shown as two.
void check_apart(const std::vector<FollowedSubject>& followed, const std::string& name) {
  for (std::size_t i = 0; i < followed.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (!are_of_one_thing(followed[k].track.places, followed[i].track.places)) continue;
      throw NoSubject(
          format("{}: {} and {} overlap, and hold the same subject. Take regions that lie apart, "
                 "or a single one",
                 name, text_of(followed[k].region), text_of(followed[i].region)));
    }
  }
}

}  // namespace

std::vector<FollowedSubject> followed_in(
    std::vector<SubjectTrack> tracks, const std::vector<Rectangle>& regions, const StudyRequest& request,
    std::uint32_t by_codes, const std::string& name, std::vector<std::string>& notes) {
  const bool is_stated = std::holds_alternative<std::vector<StatedTime>>(request.moments);
  std::vector<FollowedSubject> followed;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const std::uint32_t side = std::max(regions[i].width, regions[i].height);
    SubjectVerdict verdict = verdict_of(tracks[i], by_codes, side, request.style, is_stated);
    std::vector<SubjectTrack> others = std::move(tracks[i].others), candidates = others;
    std::vector<SubjectTrack> left_out = std::move(tracks[i].lesser);
    std::ranges::copy(tracks[i].instead, std::back_inserter(candidates));
    std::ranges::move(tracks[i].instead, std::inserter(left_out, left_out.begin()));
    for (SubjectTrack& candidate : candidates) {
      SubjectVerdict of_candidate = verdict_of(candidate, by_codes, side, request.style, is_stated);
      if (of_candidate.shows >= verdict.shows) continue;
      tracks[i] = std::move(candidate);
      verdict = std::move(of_candidate);
      others.clear();
    }
    if (!request.regions.empty() && !verdict.why.empty()) verdict.why = text_of(regions[i]) + ": " + verdict.why;
    followed.push_back({std::move(tracks[i]), regions[i], std::move(verdict)});
    if (!request.regions.empty() || followed.back().verdict.shows == SubjectVerdict::Shows::nothing) continue;
    if (is_stated || shows_one(request.style) || followed.back().verdict.shows != SubjectVerdict::Shows::all) {
      if (others.empty()) continue;
      notes.push_back(format("one subject is shown, and another thing goes its way at the same time, {}{}",
                             within_text(others.front(), followed.back().track,
                                         "Name a region for each of them to show both"),
                             shows_one(request.style) ? ", or take the style trail or strobe" : ""));
      continue;
    }
    for (SubjectTrack& other : others) {
      if (verdict_of(other, by_codes, side, request.style, false).shows != SubjectVerdict::Shows::all) continue;
      followed.push_back({std::move(other), regions[i]});
    }
    if (followed.size() > 1) {
      notes.push_back(format("{} subjects are shown: another thing goes its way at the same time, {}", followed.size(),
                             within_text(followed[1].track, followed[0].track, kNameIt)));
    }
    tell_of_left_out(std::move(left_out), followed, request, by_codes, notes);
  }
  if (!request.regions.empty()) check_apart(followed, name);
  return followed;
}

}  // namespace nutik
