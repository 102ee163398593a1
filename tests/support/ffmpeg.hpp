// Clips that the ffmpeg command makes from known codes.
#pragma once

#include <gtest/gtest.h>
#include <array>

#include <filesystem>
#include <string>
#include <vector>

#include "capture/error.hpp"
#include "capture/picture.hpp"
#include "support/clips.hpp"
#include "support/program.hpp"
#include "support/scratch.hpp"

namespace nutik::test {

inline bool has_ffmpeg() {
  const Scratch scratch;
  return test::run_shell("ffmpeg -version", scratch.folder()).status == 0;
}

#define NEEDS_FFMPEG() \
  if (!nutik::test::has_ffmpeg()) GTEST_SKIP() << "the ffmpeg command is missing, which makes the clips"

inline std::string bytes_of(const std::vector<Picture>& pictures) {
  std::string bytes;
  for (const Picture& picture : pictures) {
    bytes.append(reinterpret_cast<const char*>(picture.bytes.data()), picture.bytes.size());
  }
  return bytes;
}

// A row of Y, U and V of more than 8 bits, each as they say: plane by plane, little-endian.
inline std::string planes_of(const std::vector<std::array<int, 3>>& yuv) {
  std::string raw;
  for (std::size_t plane = 0; plane < 3; ++plane) {
    for (const auto& pixel : yuv) {
      raw += static_cast<char>(pixel[plane] & 255);
      raw += static_cast<char>(pixel[plane] >> 8);
    }
  }
  return raw;
}

// The words that read pictures' bytes, from the file `raw`, 25 a second.
inline std::string from_raw(Shape shape, const std::string& pixels) {
  return "-f rawvideo -s " + std::to_string(shape.width) + "x" + std::to_string(shape.height) +
         " -r 25 -pix_fmt " + pixels + " -i raw ";
}

// Runs ffmpeg in the scratch folder.
inline void make(const Scratch& scratch, const std::string& words) {
  const auto made = test::run_shell("ffmpeg -v error -y " + words, scratch.folder());
  ASSERT_EQ(made.status, 0) << words << "\n" << made.err;
}

// A clip that is opened, read to its end or given a timeline must throw, saying `part`.
inline void expect_clip_refused(const std::filesystem::path& path, const ClipOptions& options,
                                const std::string& part) {
  try {
    const auto clip = open_test_clip(path, options);
    const auto rasters = read_all(*clip);
    static_cast<void>(timeline_of(path.string(), clip->info(), options, {360, 1}, rasters.size()));
    FAIL() << path << " was read";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

}  // namespace nutik::test
