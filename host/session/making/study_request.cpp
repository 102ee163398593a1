#include "session/making/study_request.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "mask/feather.hpp"
#include "scene/code_band.hpp"
#include "session/making/gain_pieces.hpp"
#include "session/making/mask_making.hpp"
#include "session/making/plate_request.hpp"
#include "session/making/study_slit.hpp"
#include "session/text/time_text.hpp"

namespace nutik {
namespace {

// Of a subject that covers a place of its way for a share of the time, the trail shows so much there.
constexpr double kTrailOpacity = 0.5;
constexpr double kMaxStrength = 8;  // more shows the noise of the empty scene
constexpr double kMaxMoving = 0.2;  // of the picture, on average
constexpr std::uint64_t kMinEmptySamples = 4;
constexpr double kMinExtent = 1.0 / 16;  // of the picture's longer side, that a subject goes
// In pixels: without specks, without holes, and with the subject's soft border.
constexpr double kSmoothRadius = 1, kGrowRadius = 9, kShrinkRadius = 7;

bool shows_one(StudyStyle style) { return style == StudyStyle::rear_curtain || style == StudyStyle::frozen; }

TrailShape default_trail(StudyStyle style) {
  switch (style) {
    case StudyStyle::trail: return TrailShape::even;
    case StudyStyle::rear_curtain: return TrailShape::ramp;
    case StudyStyle::strobe: return TrailShape::none;
    case StudyStyle::frozen: return TrailShape::even;
    case StudyStyle::clean:
    case StudyStyle::slit: break;
  }
  return TrailShape::none;
}

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

class StudyPlanner {
 public:
  StudyPlanner(const StudyRequest& request, const Timeline& timeline, const std::string& name,
               std::vector<SubjectTrack> tracks, const std::vector<Rectangle>& regions)
      : request_(request), timeline_(timeline), name_(name), tracks_(std::move(tracks)), regions_(regions) {
    shape_ = request.trail.value_or(default_trail(request.style));
  }

  // Subject by subject.
  void choose(Study& study) {
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      for (const std::uint64_t sample : moments_of(tracks_[i], study)) {
        study.moments.push_back(sample);
        subjects_.push_back(i);
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
      const SubjectTrack& track = tracks_[subjects_[i]];
      if (!is_seen_at(track, study.moments[i])) {
        study.notes.push_back(format(
            "at {} ({}f) the subject that was followed is not seen: what differs most from the empty scene "
            "then, if anything, is shown in its place",
            duration_text(timeline_.start_ns(study.moments[i])), study.moments[i]));
      }
      step.changes = {{RegionChange::Kind::within, 0.0, box_at(subjects_[i], study.moments[i])},
                      {RegionChange::Kind::largest, 0.0, {}},
                      {RegionChange::Kind::smooth, kSmoothRadius, {}},
                      {RegionChange::Kind::grow, kGrowRadius, {}},
                      {RegionChange::Kind::shrink, kShrinkRadius, {}}};
      study.mask.steps.push_back(std::move(step));
    }
  }

  void add_functions(Study& study) const {
    for (std::size_t i = 0; i < study.moments.size(); ++i) {
      GainPieces moment;
      moment.add(interval_of({study.moments[i], study.moments[i] + 1}), 1, 1);
      study.functions.emplace(static_cast<std::uint8_t>(i + 1), moment.function());
    }
    study.empty = empty_of_all();
    if (study.empty.size() < kMinEmptySamples) study.empty = {};
    study.functions.emplace(std::uint8_t{0}, shape_ == TrailShape::none ? background(study) : trail(study));
  }

 private:
  [[nodiscard]] std::vector<std::uint64_t> moments_of(const SubjectTrack& track, Study& study) const {
    if (const auto* times = std::get_if<std::vector<StatedTime>>(&request_.moments)) {
      return stated_moments(*times, timeline_);
    }
    study.are_moments_found = true;
    if (request_.style == StudyStyle::rear_curtain) return {last_whole_place(track).sample};
    const std::uint32_t wanted = shows_one(request_.style) ? 1 : std::get<std::uint32_t>(request_.moments);
    std::vector<std::uint64_t> moments;
    for (const SubjectPlace& place : choose_moments(track, wanted, request_.spacing)) {
      moments.push_back(place.sample);
    }
    if (moments.size() < std::min(wanted, 2u)) {
      throw NoSubject(format(
          "{}: what moves goes {:.0f} pixels, and is {:.0f} pixels large: at no two moments{} does it lie "
          "apart from itself. A single moment can be shown, frozen or at the end of its trail",
          name_, track.extent, track.size(),
          track.extent > track.size() ? " at which it is seen as a whole" : ""));
    }
    if (moments.size() < wanted) {
      study.notes.push_back(
          format("{} of {} moments are shown: at others the subject would overlap with itself, or the border "
                 "of the picture or of its region would leave less than half of it",
                 moments.size(), wanted));
    }
    return moments;
  }

  // When none of them is there.
  [[nodiscard]] SampleRange empty_of_all() const {
    SampleRange empty = tracks_.front().empty;
    for (const SubjectTrack& track : tracks_) {
      empty.first = std::max(empty.first, track.empty.first);
      empty.last = std::max(empty.first, std::min(empty.last, track.empty.last));
    }
    return empty;
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

  [[nodiscard]] static const SubjectPlace& last_whole_place(const SubjectTrack& track) {
    const auto whole = std::find_if(track.places.rbegin(), track.places.rend(),
                                    [](const SubjectPlace& place) { return !place.is_cut_off; });
    return whole == track.places.rend() ? track.places.back() : *whole;
  }

  [[nodiscard]] Interval interval_of(SampleRange samples) const {
    return {timeline_.start_ns(samples.first), timeline_.end_ns(samples.last - 1)};
  }

  // The scene between the moments: when nothing is there; else the moments together, in each of which most of it is
  // seen.
  [[nodiscard]] GainFunction background(const Study& study) const {
    GainPieces pieces;
    if (!study.empty.empty()) {
      pieces.add(interval_of(study.empty), 1, 1);
    } else {
      for (const std::uint64_t sample : study.moments) pieces.add(interval_of({sample, sample + 1}), 1, 1);
    }
    return pieces.function();
  }

  // The whole way of the subject, or of all of them. Where nothing is there for a while, that is taken away again, so that the way may be as
  // much stronger.
  [[nodiscard]] GainFunction trail(Study& study) const {
    std::uint64_t first = tracks_.front().places.front().sample, last = 0;
    double covered = 0;
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      first = std::min(first, tracks_[i].places.front().sample);
      last = std::max(last, request_.style == StudyStyle::rear_curtain ? study.moments[i]
                                                                       : tracks_[i].places.back().sample);
      covered = std::max(covered, tracks_[i].covered_share());
    }
    const Interval way = interval_of({std::min(first, last), last + 1});
    const double begin = shape_ == TrailShape::ramp ? 0.0 : 1.0, end = shape_ == TrailShape::fade ? 0.0 : 1.0;
    GainPieces pieces;
    const Interval without = study.empty.empty() ? way : interval_of(study.empty);
    const bool is_apart = without.end_ns <= way.begin_ns || without.begin_ns >= way.end_ns;
    double way_ns = 0;  // each time as strong as it is
    std::vector<std::pair<Interval, std::pair<double, double>>> moving;
    for (const Interval& part : without_rests(way)) {
      const auto gain = [&](std::int64_t time_ns) {
        return begin + (end - begin) * static_cast<double>(time_ns - way.begin_ns) /
                           static_cast<double>(way.end_ns - way.begin_ns);
      };
      const double first_gain = gain(part.begin_ns), last_gain = gain(part.end_ns);
      way_ns += static_cast<double>(part.end_ns - part.begin_ns) * (first_gain + last_gain) / 2;
      moving.push_back({part, {first_gain, last_gain}});
    }
    const auto add_way = [&] {
      for (const auto& [part, gains] : moving) pieces.add(part, gains.first, gains.second);
    };
    if (!is_apart || request_.style == StudyStyle::frozen) {
      add_way();
      return pieces.function();
    }
    const double wanted = kTrailOpacity / covered;
    study.trail_strength = std::round(10 * std::clamp(wanted, 1.0, kMaxStrength)) / 10;
    const double taken =
        -(1 - 1 / study.trail_strength) * way_ns / static_cast<double>(without.end_ns - without.begin_ns);
    const double rounded = std::round(1000 * taken) / 1000;
    const bool is_before = without.begin_ns < way.begin_ns;
    if (is_before) pieces.add(without, rounded, rounded);
    add_way();
    if (!is_before) pieces.add(without, rounded, rounded);
    return pieces.function();
  }

  // Parts of the way in which a single subject goes on; all of it for several, or for a scene that is exposed for all of
  // the time.
  [[nodiscard]] std::vector<Interval> without_rests(const Interval& way) const {
    std::vector<Interval> parts{way};
    if (request_.style == StudyStyle::frozen || tracks_.size() > 1) return parts;
    for (const SampleRange& rest : tracks_.front().rests) {
      const Interval resting = interval_of(rest);
      if (parts.empty() || resting.begin_ns >= way.end_ns) break;
      const Interval part = parts.back();
      parts.pop_back();
      if (part.begin_ns < resting.begin_ns) parts.push_back({part.begin_ns, resting.begin_ns});
      if (resting.end_ns < part.end_ns) parts.push_back({resting.end_ns, part.end_ns});
    }
    return parts.empty() ? std::vector<Interval>{way} : parts;
  }

  const StudyRequest& request_;
  const Timeline& timeline_;
  const std::string& name_;  // of the capture, for messages
  std::vector<SubjectTrack> tracks_;
  const std::vector<Rectangle>& regions_;  // in which each was looked for
  std::vector<std::size_t> subjects_;      // whose moment each is
  TrailShape shape_;
};

}  // namespace

namespace {

std::string text_of(const Rectangle& region) {
  return format("region {},{},{},{}", region.x, region.y, region.width, region.height);
}

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

// Throws what makes no study. Moments that are stated are shown wherever the subject goes.
void check_track(const SubjectTrack& track, const std::string& where, std::uint32_t by_codes,
                 std::uint32_t side, bool is_stated) {
  if (track.moving_share > kMaxMoving) {
    throw EverythingMoves(format(
        "{}: {:.0f} % of the picture differ from the scene at rest on average: everything moves, as it "
        "does where the camera did. A study needs a scene that rests, and something that moves in it",
        where, 100 * track.moving_share));
  }
  if (track.places.empty()) {
    throw NoSubject(
        format("{}: nothing moves: no part of it differs from the rest of the time by more than {} codes",
               where, by_codes));
  }
  if (is_stated) return;
  if (kMinExtent * side > track.extent) {
    throw NoSubject(
        format("{}: nothing goes anywhere: what moves most goes {:.0f} pixels of {}, and is {:.0f} pixels "
               "large. Take a part of the picture, or name the moments to show",
               where, track.extent, side, track.size()));
  }
  if (track.is_scraps()) {
    throw NoSubject(format(
        "{}: what goes furthest are scraps: they fill {:.0f} % of their box and are {:.0f} % of what differs "
        "from the scene at rest, and a thing that goes its way is at least half of one of these. So do edges look of a "
        "thing that goes less than its own size, and never leaves its place, or that shakes, grows or shines: it cannot "
        "be shown twice. Take a clip in which it goes further, name a region with a single subject, or the moments to "
        "show",
        where, 100 * track.fill, 100 * track.share));
  }
  if (track.flickers) {
    throw NoSubject(format(
        "{}: what differs from the scene at rest flickers here and there over {:.0f} pixels, and nothing "
        "of it goes its way as one thing: light that changes, leaves, or many things at once. Name a "
        "region with a single subject, a part of the time, or the moments to show",
        where, track.extent));
  }
}

}  // namespace

MadeMask make_regions(Study& study, CaptureSource& capture, const std::string& capture_name) {
  MadeMask made = make_mask(study.mask, &capture, capture_name, [&] { return std::move(study.plate); });
  if (!study.are_moments_found) return made;
  const auto left = made.mask.pixels_per_tag();
  for (std::size_t i = 0; i < made.steps.size(); ++i) {
    const StepReport& step = made.steps[i];
    if (2 * left[step.tag] >= step.pixel_count) continue;
    throw NoSubject(nutik::format(
        "{}: the subject overlaps with itself: of the {} pixels that it has at picture {} moments after it "
        "cover "
        "all but {}. It goes too little for its size. Name moments further apart, or show a single one",
        capture_name, step.pixel_count, study.moments[i], left[step.tag]));
  }
  return made;
}

Study plan_study(CaptureSource& capture, const std::string& capture_name, const StudyRequest& request,
                 const MemoryBudget& memory, const ReportedProgress& progress) {
  if (request.style == StudyStyle::slit) {
    return slit_study(capture, capture_name, std::get<std::uint32_t>(request.moments), request.slit_from);
  }
  const CaptureFormat& format = capture.format();
  const std::vector<Rectangle> regions = regions_of(request, capture_name, format.shape);
  MadePlate plate = make_rough_plate(capture, capture_name, memory, progress);
  const double moving = uncertain_share(plate.uncertain, regions);
  if (moving > kMaxMoving) {
    throw EverythingMoves(
        nutik::format("{}: {:.0f} % of the pixels hold no light for half of the time: everything moves, as "
                      "it does where nobody held "
                      "the camera still. A study needs a scene that rests and something that moves in it",
                      capture_name, 100 * moving));
  }
  if (request.style == StudyStyle::clean) {
    Study study;
    study.plate = std::move(plate.picture);
    return study;
  }
  const auto by_codes = static_cast<std::uint32_t>(std::ceil(2 * CodeBand::kMinShare * format.white_code));
  std::vector<SubjectTrack> tracks = track_subjects(capture, plate.picture, by_codes, regions, progress);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const bool is_stated = std::holds_alternative<std::vector<StatedTime>>(request.moments);
    check_track(tracks[i], request.regions.empty() ? capture_name : capture_name + ", " + text_of(regions[i]),
                by_codes, std::max(regions[i].width, regions[i].height), is_stated);
  }
  Study study;
  study.plate = std::move(plate.picture);
  StudyPlanner planner(request, capture.timeline(), capture_name, std::move(tracks), regions);
  planner.choose(study);
  planner.add_regions(study);
  planner.add_functions(study);
  return study;
}

ExposureRequest study_exposure(const Study& study, StudyStyle style, const Mask& regions) {
  ExposureRequest request;
  request.gains = Shared(FunctionSet(study.functions));
  request.mask = Shared(MaskWithRegions(
      style == StudyStyle::slit ? regions : feathered(regions, Feather::parse(kStudyFeather))));
  request.normalization = Normalization::parse("integral");
  return request;
}

}  // namespace nutik
