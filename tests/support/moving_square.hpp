// A scene with known motion, as stills: a bright square of 8 × 8 pixels on a dark, noisy ground moves to the
// right by two pixels a picture and then rests.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "support/random_case.hpp"
#include "support/scratch.hpp"

namespace nutik::test {

struct MovingSquare {
  static constexpr int kWidth = 96, kHeight = 48, kCount = 20;
  static constexpr int kSide = 8, kTop = 20, kFirstLeft = 4, kStep = 2, kLastMoving = 12;
  static constexpr int kGround = 60, kBright = 200, kNoise = 2;

  // Where the square's left side is.
  static int left(int sample) { return kFirstLeft + kStep * std::min(sample, kLastMoving); }

  std::vector<std::vector<int>> pictures;  // codes, row by row

  MovingSquare() {
    Random random(5);
    for (int k = 0; k < kCount; ++k) {
      std::vector<int> codes(std::size_t{kWidth} * kHeight);
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
          const bool inside = y >= kTop && y < kTop + kSide && x >= left(k) && x < left(k) + kSide;
          codes[static_cast<std::size_t>(y * kWidth + x)] =
              (inside ? kBright : kGround) + static_cast<int>(random.whole(-kNoise, kNoise));
        }
      }
      pictures.push_back(std::move(codes));
    }
  }

  // frames/00.pgm and so on.
  void write(const Scratch& scratch) const {
    std::filesystem::create_directory(scratch / "frames");
    for (int k = 0; k < kCount; ++k) {
      std::string file = "P5 " + std::to_string(kWidth) + " " + std::to_string(kHeight) + " 255\n";
      for (const int code : pictures[static_cast<std::size_t>(k)]) file += static_cast<char>(code);
      scratch.write(std::string("frames/") + (k < 10 ? "0" : "") + std::to_string(k) + ".pgm", file);
    }
  }
};

}  // namespace nutik::test
