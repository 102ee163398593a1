#include "app/requests/requests.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/output/console.hpp"
#include "app/text/number_text.hpp"
#include "session/below/error.hpp"
#include "session/below/format.hpp"
#include "session/below/functions.hpp"
#include "session/requests/function_input.hpp"
#include "session/text/shell_text.hpp"
#include "system/input_bytes.hpp"

namespace nutik::app {
namespace {

constexpr const char* kFilmRate = "24";
constexpr const char* kFilmAngle = "180";

Shared<FunctionSet> read_functions_of(const std::string& name) {
  FunctionInput input = read_function_input(name);
  if (!input.warnings.empty()) print_note(input.warnings);
  return std::move(input.functions);
}

// How far it is from one exposure to the next.
StatedTime step_of(const Options& options) {
  const StatedTime every = StatedTime::parse(*options.every, "--every");
  if (every.number.numerator <= 0)
    throw UsageError(format("--every '{}' is not longer than nothing", *options.every));
  if (every.counts_samples() && every.number.denominator != 1)
    throw UsageError(format("--every '{}' is not a whole number of pictures", *options.every));
  return every;
}

NegativeLight parse_negative_light(const std::string& text) {
  if (text == "saturate") return NegativeLight::saturate;
  if (text == "offset") return NegativeLight::offset;
  if (text == "abs") return NegativeLight::absolute;
  throw UsageError(format("--negative {} is not known; choose saturate, offset or abs", text));
}

// The one value that an option with one value may have.
bool parse_only(const std::optional<std::string>& text, std::string_view option, std::string_view only) {
  if (!text) return false;
  if (*text == only) return true;
  throw UsageError(format("{} {} is not known; the only choice is {} {}", option, *text, option, only));
}

double parse_signed_number(std::string_view text, std::string_view option) {
  const auto value = parse_number(text.substr(text.starts_with('+') ? 1 : 0));
  if (!value) throw UsageError(format("{} {} is no number", option, text));
  return *value;
}

// All but when it is exposed. Functions are read unless they are known.
ExposureRequest timeless_request(const Options& options,
                                 const std::optional<Shared<FunctionSet>>& known = {}) {
  ExposureRequest request;
  request.unmapped_is_zero = parse_only(options.unmapped, "--unmapped", "zero");
  request.live_all = parse_only(options.live, "--live", "all");
  if (options.transfer) request.transfer = Transfer::parse(*options.transfer);
  request.normalization = Normalization::parse(options.normalize.value_or("support"));
  if (options.feather && !options.mask) {
    throw UsageError(
        "--feather blends functions along the edges of a mask; add -m mask.pgm and -k functions.fn");
  }
  if (options.mask_share && !options.mask_to)
    throw UsageError("--mask-share says how far it is to a second mask: add --mask-to");
  request.gain = brightening(options);
  request.delay = delay_request(options);
  if (request.delay) request.delay->read();
  if (!options.functions) {
    if (options.mask || options.mask_to)
      throw UsageError("a mask goes with gain functions (-k), not with a plain interval");
    request.gains = PlainInterval{{}, parse_shutter(options.shutter.value_or("box"), options.shutter_error)};
    return request;
  }
  const auto refuse = [&](const std::optional<std::string>& option, std::string_view name) {
    if (option)
      throw UsageError(format("{} describes a plain interval, -k a file of functions; use one", name));
  };
  refuse(options.exposure, "--exposure");
  refuse(options.shutter, "--shutter");
  refuse(options.shutter_error, "--shutter-error");
  const Shared<FunctionSet> functions = known ? *known : read_functions_of(*options.functions);
  if (!options.mask && functions->size() > 1) {
    throw UsageError(format("{} holds {} functions; a mask says where each applies: -m mask.pgm",
                            input_title(*options.functions), functions->size()));
  }
  request.gains = functions;
  if (options.mask_to && !options.mask) throw UsageError("--mask-to is a second mask; add the first: -m mask.pgm");
  if (options.mask)
    request.mask = Shared(MaskWithRegions(exposure_mask(options, functions->begin()->first)));
  return request;
}

// A value that only a later mask has would end the film in the middle.
void check_mapped(const FramesRequest& request) {
  if (request.keys.masks.empty() || request.exposure.unmapped_is_zero) return;
  const FunctionSet& functions = *std::get<Shared<FunctionSet>>(request.exposure.gains);
  for (const MaskKey& key : request.keys.masks) {
    for (const MaskRegion& region : regions_of(*key.mask)) {
      if (functions.contains(region.tag)) continue;
      throw InputError(format("{}: mask value {} has no function; add M{}, or --unmapped zero", key.name, region.tag,
                              region.tag));
    }
  }
}

// How far it is to the second mask, of kWholeWay.
std::uint32_t mask_way(const Options& options) {
  if (!options.mask_share) throw UsageError("how far is it to --mask-to? Add --mask-share 1/2, 0 to 1");
  const Rational share = Rational::parse(*options.mask_share, "--mask-share");
  if (share.numerator < 0 || share.numerator > share.denominator)
    throw UsageError(format("--mask-share {} is no share of 0 to 1", *options.mask_share));
  return static_cast<std::uint32_t>(round_half_up(int128{share.numerator} * kWholeWay, share.denominator));
}

}  // namespace

std::optional<DelayRequest> delay_request(const Options& options) {
  if (!options.delay) return std::nullopt;
  return DelayRequest::parse(*options.delay, "--delay");
}

Mask unfeathered_mask(const Options& options, const std::string& name, std::uint8_t rest) {
  const auto capture = options.operands.empty() ? std::nullopt : std::optional(options.operands.front());
  if (options.feather && !layer_files(name).empty()) {
    throw UsageError(format(
        "{} is made of layers, which say themselves how they are blended; leave out --feather", name));
  }
  return read_layered_mask_input(name, rest, capture);
}

std::string exposure_mask_name(const Options& options) {
  const std::string from = input_title(*options.mask), to = input_title(options.mask_to.value_or(*options.mask));
  const std::uint32_t way = options.mask_to ? mask_way(options) : 0;
  return way == 0 ? from : way == kWholeWay ? to : format("{} on its way to {}", from, to);
}

Mask exposure_mask(const Options& options, std::uint8_t rest) {
  const Mask mask = unfeathered_mask(options, *options.mask, rest);
  const auto feather = options.feather ? std::optional(Feather::parse(*options.feather)) : std::nullopt;
  if (!options.mask_to) return feather ? feathered(mask, *feather) : mask;
  const std::uint32_t way = mask_way(options);
  return blended_mask(mask, *options.mask, unfeathered_mask(options, *options.mask_to, rest), *options.mask_to,
                      mask_blend(options), way, feather);
}

double brightening(const Options& options) {
  double gain = 1.0;
  if (options.gain) gain = parse_signed_number(*options.gain, "--gain");
  if (options.ev) gain *= std::exp2(parse_signed_number(*options.ev, "--ev"));
  if (!std::isfinite(gain) || gain == 0.0) {
    throw UsageError(format("{}{} makes a picture of nothing but {}; choose a number nearer to {}",
                            options.gain ? "--gain " + *options.gain : "",
                            options.ev ? " --ev " + *options.ev : "",
                            gain == 0.0 ? "black" : "infinite light", options.gain ? "1" : "0"));
  }
  return gain;
}

Shutter parse_shutter(const std::string& shape, const std::optional<std::string>& error_text) {
  double error = ShutterShape::kDefaultError;
  if (error_text) {
    error = parse_signed_number(*error_text, "--shutter-error");
    if (!(error >= ShutterShape::kMinError && error < 1.0))
      throw UsageError(
          format("--shutter-error {} is no share from {} to 1", *error_text, ShutterShape::kMinError));
  }
  return {ShutterShape::parse(shape), error};
}

ExposureRequest exposure_request(const Options& options, const Shared<FunctionSet>& functions) {
  return timeless_request(options, functions);
}

ExposureRequest exposure_request(const Options& options) {
  if (!options.functions && !options.start && !options.exposure) {
    if (options.mask) {
      throw UsageError(format("a mask needs gain functions: nutik-cl -m {} -k functions.fn {}",
                              shell_word(*options.mask),
                              options.operands.empty() ? "clip.tik" : shell_word(options.operands.front())));
    }
    throw UsageError(
        "an exposure needs a plain interval (--start 0.4s --exposure 10ms) or "
        "gain functions (-k functions.fn)");
  }
  ExposureRequest request = timeless_request(options);
  request.start = StatedTime::parse(options.start.value_or("0s"), "--start");
  if (auto* plain = std::get_if<PlainInterval>(&request.gains)) {
    if (!options.exposure) throw UsageError("how long is the exposure? Add --exposure 10ms");
    plain->length = StatedTime::parse(*options.exposure, "--exposure");
  }
  return request;
}

std::string exposure_label(const Options& options) {
  std::string label;
  if (options.functions) {
    label = is_standard_input(*options.functions) ? "standard-input"
                                                  : std::filesystem::path(*options.functions).stem().string();
    if (options.start) label += "-" + *options.start;
  } else {
    label = format("{}-{}", options.start.value_or("0s"), options.exposure.value_or(""));
  }
  std::ranges::replace(label, '/', '_');
  return label;
}

OutputRequest output_request(const Options& options) {
  OutputRequest request;
  if (options.depth) request.depth = parse_depth(*options.depth);
  if (options.quality)
    request.quality = static_cast<int>(parse_whole_number(*options.quality, "--quality", 1, 100));
  if (options.negative) request.negative = parse_negative_light(*options.negative);
  if (options.out_transfer) request.transfer = parse_out_transfer(*options.out_transfer);
  return request;
}

SeriesRequest series_request(const Options& options) {
  SeriesRequest series{step_of(options), {}, {}};
  if (options.frames) series.numbers = FrameRanges::parse(*options.frames, "--frames");
  if (options.count)
    series.count = parse_whole_number(*options.count, "--count", 1, SeriesRequest::kMaxExposures);
  return series;
}

ContactRequest contact_request(const Options& options) {
  ContactRequest request;
  if (options.start) request.start = StatedTime::parse(*options.start, "--start");
  if (options.every) request.every = step_of(options);
  if (options.exposure) request.length = StatedTime::parse(*options.exposure, "--exposure");
  return request;
}

sheet::SheetWishes sheet_wishes(const Options& options) {
  sheet::SheetWishes wishes;
  if (options.columns) wishes.columns = parse_whole_number(*options.columns, "--columns", 1, 1000);
  if (options.width) wishes.width = parse_whole_number(*options.width, "--width", 100, plot::kLargestSide);
  return wishes;
}

FramesRequest frames_request(const Options& options) {
  FramesRequest request;
  request.rate = Rational::parse(options.out_fps.value_or(kFilmRate), "--out-fps");
  request.speed = Rational::parse(options.speed.value_or("1"), "--speed");
  request.angle = Rational::parse(options.out_angle.value_or(kFilmAngle), "--out-angle");
  if (options.from) request.from = StatedTime::parse(*options.from, "--from");
  if (options.to) request.to = StatedTime::parse(*options.to, "--to");
  // Before anything is opened.
  static_cast<void>(FrameTimes({}, request.rate, request.speed, request.angle));
  request.keys.functions = function_keys(options, request);
  const bool has_functions = options.functions || !request.keys.functions.empty();
  if (has_functions && options.out_angle) {
    throw UsageError(
        "--out-angle describes plain exposures; with -k the functions say how each frame is exposed, from "
        "its start on. Use one");
  }
  // The first keys stand for all where an exposure is described.
  Options first = options;
  std::optional<Shared<FunctionSet>> known;
  if (!request.keys.functions.empty()) {
    known = request.keys.functions.front().functions;
    first.functions = request.keys.functions.front().name;
  }
  if (const auto mask = first_mask_key(options)) first.mask = mask;
  request.exposure = timeless_request(first, known);
  if (!request.exposure.is_plain()) {
    const auto rest = std::get<Shared<FunctionSet>>(request.exposure.gains)->begin()->first;
    read_mask_keys(request, options, rest);
  }
  request.keys.check();
  check_mapped(request);
  request.curve = film_curve(options, request);
  if (options.frames) request.numbers = FrameRanges::parse(*options.frames, "--frames");
  return request;
}

}  // namespace nutik::app
