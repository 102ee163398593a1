#include "app/words/stated_requests.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/output/console.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/mask.hpp"
#include "mask/feather.hpp"
#include "render/render_plan.hpp"
#include "session/requests/named_inputs.hpp"
#include "session/text/shell_text.hpp"
#include "system/input_bytes.hpp"

namespace nutik::app {
namespace {

Shared<FunctionSet> read_functions_of(const std::string& name) {
  FunctionInput input = read_function_input(name);
  if (!input.warnings.empty()) print_note(input.warnings);
  return std::move(input.functions);
}

// All but when it is exposed. Functions are read unless they are known.
ExposureRequest timeless_request(const Options& options,
                                 const std::optional<Shared<FunctionSet>>& known = {}) {
  if (options.feather && !options.mask) {
    throw UsageError(
        "--feather blends functions along the edges of a mask; add -m mask.pgm and -k functions.fn");
  }
  refuse_without_mask(options);
  ExposureRequest request = exposure_without_gains(options);
  if (!options.functions) {
    if (options.mask || options.mask_to)
      throw UsageError("a mask goes with gain functions (-k), not with a plain interval");
    if (options.shutter_error && !options.has("shutter"))
      throw UsageError("--shutter-error says how near gains come to a smooth shape: add --shutter hann, for one");
    request.gains = PlainInterval{{}, stated_shutter(options)};
    return request;
  }
  for (const char* name : {"exposure", "shutter", "shutter-error"}) {
    if (options.has(name))
      throw UsageError(format("--{} describes a plain interval, -k a file of functions; use one", name));
  }
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
  if (request.keys.masks.empty() || request.exposure.plan.unmapped_is_zero) return;
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
  if (!options.mask_way) throw UsageError("how far is it to --mask-to? Add --mask-share 1/2, 0 to 1");
  return *options.mask_way;
}

// One mask by its name.
Mask unfeathered_mask(const Options& options, const std::string& name, std::uint8_t rest) {
  const auto capture = options.operands.empty() ? std::nullopt : std::optional(options.operands.front());
  if (options.feather && !layer_files(name).empty()) {
    throw UsageError(format(
        "{} is made of layers, which say themselves how they are blended; leave out --feather", name));
  }
  return read_layered_mask_input(name, rest, capture);
}

}  // namespace

void refuse_without_mask(const Options& options) {
  if (options.mask_way && !options.mask_to)
    throw UsageError("--mask-share says how far it is to a second mask: add --mask-to");
  if (options.mask_blend && !options.mask_to && !options.has("mask-key"))
    throw UsageError("--mask-blend says how the mask turns into a second one: add --mask-to");
  if (options.asked.plan.unmapped_is_zero && !options.mask)
    throw UsageError("--unmapped says what values of a mask show that have no function: add -m mask.pgm");
}

std::string exposure_mask_name(const Options& options) {
  const std::string from = input_title(*options.mask), to = input_title(options.mask_to.value_or(*options.mask));
  const std::uint32_t way = options.mask_to ? mask_way(options) : 0;
  return way == 0 ? from : way == kWholeWay ? to : format("{} on its way to {}", from, to);
}

Mask exposure_mask(const Options& options, std::uint8_t rest) {
  const Mask mask = unfeathered_mask(options, *options.mask, rest);
  if (!options.mask_to) return options.feather ? feathered(mask, *options.feather) : mask;
  const std::uint32_t way = mask_way(options);
  return blended_mask(mask, *options.mask, unfeathered_mask(options, *options.mask_to, rest), *options.mask_to,
                      options.mask_blend.value_or(MaskBlend::distance), way, options.feather);
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
  request.start = options.start.value_or(StatedTime());
  if (auto* plain = std::get_if<PlainInterval>(&request.gains)) {
    if (!options.exposure) throw UsageError("how long is the exposure? Add --exposure 10ms");
    plain->length = *options.exposure;
  }
  return request;
}

std::string exposure_label(const Options& options) {
  std::string label;
  if (options.functions) {
    label = is_standard_input(*options.functions) ? "standard-input"
                                                  : std::filesystem::path(*options.functions).stem().string();
    if (options.start) label += "-" + options.text("start");
  } else {
    label = format("{}-{}", options.text("start", "0s"), options.text("exposure"));
  }
  std::ranges::replace(label, '/', '_');
  return label;
}

// What changes along a film: functions, masks (of their first key the name alone), and when the capture is shown.

namespace {

// A key's words: its time, and its file.
struct StatedKey {
  std::int64_t film_ns;
  std::string file;
};

std::vector<StatedKey> stated_keys(const Options& options, std::string_view option, const FramesRequest& request) {
  const std::string name = "--" + std::string(option);
  std::vector<StatedKey> keys;
  for (const Said& said : options.said) {
    if (said.option != option) continue;
    const StatedTime time = StatedTime::parse(said.words[0], name);
    if (is_standard_input(said.words[1])) {
      throw UsageError(format("{} {} - would read standard input; a key is a file", name, said.words[0]));
    }
    keys.push_back({film_moment_ns(time, name, request.film_times()), said.words[1]});
  }
  return keys;
}

std::vector<FunctionKey> function_keys(const Options& options, const FramesRequest& request) {
  std::vector<FunctionKey> keys;
  for (StatedKey& stated : stated_keys(options, "key", request)) {
    FunctionInput input = read_function_input(stated.file);
    if (!input.warnings.empty()) print_note(input.warnings);
    keys.push_back({stated.film_ns, std::move(stated.file), std::move(input.functions)});
  }
  if (!keys.empty() && options.functions) {
    throw UsageError("-k is one file of functions for the whole film, --key several that change along it; use one");
  }
  return keys;
}

std::optional<std::string> first_mask_key(const Options& options) {
  for (const Said& said : options.said) {
    if (said.option != "mask-key") continue;
    if (options.mask) {
      throw UsageError("-m is one mask for the whole film, --mask-key several that change along it; use one");
    }
    return said.words[1];
  }
  if (options.mask_blend) throw UsageError("--mask-blend says how masks change; add --mask-key 0s mask.pgm twice");
  return std::nullopt;
}

void read_mask_keys(FramesRequest& request, const Options& options, std::uint8_t rest) {
  KeyFrames& keys = request.keys;
  keys.blend = options.mask_blend.value_or(MaskBlend::distance);
  for (StatedKey& stated : stated_keys(options, "mask-key", request)) {
    Mask mask = unfeathered_mask(options, stated.file, rest);
    std::string checksum = mask_checksum(stated.file);
    keys.masks.push_back({stated.film_ns, std::move(stated.file), std::move(checksum), Shared(std::move(mask))});
  }
  if (!keys.masks.empty() && options.feather) keys.feather = options.feather;
}

std::optional<FilmCurve> film_curve(const Options& options, const FramesRequest& request) {
  if (!options.curve) return std::nullopt;
  for (const char* name : {"from", "to", "speed"}) {
    if (options.has(name))
      throw UsageError(format("--{} says what of the capture the film shows, and so does --curve; use one", name));
  }
  return FilmCurve::parse(InputBytes(*options.curve).text(), input_title(*options.curve), request.film_times());
}

}  // namespace

FramesRequest frames_request(const Options& options) {
  FramesRequest request = options.film;
  // Before anything is opened.
  static_cast<void>(FrameTimes({}, request.rate, request.speed, request.angle));
  request.keys.functions = function_keys(options, request);
  const bool has_functions = options.functions || !request.keys.functions.empty();
  if (has_functions && options.has("out-angle")) {
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
  request.numbers = options.frames;
  return request;
}

}  // namespace nutik::app
