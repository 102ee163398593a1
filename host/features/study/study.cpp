#include "features/study/study.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "features/masks/mask_making.hpp"
#include "features/plate/plate.hpp"
#include "features/study/study_trail.hpp"
#include "mask/feather.hpp"
#include "scene/moments.hpp"
#include "scene/place_times.hpp"
#include "session/text/number_text.hpp"

namespace nutik {
namespace {

constexpr double kMaxMoving = 0.2;  // of the picture, on average
// Largest share of a subject's border with an edge in the plate and none in the picture. Measured: at most 0.1 before
// texture and 0.25 before large dark things where the plate does not show the subject; 0.2 where it shows a quarter of
// it. The latter cover a place for nearly half of the time, hence kMinCoveredInPlate.
constexpr double kMaxPlateEdges = 0.15;
constexpr double kMinCoveredInPlate = 0.4;
constexpr std::size_t kMinLooks = 8;
constexpr double kMinExtent = 1.0 / 16;  // of the picture's longer side, that a subject goes
// In pixels: without specks and without holes.
constexpr double kSmoothRadius = 1, kCloseRadius = 7;

Feather feather_of(const StudyRequest& request) {
  return request.feather.value_or(Feather{request.style == StudyStyle::slit ? 0 : kStudyFeather, {}});
}

// How far regions reach beyond the subject, so that they are blended outside of it: in whole pixels, and as far as it is
// blended usually, for its own border is soft.
std::uint32_t border_pixels(const StudyRequest& request) {
  return static_cast<std::uint32_t>((std::max(feather_of(request).everywhere, kStudyFeather) + 99) / 100);
}

bool shows_one(StudyStyle style) { return style == StudyStyle::rear_curtain || style == StudyStyle::frozen; }

std::vector<std::uint64_t> stated_moments(const std::vector<StatedTime>& times, const Timeline& timeline) {
  std::vector<std::uint64_t> samples;
  for (const StatedTime& time : times) {
    samples.push_back(sample_at(time, "the moment", timeline));
    if (samples.size() > 1 && samples.back() <= samples[samples.size() - 2]) {
      throw UsageError(format(
          "the moment {} is not after the one before it; state moments in the order of time", time.text()));
    }
  }
  return samples;
}

std::string text_of(const Rectangle& region) {
  return format("region {},{},{},{}", region.x, region.y, region.width, region.height);
}

// For messages.
std::string where(const std::string& name, const StudyRequest& request, const Rectangle& region) {
  return request.regions.empty() ? name : name + ", " + text_of(region);
}

class StudyPlanner {
 public:
  StudyPlanner(const StudyRequest& request, const Timeline& timeline, const std::string& name,
               std::vector<SubjectTrack> tracks, const std::vector<Rectangle>& regions)
      : request_(request), timeline_(timeline), name_(name), tracks_(std::move(tracks)), regions_(regions) {}

  // Subject by subject.
  void choose(Study& study) {
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      for (const std::uint64_t sample : moments_of(i, study)) {
        study.moments.push_back(sample);
        study.subjects.push_back(i);
      }
    }
    constexpr std::size_t kMaxTags = 255;
    if (study.moments.size() > kMaxTags) {
      throw UsageError(format("{} moments of {} subjects are {}; a mask has room for {}",
                              study.moments.size() / tracks_.size(), tracks_.size(), study.moments.size(),
                              kMaxTags));
    }
  }

  void add_regions(Study& study) const {
    for (std::size_t i = 0; i < study.moments.size(); ++i) {
      MaskStep step;
      step.name = {nutik::format("subject {}", i + 1)};
      step.tag = static_cast<std::uint8_t>(i + 1);
      step.selection = select::Subject{StatedTime::of_pictures(static_cast<std::int64_t>(study.moments[i]))};
      const SubjectTrack& track = tracks_[study.subjects[i]];
      if (!is_seen_at(track, study.moments[i])) {
        study.notes.push_back(format(
            "at {} ({}f) the subject that was followed{} is not seen: what differs most from the empty scene "
            "then, if anything, is shown in its place",
            duration_text(timeline_.start_ns(study.moments[i])), study.moments[i],
            tracks_.size() > 1 ? " in " + text_of(regions_[study.subjects[i]]) : ""));
      }
      step.by_codes = request_.by_codes;
      step.changes = {{RegionChange::Kind::within, 0.0, box_at(study.subjects[i], study.moments[i])},
                      {RegionChange::Kind::largest, 0.0, {}},
                      {RegionChange::Kind::smooth, kSmoothRadius, {}},
                      {RegionChange::Kind::grow, kCloseRadius + border_pixels(request_), {}},
                      {RegionChange::Kind::shrink, kCloseRadius, {}}};
      study.mask.steps.push_back(std::move(step));
    }
  }

  [[nodiscard]] const std::vector<SubjectTrack>& tracks() const { return tracks_; }

 private:
  [[nodiscard]] std::vector<std::uint64_t> moments_of(std::size_t subject, Study& study) const {
    const SubjectTrack& track = tracks_[subject];
    if (const auto* times = std::get_if<std::vector<StatedTime>>(&request_.moments)) {
      return stated_moments(*times, timeline_);
    }
    study.are_moments_found = true;
    if (request_.style == StudyStyle::rear_curtain) return {last_large_place(track.places).sample};
    const std::uint32_t wanted = std::get<std::uint32_t>(request_.moments);
    std::vector<std::uint64_t> moments;
    for (const SubjectPlace& place :
         choose_moments(track, wanted, request_.spacing, 4 * border_pixels(request_))) {
      moments.push_back(place.sample);
    }
    if (moments.size() < std::min(wanted, 2u)) {
      throw NoSubject(format(
          "{}: what moves goes {:.0f} pixels, and is {:.0f} pixels large: at no two moments{} does it lie "
          "apart from itself. A single moment can be shown, frozen or at the end of its trail",
          where(name_, request_, regions_[subject]), track.extent, track.size(),
          track.extent > track.size() ? " at which it is seen as a whole" : ""));
    }
    if (moments.size() < wanted) {
      study.notes.push_back(format(
          "{}{} of {} moments are shown: at others the subject would overlap with itself, or the border "
          "of the picture or of its region would leave less than half of it",
          tracks_.size() > 1 ? format("subject {}: ", subject + 1) : "", moments.size(), wanted));
    }
    return moments;
  }

  // Whether it was found at the last sample before that was looked at.
  [[nodiscard]] static bool is_seen_at(const SubjectTrack& track, std::uint64_t sample) {
    const auto after = std::ranges::upper_bound(track.looked_at, sample);
    return after != track.looked_at.begin() &&
           std::ranges::binary_search(track.places, *(after - 1), {}, &SubjectPlace::sample);
  }

  // The box that it was found in then; all that is looked at if it was not.
  [[nodiscard]] select::Rectangle box_at(std::size_t subject, std::uint64_t sample) const {
    const SubjectTrack& track = tracks_[subject];
    Rectangle box = regions_[subject];
    if (is_seen_at(track, sample)) {
      box = (std::ranges::upper_bound(track.places, sample, {}, &SubjectPlace::sample) - 1)->box;
    }
    return {{double(box.x), double(box.y)}, double(box.width), double(box.height)};
  }

  const StudyRequest& request_;
  const Timeline& timeline_;
  const std::string& name_;  // of the capture, for messages
  std::vector<SubjectTrack> tracks_;
  const std::vector<Rectangle>& regions_;  // in which each was looked for
};

// Where subjects are looked for, one in each.
std::vector<Rectangle> regions_of(const StudyRequest& request, const std::string& name, const Shape& shape) {
  for (const Rectangle& region : request.regions) {
    if (region.lies_in(shape)) continue;
    throw UsageError(format("{} does not lie in the {} x {} pixels of {}", text_of(region), shape.width,
                            shape.height, name));
  }
  return request.regions.empty() ? std::vector<Rectangle>{Rectangle::whole(shape)} : request.regions;
}

double uncertain_share(const Region& uncertain, const std::vector<Rectangle>& regions) {
  std::uint64_t count = 0, all = 0;
  for (const Rectangle& region : regions) {
    for (std::uint32_t y = region.y; y < region.y + region.height; ++y) {
      const auto row = uncertain.inside.begin() + (std::ptrdiff_t{y} * uncertain.width + region.x);
      count += static_cast<std::uint64_t>(std::count(row, row + region.width, std::uint8_t{1}));
    }
    all += std::uint64_t{region.width} * region.height;
  }
  return static_cast<double>(count) / static_cast<double>(all);
}

// That what is not followed leaves a trail only.
void tell_of_other(const std::vector<SubjectPlace>& places, std::vector<std::string>& notes) {
  if (places.empty()) return;
  std::uint32_t left = places[0].box.x, top = places[0].box.y, right = 0, bottom = 0;
  for (const SubjectPlace& place : places) {
    left = std::min(left, place.box.x);
    top = std::min(top, place.box.y);
    right = std::max(right, place.box.x + place.box.width);
    bottom = std::max(bottom, place.box.y + place.box.height);
  }
  notes.push_back(
      format("one subject is shown, and another thing goes its way at the same time, within {},{},{},{}: name a region "
             "for each of them to show both",
             left, top, right - left, bottom - top));
}

// A plate that shows the subject makes a hole of the ground that it left. Moments that are stated are shown with a note.
void check_before_plate(Study& study, const MadeMask& made, const std::string& name) {
  for (std::size_t i = 0; i < made.steps.size(); ++i) {
    const double share = made.steps[i].plate_edges.value_or(0);
    if (share <= kMaxPlateEdges || !study.may_be_in_plate[study.subjects[i]]) continue;
    const std::string why = format(
        "the scene at rest shows the subject, too, which covers some places for half of the time: at picture {} {:.0f} "
        "% of its border are edges of that scene",
        study.moments[i], 100 * share);
    if (study.are_moments_found) {
      throw NoSubject(
          format("{}: {}. Take a longer part of the time, in which it goes on, or name the moments to show",
                 name, why));
    }
    study.notes.push_back(why + ". It may be shown in part, or as a hole");
  }
}

// Throws what makes no study. Moments that are stated are shown wherever the subject goes.
void check_track(const SubjectTrack& track, const std::string& name, std::uint32_t by_codes,
                 std::uint32_t side, StudyStyle style, bool is_stated) {
  if (track.moving_share > kMaxMoving) {
    throw EverythingMoves(format(
        "{}: {:.0f} % of the picture differ from the scene at rest on average: everything moves, as it "
        "does where the camera did. A study needs a scene that rests, and something that moves in it",
        name, 100 * track.moving_share));
  }
  if (track.places.empty()) {
    throw NoSubject(
        format("{}: nothing moves: no part of it differs from the rest of the time by more than {} codes. State fewer "
               "to find what hardly stands out",
               name, by_codes));
  }
  if (is_stated) return;
  if (kMinExtent * side > track.extent && !shows_one(style)) {
    throw NoSubject(format(
        "{}: nothing goes anywhere: what moves most is {:.0f} pixels large, and goes {:.0f} pixels of {}{}. "
        "{}",
        name, track.size(), track.extent, side,
        track.looked_at.size() < kMinLooks ? format(", in {} pictures", track.looked_at.size()) : "",
        track.extent < track.cell_side
            ? "It comes and goes in its place: a single moment can be shown, frozen, or those that are named"
            : "Take a part of the picture, of which that is more, or name the moments to show. A camera that "
              "sways before a texture that repeats itself looks so, too: align the clip"));
  }
  if (track.is_scraps()) {
    const double length = track.length();
    throw NoSubject(format(
        "{}: nothing moves as one whole thing. What goes furthest fills {:.0f} % of its box, and is {:.0f} % of what "
        "differs from the scene at rest: of one of these a subject is half or more. {} shows its edges only, and "
        "cannot be shown twice. Take a clip in which it goes further, name a region with a single subject, or the "
        "moments to show",
        name, 100 * track.fill, 100 * track.share,
        track.extent < length
            ? format(
                  "Its box is {:.0f} pixels long and goes {:.0f}: a thing that goes less than its own size",
                  length, track.extent)
            : "A thing that shakes, grows or shines"));
  }
  if (track.flickers) {
    throw NoSubject(
        format("{}: nothing moves as one whole thing. What differs from the scene at rest flickers here and there over "
               "{:.0f} pixels, as light does that changes, leaves, or many things at once. Name a region with a single "
               "subject, a part of the time, or the moments to show",
               name, track.extent));
  }
}

// Regions that overlap may hold a single thing, which cannot be shown as two.
void check_apart(const std::vector<SubjectTrack>& tracks, const std::vector<Rectangle>& regions,
                 const std::string& name) {
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (!are_of_one_thing(tracks[k].places, tracks[i].places)) continue;
      throw NoSubject(
          format("{}: {} and {} overlap, and hold the same subject. Take regions that lie apart, "
                 "or a single one",
                 name, text_of(regions[k]), text_of(regions[i])));
    }
  }
}

}  // namespace

MadeMask make_regions(Study& study, CaptureSource& capture, const std::string& capture_name) {
  MadeMask made = make_mask(study.mask, &capture, capture_name, [&] { return std::move(study.plate); });
  check_before_plate(study, made, capture_name);
  if (!study.are_moments_found) return made;
  const auto left = made.mask.pixels_per_tag();
  for (std::size_t i = 0; i < made.steps.size(); ++i) {
    const StepReport& step = made.steps[i];
    if (2 * left[step.tag] >= step.pixel_count) continue;
    const bool is_single = study.subjects.back() == 0;
    throw NoSubject(nutik::format(
        "{}: {}: of the {} pixels that it has at picture {} moments after it cover all but {}. {}",
        capture_name,
        is_single ? "the subject overlaps with itself"
                  : nutik::format("subject {} overlaps with itself or with another", study.subjects[i] + 1),
        step.pixel_count, study.moments[i], left[step.tag],
        is_single ? "It goes too little for its size. Name moments further apart, or show a single one"
                  : "Take regions that lie apart, fewer moments, or a single subject"));
  }
  return made;
}

std::uint32_t usual_moments(StudyStyle style) {
  constexpr std::uint32_t kUsual = 5;
  return style == StudyStyle::slit ? kMaxStrips : shows_one(style) ? 1 : kUsual;
}

namespace {

void check_moments(const StudyRequest& request) {
  const auto* times = std::get_if<std::vector<StatedTime>>(&request.moments);
  const std::size_t count = times != nullptr ? times->size() : std::get<std::uint32_t>(request.moments);
  const bool is_slit = request.style == StudyStyle::slit;
  if (is_slit && times != nullptr) {
    throw UsageError(Advice{
        "`style slit` shows a moment in each strip; say with `moments` how many there are, not which"});
  }
  if (shows_one(request.style) && count != 1) {
    throw UsageError(Advice{format("`style {}` shows a single moment; leave `moments` out, or name one time",
                                   request.style == StudyStyle::frozen ? "frozen" : "rear-curtain")});
  }
  const std::size_t least = is_slit ? 2 : 1, most = is_slit ? kMaxStrips : kMaxMoments;
  if (count < least || count > most)
    throw UsageError(Advice{format("`moments` says {}; a study has {} to {}", count, least, most)});
}

}  // namespace

void check_study(const StudyRequest& request) {
  if (request.style != StudyStyle::clean) check_moments(request);
  if (!request.feather || request.style == StudyStyle::slit) return;
  if (!request.feather->of_tag.empty()) {
    throw UsageError(
        "the feather of a study is one width for all of its moments, 6px; exposed by hand, each may have its "
        "own");
  }
  if (request.feather->everywhere > kMaxStudyFeather) {
    throw UsageError(format(
        "the feather of a study reaches {} pixels at most, for its moments lie four times as far apart",
        kMaxStudyFeather / 100));
  }
}

Study plan_study(CaptureSource& capture, const std::string& capture_name, const StudyRequest& request,
                 const MemoryBudget& memory, const ReportedProgress& progress) {
  check_study(request);
  if (request.style == StudyStyle::slit) {
    return slit_study(capture, capture_name, std::get<std::uint32_t>(request.moments), request.slit_from);
  }
  const CaptureFormat& format = capture.format();
  const std::vector<Rectangle> regions = regions_of(request, capture_name, format.shape);
  if (request.by_codes.value_or(0) >= format.white_code) {
    throw UsageError(nutik::format("{}: no codes differ by more than {}, for white is {}; state fewer codes",
                                   capture_name, *request.by_codes, format.white_code));
  }
  MadePlate plate = make_rough_plate(capture, capture_name, memory, progress);
  const double moving = uncertain_share(plate.uncertain, regions);
  if (moving > kMaxMoving) {
    throw EverythingMoves(
        nutik::format("{}: {:.0f} % of the pixels hold no light for half of the time: everything moves, as it does "
                      "where nobody held the camera still. A study needs a scene that rests and something that moves "
                      "in it",
                      capture_name, 100 * moving));
  }
  if (request.style == StudyStyle::clean) {
    Study study;
    study.plate = std::move(plate.picture);
    return study;
  }
  const std::uint32_t by_codes = request.by_codes.value_or(
      static_cast<std::uint32_t>(std::ceil(2 * CodeBand::kMinShare * format.white_code)));
  std::vector<SubjectTrack> tracks = track_subjects(capture, plate.picture, by_codes, regions, progress);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const bool is_stated = std::holds_alternative<std::vector<StatedTime>>(request.moments);
    check_track(tracks[i], where(capture_name, request, regions[i]), by_codes,
                std::max(regions[i].width, regions[i].height), request.style, is_stated);
  }
  Study study;
  study.plate = std::move(plate.picture);
  check_apart(tracks, regions, capture_name);
  if (request.regions.empty()) tell_of_other(tracks.front().other, study.notes);
  for (const SubjectTrack& track : tracks) {
    study.may_be_in_plate.push_back(track.most_covered_share() >= kMinCoveredInPlate);
  }
  StudyPlanner planner(request, capture.timeline(), capture_name, std::move(tracks), regions);
  planner.choose(study);
  planner.add_regions(study);
  add_functions(study, request, capture.timeline(), planner.tracks());
  return study;
}

ExposureRequest study_exposure(const Study& study, const StudyRequest& asked, const Mask& regions) {
  ExposureRequest request;
  request.gains = Shared(FunctionSet(study.functions));
  const Feather feather = feather_of(asked);
  request.mask = Shared(MaskWithRegions(feather == Feather{} ? regions : feathered(regions, feather)));
  request.normalization = Normalization::parse("integral");
  return request;
}

}  // namespace nutik
