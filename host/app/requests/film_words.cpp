#include "app/output/console.hpp"
#include "app/requests/requests.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "session/requests/function_input.hpp"
#include "system/input_bytes.hpp"

namespace nutik::app {
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

}  // namespace

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

}  // namespace nutik::app
