#include "media/clip.hpp"

#include <algorithm>
#include <cmath>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/seconds_text.hpp"
#include "capture/text.hpp"
#include "media/settled_fact.hpp"

namespace nutik {

std::string left_out_note(std::string_view channels) {
  return format("the file's {} {} left out", channels, channels.starts_with("channels ") ? "are" : "is");
}

void refuse_left_out(const std::string& name, std::string_view channels) {
  if (!channels.empty()) throw InputError(format("{} has {} beside its codes; save it without", name, channels));
}

void refuse_yuv_options(const ClipOptions& options) {
  if (!options.matrix && !options.range && !options.chroma_at) return;
  throw UsageError(
      "its pictures are RGB or grey as they are: leave matrix, range and the place of chroma out",
      {Setting::matrix, Setting::range, Setting::chroma_place});
}

void describe_light(ClipInfo& info, double white) {
  info.holds_light = true;
  info.roundings.add();
  info.format.white_code = kLightSteps;
  info.facts.push_back({format("light {} is white, to the nearest of {} steps", white, kLightSteps), Origin::stated,
                        Setting::white_code});
}

void describe_stored_codes(ClipInfo& info, const ClipOptions& options, const StoredCodes& codes) {
  refuse_yuv_options(options);
  CaptureFormat& capture = info.format;
  capture.transfer = settle(info.facts, options.transfer, codes.transfer, codes.usual, Setting::transfer,
                            [](const Transfer& transfer) { return "transfer " + transfer.text(); });
  const auto add_origin = [&](const std::string& unread) {
    Fact& fact = info.facts.back();
    if (fact.origin == Origin::file && !codes.colours_from.empty()) fact.source = codes.colours_from;
    if (fact.origin == Origin::assumed && !unread.empty()) fact.remark = format("the file names {}", unread);
  };
  add_origin(codes.unread_transfer);
  if (capture.shape.channels > 1) {
    capture.primaries =
        settle(info.facts, options.primaries, codes.primaries,
               capture.transfer.usual_primaries().value_or(Primaries::bt709), Setting::primaries,
               [](Primaries primaries) { return format("primaries {}", to_text(primaries)); });
    add_origin(codes.unread_primaries);
  }
  capture.pixel_aspect = settle(info.facts, options.pixel_aspect, codes.pixel_aspect, Rational{1, 1},
                                Setting::pixel_aspect, pixel_aspect_text);
}

namespace {

constexpr double kMinContrast = 0.001, kMaxContrast = 10;
constexpr double kMinStart = 0.0001;

}  // namespace

Contrast parse_contrast(std::string_view text) {
  const auto colon = text.find(':');
  const auto up = parsed<double>(text.substr(0, colon));
  const auto down = colon == text.npos ? up : parsed<double>(text.substr(colon + 1));
  const auto is_possible = [](std::optional<double> step) {
    return step && *step >= kMinContrast && *step <= kMaxContrast;
  };
  if (!is_possible(up) || !is_possible(down)) {
    throw UsageError(
        format("contrast '{}' is no step of log light; write 0.2, or one for up and one for down, 0.3:0.17, "
               "each from {} to {}",
               text, kMinContrast, kMaxContrast));
  }
  return {*up, *down};
}

StartLight parse_start_light(std::string_view text) {
  const auto light = parsed<double>(text);
  if (!light) return std::filesystem::path(text);
  if (*light >= kMinStart && *light <= 1) return *light;
  throw UsageError(
      format("light {} at the start is outside {} … 1, of which 1 is white", text, kMinStart));
}

std::string_view to_text(YuvMatrix matrix) {
  switch (matrix) {
    case YuvMatrix::bt601: return "bt601";
    case YuvMatrix::bt709: return "bt709";
    case YuvMatrix::bt2020: return "bt2020";
    case YuvMatrix::fcc: return "fcc";
    case YuvMatrix::smpte240m: return "smpte240m";
    case YuvMatrix::p3: return "p3";
    case YuvMatrix::ycgco: return "ycgco";
  }
  return {};
}

std::string_view to_text(CodeRange range) { return range == CodeRange::full ? "full" : "limited"; }

std::string_view to_text(ChromaPlace place) {
  switch (place) {
    case ChromaPlace::left: return "left";
    case ChromaPlace::center: return "center";
    case ChromaPlace::topleft: return "topleft";
    case ChromaPlace::top: return "top";
    case ChromaPlace::bottomleft: return "bottomleft";
    case ChromaPlace::bottom: return "bottom";
  }
  return {};
}

Rational parse_pixel_aspect(std::string_view text) {
  constexpr double kMax = 64.0;
  const auto colon = text.find(':');
  std::string fraction(text);
  if (colon != std::string_view::npos) fraction[colon] = '/';
  const Rational aspect = Rational::parse(fraction, "pixel aspect");
  if (!(aspect.value() >= 1 / kMax && aspect.value() <= kMax)) {
    throw UsageError(format("pixel aspect '{}' lies outside 1:64 … 64:1", text));
  }
  return aspect;
}

// Pictures that a decoder leaves out shift all behind them to earlier times.
std::optional<std::string> lost_pictures_text(const std::string& name, std::uint64_t announced, std::uint64_t decoded) {
  if (announced == 0 || announced == decoded) return std::nullopt;
  return format(
      "{} announces {} pictures and {} could be decoded: if some within are damaged, those after them have the "
      "times of others",
      name, announced, decoded);
}

Timeline timeline_of(const std::string& name, const ClipInfo& info, const ClipOptions& options,
                     std::uint64_t sample_count) {
  const ClipTiming& timing = info.timing;
  const std::optional<Rational> rate = options.rate ? options.rate : timing.rate;
  if (!timing.exposed_ns) return timeline_of(name, info, options, Timeline::kFullShutter, sample_count);
  if (rate) {
    const double degrees =
        360.0 * static_cast<double>(*timing.exposed_ns) * rate->value() / static_cast<double>(kSecondNs);
    constexpr double kRounding = 1.01;  // of times that cameras write
    if (degrees > 360.0 * kRounding) {
      throw InputError(
          format("{}: at {} pictures a second each lasts {:.6g} s, and the shutter is said to "
                 "have been open for {}; state the rate or the shutter angle that it was filmed with",
                 name, rate->text(), 1 / rate->value(), seconds_text(*timing.exposed_ns)),
          {Setting::frame_rate, Setting::shutter_angle});
    }
    // As exact as anybody reads an angle; longer than a period none is.
    constexpr std::int64_t kParts = 1'000'000;
    const auto parts =
        static_cast<std::int64_t>(std::clamp(std::round(degrees * kParts), 1.0, 360.0 * kParts));
    return timeline_of(name, info, options, Rational::of(parts, kParts), sample_count);
  }
  ClipInfo listed = info;
  const std::vector<std::int64_t>& starts = timing.starts_ns;
  for (std::size_t k = 0; k < starts.size(); ++k) {
    const std::int64_t end_ns = starts[k] + *timing.exposed_ns;
    listed.timing.exposures.push_back(
        {starts[k], k + 1 < starts.size() ? std::min(end_ns, starts[k + 1]) : end_ns});
  }
  return timeline_of(name, listed, options, Timeline::kFullShutter, sample_count);
}

Timeline timeline_of(const std::string& name, const ClipInfo& info, const ClipOptions& options,
                     Rational shutter_angle, std::uint64_t sample_count) {
  if (options.rate) return Timeline::constant(*options.rate, shutter_angle, sample_count);
  if (!info.timing.is_known()) {
    const std::string& doubt = info.timing.rate_doubt;
    throw InputError(format("{} does not say how fast it was taken{}{}; state the rate", name,
                            doubt.empty() ? "" : ": ", doubt),
                     {Setting::frame_rate});
  }
  if (info.timing.rate) {
    try {
      static_cast<void>(Timeline::constant(*info.timing.rate, Timeline::kFullShutter, sample_count));
    } catch (const UsageError& error) {  // nobody stated it
      throw InputError(format("{}: the rate in the file cannot be: {}; state another", name, error.what()),
                       {Setting::frame_rate});
    }
    return Timeline::constant(*info.timing.rate, shutter_angle, sample_count);
  }
  const std::size_t times = std::max(info.timing.starts_ns.size(), info.timing.exposures.size());
  if (times < sample_count) {
    throw InputError(
        format("{} has {} pictures but only {} times; state its rate", name, sample_count, times),
        {Setting::frame_rate});
  }
  try {
    if (!info.timing.exposures.empty()) {
      const auto& exposures = info.timing.exposures;
      return Timeline::explicit_exposures(
          {exposures.begin(), exposures.begin() + static_cast<std::ptrdiff_t>(sample_count)});
    }
    // Where the picture behind the last one begins, it does not have to be guessed how long the last one holds.
    const std::vector<std::int64_t>& starts = info.timing.starts_ns;
    const bool is_next_known = starts.size() > sample_count && sample_count > 0;
    Timeline timeline = Timeline::irregular(
        {starts.begin(),
         starts.begin() + static_cast<std::ptrdiff_t>(sample_count + (is_next_known ? 1 : 0))},
        shutter_angle);
    if (!is_next_known) return timeline;
    const auto samples = timeline.table().first(sample_count);
    return Timeline::stored({samples.begin(), samples.end()}, timeline.start_ns(sample_count), shutter_angle);
  } catch (const InputError& error) {
    throw InputError(format("{}: {}", name, error.what()), error.settings());
  }
}

}  // namespace nutik
