#include "media/stills/mask_reader.hpp"

#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"
#include "media/formats/input_kinds.hpp"
#include "media/stills/netpbm.hpp"
#include "media/stills/picture_files.hpp"
#include "system/mapped_file.hpp"

namespace nutik {

namespace {

// What painting programs save as colour: all three channels are the tag.
Picture grey_of(Picture&& picture, const std::string& name) {
  if (picture.shape.channels == 1) return std::move(picture);
  Shape shape = picture.shape;
  shape.channels = 1;
  Picture grey(shape, ValueType::code8, picture.white_code);
  const auto colours = picture.values<std::uint8_t>();
  for (std::uint64_t i = 0; i < shape.pixel_count(); ++i) {
    const int red = colours[3 * i], green = colours[3 * i + 1], blue = colours[3 * i + 2];
    if (red != green || red != blue) {
      throw InputError(format(
          "{} is a colour picture, and its pixel {},{} is no grey: red {}, green {}, blue {}. A mask has one "
          "value for each pixel; save it as grey",
          name, i % shape.width, i / shape.width, red, green, blue));
    }
    grey.bytes[i] = picture.bytes[3 * i];
  }
  return grey;
}

// From how a grey picture lies, as EXIF numbers it; from 5 on, rows are what it shows as columns.
Picture upright(Picture&& picture, unsigned orientation) {
  if (orientation <= 1) return std::move(picture);
  const bool is_turned = orientation >= 5;
  Shape shape = picture.shape;
  if (is_turned) std::swap(shape.width, shape.height);
  Picture turned(shape, picture.type, picture.white_code);
  const unsigned flips = orientation % 4;  // 2 or 3: left for right; 3 or 0: upside down
  for (std::uint32_t y = 0; y < shape.height; ++y) {
    for (std::uint32_t x = 0; x < shape.width; ++x) {
      const std::uint32_t from_x = flips >= 2 ? shape.width - 1 - x : x;
      const std::uint32_t from_y = flips == 3 || flips == 0 ? shape.height - 1 - y : y;
      const std::size_t from = is_turned ? std::size_t{from_x} * shape.height + from_y
                                         : std::size_t{from_y} * shape.width + from_x;
      turned.bytes[std::size_t{y} * shape.width + x] = picture.bytes[from];
    }
  }
  return turned;
}

}  // namespace

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
    return upright(grey_of(read_8_bit_png(bytes, name, check_upright), name), orientation);
  }
  if (bytes.size() < 2 || bytes[0] != std::byte{'P'}) {
    const bool is_functions = bytes.size() > 1 && bytes[0] == std::byte{'M'} && bytes[1] >= std::byte{'0'} &&
                              bytes[1] <= std::byte{'9'};
    throw InputError(
        format("{} is neither a PGM nor a PNG; masks are 8-bit grey pictures of these kinds, or "
               ".tif, .npy, .exr and .pfm with whole numbers (JPEG would change their values){}",
               name, is_functions ? ". It looks like gain functions; were mask and functions swapped?" : ""));
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
