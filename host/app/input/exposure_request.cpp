#include "app/input/exposure_request.hpp"

#include <algorithm>
#include <filesystem>

#include "app/output/console.hpp"
#include "app/text/time_text.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/mask_reader.hpp"
#include "system/mapped_file.hpp"

namespace nutik::app {
namespace {

FunctionFile read_functions(const std::string& name) {
  const MappedFile file(name);
  const auto bytes = file.bytes();
  FunctionFile functions = parse_functions({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  if (functions.has_errors()) {
    throw InputError(format("{} has mistakes:\n{}", name, functions.report(name)));
  }
  if (const std::string warnings = functions.report(name); !warnings.empty()) print_note(warnings);
  return functions;
}

// The one value that an option with one value may have.
bool parse_only(const std::optional<std::string>& text, std::string_view option, std::string_view only) {
  if (!text) return false;
  if (*text == only) return true;
  throw UsageError(format("{} {} is not known; the only choice is {} {}", option, *text, option, only));
}

}  // namespace

ExposureRequest ExposureRequest::from(const Options& options) {
  ExposureRequest request;
  request.plan_options_.unmapped_is_zero = parse_only(options.unmapped, "--unmapped", "zero");
  request.plan_options_.live_all = parse_only(options.live, "--live", "all");
  if (options.transfer) request.plan_options_.transfer = Transfer::parse(*options.transfer);
  const bool plain = options.start || options.exposure;
  if (plain && options.functions) {
    throw UsageError("--start and --exposure describe a plain interval, -k a file of functions; use one");
  }
  if (!plain && !options.functions) {
    throw UsageError(options.mask ? "a mask needs gain functions: -k functions.fn"
                                  : "an exposure needs a plain interval (--start 0.4s --exposure 10ms) or "
                                    "gain functions (-k functions.fn)");
  }
  if (options.functions) {
    request.file_ = read_functions(*options.functions);
    request.label_ = std::filesystem::path(*options.functions).stem().string();
    if (!options.mask && request.file_->functions.size() > 1) {
      throw UsageError(format("{} holds {} functions; a mask says where each applies: -m mask.pgm",
                              *options.functions, request.file_->functions.size()));
    }
    if (options.mask) request.mask_ = Mask::from_picture(read_mask(*options.mask));
    return request;
  }
  if (options.mask) throw UsageError("a mask goes with gain functions (-k), not with a plain interval");
  if (!options.exposure) throw UsageError("how long is the exposure? Add --exposure 10ms");
  request.start_ = options.start.value_or("0s");
  request.exposure_ = *options.exposure;
  TimeText::parse(request.start_, "start");  // before anything is opened
  TimeText::parse(request.exposure_, "exposure");
  request.label_ = format("{}-{}", request.start_, request.exposure_);
  std::replace(request.label_.begin(), request.label_.end(), '/', '_');
  request.plan_options_.function_name = "the exposure";
  return request;
}

FunctionSet ExposureRequest::functions(const Timeline& timeline) const {
  FunctionSet functions;
  if (!file_) {
    const Exposure interval = plain_interval(start_, exposure_, timeline);
    if (interval.start_ns >= timeline.duration_ns() || interval.end_ns <= 0) {
      throw UsageError(format("the interval from {} on lies outside the capture, which lasts {}",
                              duration_text(interval.start_ns), duration_text(timeline.duration_ns())));
    }
    functions.emplace(0, GainFunction::boxcar(interval.start_ns, interval.end_ns));
    return functions;
  }
  for (const auto& [tag, function] : file_->functions) functions.emplace(tag, function.function);
  return functions;
}

Mask ExposureRequest::mask(const Shape& shape) const {
  if (mask_) return *mask_;
  const std::uint8_t tag = file_ ? file_->functions.begin()->first : std::uint8_t{0};
  return Mask::uniform(shape.width, shape.height, tag);
}

}  // namespace nutik::app
