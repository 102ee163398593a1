// Which of the containers that FFmpeg knows are read, what is believed of them, and what is refused by name.
#include <gtest/gtest.h>

#include "support/ffmpeg.hpp"
#include "support/messages.hpp"
#include "support/stills.hpp"

namespace nutik {
namespace {

using test::make;
using test::open_test_clip;
using test::read_all;
using test::Scratch;

// A limit that follows from a file's size has a limit itself: FFmpeg's settings are ints.
TEST(Containers, WithoutASizeAreReadHoweverLargeTheyAre) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  constexpr Shape kShape{352, 288, 1};
  scratch.write("raw", test::bytes_of(test::random_stills(kShape, 255, 12, 1)));
  for (const auto& [name, codec] : std::vector<std::pair<std::string, std::string>>{
           {"a.ts", "-c:v mpeg2video -q:v 1"},
           {"a.mts", "-c:v libx264 -preset ultrafast -qp 4 -f mpegts"},
           {"a.m2ts", "-c:v libx264 -preset ultrafast -qp 4 -bf 0"},
           {"a.mpg", "-c:v mpeg2video -q:v 1"},
           {"a.m2v", "-c:v mpeg2video -q:v 1"},
           {"a.h264", "-c:v libx264 -preset ultrafast -qp 4"},
           {"a.hevc", "-c:v libx265 -preset ultrafast -x265-params qp=4:log-level=none"},
           {"a.mpeg4", "-c:v mpeg4 -q:v 1 -f m4v"},
           {"a.h263", "-c:v h263 -q:v 1"},
           {"a.mjpeg", "-c:v mjpeg -q:v 1 -pix_fmt yuvj420p"},
           {"a.obu", "-c:v libaom-av1 -cpu-used 8 -crf 1 -row-mt 1"},
           {"a.drc", "-c:v vc2"},
           {"a.dv", "-s 720x576 -pix_fmt yuv420p"}}) {
    SCOPED_TRACE(name);
    make(scratch, test::from_raw(kShape, "gray") + "-pix_fmt yuv420p " + codec + " " + name);
    ASSERT_GT(std::filesystem::file_size(scratch / name), 261'000u);
    ClipOptions options;
    options.interlaced = Interlaced::ignored;
    EXPECT_EQ(read_all(*open_test_clip(scratch / name, options)).size(), 12u);
  }
}

}  // namespace
}  // namespace nutik
