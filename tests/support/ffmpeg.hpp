// Clips that the ffmpeg command makes from known codes.
#pragma once

#include <gtest/gtest.h>
#include <array>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include "capture/error.hpp"
#include "capture/picture.hpp"
#include "support/clips.hpp"
#include "support/messages.hpp"
#include "support/program.hpp"
#include "support/scratch.hpp"

namespace nutik::test {

inline bool has_ffmpeg() {
  static const bool is_there = run_shell("command -v ffmpeg", Scratch().folder()).status == 0;
  return is_there;
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

// Runs ffmpeg in the scratch folder. What options say of colours is written into the output by copying it: while it
// encodes, ffmpeg 7 converts pictures to what they say, and leaves out what the encoder does not know.
inline void make(const Scratch& scratch, const std::string& words) {
  static const std::regex mark(" -(colorspace|color_primaries|color_trc|color_range|chroma_sample_location) \\S+");
  std::string marks, command = "ffmpeg -v error -y " + std::regex_replace(words, mark, "");
  for (std::sregex_iterator found(words.begin(), words.end(), mark), end; found != end; ++found) marks += found->str();
  if (!marks.empty()) {
    const std::string output = words.substr(words.rfind(' ') + 1), plain = "unmarked-" + output;
    command += " && mv " + output + " " + plain;
    command += " && ffmpeg -v error -y -i " + plain + " -c copy" + marks + " " + output;
  }
  const auto made = run_shell(command, scratch.folder());
  ASSERT_EQ(made.status, 0) << words << "\n" << made.err;
}

// Writes another display matrix into the track header of an MP4 or MOV: (x, y) of a stored pixel is shown at
// (a x + c y, b x + d y). Each ffmpeg has an option of its own for it.
inline void set_display_matrix(const std::filesystem::path& path, const std::array<double, 4>& a_b_c_d) {
  std::string bytes = read_file(path);
  const std::size_t matrix = bytes.find("tkhd") + 44;  // of 9 numbers, big-endian, of which 16 bits are a fraction
  ASSERT_LT(matrix + 36, bytes.size());
  for (std::size_t i = 0; i < 4; ++i) {
    const auto fixed = static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(a_b_c_d[i] * 65536)));
    const std::size_t at = matrix + std::array<std::size_t, 4>{0, 4, 12, 16}[i];
    for (std::size_t byte = 0; byte < 4; ++byte) bytes[at + byte] = static_cast<char>(fixed >> (24 - 8 * byte));
  }
  std::ofstream(path, std::ios::binary) << bytes;
}

// A clip that is opened, read to its end or given a timeline must throw, saying `part`.
inline void expect_clip_refused(const std::filesystem::path& path, const ClipOptions& options,
                                const std::string& part) {
  const auto read = [&] {
    const auto clip = open_test_clip(path, options);
    const auto rasters = read_all(*clip);
    static_cast<void>(timeline_of(path.string(), clip->info(), options, {360, 1}, rasters.size()));
  };
  expect_error<Error>(read, {part});
}

}  // namespace nutik::test
