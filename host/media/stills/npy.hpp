// NumPy's arrays in files (.npy), as pictures: [height, width], [height, width, 3], or several of them behind one
// another, with an axis in front. https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html has the bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "capture/picture.hpp"

namespace nutik {

// What an array holds: pictures of a shape and type, and where the first one's bytes begin.
struct NpyFront {
  Shape shape;
  ValueType type = ValueType::light32;
  std::uint64_t pictures = 1;
  std::size_t begin = 0;
};

// Arrays of uint8 and uint16 are codes, of float32 and float64 light. Throws InputError naming `name` where it is of
// another type or order, has other axes, was cut off, or goes on behind it.
[[nodiscard]] NpyFront read_npy_front(std::span<const std::byte> file, const std::string& name);
// One of its pictures, from 0.
[[nodiscard]] Picture read_npy(std::span<const std::byte> file, const std::string& name, std::uint64_t number);

// A picture of light as [height, width] or [height, width, 3].
[[nodiscard]] std::string npy_text(const Picture& picture);
// Several as [layers, height, width].
[[nodiscard]] std::string npy_text(std::span<const PictureLayer> layers);

}  // namespace nutik
