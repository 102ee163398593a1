#include "features/study/study_trail.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>
#include <utility>

#include "capture/format.hpp"
#include "capture/made_samples.hpp"
#include "exposure/function_text.hpp"
#include "exposure/gain_function.hpp"
#include "features/masks/mask_making.hpp"

namespace nutik {
namespace {

// Where a subject covers a place of its way for a share of the time, the trail shows so much of it.
constexpr double kTrailOpacity = 0.5;
constexpr double kMaxStrength = 8;  // more shows the noise of the empty scene
constexpr std::uint64_t kMinEmptySamples = 4;

// A gain over an interval, along a straight line.
struct GainPiece {
  Interval interval;
  double begin_gain = 0, end_gain = 0;

  [[nodiscard]] double length_ns() const { return static_cast<double>(interval.end_ns - interval.begin_ns); }
  [[nodiscard]] double integral() const { return length_ns() * (begin_gain + end_gain) / 2; }
  [[nodiscard]] double at(std::int64_t time_ns) const {
    return std::lerp(begin_gain, end_gain, static_cast<double>(time_ns - interval.begin_ns) / length_ns());
  }
};

// Pieces may lie over each other.
GainFunction sum_of(const std::vector<GainPiece>& pieces) {
  std::set<std::int64_t> times;
  for (const GainPiece& piece : pieces) times.insert({piece.interval.begin_ns, piece.interval.end_ns});
  std::vector<ControlPoint> points;
  for (auto end = std::next(times.begin()); end != times.end(); ++end) {
    const Interval interval{*std::prev(end), *end};
    double begin_gain = 0, end_gain = 0;
    bool is_exposed = false;
    for (const GainPiece& piece : pieces) {
      if (interval.end_ns <= piece.interval.begin_ns || interval.begin_ns >= piece.interval.end_ns) continue;
      begin_gain += piece.at(interval.begin_ns);
      end_gain += piece.at(interval.end_ns);
      is_exposed = true;
    }
    if (!is_exposed) continue;
    if (!points.empty() && points.back().time_ns == interval.begin_ns) {
      points.pop_back();  // it goes on from the piece before it
      if (points.back().gain == begin_gain) points.pop_back();
    } else {
      points.push_back({interval.begin_ns, 0.0});
    }
    if (points.empty() || points.back().gain != begin_gain) points.push_back({interval.begin_ns, begin_gain});
    points.push_back({interval.end_ns, end_gain});
    points.push_back({interval.end_ns, 0.0});
  }
  return with_steps(GainFunction(points));
}

// A gain of 1 over each of them, and of 0 elsewhere.
GainFunction exposing(const std::vector<Interval>& intervals) {
  std::vector<GainPiece> pieces;
  for (const Interval& each : intervals) pieces.push_back({each, 1, 1});
  return sum_of(pieces);
}

class StudyFunctions {
 public:
  StudyFunctions(const StudyRequest& request, const Timeline& timeline,
                 const std::vector<SubjectTrack>& tracks, bool is_between)
      : request_(request),
        is_between_(is_between),
        timeline_(timeline),
        tracks_(tracks),
        shape_(trail_shape(request)) {}

  void add_to(Study& study) const {
    for (std::size_t i = 0; i < study.moments.size(); ++i)
      study.functions.emplace(static_cast<std::uint8_t>(i + 1), exposing({moment_of(study.moments[i])}));
    study.empty = tracks_.front().empty;  // of all the picture, and so of all subjects
    const auto was_there = [](const SubjectTrack& track) { return !track.bare.empty(); };
    if (study.empty.size() < kMinEmptySamples || std::ranges::any_of(tracks_, was_there)) study.empty = {};
    if (shape_ == TrailShape::none) {
      study.functions.emplace(std::uint8_t{0}, background(study));
      return;
    }
    const std::vector<GainPiece> way = trail(study);
    study.functions.emplace(std::uint8_t{0}, sum_of(way));
    // Around a thing lies what is seen at its moment, its shadow for example, and what the trail adds to the ground.
    double light = 0;
    for (const GainPiece& piece : way) light += piece.integral();
    for (std::size_t i = 0; i < study.grounds.size(); ++i) {
      if (study.grounds[i].empty()) continue;
      for (std::size_t level = 0; level < kAround.size(); ++level) {
        std::vector<GainPiece> around = way;
        for (const auto& [interval, share] :
             {std::pair(moment_of(study.moments[i]), 1 / kAround[level].trail_share),
              std::pair(interval_of(study.grounds[i]), -1.0)}) {
          const double gain = share * light / static_cast<double>(interval.end_ns - interval.begin_ns);
          around.push_back({interval, gain, gain});
        }
        study.functions.emplace(static_cast<std::uint8_t>((level + 1) * study.moments.size() + i + 1), sum_of(around));
      }
    }
  }

 private:
  [[nodiscard]] Interval interval_of(SampleRange samples) const {
    return {timeline_.start_ns(samples.first), timeline_.end_ns(samples.last - 1)};
  }

  [[nodiscard]] Interval moment_of(std::uint64_t sample) const {
    const Interval exposed = interval_of({sample, sample + 1});
    if (!is_between_) return exposed;
    const std::int64_t middle = std::midpoint(exposed.begin_ns, exposed.end_ns);
    const std::int64_t reach = (exposed.end_ns - exposed.begin_ns) / (4 * (MadeSamples::kMost + 1));
    return {middle - reach, middle + std::max<std::int64_t>(reach, 1)};
  }

  // The scene between the moments: when nothing is there; else the moments together, in each of which most of it is
  // seen. Where there are several subjects, the moments of one show the others elsewhere: then the samples that show
  // the least of them beside the regions.
  [[nodiscard]] GainFunction background(const Study& study) const {
    if (!study.empty.empty()) return exposing({interval_of(study.empty)});
    const std::vector<std::uint64_t> samples = tracks_.size() > 1 ? least_covered(study) : study.moments;
    std::vector<Interval> shown;
    for (const std::uint64_t sample : std::set(samples.begin(), samples.end()))
      shown.push_back(interval_of({sample, sample + 1}));
    return exposing(shown);
  }

  // In time order.
  [[nodiscard]] std::vector<std::uint64_t> least_covered(const Study& study) const {
    const SubjectTrack& any = tracks_.front();
    const Mask& regions = study.regions.mask;
    std::vector<std::size_t> beside;  // how many cells differ, at each look
    for (const std::vector<bool>& differs : *any.differing) {
      std::size_t count = 0;
      for (std::size_t cell = 0; cell < differs.size(); ++cell) {
        const std::size_t x = cell % any.cell_columns * any.cell_side, y = cell / any.cell_columns * any.cell_side;
        count += differs[cell] && regions.tags[y * regions.width + x] == 0 ? 1 : 0;
      }
      beside.push_back(count);
    }
    const std::size_t least = std::ranges::min(beside);
    std::vector<std::uint64_t> samples;
    for (std::size_t look = 0; look < beside.size(); ++look) {
      if (beside[look] == least) samples.push_back(any.looked_at[look]);
    }
    return samples;
  }

  // The whole way of the subject, or of all of them. Where nothing is there for a while, that is taken away again, so
  // that the way may be as much stronger.
  [[nodiscard]] std::vector<GainPiece> trail(Study& study) const {
    std::uint64_t first = tracks_.front().places.front().sample, last = 0;
    double covered = 0;
    for (const SubjectTrack& track : tracks_) {
      first = std::min(first, track.places.front().sample);
      last = std::max(last, track.places.back().sample);
      covered = std::max(covered, track.covered_share());
    }
    if (request_.style == StudyStyle::rear_curtain) last = std::ranges::max(study.moments);
    const SampleRange seen{std::min(first, last), last + 1};
    if (study.way.empty()) study.way = seen;
    covered *= static_cast<double>(seen.size()) / static_cast<double>(study.way.size());
    const Interval way = interval_of(study.way);
    const double begin = shape_ == TrailShape::ramp ? 0.0 : 1.0, end = shape_ == TrailShape::fade ? 0.0 : 1.0;
    const Interval without = study.empty.empty() ? way : interval_of(study.empty);
    const bool is_apart = without.end_ns <= way.begin_ns || without.begin_ns >= way.end_ns;
    double way_ns = 0;  // each time as strong as it is
    std::vector<GainPiece> pieces;
    for (const Interval& part : without_rests(way)) {
      const auto gain = [&](std::int64_t time_ns) {
        return begin + (end - begin) * static_cast<double>(time_ns - way.begin_ns) /
                           static_cast<double>(way.end_ns - way.begin_ns);
      };
      const double first_gain = gain(part.begin_ns), last_gain = gain(part.end_ns);
      pieces.push_back({part, first_gain, last_gain});
      way_ns += pieces.back().integral();
    }
    if (!is_apart || request_.style == StudyStyle::frozen) return pieces;
    // Where something is for a share of the trail's light, more than all of it would be taken away; and with more than
    // this the empty scene would have more noise than a picture.
    const auto empty_samples = static_cast<double>(study.empty.size());
    const double most = std::min(1 / most_covered_share(pieces), 1 + std::sqrt(empty_samples));
    const double wanted = std::min(kTrailOpacity / covered, most);
    study.trail_strength = std::floor(10 * std::clamp(wanted, 1.0, kMaxStrength)) / 10;
    const double taken =
        -(1 - 1 / study.trail_strength) * way_ns / static_cast<double>(without.end_ns - without.begin_ns);
    const double rounded = std::round(1000 * taken) / 1000;
    pieces.push_back({without, rounded, rounded});
    return pieces;
  }

  // The largest share of the trail's light for which anything is at a place.
  [[nodiscard]] double most_covered_share(const std::vector<GainPiece>& trail) const {
    const SubjectTrack& any = tracks_.front();
    double all = 0;
    std::vector<double> of_cells(any.differing->front().size());
    for (std::size_t look = 0; look < any.looked_at.size(); ++look) {
      const std::int64_t time_ns = timeline_.start_ns(any.looked_at[look]);
      const auto piece = std::ranges::find_if(trail, [&](const GainPiece& each) {
        return each.interval.begin_ns <= time_ns && time_ns < each.interval.end_ns;
      });
      if (piece == trail.end()) continue;
      const double gain = piece->at(time_ns);
      all += gain;
      for (std::size_t cell = 0; cell < of_cells.size(); ++cell)
        of_cells[cell] += (*any.differing)[look][cell] ? gain : 0;
    }
    return all > 0 ? std::ranges::max(of_cells) / all : 1;
  }

  // Parts of the way in which a single subject goes on; all of it for several, or for a scene that is exposed for all
  // of the time.
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
  bool is_between_;  // samples are made between the pictures
  const Timeline& timeline_;
  const std::vector<SubjectTrack>& tracks_;
  TrailShape shape_;
};

// The mean of each cell's first pixel.
double mean_code(const Picture& picture, const SubjectTrack& track, const std::vector<std::size_t>& cells) {
  const Shape& shape = picture.shape;
  const auto mean = [&](const auto& codes) {
    double sum = 0;
    for (const std::size_t cell : cells) {
      const std::size_t x = cell % track.cell_columns, y = cell / track.cell_columns;
      const auto* const pixel = &codes[(y * shape.width + x) * track.cell_side * shape.channels];
      sum += std::accumulate(pixel, pixel + shape.channels, 0.0);
    }
    return sum / static_cast<double>(std::max(cells.size(), std::size_t{1}) * shape.channels);
  };
  return picture.type == ValueType::code8 ? mean(picture.values<std::uint8_t>())
                                          : mean(picture.values<std::uint16_t>());
}

}  // namespace

Study slit_study(CaptureSource& capture, const std::string& name, std::uint32_t wanted, SlitFrom from) {
  const std::uint64_t samples = capture.timeline().sample_count();
  const Shape& shape = capture.format().shape;
  const bool are_columns = from == SlitFrom::left || from == SlitFrom::right;
  const bool are_reversed = from == SlitFrom::right || from == SlitFrom::bottom;
  const auto strips = static_cast<std::uint32_t>(
      std::min<std::uint64_t>({wanted, samples, are_columns ? shape.width : shape.height}));
  const char* const strip = are_columns ? "column" : "row";
  if (strips < 2) throw InputError(format("{}: a single {} shows nothing of the time", name, strip));
  Study study;
  for (std::uint32_t i = 0; i < strips; ++i) {
    const std::uint64_t moment = are_reversed ? strips - 1 - i : i;
    const std::uint64_t sample = moment * (samples - 1) / (strips - 1);
    study.moments.push_back(sample);
    study.functions.emplace(static_cast<std::uint8_t>(i),
                            exposing({{capture.timeline().start_ns(sample), capture.timeline().end_ns(sample)}}));
  }
  const select::Grid grid{are_columns ? strips : 1, are_columns ? 1 : strips};
  study.mask.steps.push_back({"slits", 0, grid, std::nullopt, {}});
  if (strips < wanted) {
    study.notes.push_back(format("{} {}s, not {}: there are no more {}", strips, strip, wanted,
                                 strips == samples ? "pictures"
                                 : are_columns     ? "pixels in a row"
                                                   : "pixels in a column"));
  }
  return study;
}

TrailShape trail_shape(const StudyRequest& request) {
  if (request.trail) return *request.trail;
  switch (request.style) {
    case StudyStyle::trail: return TrailShape::even;
    case StudyStyle::rear_curtain: return TrailShape::ramp;
    case StudyStyle::strobe: return TrailShape::none;
    case StudyStyle::frozen: return TrailShape::even;
    case StudyStyle::clean:
    case StudyStyle::slit: break;
  }
  return TrailShape::none;
}

FunctionSet whole_time(const Timeline& timeline) {
  return {{std::uint8_t{0}, exposing({{timeline.start_ns(0), timeline.end_ns(timeline.sample_count() - 1)}})}};
}

SampleRange bare_time(CaptureSource& capture, const SubjectTrack& track, const SubjectPlace& place,
                      std::uint32_t pixels, double most_codes) {
  constexpr std::size_t kMaxTried = 8;
  SubjectTrack::BareGround bare = track.bare_ground(place, pixels);
  bare.times.resize(std::min(bare.times.size(), kMaxTried));
  const auto code_at = [&](std::uint64_t sample) {
    return mean_code(picture_of_sample(capture, sample), track, bare.cells);
  };
  const double code = code_at(place.sample);
  const auto found = std::ranges::find_if(bare.times, [&](SampleRange time) {
    return code - code_at(std::midpoint(time.first, time.last)) <= most_codes;
  });
  return found == bare.times.end() ? SampleRange() : *found;
}

void add_functions(Study& study, const StudyRequest& request, const Timeline& timeline,
                   const std::vector<SubjectTrack>& tracks) {
  StudyFunctions(request, timeline, tracks, true).add_to(study);
  study.functions_between = std::exchange(study.functions, {});
  StudyFunctions(request, timeline, tracks, false).add_to(study);
}

}  // namespace nutik
