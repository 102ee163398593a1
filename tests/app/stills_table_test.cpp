// A table of stills through the program: its times live in the capture and in every exposure.
#include <gtest/gtest.h>

#include "support/clips.hpp"
#include "support/app_test.hpp"
#include "support/stills.hpp"

namespace nutik::test {
namespace {

class StillsTableProgram : public AppTest {};

TEST_F(StillsTableProgram, KeepsTheListedExposures) {
  // One dark and one bright picture; 10 ms each, and a gap of 30 ms between them.
  const auto flat = [](std::uint8_t code) {
    Picture picture({8, 8, 1}, ValueType::code8, 255);
    for (auto& value : picture.values<std::uint8_t>()) value = code;
    return netpbm_file(picture, false);
  };
  scratch_.write("dark.pgm", flat(50));
  scratch_.write("bright.pgm", flat(150));
  scratch_.write("stills.csv",
                "file,start_ns,exposure_ns\ndark.pgm,7,10000000\nbright.pgm,40000007,10000000\n");
  const ProgramResult made = make("--transfer linear stills.csv c.tik");
  expect_says(made.out, {"(from the table), shutter 90 degrees (from the mean of the listed exposures)"});
  EXPECT_EQ(made.err.find("slow-motion"), std::string::npos) << made.err;
  expect_says(make("info c.tik").out, "(irregular), shutter 90 degrees");
  const auto code_of = [&](const Words& words) {
    make(words + "-q --out-transfer source p.pgm");
    return static_cast<int>(read_all(*open_test_clip(scratch_ / "p.pgm")).front().front());
  };
  EXPECT_EQ(code_of({"--start", "0f", "--exposure", "1f", "c.tik"}), 50);
  EXPECT_EQ(code_of({"--start", "1f", "--exposure", "1f", "c.tik"}), 150);
  // In the gap the light runs straight: its last third has a mean of 5/6 on the way.
  EXPECT_EQ(code_of({"--start", "30ms", "--exposure", "10ms", "c.tik"}), 133);
  EXPECT_EQ(code_of({"--transfer", "linear", "--start", "30ms", "--exposure", "10ms", "stills.csv"}), 133);
  // Frames of a video, too: 10 ms of every 10 ms, five in all.
  make("video --out-fps 100 --out-angle 360 c.tik v-%d.pgm -q --out-transfer source");
  const auto frames = read_all(*open_test_clip(scratch_ / "v-%d.pgm"));
  ASSERT_EQ(frames.size(), 5u);
  const int expected[] = {50, 67, 100, 133, 150};  // 50 + 100 · (1/6, 3/6, 5/6), rounded
  for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(static_cast<int>(frames[k].front()), expected[k]) << k;

  expect_refused("-a 180 stills.csv d.tik", 2, "stills.csv says how long each picture was exposed");
  // What the table lists is an input, which no output replaces.
  expect_refused("--start 0s --exposure 1ms stills.csv dark.pgm", 2, "the output dark.pgm is also an input");
}

}  // namespace
}  // namespace nutik::test
