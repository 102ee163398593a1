#include "app/input/exposure_request.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/input/standard_input.hpp"
#include "app/output/console.hpp"
#include "app/text/number_text.hpp"
#include "app/text/shell_text.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik::app {
namespace {

FunctionFile read_functions(const std::string& name) {
  FunctionFile functions = parse_functions(InputBytes(name).text());
  const std::string title = input_title(name);
  if (functions.has_errors()) {
    throw InputError(format("{} has mistakes:\n{}", title, functions.report(title)));
  }
  if (const std::string warnings = functions.report(title); !warnings.empty()) print_note(warnings);
  return functions;
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

}  // namespace

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
  double error = ShutterShape::kUsualError;
  if (error_text) {
    error = parse_signed_number(*error_text, "--shutter-error");
    if (!(error >= ShutterShape::kLeastError && error < 1.0)) {
      throw UsageError(
          format("--shutter-error {} is no share from {} to 1", *error_text, ShutterShape::kLeastError));
    }
  }
  return {ShutterShape::parse(shape), error};
}

ExposureRequest ExposureRequest::common(const Options& options) {
  ExposureRequest request;
  request.plan_options_.unmapped_is_zero = parse_only(options.unmapped, "--unmapped", "zero");
  request.plan_options_.live_all = parse_only(options.live, "--live", "all");
  if (options.transfer) request.plan_options_.transfer = Transfer::parse(*options.transfer);
  request.normalization_ = Normalization::parse(options.normalize.value_or("support"));
  request.gain_ = brightening(options);
  if (!options.functions) {
    if (options.mask) throw UsageError("a mask goes with gain functions (-k), not with a plain interval");
    request.shutter_ = parse_shutter(options.shutter.value_or("box"), options.shutter_error);
    request.plan_options_.function_name = "the exposure";
    return request;
  }
  const auto refuse = [&](const std::optional<std::string>& option, std::string_view name) {
    if (option)
      throw UsageError(format("{} describes a plain interval, -k a file of functions; use one", name));
  };
  refuse(options.exposure, "--exposure");
  refuse(options.shutter, "--shutter");
  refuse(options.shutter_error, "--shutter-error");
  request.file_ = read_functions(*options.functions);
  if (!options.mask && request.file_->functions.size() > 1) {
    throw UsageError(format("{} holds {} functions; a mask says where each applies: -m mask.pgm",
                            input_title(*options.functions), request.file_->functions.size()));
  }
  if (options.mask) {
    request.mask_ = read_mask_input(*options.mask);
    request.mask_pixels_ = request.mask_->pixels_per_tag();
  }
  return request;
}

ExposureRequest ExposureRequest::from(const Options& options) {
  if (!options.functions && !options.start && !options.exposure) {
    if (options.mask) {
      throw UsageError(format("a mask needs gain functions: nutik-cl -m {} -k functions.fn {}",
                              shell_word(*options.mask), options.operands.empty() ? "clip.tik" : shell_word(options.operands.front())));
    }
    throw UsageError(
        "an exposure needs a plain interval (--start 0.4s --exposure 10ms) or "
        "gain functions (-k functions.fn)");
  }
  ExposureRequest request = common(options);
  request.start_ = TimeText::parse(options.start.value_or("0s"), "start");
  if (options.functions) {
    request.label_ = is_standard_input(*options.functions)
                         ? "standard-input"
                         : std::filesystem::path(*options.functions).stem().string();
    if (options.start) request.label_ += "-" + *options.start;
  } else {
    if (!options.exposure) throw UsageError("how long is the exposure? Add --exposure 10ms");
    request.length_ = TimeText::parse(*options.exposure, "exposure");
    request.label_ = format("{}-{}", options.start.value_or("0s"), *options.exposure);
  }
  std::replace(request.label_.begin(), request.label_.end(), '/', '_');
  return request;
}

ExposureRequest ExposureRequest::for_frames(const Options& options) { return common(options); }

GainFunction ExposureRequest::interval_function(const Exposure& interval, const Timeline& timeline) {
  if (interval.start_ns >= timeline.duration_ns() || interval.end_ns <= 0) {
    throw UsageError(format("the interval from {} on lies outside the capture, which lasts {}",
                            duration_text(interval.start_ns), duration_text(timeline.duration_ns())));
  }
  return shutter_.function({interval.start_ns, interval.end_ns});
}

FunctionSet ExposureRequest::functions(const TimeText& start, const Timeline& timeline) {
  if (!file_) return functions(plain_interval(start, length_, timeline), timeline);
  const std::int64_t zero_ns = moment_ns(start, timeline);
  return functions(Exposure{zero_ns, zero_ns}, timeline);
}

FunctionSet ExposureRequest::functions(const Exposure& interval, const Timeline& timeline) {
  const std::int64_t duration_ns = timeline.duration_ns();
  FunctionSet functions;
  if (!file_) {
    functions.emplace(0, normalization_.normalized(interval_function(interval, timeline), duration_ns, gain_,
                                                   plan_options_.function_name));
    return functions;
  }
  for (const auto& [tag, written] : file_->functions) {
    // What no pixel is exposed with may be what it likes.
    if (!mask_uses(tag)) continue;
    const GainFunction function =
        interval.start_ns == 0 ? written.function : written.function.shifted(interval.start_ns);
    functions.emplace(tag, normalization_.normalized(function, duration_ns, gain_, format("M{}", tag)));
  }
  return functions;
}

std::int64_t ExposureRequest::functions_end_ns() const {
  std::int64_t end_ns = 0;
  for (const auto& [tag, written] : file_->functions) {
    if (!mask_uses(tag)) continue;
    const auto points = written.function.points();
    const auto is_live = [](const ControlPoint& point) { return point.gain != 0.0; };
    const auto dark =
        std::find_if(points.rbegin(), points.rend(), is_live).base();  // behind the last live one
    if (dark == points.begin()) continue;
    end_ns = std::max(end_ns, dark == points.end() ? points.back().time_ns : dark->time_ns);
  }
  return end_ns;
}

Mask ExposureRequest::mask(const Shape& shape) const {
  if (mask_) return *mask_;
  const std::uint8_t tag = file_ ? file_->functions.begin()->first : std::uint8_t{0};
  return Mask::uniform(shape.width, shape.height, tag);
}

}  // namespace nutik::app
