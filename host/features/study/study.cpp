#include "features/study/study.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/median.hpp"
#include "features/masks/mask_making.hpp"
#include "features/plate/plate.hpp"
#include "features/study/study_regions.hpp"
#include "features/study/study_subjects.hpp"
#include "features/study/study_trail.hpp"
#include "mask/feather.hpp"
#include "scene/moments.hpp"
#include "scene/place_times.hpp"
#include "session/requests/stated_moments.hpp"
#include "session/text/number_text.hpp"

namespace nutik {
namespace {

constexpr double kMaxUnrest = 0.6;  // of the picture, on average: where more moves is no scene
// Largest share of a subject's border with an edge in the plate and none in the picture. Measured: at most 0.1 before
// texture and 0.25 before large dark things where the plate does not show the subject; 0.2 where it shows a quarter of
// it. The latter cover a place for nearly half of the time, hence kMinCoveredInPlate.
constexpr double kMaxPlateEdges = 0.15;
// Where the plate has so much of the border, the thing is gone from the picture: a hole, however long it was covered.
constexpr double kMinCoveredInPlate = 0.4, kHoleEdges = 0.5;
// Ground that it laid bare for good is such a hole, of a quarter of its size or more. Measured: 0.96 to 1 of balls that
// rested for half of the time, 0.42 of what stands for most of its way.
constexpr double kMinBare = 0.25;
// The share of a single moment's border, where that stands for what makes no study, at which there is an edge or light
// changed.
constexpr double kMinOwnEdges = 0.4;
// And of a thing that moves as one whole. Measured: 0.2 of dark legs that blur before dark ground, at most 0.05 of
// light on a wall.
constexpr double kMinEdgesOfWhole = 0.1;
constexpr std::uint64_t kMinTelling = 144;  // pixels: the border of fewer is too short to tell its edges
// How far beyond that what lies around a subject reaches: a shadow ends as softly as no threshold shows.
constexpr double kAroundPixels = 6;
// By how much of the codes by which it differs the ground around it may be brighter then than where it is bare: more
// would be a halo.
constexpr double kMaxBrightened = 0.25;

Feather feather_of(const StudyRequest& request) {
  return request.feather.value_or(Feather{request.style == StudyStyle::slit ? 0 : kStudyFeatherCentipixels, {}});
}

// How far regions reach beyond the subject, so that they are blended outside of it: in whole pixels, and as far as it
// is blended usually, for its own border is soft.
std::uint32_t border_pixels(const StudyRequest& request) {
  return static_cast<std::uint32_t>(
      (std::max(feather_of(request).everywhere_centipixels, kStudyFeatherCentipixels) + 99) / 100);
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

// For messages.
std::string where(const std::string& name, const StudyRequest& request, const Rectangle& region) {
  return request.regions.empty() ? name : name + ", " + text_of(region);
}

// The place at which it is seen best: large, and standing out.
const SubjectPlace& strongest_of(const std::vector<SubjectPlace>& places) {
  const Places telling = telling_places(places);
  Places best = whole_places(telling);
  const auto size = [](const SubjectPlace& place) { return static_cast<double>(place.cells.size()); };
  // Where a thing reaches out of the picture, what a border does not cut off is a piece of it.
  std::erase_if(best, [&](const SubjectPlace* place) { return size(*place) < usual(telling, size) / 2; });
  if (best.empty()) best = telling;
  const auto strength = [&](const SubjectPlace* place) {
    return static_cast<double>(place->solid) * place->contrast * place->contrast;
  };
  return best.empty() ? places.front() : **std::ranges::max_element(best, {}, strength);
}

// Whether a place covers half or more of the smaller of the two.
bool covers_half(const SubjectPlace& place, const SubjectPlace& other) {
  return 2 * common_cells(place, other) >= std::min(place.cells.size(), other.cells.size());
}

class StudyPlanner {
 public:
  StudyPlanner(const StudyRequest& request, CaptureSource& capture, const std::string& name, Picture plate,
               std::vector<FollowedSubject> followed, std::uint32_t by_codes)
      : request_(request),
        capture_(capture),
        timeline_(capture.timeline()),
        name_(name),
        plate_(std::move(plate)),
        followed_(std::move(followed)),
        by_codes_(by_codes) {}

  // Chooses moments, and others for those whose regions turn out not to show what they should.
  void plan(Study& study) {
    for (FollowedSubject& each : followed_) {
      each.track.bare = ground_laid_bare(each.track);
      each.exchange = exchanged_by(each.track, capture_, name_, by_codes_);
      // A thing that lies on such ground in part is seen in part, beside it.
      const auto is_whole = [&](const SubjectPlace& place) {
        return !touches(place, each.track.bare, each.track.cell_columns);
      };
      if (std::ranges::count_if(each.track.places, is_whole) > 1) set_aside(each, is_whole);
    }
    const std::vector<std::string> notes = study.notes;
    for (int round = 0;; ++round) {
      study.notes = notes;
      choose(study);
      if (study.moments.empty() || round == kMaxRounds) {
        study.notes = notes;
        return show_all_of_the_time(study);
      }
      add_regions(study);
      study.regions = make_mask(study.mask, &capture_, name_, [&] { return plate_; });
      if (!study.are_moments_found) break;
      const std::vector<std::size_t> bad = bad_moments(study);
      if (bad.empty()) break;
      refuse(study, bad, round + 2 >= kMaxRounds);
    }
    if (!study.are_moments_found) tell_of_holes(study);
    std::vector<SubjectTrack> tracks;
    for (FollowedSubject& each : followed_) {
      std::ranges::move(each.refused, std::back_inserter(each.track.places));
      std::ranges::sort(each.track.places, {}, &SubjectPlace::sample);
      if (each.verdict.stays && followed_.size() == 1 && has_trail(request_)) study.way = way_of_lights(each.track);
      if (!each.track.places.empty()) tracks.push_back(std::move(each.track));
    }
    for (const SubjectTrack& track : tracks) {
      const double step = usual_step(track);
      if (step <= study.step_share * track.size()) continue;
      study.step_pixels = step;
      study.step_share = step / track.size();
    }
    if (!study.way.empty()) {
      study.notes.emplace_back(
          "most of what differs from the scene at rest is seen before or behind that moment: around it all of that "
          "time is exposed");
    }
    add_functions(study, request_, timeline_, tracks);
  }

 private:
  static constexpr int kMaxRounds = 4;
  static constexpr std::size_t kMaxTags = 255;

  // Where the plate shows the subject as it was before it left: what changed for good there has its edges in the plate.
  [[nodiscard]] std::vector<std::size_t> ground_laid_bare(const SubjectTrack& track) const {
    std::vector<std::size_t> bare;
    const double least = kMinBare * std::pow(track.size() / track.cell_side, 2);
    for (const std::vector<std::size_t>& part : track.changed_for_good()) {
      if (static_cast<double>(part.size()) < least) continue;
      const select::Rectangle box = box_round(part, track);
      const Point middle{box.corner.x + box.width / 2, box.corner.y + box.height / 2};
      const auto away = [&](const SubjectPlace& place) { return distance(place.centre, middle); };
      const std::uint64_t sample = std::ranges::max_element(track.places, {}, away)->sample;
      MaskStep step;
      step.name = {"what changed for good"};
      step.tag = 1;
      step.selection = select::Subject{stated_sample(sample, timeline_)};
      step.by_codes = by_codes_;
      step.changes = {{RegionChange::Kind::within, 0.0, box}};
      MaskRequest request;
      request.steps = {std::move(step)};
      const MadeMask made = make_mask(request, &capture_, name_, [&] { return plate_; });
      if (made.steps.front().plate_edges.value_or(0) > kHoleEdges) std::ranges::copy(part, std::back_inserter(bare));
    }
    std::ranges::sort(bare);
    return bare;
  }

  // From where to where anything differs, if most of that is elsewhere, at other times: lights that come and go.
  [[nodiscard]] static SampleRange way_of_lights(const SubjectTrack& track) {
    std::size_t elsewhere = 0, own = 0;
    SampleRange way;
    for (std::size_t look = 0; look < track.looked_at.size(); ++look) {
      const auto cells = static_cast<std::size_t>(std::ranges::count((*track.differing)[look], true));
      if (cells < kMinCells) continue;
      way = {way.empty() ? track.looked_at[look] : way.first, track.looked_at[look] + 1};
      const bool is_then = track.places.front().sample <= way.last - 1 && way.last - 1 <= track.places.back().sample;
      (is_then ? own : elsewhere) += cells;
    }
    return elsewhere > own ? way : SampleRange();
  }

  // Subject by subject.
  void choose(Study& study) {
    study.moments.clear();
    study.subjects.clear();
    study.falls_short = false;
    std::vector<SubjectPlace> taken;
    for (std::size_t i = 0; i < followed_.size(); ++i) {
      for (const std::uint64_t sample : moments_of(i, taken, study)) {
        study.moments.push_back(sample);
        study.subjects.push_back(i);
      }
    }
    if (study.moments.size() > kMaxTags) {
      throw UsageError(format("{} moments of {} subjects are {}; a mask has room for {}",
                              study.moments.size() / followed_.size(), followed_.size(), study.moments.size(),
                              kMaxTags));
    }
  }

  void add_regions(Study& study) const {
    std::vector<MaskStep> around, exchanged;
    study.mask.steps.clear();
    study.grounds.assign(study.moments.size(), {});
    const std::uint32_t border = border_pixels(request_);
    for (std::size_t i = 0; i < study.moments.size(); ++i) {
      MaskStep step;
      step.name = {nutik::format("subject {}", i + 1)};
      step.tag = static_cast<std::uint8_t>(i + 1);
      step.selection = select::Subject{stated_sample(study.moments[i], timeline_)};
      const SubjectTrack& track = followed_[study.subjects[i]].track;
      if (!is_seen_at(track, study.moments[i])) {
        study.notes.push_back(format(
            "at {} ({}) the subject that was followed{} is not seen: what differs most from the empty scene "
            "then, if anything, is shown in its place",
            duration_text(timeline_.start_ns(study.moments[i])), stated_sample(study.moments[i], timeline_).text(),
            followed_.size() > 1 ? " in " + text_of(followed_[study.subjects[i]].region) : ""));
      }
      step.by_codes = request_.by_codes;
      study.grounds[i] = ground_of(study, i);
      // Where a trail ends at the subject itself, ground of its moment between the two would be a halo.
      const std::uint32_t within = has_trail(request_) && study.grounds[i].empty() ? kStudyFeatherCentipixels / 100 : 0;
      step.changes = whole_within(box_at(study.subjects[i], study.moments[i]), border, within);
      if (!study.grounds[i].empty()) {
        for (std::size_t level = 0; level < kAround.size(); ++level) {
          MaskStep& all = around.emplace_back(step);
          all.tag = static_cast<std::uint8_t>((level + 1) * study.moments.size() + i + 1);
          if (level == 0) all.changes.back().radius -= kAroundPixels;
          all.by_codes = static_cast<std::uint32_t>(std::lround(kAround[level].times * by_codes_));
        }
        std::get<select::Subject>(step.selection).is_without_shadow = true;
      }
      if (is_seen_at(track, study.moments[i])) {
        std::ranges::move(exchange_steps(followed_[study.subjects[i]].exchange, place_at(track, study.moments[i]),
                                         step.tag, border),
                          std::back_inserter(exchanged));
      }
      study.mask.steps.push_back(std::move(step));
    }
    std::ranges::stable_sort(around, {}, [&](const MaskStep& step) { return (step.tag - 1U) / study.moments.size(); });
    study.mask.steps.insert(study.mask.steps.begin(), exchanged.begin(), exchanged.end());
    study.mask.steps.insert(study.mask.steps.begin(), around.begin(), around.end());
  }

  // When the ground of a moment is seen bare, so that its trail may lie on it, and its shadow on both. Nothing where
  // there is no trail, no such time, or no room in the mask.
  [[nodiscard]] SampleRange ground_of(const Study& study, std::size_t moment) const {
    const SubjectTrack& track = followed_[study.subjects[moment]].track;
    if (!has_trail(request_) || !is_seen_at(track, study.moments[moment]) ||
        (kAround.size() + 1) * study.moments.size() > kMaxTags) {
      return {};
    }
    return bare_time(capture_, track, place_at(track, study.moments[moment]),
                     static_cast<std::uint32_t>(kAroundPixels), kMaxBrightened * by_codes_);
  }

  // The scene as it is on average, without moments.
  void show_all_of_the_time(Study& study) const {
    std::string why = why_;
    for (const FollowedSubject& each : followed_) {
      if (why.empty()) why = each.verdict.why;
    }
    study.notes.push_back(format("{}. So the picture exposes all of the time and shows no moments; the style clean "
                                 "shows the empty scene",
                                 why));
    study.falls_short = true;
    study.moments.clear();
    study.subjects.clear();
    MaskStep all;
    all.name = {"all of the time"};
    all.tag = 0;
    all.selection = select::Whole{};
    study.mask.steps = {std::move(all)};
    study.regions = make_mask(study.mask, &capture_, name_);
    study.functions = study.functions_between = whole_time(timeline_);
  }

  [[nodiscard]] std::vector<std::uint64_t> moments_of(std::size_t subject, std::vector<SubjectPlace>& taken,
                                                      Study& study) {
    const auto& [track, region, verdict, refused, exchange] = followed_[subject];
    if (const auto* times = std::get_if<std::vector<StatedTime>>(&request_.moments)) {
      return stated_moments(*times, timeline_);
    }
    study.are_moments_found = true;
    if (verdict.shows == SubjectVerdict::Shows::nothing || track.places.empty()) return {};
    const std::string whose = followed_.size() > 1 ? format("subject {}: ", subject + 1) : "";
    const auto one = [&](const SubjectPlace& place, const std::string& why) {
      taken.push_back(place);
      if (!why.empty()) {
        study.falls_short = true;
        study.notes.push_back(format("{}{}. So a single moment of it is shown", whose, why));
      }
      return std::vector{place.sample};
    };
    if (request_.style == StudyStyle::rear_curtain) return one(last_large_place(track.places), {});
    if (verdict.shows == SubjectVerdict::Shows::one) return one(strongest_of(track.places), verdict.why);
    const std::uint32_t wanted = std::get<std::uint32_t>(request_.moments);
    const std::vector<SubjectPlace> chosen =
        choose_moments(track, wanted, request_.spacing, 4 * border_pixels(request_), taken);
    if (chosen.size() < std::min(wanted, 2u)) {
      if (subject > 0 && chosen.empty()) return {};  // no room beside the others
      return one(strongest_of(track.places),
                 format("what moves goes {:.0f} pixels, and is {:.0f} pixels large: at no two moments{} does it lie "
                        "apart from itself",
                        track.extent, track.size(),
                        track.extent > track.size() ? " at which it is seen as a whole" : ""));
    }
    if (chosen.size() < wanted) {
      study.notes.push_back(format(
          "{}{} of {} moments are shown: at others the subject would overlap with itself, or the border "
          "of the picture or of its region would leave less than half of it",
          whose, chosen.size(), wanted));
    }
    std::vector<std::uint64_t> samples;
    for (const SubjectPlace& place : chosen) samples.push_back(place.sample);
    std::ranges::copy(chosen, std::back_inserter(taken));
    return samples;
  }

  // Moments that the plate shows, too: the ground that the subject left would become a hole. And moments that later
  // ones cover.
  [[nodiscard]] std::vector<std::size_t> bad_moments(const Study& study) {
    std::vector<std::size_t> bad;
    const auto left = study.regions.mask.pixels_per_tag();
    for (std::size_t i = 0; i < study.moments.size(); ++i) {
      const StepReport& step = step_of(study, i);
      const bool is_hole = is_in_plate(study, i);
      const FollowedSubject& subject = followed_[study.subjects[i]];
      const double least = subject.verdict.shows != SubjectVerdict::Shows::all ? kMinOwnEdges
                           : step.pixel_count < kMinTelling             ? 0
                                                                        : kMinEdgesOfWhole;
      const bool is_light = step.own_edges.value_or(1) < least;
      if (!is_hole && !is_light && step.pixel_count > 0 && 2 * left[step.tag] >= step.pixel_count) continue;
      bad.push_back(i);
      if (why_.empty()) why_ = subject.verdict.why;
      if (!why_.empty()) continue;
      if (is_hole) {
        why_ = why_a_hole(study, i);
      } else if (is_light) {
        why_ = format("at picture {} hardly any of its border is an edge of its own: light that changed is no thing",
                      study.moments[i]);
      } else if (step.pixel_count == 0) {
        why_ = format("at picture {} nothing of it stands out from the scene at rest", study.moments[i]);
      } else {
        why_ = format("at picture {} moments after it cover all but {} of the subject's {} pixels: it goes too little "
                      "for its size",
                      study.moments[i], left[step.tag], step.pixel_count);
      }
    }
    return bad;
  }

  // Places like those of bad moments are not chosen again; in the end no others than those that were good.
  void refuse(const Study& study, const std::vector<std::size_t>& bad, bool is_last) {
    for (std::size_t subject = 0; subject < followed_.size(); ++subject) {
      std::vector<SubjectPlace>& places = followed_[subject].track.places;
      std::vector<SubjectPlace> chosen, like;
      for (std::size_t i = 0; i < study.moments.size(); ++i) {
        if (study.subjects[i] != subject) continue;
        const auto place = std::ranges::find(places, study.moments[i], &SubjectPlace::sample);
        if (place != places.end()) (std::ranges::binary_search(bad, i) ? like : chosen).push_back(*place);
      }
      set_aside(followed_[subject], [&](const SubjectPlace& place) {
        const auto is_same = [&](const SubjectPlace& other) { return other.sample == place.sample; };
        if (is_last) return std::ranges::any_of(chosen, is_same);
        return std::ranges::none_of(like, [&](const SubjectPlace& other) { return covers_half(place, other); });
      });
    }
  }

  // Refuses all places but those that may be chosen.
  static void set_aside(FollowedSubject& followed, const auto& may_be_chosen) {
    std::vector<SubjectPlace>& places = followed.track.places;
    const auto first = std::stable_partition(places.begin(), places.end(), may_be_chosen);
    std::move(first, places.end(), std::back_inserter(followed.refused));
    places.erase(first, places.end());
  }

  [[nodiscard]] bool is_in_plate(const Study& study, std::size_t moment) const {
    const double share = step_of(study, moment).plate_edges.value_or(0);
    const FollowedSubject& subject = followed_[study.subjects[moment]];
    return share > kHoleEdges ||
           (share > kMaxPlateEdges && (subject.verdict.shows != SubjectVerdict::Shows::all ||
                                       subject.track.most_covered_share() >= kMinCoveredInPlate));
  }
  [[nodiscard]] static std::string why_a_hole(const Study& study, std::size_t moment) {
    return format(
        "the scene at rest shows the subject, too, which covers some places for half of the time: at picture {} {:.0f} "
        "% of its border are edges of that scene",
        study.moments[moment], 100 * step_of(study, moment).plate_edges.value_or(0));
  }
  void tell_of_holes(Study& study) const {
    for (std::size_t i = 0; i < study.moments.size(); ++i) {
      if (is_in_plate(study, i))
        study.notes.push_back(why_a_hole(study, i) + ". It may be shown in part, or as a hole");
    }
  }

  [[nodiscard]] static double usual_step(const SubjectTrack& track) {
    constexpr double kResting = 0.5;
    std::vector<double> steps;
    for (std::size_t i = 1; i < track.places.size(); ++i) {
      const SubjectPlace &before = track.places[i - 1], &place = track.places[i];
      const double step = distance(place.centre, before.centre) / static_cast<double>(place.sample - before.sample);
      if (step > kResting) steps.push_back(step);
    }
    return steps.empty() ? 0 : median(std::move(steps));
  }

  // Those of moments come last.
  [[nodiscard]] static const StepReport& step_of(const Study& study, std::size_t moment) {
    return study.regions.steps[study.regions.steps.size() - study.moments.size() + moment];
  }

  // Whether it was found at the last sample before that was looked at.
  [[nodiscard]] static bool is_seen_at(const SubjectTrack& track, std::uint64_t sample) {
    const auto after = std::ranges::upper_bound(track.looked_at, sample);
    return after != track.looked_at.begin() &&
           std::ranges::binary_search(track.places, *(after - 1), {}, &SubjectPlace::sample);
  }

  [[nodiscard]] static const SubjectPlace& place_at(const SubjectTrack& track, std::uint64_t sample) {
    return *(std::ranges::upper_bound(track.places, sample, {}, &SubjectPlace::sample) - 1);
  }

  // The box that it was found in then; all that is looked at if it was not.
  [[nodiscard]] select::Rectangle box_at(std::size_t subject, std::uint64_t sample) const {
    const SubjectTrack& track = followed_[subject].track;
    const Rectangle box = is_seen_at(track, sample) ? place_at(track, sample).box : followed_[subject].region;
    return {{double(box.x), double(box.y)}, double(box.width), double(box.height)};
  }

  const StudyRequest& request_;
  CaptureSource& capture_;
  const Timeline& timeline_;
  const std::string& name_;  // of the capture, for messages
  Picture plate_;
  std::vector<FollowedSubject> followed_;
  std::uint32_t by_codes_;
  std::string why_;  // why the first moment was refused that was
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

}  // namespace

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
  if (request.feather->everywhere_centipixels > kMaxStudyFeatherCentipixels) {
    throw UsageError(format(
        "the feather of a study reaches {} pixels at most, for its moments lie four times as far apart",
        kMaxStudyFeatherCentipixels / 100));
  }
}

Study plan_study(CaptureSource& capture, const std::string& capture_name, const StudyRequest& request,
                 const MemoryBudget& memory, const ReportedProgress& progress, Unrest unrest) {
  check_study(request);
  if (request.style == StudyStyle::slit) {
    Study slit = slit_study(capture, capture_name, std::get<std::uint32_t>(request.moments), request.slit_from);
    slit.regions = make_mask(slit.mask, &capture, capture_name);
    return slit;
  }
  const CaptureFormat& format = capture.format();
  const std::vector<Rectangle> regions = regions_of(request, capture_name, format.shape);
  if (request.by_codes.value_or(0) >= format.white_code) {
    throw UsageError(nutik::format("{}: no codes differ by more than {}, for white is {}; state fewer codes",
                                   capture_name, *request.by_codes, format.white_code));
  }
  MadePlate plate = make_rough_plate(capture, capture_name, memory, progress);
  Study study;
  study.moving_share = uncertain_share(plate.uncertain, regions);
  // An empty scene shows no subject whose way would tell that the camera moved.
  const bool is_clean = request.style == StudyStyle::clean;
  const double most = unrest == Unrest::shown ? kMaxUnrest : is_clean ? kMaxMoving / 2 : kMaxMoving;
  if (study.moving_share > most) {
    throw EverythingMoves(
        nutik::format("{}: {:.0f} % of the pixels rest for less than half of the time: everything moves, as it does "
                      "where nobody held the camera still. A study needs a scene that rests and something that moves "
                      "in it",
                      capture_name, 100 * study.moving_share));
  }
  if (is_clean) return study;
  const std::uint32_t by_codes = request.by_codes.value_or(
      static_cast<std::uint32_t>(std::ceil(2 * CodeBand::kMinShare * format.white_code)));
  std::vector<SubjectTrack> tracks = track_subjects(capture, plate.picture, by_codes, regions, progress);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    study.moving_share = std::max(study.moving_share, tracks[i].moving_share);
    if (tracks[i].moving_share <= most) continue;
    throw EverythingMoves(nutik::format(
        "{}: {:.0f} % of the picture differ from the scene at rest on average: everything moves, as it "
        "does where the camera did. A study needs a scene that rests, and something that moves in it",
        where(capture_name, request, regions[i]), 100 * tracks[i].moving_share));
  }
  std::vector<FollowedSubject> followed =
      followed_in(std::move(tracks), regions, request, by_codes, capture_name, study.notes);
  StudyPlanner(request, capture, capture_name, std::move(plate.picture), std::move(followed), by_codes)
      .plan(study);
  return study;
}

bool has_trail(const StudyRequest& request) { return trail_shape(request) != TrailShape::none; }

ExposureRequest study_exposure(const Study& study, const StudyRequest& asked) {
  const Mask& regions = study.regions.mask;
  ExposureRequest request;
  request.gains = Shared(FunctionSet(study.functions));
  const Feather feather = feather_of(asked);
  request.mask = Shared(MaskWithRegions(feather == Feather{} ? regions : feathered(regions, feather)));
  request.normalization = Normalization::parse("integral");
  return request;
}

}  // namespace nutik
