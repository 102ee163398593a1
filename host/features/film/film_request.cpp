#include "features/film/film_request.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"
#include "exposure/key_frame_values.hpp"
#include "session/text/number_text.hpp"

namespace nutik {
namespace {

FilmCurve::Point parse_point(std::string_view line, const FrameTimes& film) {
  const auto comma = line.find(',');
  if (comma == std::string_view::npos || line.find(',', comma + 1) != std::string_view::npos) {
    throw UsageError(
        format("'{}' is no point; write a time of the film and one of the capture: 1.5s,0.4s", line));
  }
  const auto film_time = StatedTime::parse(trimmed(line.substr(0, comma)), "the film's time");
  return {film_moment_ns(film_time, "the film's time", film),
          StatedTime::parse(trimmed(line.substr(comma + 1)), "the capture's time")};
}

void check_order(const std::vector<FilmCurve::Point>& points) {
  const std::int64_t last_ns = points.back().film_ns;
  if (points.size() == 1) {
    if (last_ns == 0) return;
    throw UsageError(format("the first point is at {} of the film; a curve begins at 0s", duration_text(last_ns)));
  }
  const std::int64_t before_ns = points[points.size() - 2].film_ns;
  if (last_ns > before_ns) return;
  throw UsageError(format("the film's time {} is not after {}; points are in order of the film's time",
                          duration_text(last_ns), duration_text(before_ns)));
}

// Smooth shutters have some tens of control points, which need room.
constexpr std::int64_t kMinShapedNs = 1'000;
constexpr std::uint64_t kMaxCurveFrames = 100'000'000;

// How long a frame is exposed at least where a curve stands still.
std::int64_t min_ns(const FramesRequest& request) {
  const auto* plain = std::get_if<PlainInterval>(&request.exposure.gains);
  return plain == nullptr || plain->shutter == Shutter() ? 1 : kMinShapedNs;
}

// From the start of a frame to the last time that its functions gather light.
std::int64_t functions_end_ns(const FramesRequest& request) {
  if (request.keys.functions.empty()) return functions_end_ns(request.exposure);
  std::int64_t end_ns = 0;
  ExposureRequest key = request.exposure;
  for (const FunctionKey& functions : request.keys.functions) {
    key.gains = functions.functions;
    end_ns = std::max(end_ns, functions_end_ns(key));
  }
  return end_ns;
}

std::string outside_text(const Frames& frames, const std::string& name, const Timeline& timeline) {
  std::vector<std::uint64_t> outside;
  for (const std::uint64_t k : frames.numbers) {
    if (frames.curve->leaves(frames.film->exposure(k))) outside.push_back(k);
  }
  if (outside.empty()) return {};
  return format("{} leaves the capture, which lasts {}, in frame{} {}; there the film shows what is left within "
                "it, or stands still at its first or last moment",
                name, duration_text(timeline.duration_ns()), outside.size() > 1 ? "s" : "",
                ranges_text(outside));
}

// The frames whose shutter is closed, or with functions whose moment has come, before the curve ends.
void put_on_curve(Frames& frames, const FramesRequest& request, const Timeline& timeline) {
  frames.curve.emplace(*request.curve, timeline, min_ns(request));
  const std::int64_t end_ns = frames.curve->film_end_ns();
  frames.count = request.exposure.is_plain() ? frames.film->count_ending_by(end_ns)
                                             : frames.film->count_starting_by(end_ns - 1);
  if (frames.count == 0 || frames.count > kMaxCurveFrames) {
    throw UsageError(format("{} lasts {}, which are {} frames of {} a second; a film by a curve has 1 to {}",
                            request.curve->name, duration_text(end_ns), frames.count, request.rate.text(),
                            kMaxCurveFrames));
  }
}

void put_evenly(Frames& frames, const FramesRequest& request, const Timeline& timeline) {
  const std::int64_t start_ns = frames.times.start_ns(0);
  std::int64_t end_ns = timeline.duration_ns();
  if (request.to) {
    const ExactTime to = exact_time(*request.to, "the video's end", timeline);
    const std::int64_t to_ns = round_half_up(to.numerator, to.denominator);
    if (to_ns > end_ns) {
      frames.warning =
          format("the video's end {} lies after the capture's end at {}; the video ends with the capture",
                 request.to->text(), duration_text(end_ns));
    }
    end_ns = std::min(end_ns, to_ns);
  }
  if (start_ns < 0 || start_ns >= timeline.duration_ns()) {
    throw UsageError(format("the video's start {} lies outside the capture, which lasts {}",
                            request.from.text(), duration_text(timeline.duration_ns())));
  }
  if (end_ns <= start_ns) {
    throw UsageError(format("the video would end at {}, which is not after its start at {}", request.to->text(),
                            request.from.text()));
  }
  const bool is_plain = request.exposure.is_plain();
  const std::int64_t exposed_ns = is_plain ? frames.times.end_ns(0) - start_ns : functions_end_ns(request);
  // Functions end with the capture: their last step down may lie 1 ns behind it.
  const std::int64_t length_ns = is_plain ? exposed_ns : std::min(exposed_ns, timeline.duration_ns());
  frames.count = is_plain ? frames.times.count_ending_by(end_ns)
                          // A frame that starts at the very end sees nothing.
                          : frames.times.count_starting_by(end_ns - std::max<std::int64_t>(length_ns, 1));
  if (frames.count == 0) {
    throw UsageError(
        format("no frame fits: {} {}{}, and between the video's start and end are {}",
               is_plain ? "each is exposed for" : "the last function ends", duration_text(exposed_ns),
               is_plain ? "" : " after its frame's start", duration_text(end_ns - start_ns)));
  }
}

// The key that holds at a moment, or comes before it, and how far it is to the next one.
struct Place {
  std::size_t key;
  KeyShare share;
};

template <typename Key>
Place place_of(const std::vector<Key>& keys, std::int64_t film_ns) {
  const auto next = std::ranges::upper_bound(keys, film_ns, {}, &Key::film_ns);
  if (next == keys.begin()) return {0, {}};
  const auto before = next - 1;
  const auto key = static_cast<std::size_t>(before - keys.begin());
  if (next == keys.end()) return {key, {}};
  return {key, {film_ns - before->film_ns, next->film_ns - before->film_ns}};
}

template <typename Key>
void check_order(const std::vector<Key>& keys, const char* of_what, const char* way_out) {
  if (keys.size() == 1) {
    throw UsageError(format("{} is the only key of {}; two or more make them change, {}", keys.front().name,
                            of_what, way_out));
  }
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (keys[i - 1].film_ns < keys[i].film_ns) continue;
    throw UsageError(format("the key {} at {} is not after {} at {}; keys are in order of time", keys[i].name,
                            duration_text(keys[i].film_ns), keys[i - 1].name,
                            duration_text(keys[i - 1].film_ns)));
  }
}

void require_regions(const FunctionKey& has, const FunctionKey& lacks) {
  for (const auto& [tag, function] : *has.functions) {
    if (lacks.functions->contains(tag)) continue;
    throw InputError(format("{} has a function M{} and {} has none; keys have functions for the same mask values",
                            has.name, tag, lacks.name));
  }
}

}  // namespace

FilmCurve FilmCurve::parse(std::string_view text, const std::string& title, const FrameTimes& film) {
  if (text.find('\0') != std::string_view::npos) {
    throw InputError(format("{} holds a zero byte: this is no text file, or one in UTF-16; save it as UTF-8", title));
  }
  if (constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF"; text.starts_with(kByteOrderMark)) {
    text.remove_prefix(kByteOrderMark.size());  // spreadsheets write it
  }
  FilmCurve curve{title, {}};
  std::size_t number = 0;
  for (const std::string& whole : parts_of(text, '\n')) {
    const std::string_view line = trimmed(std::string_view(whole).substr(0, whole.find('#')));
    ++number;
    if (line.empty()) continue;
    try {
      curve.points.push_back(parse_point(line, film));
      check_order(curve.points);
    } catch (const UsageError& error) {
      throw InputError(format("{}:{}: {}", title, number, error.what()));
    }
  }
  if (curve.points.size() < 2) {
    throw InputError(
        format("{} is too short, with {} of the points that a curve has: two or more, a line each: 0s,0.2s and 2s,0.7s "
               "show half a second of the capture in two of the film",
               title, curve.points.size()));
  }
  return curve;
}

CapturedCurve::CapturedCurve(const FilmCurve& curve, const Timeline& timeline, std::int64_t min_ns)
    : duration_ns_(timeline.duration_ns()), min_ns_(std::min(min_ns, timeline.duration_ns())) {
  for (const FilmCurve::Point& point : curve.points) {
    try {
      const ExactTime time = exact_time(point.capture, "the capture's time", timeline);
      points_.push_back({point.film_ns, round_half_up(time.numerator, time.denominator)});
    } catch (const UsageError& error) {
      throw UsageError(format("{}: {}", curve.name, error.what()));
    }
  }
}

std::int64_t CapturedCurve::time_ns(std::int64_t film_ns) const {
  const auto next = std::ranges::upper_bound(points_, film_ns, {}, &Point::film_ns);
  if (next == points_.begin()) return points_.front().capture_ns;
  const auto before = next - 1;
  if (next == points_.end()) return before->capture_ns;
  return time_between(before->capture_ns, next->capture_ns,
                      {film_ns - before->film_ns, next->film_ns - before->film_ns});
}

Exposure CapturedCurve::passed(const Exposure& film) const {
  const std::int64_t first = time_ns(film.start_ns), last = time_ns(film.end_ns);
  Exposure passed{std::min(first, last), std::max(first, last)};
  for (const Point& point : points_) {  // it may turn round meanwhile
    if (point.film_ns <= film.start_ns || point.film_ns >= film.end_ns) continue;
    passed.start_ns = std::min(passed.start_ns, point.capture_ns);
    passed.end_ns = std::max(passed.end_ns, point.capture_ns);
  }
  return passed;
}

Exposure CapturedCurve::exposure(const Exposure& film) const {
  Exposure exposure = passed(film);
  exposure.start_ns = std::clamp<std::int64_t>(exposure.start_ns, 0, duration_ns_);
  exposure.end_ns = std::clamp<std::int64_t>(exposure.end_ns, 0, duration_ns_);
  if (exposure.end_ns - exposure.start_ns >= min_ns_) return exposure;
  const std::int64_t start_ns = std::min(exposure.start_ns, duration_ns_ - min_ns_);
  return {start_ns, start_ns + min_ns_};
}

bool CapturedCurve::leaves(const Exposure& film) const {
  const Exposure range = passed(film);
  return range.start_ns < 0 || range.end_ns > duration_ns_;
}

void KeyFrames::check() const {
  check_order(functions, "functions", "and one alone is a file of functions for the whole film");
  check_order(masks, "masks", "and one alone is a mask for the whole film");
  for (std::size_t i = 1; i < functions.size(); ++i) {
    require_regions(functions[0], functions[i]);
    require_regions(functions[i], functions[0]);
  }
  for (std::size_t i = 1; i < masks.size(); ++i) {
    static_cast<void>(
        mask_between(*masks[i - 1].mask, masks[i - 1].name, *masks[i].mask, masks[i].name, blend, 0));
  }
}

FunctionSet KeyFrames::functions_at(std::int64_t film_ns) const {
  const auto [key, share] = place_of(functions, film_ns);
  if (share.passed == 0) return *functions[key].functions;
  FunctionSet between;
  for (const auto& [tag, function] : *functions[key].functions) {
    between.emplace(tag, function_between(function, functions[key + 1].functions->at(tag), share));
  }
  return between;
}

MaskMoment KeyFrames::mask_moment(std::int64_t film_ns) const {
  const auto [key, share] = place_of(masks, film_ns);
  const auto way = static_cast<std::uint32_t>(time_between(0, kWholeWay, share));
  if (way == kWholeWay) return {key + 1, 0};  // rounded up
  return {key, way};
}

Mask KeyFrames::mask_at(std::int64_t film_ns) const {
  const auto [key, way] = mask_moment(film_ns);
  const MaskKey& from = masks[key];
  const MaskKey& to = way > 0 ? masks[key + 1] : from;
  return blended_mask(*from.mask, from.name, *to.mask, to.name, blend, way, feather);
}

ExposureRequest KeyFrames::exposure_at(std::int64_t film_ns, const ExposureRequest& exposure) const {
  ExposureRequest own = exposure;
  if (!functions.empty()) own.gains = Shared(functions_at(film_ns));
  if (!masks.empty()) own.mask = Shared(MaskWithRegions(mask_at(film_ns)));
  return own;
}

Mask blended_mask(const Mask& a, const std::string& a_name, const Mask& b, const std::string& b_name,
                  MaskBlend blend, std::uint32_t way, const std::optional<Feather>& feather) {
  if (!feather) return mask_between(a, a_name, b, b_name, blend, way);
  if (way == 0) return feathered(a, *feather);
  if (blend == MaskBlend::distance) return feathered(mask_between(a, a_name, b, b_name, blend, way), *feather);
  return mask_between(feathered(a, *feather), a_name, feathered(b, *feather), b_name, blend, way);
}

std::int64_t film_moment_ns(const StatedTime& time, const std::string& what, const FrameTimes& film) {
  if (time.number.numerator < 0) {
    throw UsageError(format("{} {} lies before the film, which begins at 0s", what, time.text()));
  }
  if (!time.counts_samples()) return time.nanoseconds();
  constexpr std::int64_t kMaxFrames = 1'000'000'000;
  if (time.number.denominator != 1 || time.number.numerator > kMaxFrames) {
    throw UsageError(format("{} {} is no frame of a film; frames have whole numbers up to {}", what,
                            time.text(), kMaxFrames));
  }
  return film.start_ns(static_cast<std::uint64_t>(time.number.numerator));
}

std::string FramesRequest::text() const {
  std::string text = format("{} frames a second", rate.text());
  if (exposure.is_plain()) text += format(", {} degrees", angle.text());
  if (curve) text += format(", by {}", curve->name);
  if (speed != Rational{1, 1}) text += format(", speed {}", speed.text());
  if (!keys.functions.empty()) text += format(", {} keys of functions", keys.functions.size());
  if (!keys.masks.empty()) text += format(", {} keys of masks", keys.masks.size());
  return text;
}

Exposure Frames::span() const {
  Exposure span{INT64_MAX, INT64_MIN};
  for (const std::uint64_t k : numbers) {
    Exposure one = exposure(k);
    if (functions_ns && !curve) one.end_ns = one.start_ns + *functions_ns;
    span = {std::min(span.start_ns, one.start_ns), std::max(span.end_ns, one.end_ns)};
  }
  return span;
}

Frames frames_of(const FramesRequest& request, const Timeline& timeline) {
  Frames frames{FrameTimes(exact_time(request.from, "the video's start", timeline), request.rate,
                           request.speed, request.angle),
                0,
                {},
                {}};
  if (request.curve || !request.keys.empty()) frames.film = request.film_times();
  if (request.curve) {
    put_on_curve(frames, request, timeline);
  } else {
    put_evenly(frames, request, timeline);
  }
  if (!request.exposure.is_plain() || !request.keys.functions.empty())
    frames.functions_ns = std::min(functions_end_ns(request), timeline.duration_ns());
  frames.numbers = chosen_numbers(request.numbers, frames.count, "frames", "film");
  if (request.curve) frames.warning = outside_text(frames, request.curve->name, timeline);
  return frames;
}

std::optional<SampleRange> seen_together(const Frames& frames, const Timeline& timeline) {
  constexpr std::uint64_t kFewest = 2, kMost = 3;  // samples
  constexpr std::int64_t kUnseen = 16;             // a part of the exposure's light at either end
  std::uint64_t torn = 0;
  SampleRange all{UINT64_MAX, 0};
  for (std::uint64_t frame = 0; frame < frames.count; ++frame) {
    Exposure exposed = frames.exposure(frame);
    if (frames.functions_ns) exposed.end_ns = exposed.start_ns + *frames.functions_ns;
    const std::int64_t unseen_ns = (exposed.end_ns - exposed.start_ns) / kUnseen;
    const SampleRange samples = timeline.samples_reaching(exposed.start_ns + unseen_ns, exposed.end_ns - unseen_ns);
    if (samples.empty()) continue;
    torn += samples.size() >= kFewest && samples.size() <= kMost ? 1 : 0;
    all = {std::min(all.first, samples.first), std::max(all.last, samples.last)};
  }
  return 4 * torn >= frames.count && torn > 0 ? std::optional(all) : std::nullopt;
}

ExposureRequest exposure_of(const FramesRequest& request, const Frames& frames, std::uint64_t frame) {
  if (request.keys.empty()) return request.exposure;
  return request.keys.exposure_at(frames.film->start_ns(frame), request.exposure);
}

NeedsOfFormat video_needs(std::uint32_t encoder_frames,
                          const std::function<ValueType(const CaptureFormat&)>& type_of) {
  return [encoder_frames, type_of](const CaptureFormat& capture) {
    const std::uint64_t bytes = capture.shape.value_count() * value_bytes(type_of(capture));
    const std::uint64_t encoded = capture.shape.pixel_count() * 3 / 2;
    return MemoryNeeds{{"frames that wait", (waiting_pictures(bytes) + 3) * bytes},
                       {"frames within the encoder", encoder_frames * encoded}};
  };
}

}  // namespace nutik
