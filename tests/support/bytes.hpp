// Whole numbers as bytes of a file.
#pragma once

#include <cstdint>
#include <string>

namespace nutik::test {

inline std::string little_endian(std::uint64_t number, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(number >> (8 * i) & 255);
  return text;
}

inline std::string big_endian(std::uint64_t number, int bytes) {
  const std::string text = little_endian(number, bytes);
  return {text.rbegin(), text.rend()};
}

}  // namespace nutik::test
