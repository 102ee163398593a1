#include "session/requests/named_inputs.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <utility>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/function_file.hpp"
#include "exposure/mask_check.hpp"
#include "mask/layers.hpp"
#include "media/clip.hpp"
#include "media/formats/extension.hpp"
#include "media/formats/file_kinds.hpp"
#include "media/formats/input_kinds.hpp"
#include "media/formats/numbered_name.hpp"
#include "media/input_checksum.hpp"
#include "media/stills/mask_reader.hpp"
#include "media/stills/still_sequence.hpp"
#include "session/requests/source_request.hpp"
#include "system/input_bytes.hpp"
#include "system/is_absent.hpp"
#include "system/mapped_file.hpp"
#include "tik/header.hpp"

namespace nutik {
namespace {

// A mask that comes through a pipe: one of 32767 x 32767 pixels.
constexpr std::size_t kMaxPipedMask = std::size_t{1} << 30;

}  // namespace

FunctionInput read_functions(std::string_view text, const std::string& title) {
  const FunctionFile file = parse_functions(text);
  std::string report = file.report(title);
  if (file.has_errors()) throw InputError(format("{} has mistakes:\n{}", title, report));
  FunctionSet functions;
  for (const auto& [tag, read] : file.functions) functions.emplace(tag, read.function);
  return {Shared(std::move(functions)), std::move(report)};
}

FunctionInput read_function_input(const std::string& name) {
  const InputBytes input(name);
  const std::string_view text = input.text();
  const auto begins = [&](const inputs::InputKind* kind) { return kind->begins(text); };
  if (const auto kind = std::ranges::find_if(inputs::kStills, begins); kind != std::end(inputs::kStills)) {
    throw InputError(format("{} is a picture, a {}, and gain functions are text; were mask and functions swapped?",
                            input_title(name), (*kind)->name));
  }
  return read_functions(text, input_title(name));
}

namespace {

// A picture file as it stands, light of `white` having the last code. `thing` is one.
ReadPicture read_still(const std::string& name, double white, std::string_view thing) {
  ClipOptions options;
  options.white_light = white;
  const auto clip = open_clip(name, options);
  refuse_left_out(name, clip->info().left_out);
  const CaptureFormat& kind = clip->info().format;
  Picture picture(kind.shape, code_type(kind), kind.white_code);
  if (!clip->read(picture.bytes)) throw InputError(format("{} has no picture", name));
  if (std::vector<std::byte> next(picture.bytes.size()); clip->read(next))
    throw InputError(format("{} holds several pictures; {} is one{}", name, thing,
                            extension_of(name) == ".npy" ? ", an array [height, width]" : ""));
  const auto says = [&](Setting setting) {
    return std::ranges::any_of(clip->info().facts, [&](const Fact& fact) {
      return fact.setting == setting && fact.origin == Origin::file;
    });
  };
  const bool holds_light = clip->info().holds_light;
  if (holds_light || says(Setting::transfer)) picture.transfer = kind.transfer;
  picture.primaries = kind.primaries;
  return {std::move(picture), holds_light, says(Setting::primaries)};
}

// Values of a TIFF, or of floating point, as tags: whole numbers from 0 to 255.
Picture read_tags(const std::string& name) {
  constexpr double kLast = 255;
  const auto refusal = [&](const std::string& pixel, const std::string& value) {
    return InputError(
        format("{}: pixel {} has {}no value of a mask, a whole number from 0 to 255", name, pixel, value));
  };
  ReadPicture still;
  try {
    still = read_still(name, kLast, "a mask");
  } catch (const LightOutside& error) {
    throw refusal(error.pixel, format("the value {:.6g}, ", error.value));
  }
  const Picture read = grey_of(std::move(still.codes), name);
  const std::uint32_t steps = still.holds_light ? 257 : 1;  // of 65535 codes, to the next tag
  if (read.type == ValueType::code8) return read;
  Picture tags(read.shape, ValueType::code8, 255);
  const auto codes = read.values<std::uint16_t>();
  for (std::size_t i = 0; i < codes.size(); ++i) {
    if (codes[i] % steps != 0 || codes[i] / steps > kLast) {
      throw refusal(format("{},{}", i % read.shape.width, i / read.shape.width),
                    still.holds_light ? "" : format("the value {}, ", codes[i]));
    }
    tags.bytes[i] = static_cast<std::byte>(codes[i] / steps);
  }
  return tags;
}

// What a .tik's pictures are, from its first bytes; none of a clip, a damaged file or standard input.
std::optional<CaptureFormat> known_format(const std::optional<std::string>& path) {
  if (!path || is_standard_input(*path) || !is_tik(*path)) return std::nullopt;
  try {
    const MappedFile file(*path);
    return tik::parse_header(file.bytes(), *path).header.capture;
  } catch (const InputError&) {  // it is said when it is opened
    return std::nullopt;
  }
}

std::optional<NumberedName> layers_name(const std::filesystem::path& path) {
  if (!is_absent(path)) return std::nullopt;  // a file of that very name
  return NumberedName::parse(path.filename().string());
}

}  // namespace

Mask read_mask_input(const std::string& name, const std::optional<std::string>& capture) {
  if (!is_standard_input(name) && layers_name(name))
    throw InputError(format("{} stands for the layers of a soft mask, and a hard one is needed here: one file", name));
  const InputBytes input(name, kMaxPipedMask);
  const auto format_known = known_format(capture);
  const inputs::InputKind* const kind = is_standard_input(name) ? nullptr : still_kind(name);
  if (kind != nullptr && kind->has_tags) return Mask::from_picture(read_tags(name));
  return Mask::from_picture(
      read_mask(input.bytes(), input_title(name), [&](std::uint32_t width, std::uint32_t height) {
        if (format_known) check_size({width, height, {}}, *format_known);
      }));
}

std::map<std::uint8_t, std::filesystem::path> layer_files(const std::string& name) {
  const std::filesystem::path path = name;
  std::map<std::uint8_t, std::filesystem::path> files;
  const auto numbered = layers_name(path);
  if (!numbered) return files;
  for (std::uint32_t tag = 0; tag < kMaskValues; ++tag) {
    const std::filesystem::path file = path.parent_path() / numbered->with(tag);
    if (!is_absent(file)) files.emplace(static_cast<std::uint8_t>(tag), file);
  }
  return files;
}

Mask read_layered_mask_input(const std::string& name, std::uint8_t rest,
                             const std::optional<std::string>& capture) {
  if (is_standard_input(name) || !layers_name(name)) return read_mask_input(name, capture);
  const auto files = layer_files(name);
  if (files.empty()) {
    const std::filesystem::path path = name;
    const NumberedName numbered = *layers_name(path);
    throw InputError(format("{} cannot be read: there is no layer of any mask value, {} to {}", name,
                            (path.parent_path() / numbered.with(0)).string(),
                            (path.parent_path() / numbered.with(kMaskValues - 1)).string()));
  }
  const auto format_known = known_format(capture);
  std::vector<MaskLayer> layers;
  for (const auto& [tag, file] : files) {
    layers.push_back({tag, file.string(), read_picture(file.string()).codes});
    const Shape& found = layers.back().picture.shape;
    if (format_known) check_size({found.width, found.height, {}}, *format_known, file.string() + ": ");
  }
  return mask_of_layers(layers, rest);
}

std::string mask_checksum(const std::string& name) {
  if (is_standard_input(name) || !layers_name(name)) return bytes_checksum(InputBytes(name, kMaxPipedMask).bytes());
  std::vector<std::filesystem::path> files;
  for (const auto& [tag, file] : layer_files(name)) files.push_back(file);
  return files_checksum(files);
}

ReadPicture read_picture(const std::string& name) {
  if (is_absent(name)) throw FileMissing(name, format("{} cannot be read: no such file", name));
  const auto stills = list_stills(name);
  if (!stills || stills->size() != 1) {
    throw UsageError(format("{} is {}; a picture is needed ({})", name,
                            stills ? format("a sequence of {}", stills->size()) : "no picture", still_kinds_text()),
                     Advice{", or a time of the capture: 0.3s, 12f"});
  }
  ReadPicture read;
  try {
    read = read_still(name, 1.0, "what is needed");
  } catch (const LightOutside& error) {
    throw InputError(format("{}: pixel {} has the value {:.6g}; floating point is read from 0 to 1 here: make it with "
                            "a smaller gain, or of codes",
                            name, error.pixel, error.value));
  }
  const Picture& picture = read.codes;
  const std::uint32_t largest = largest_code(picture.bytes, static_cast<std::uint32_t>(value_bytes(picture.type)));
  if (largest > picture.white_code) {
    throw InputError(
        format("{} cannot be read: it has a code of {}, above the {} that it states as its largest; write it "
               "again with the right one",
               name, largest, picture.white_code));
  }
  return read;
}

}  // namespace nutik
