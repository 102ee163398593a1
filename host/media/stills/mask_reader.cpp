#include "media/stills/mask_reader.hpp"

#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"
#include "capture/turned.hpp"
#include "media/formats/file_kinds.hpp"
#include "media/formats/input_kinds.hpp"
#include "media/stills/netpbm.hpp"
#include "media/stills/picture_files.hpp"
#include "system/mapped_file.hpp"

namespace nutik {

Picture grey_of(Picture&& picture, const std::string& name) {
  if (picture.shape.channels == 1) return std::move(picture);
  Shape shape = picture.shape;
  shape.channels = 1;
  Picture grey(shape, picture.type, picture.white_code);
  with_codes(static_cast<std::uint32_t>(value_bytes(picture.type)), grey.bytes.data(), [&]<typename Code>(Code* greys) {
    const auto colours = picture.values<Code>();
    for (std::uint64_t i = 0; i < shape.pixel_count(); ++i) {
      const int red = colours[3 * i], green = colours[3 * i + 1], blue = colours[3 * i + 2];
      if (red != green || red != blue) {
        throw InputError(format(
            "{} is a colour picture, and its pixel {},{} is no grey: red {}, green {}, blue {}. A mask has one "
            "value for each pixel; save it as grey",
            name, i % shape.width, i / shape.width, red, green, blue));
      }
      greys[i] = colours[3 * i];
    }
  });
  return grey;
}

Picture read_mask(const std::filesystem::path& path) {
  const MappedFile file(path);
  return read_mask(file.bytes(), path.string());
}

Picture read_mask(std::span<const std::byte> bytes, const std::string& name,
                  const CheckMaskSize& check_size) {
  if (inputs::kPng.begins(as_text(bytes))) {
    const unsigned orientation = png_orientation(bytes);
    const auto check_upright = [&](std::uint32_t width, std::uint32_t height) {
      if (check_size) orientation >= 5 ? check_size(height, width) : check_size(width, height);
    };
    Picture grey = grey_of(read_png(bytes, name, PngUse::mask, check_upright).picture, name);
    turn_upright(grey.bytes, grey.shape, 1, orientation);
    return grey;
  }
  if (bytes.size() < 2 || bytes[0] != std::byte{'P'}) {
    const bool is_functions = bytes.size() > 1 && bytes[0] == std::byte{'M'} && bytes[1] >= std::byte{'0'} &&
                              bytes[1] <= std::byte{'9'};
    throw InputError(
        format("{} is neither a PGM nor a PNG; masks are 8-bit grey pictures of these kinds, or of whole numbers: {} "
               "(JPEG would change their values){}",
               name, still_kinds_text(&inputs::InputKind::has_tags),
               is_functions ? ". It looks like gain functions; were mask and functions swapped?" : ""));
  }
  if (netpbm_starts(bytes, name).size() > 1) throw InputError(format("{} holds several pictures; a mask is one", name));
  Picture picture = read_netpbm(bytes, name);
  if (picture.type != ValueType::code8) {
    throw InputError(format("{} is a picture of 16 bits (maximum {}); a mask has 8 (maximum 255 or less)",
                            name, picture.white_code));
  }
  return grey_of(std::move(picture), name);
}

}  // namespace nutik
