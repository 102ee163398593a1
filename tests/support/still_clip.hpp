// A clip of stills for whole-program tests, and the light that was exposed from it.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "support/random_case.hpp"
#include "support/scratch.hpp"

namespace nutik::test {

// `frames/NNN.pgm` in a folder: `count` grey pictures of size × size with a bright square that moves.
inline void write_still_clip(const std::filesystem::path& folder, int size, int count) {
  std::filesystem::create_directory(folder / "frames");
  Random random(11);
  for (int k = 0; k < count; ++k) {
    std::string text = "P5\n" + std::to_string(size) + " " + std::to_string(size) + "\n255\n";
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        const bool in_square = x >= k % size && x < k % size + 5 && y >= 3 && y < 9;
        text.push_back(
            static_cast<char>(in_square ? 240 : 40 + 3 * y + (x % 7 == 0 ? random.whole(0, 20) : 0)));
      }
    }
    std::string name = std::to_string(k);
    name.insert(0, 3 - name.size(), '0');
    std::ofstream(folder / "frames" / (name + ".pgm"), std::ios::binary) << text;
  }
}

// The values of a PFM file, bottom row first.
inline std::vector<float> read_pfm(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  std::size_t at = 0;
  for (int line = 0; line < 3; ++line) at = text.find('\n', at) + 1;
  std::vector<float> values((text.size() - at) / sizeof(float));
  std::copy(text.begin() + static_cast<std::ptrdiff_t>(at), text.end(),
            reinterpret_cast<char*>(values.data()));
  return values;
}

}  // namespace nutik::test
