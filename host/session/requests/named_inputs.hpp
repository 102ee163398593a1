// Reads the functions, masks and pictures that a person names, a file or `-` for standard input, as requests hold them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "capture/picture.hpp"
#include "exposure/mask.hpp"
#include "render/render_plan.hpp"
#include "system/shared.hpp"

namespace nutik {

struct FunctionInput {
  Shared<FunctionSet> functions;
  std::string warnings;  // of the text, with its lines; empty where there are none
};

// Throws InputError with all mistakes of the text; `title` names it there and in warnings.
[[nodiscard]] FunctionInput read_functions(std::string_view text, const std::string& title);
// The same of an input. Throws InputError where it cannot be read, too.
[[nodiscard]] FunctionInput read_function_input(const std::string& name);

// The layers that a name with a number in it stands for, `layer-%d.png`: the files that are there, by mask value. None
// of a name of one file.
[[nodiscard]] std::map<std::uint8_t, std::filesystem::path> layer_files(const std::string& name);

// A hard mask. Throws InputError that says what was found and what is needed (media/stills/mask_reader.hpp).
// Where it is for a `capture` whose size costs nothing to know, a .tik, another size is refused before it is read.
[[nodiscard]] Mask read_mask_input(const std::string& name, const std::optional<std::string>& capture = {});
// The same, or one that is made of layers (mask/layers.hpp), of which the tag `rest` gets what they leave.
[[nodiscard]] Mask read_layered_mask_input(const std::string& name, std::uint8_t rest,
                                           const std::optional<std::string>& capture = {});
// The checksum that recipes know a mask by: that of its files.
[[nodiscard]] std::string mask_checksum(const std::string& name);

struct ReadPicture {
  Picture codes;
  bool holds_light = false;  // its file does
  bool says_primaries = false;
};

// A picture file, codes as they stand, with their transfer function if the file says it; floating-point light, from 0
// to 1, in 65535 steps. Throws UsageError where it is no picture, or many; InputError where it cannot be read.
[[nodiscard]] ReadPicture read_picture(const std::string& name);

}  // namespace nutik
