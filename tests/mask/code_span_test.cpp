#include "mask/code_span.hpp"

#include <gtest/gtest.h>

#include "imev/capture_source.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

TEST(CodeSpan, IsThatOfTheSamplesAskedFor) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    RandomCase random(seed);
    random.capture.noise.tolerance = 0;
    Random draw(seed + 1000);
    const auto last_sample = static_cast<std::int64_t>(random.rasters.size()) - 1;
    const std::int64_t first = draw.whole(0, last_sample);
    const SampleRange range{static_cast<std::uint64_t>(first),
                            static_cast<std::uint64_t>(draw.whole(first, last_sample)) + 1};
    const MemoryCapture capture = random.encode();
    CodeSpan span(capture.format(), range);
    for (std::uint64_t block = 0; block < capture.block_count(); ++block) span.add(capture.view(block));
    const std::vector<std::uint32_t> spans = span.spans();
    const std::uint32_t channels = random.capture.shape.channels;
    for (std::uint64_t pixel = 0; pixel < spans.size(); ++pixel) {
      std::uint32_t widest = 0;
      for (std::uint64_t value = pixel * channels; value < (pixel + 1) * channels; ++value) {
        std::uint32_t least = ~0u, most = 0;
        for (std::uint64_t k = range.first; k < range.last; ++k) {
          const std::uint32_t code = code_at(random.capture, random.rasters[k], value);
          least = std::min(least, code);
          most = std::max(most, code);
        }
        widest = std::max(widest, most - least);
      }
      ASSERT_EQ(spans[pixel], widest)
          << random.text() << ", pixel " << pixel << ", samples " << range.first << " to " << range.last;
    }
  }
}

TEST(CodeSpan, NoiseIsWhatTheQuietestQuarterHas) {
  std::vector<std::uint32_t> spans(100, 90);
  std::fill_n(spans.begin(), 30, 12u);
  EXPECT_EQ(default_noise(spans, 255), 24u);
  EXPECT_EQ(default_noise(std::vector<std::uint32_t>(100, 0), 255), 15u);
  EXPECT_EQ(default_noise(std::vector<std::uint32_t>(1, 3), 4095), 255u);
  // A scene that moves everywhere: codes cannot differ by 400, so pixels that move most would be still.
  EXPECT_EQ(default_noise(std::vector<std::uint32_t>(100, 200), 255), 227u);
  EXPECT_EQ(default_noise(std::vector<std::uint32_t>(100, 255), 255), 254u);
  EXPECT_EQ(default_noise(std::vector<std::uint32_t>(100, 1), 1), 0u);
  const Region moving = spanning_more({3, 1, 3}, std::vector<std::uint32_t>{24, 25, 0}, 24);
  EXPECT_EQ(moving.inside, (std::vector<std::uint8_t>{0, 1, 0}));
}

TEST(CodeSpan, DifferenceIsThatOfTheChannelThatChangesMost) {
  Picture a({2, 1, 3}, ValueType::code8, 255), b = a;
  const std::uint8_t first[] = {10, 20, 30, 200, 0, 255}, second[] = {13, 20, 25, 199, 0, 255};
  std::copy_n(first, 6, a.values<std::uint8_t>().begin());
  std::copy_n(second, 6, b.values<std::uint8_t>().begin());
  EXPECT_EQ(differences(a, b), (std::vector<std::uint32_t>{5, 1}));
  Picture deep({1, 1, 1}, ValueType::code16, 65'535), other = deep;
  deep.values<std::uint16_t>()[0] = 65'535;
  EXPECT_EQ(differences(deep, other), (std::vector<std::uint32_t>{65'535}));
}

TEST(CodeSpan, BrightnessOfAGreyInColourIsItsCode) {
  Picture picture({256, 1, 3}, ValueType::code8, 255);
  for (std::size_t i = 0; i < 768; ++i) picture.values<std::uint8_t>()[i] = static_cast<std::uint8_t>(i / 3);
  for (std::uint32_t code = 0; code < 256; ++code) {
    const Region one = between(picture, code, code);
    EXPECT_EQ(one.pixel_count(), 1u) << code;
    EXPECT_EQ(one.inside[code], 1) << code;
  }
  EXPECT_EQ(between(picture, 100, 255).pixel_count(), 156u);
  picture.values<std::uint8_t>()[0] = 100;  // (100, 0, 0) has the luma 21.26
  EXPECT_EQ(between(picture, 21.25, 21.27).inside[0], 1);
}

}  // namespace
}  // namespace nutik::test
