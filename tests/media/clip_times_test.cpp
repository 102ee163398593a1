// When a clip's pictures were taken: irregular times of containers, and a camera's own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <sstream>

#include "support/ffmpeg.hpp"
#include "support/stills.hpp"

namespace nutik::test {
namespace {

// Times in ms, that fit no rate.
const std::vector<std::int64_t> kStarts{0, 40, 80, 120, 240, 250, 490};

void make_irregular(const Scratch& scratch, const std::string& output, const std::string& codec) {
  const auto pictures = random_stills({32, 16, 1}, 255, static_cast<int>(kStarts.size()), 2);
  scratch.write("raw", bytes_of(pictures));
  std::string times;
  for (std::size_t k = 0; k < kStarts.size(); ++k) {
    times += (k == 0 ? "eq(N," : "+eq(N,") + std::to_string(k) + ")*" + std::to_string(kStarts[k]);
  }
  make(scratch, from_raw({32, 16, 1}, "gray") + "-vf \"settb=1/1000,setpts='" + times +
                    "'\" -fps_mode vfr -enc_time_base 1:1000 " + codec + " " + output);
}

TEST(ClipTimes, TakesIrregularTimesFromTheContainer) {
  NEEDS_FFMPEG();
  // Some ffmpegs leave the last packet without a duration: an MP4's edit list, if there was one, would end before it.
  for (const auto& [output, codec] :
       {std::pair<std::string, std::string>{"clip.mkv", "-c:v ffv1 -pix_fmt gray"},
        {"clip.mp4", "-c:v libx264 -bf 2 -pix_fmt yuv420p10le -video_track_timescale 1000 -use_editlist 0"},
        {"eight.mp4", "-c:v libx264 -bf 2 -pix_fmt yuv420p -video_track_timescale 90000 -use_editlist 0"}}) {
    SCOPED_TRACE(output);
    const Scratch scratch;
    make_irregular(scratch, output, codec);
    const auto clip = open_test_clip(scratch / output);
    ASSERT_FALSE(clip->info().timing.rate);
    ASSERT_EQ(clip->info().sample_count, kStarts.size());
    EXPECT_EQ(read_all(*clip).size(), kStarts.size());
    const Timeline timeline = timeline_of(output, clip->info(), {}, {180, 1}, kStarts.size());
    for (std::size_t k = 0; k < kStarts.size(); ++k) {
      EXPECT_EQ(timeline.start_ns(k), kStarts[k] * 1'000'000);
      const std::int64_t period = k + 1 < kStarts.size() ? kStarts[k + 1] - kStarts[k] : 240;
      EXPECT_EQ(timeline.end_ns(k), kStarts[k] * 1'000'000 + period * 500'000);
    }
    EXPECT_EQ(timeline.duration_ns(), 730'000'000);
    // A stated rate goes before them.
    EXPECT_TRUE(timeline_of(output, clip->info(), {.rate = Rational{100, 1}}, {360, 1}, kStarts.size()).is_constant());
  }
}

TEST(ClipTimes, RefusesTimesThatDoNotIncrease) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  make_irregular(scratch, "clip.mkv", "-c:v ffv1 -pix_fmt gray");
  // A block's header: track 1, then the time after the cluster's in 16 bits.
  std::string bytes = read_file(scratch / "clip.mkv");
  const auto at = bytes.find(std::string("\x81\x00\xFA", 3));  // 250 ms
  ASSERT_NE(at, std::string::npos);
  bytes[at + 2] = '\xF0';  // 240 ms, as the picture before
  const auto clip = scratch.write("same.mkv", bytes);
  expect_clip_refused(
      clip, {},
      "same.mkv: sample 5 starts at 240000000 ns, not after sample 4 at 240000000 ns; if they "
      "were taken at a constant rate, state it");
  const ClipOptions stated{.rate = Rational{25, 1}};
  EXPECT_TRUE(timeline_of("", open_test_clip(clip, stated)->info(), stated, {360, 1}, 7).is_constant());
}

TEST(ClipTimes, ThatRunBackAreThoseOfTwoClips) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  for (const std::string clip : {"clip.ts", "clip.mpg"}) {
    test::make(scratch, "-f lavfi -i testsrc2=s=64x48:r=25:d=1 -c:v mpeg2video -bf 2 " + clip);
    const std::string bytes = read_file(scratch / clip);
    const auto twice = scratch.write("twice-" + clip, bytes + bytes);
    expect_clip_refused(twice, {}, "does not say how fast it was taken: its times run back at picture 25, as if");
    const ClipOptions stated{.rate = Rational{25, 1}};
    EXPECT_TRUE(timeline_of("", open_test_clip(twice, stated)->info(), stated, {360, 1}, 50).is_constant());
  }
}

// What ffprobe says of decoded pictures: their times in ticks, without those that no decoder can tell (the last ones of
// files that time packets' decoding alone), and the seconds of a tick.
struct ProbedTimes {
  std::vector<std::int64_t> ticks;
  std::size_t pictures = 0;
  Rational tick_s{1, 1};
};

ProbedTimes probed(const Scratch& scratch, const std::string& clip) {
  const auto said = run_shell(
      "ffprobe -v error -select_streams v -show_frames -show_entries "
      "stream=time_base:frame=best_effort_timestamp "
      "-of default=nw=1 " +
          clip,
      scratch.folder());
  EXPECT_EQ(said.status, 0) << said.err;
  ProbedTimes times;
  std::istringstream lines(said.out);
  for (std::string line; std::getline(lines, line);) {
    const auto equals = line.find('=');
    const std::string key = line.substr(0, equals);
    if (key == "time_base") times.tick_s = Rational::parse(line.substr(equals + 1), key);
    if (key != "best_effort_timestamp") continue;
    ++times.pictures;
    if (line.substr(equals + 1) != "N/A") times.ticks.push_back(std::stoll(line.substr(equals + 1)));
  }
  return times;
}

struct TimedClip {
  std::string name;
  std::string filter;  // pictures that are left out, at the rate that stands before it
  std::string codec;
  Rational rate;     // of the slots
  bool is_constant;  // what must come of it
};

// A third of a second to two seconds of 64 x 48 pixels.
void make_timed(const Scratch& scratch, const TimedClip& clip, int slots) {
  const std::string source =
      "-f lavfi -i testsrc=s=64x48:r=" + clip.rate.text() + " -frames:v " + std::to_string(slots);
  const std::string left_out =
      clip.filter.empty() ? "" : " -vf \"select='not(" + clip.filter + ")'\" -fps_mode vfr";
  make(scratch, source + left_out + " " + clip.codec + " " + clip.name);
}

TEST(ClipTimes, AreThoseOfTheDecodedPictures) {
  NEEDS_FFMPEG();
  const std::string two = "eq(n,5)+eq(n,17)", second = "eq(n,1)";
  const std::string mpeg4 = "-c:v mpeg4 -bf 2", h264 = "-c:v libx264 -bf 3 -b_strategy 0",
                    mpeg2 = "-c:v mpeg2video -bf 2";
  constexpr int kSlots = 60;
  const TimedClip clips[] = {
      // A tick of AVI is a whole picture.
      {"plain.avi", "", "-c:v mjpeg", {30, 1}, true},
      {"two-gaps.avi", two, "-c:v mjpeg", {30, 1}, false},
      {"gap-behind-the-first.avi", second, "-c:v mjpeg", {30, 1}, false},
      {"reordered.avi", "", mpeg4, {30, 1}, true},
      {"reordered-with-gaps.avi", two, mpeg4, {30, 1}, false},
      {"h264.avi", "", h264, {960, 1}, true},
      {"h264-with-gaps.avi", two, h264, {960, 1}, false},
      // Program streams time some of their pictures, or their decoding alone.
      {"reordered.mpg", "", mpeg2, {30, 1}, true},
      {"reordered-with-gap.mpg", "eq(n,40)", mpeg2, {30, 1}, false},
      {"in-order.mpg", "", "-c:v mpeg1video -bf 0", {30, 1}, true},
      {"camcorder.vob", "", "-c:v mpeg2video -b:v 4M -bf 2 -g 12 -f dvd", {25, 1}, true},
      {"broadcast.ts", "", h264, {30, 1}, true},
      {"broadcast-with-gaps.ts", two, h264, {30, 1}, false},
      // Clocks as coarse as pictures: one that states the rate, one that does not.
      {"fast.mkv", "", h264, {960, 1}, true},
      {"fast-with-gaps.mkv", two, h264, {960, 1}, false},
      {"coarse.mp4", "", h264 + " -video_track_timescale 30", {30, 1}, true},
      {"coarse-with-gap.mp4", "eq(n,20)", h264 + " -video_track_timescale 30", {30, 1}, false},
      {"phone.mov", "", "-c:v mjpeg -video_track_timescale 600", {240, 1}, true},
      {"film.mp4", "", h264, {24000, 1001}, true},
  };
  for (const TimedClip& clip : clips) {
    SCOPED_TRACE(clip.name);
    const Scratch scratch;
    make_timed(scratch, clip, kSlots);
    const ProbedTimes want = probed(scratch, clip.name);
    ASSERT_GE(want.ticks.size() + 2, want.pictures);
    const auto opened = open_test_clip(scratch / clip.name);
    ASSERT_EQ(opened->info().sample_count, want.pictures);
    EXPECT_EQ(read_all(*opened).size(), want.pictures);
    const Timeline timeline = timeline_of(clip.name, opened->info(), {}, {360, 1}, want.pictures);
    EXPECT_EQ(timeline.is_constant(), clip.is_constant);
    if (clip.is_constant) {
      EXPECT_NEAR(timeline.rate().value(), clip.rate.value(), 0.01);
    }
    const double tick_ns = want.tick_s.value() * 1e9;
    for (std::size_t k = 0; k < want.ticks.size(); ++k) {
      const double want_ns = static_cast<double>(want.ticks[k] - want.ticks[0]) * tick_ns;
      // A constant rate is what the clock's ticks were rounded from.
      EXPECT_NEAR(static_cast<double>(timeline.start_ns(k)), want_ns, clip.is_constant ? tick_ns : 0.51) << k;
    }
  }
}

// Cut in its middle, a broadcast or a disc starts with pictures that refer to others which are gone.
TEST(ClipTimes, OfAStreamCutInItsMiddleAreThoseOfTheDecodedPictures) {
  NEEDS_FFMPEG();
  constexpr int kSlots = 90;
  const std::string gaps = "eq(mod(n,20),7)+eq(n,62)";
  const std::string mpeg2 = "-c:v mpeg2video -bf 2 -g 12 -q:v 4", h264 = "-c:v libx264 -bf 3 -g 12";
  const TimedClip clips[] = {{"even.mpg", "", mpeg2, {25, 1}, true},
                             {"gaps.mpg", gaps, mpeg2, {25, 1}, false},
                             {"disc.vob", "", mpeg2 + " -f dvd", {25, 1}, true},
                             {"in-order.mpg", "", "-c:v mpeg1video -bf 0 -g 12", {25, 1}, true},
                             {"even.ts", "", h264, {25, 1}, true},
                             {"gaps.ts", gaps, h264, {25, 1}, false}};
  int compared = 0;
  for (const TimedClip& clip : clips) {
    const Scratch scratch;
    make_timed(scratch, clip, kSlots);
    const std::string whole = read_file(scratch / clip.name);
    for (const double share : {0.2, 0.35, 0.5}) {
      SCOPED_TRACE(clip.name + " from " + std::to_string(share));
      const std::string name = "cut-" + clip.name;
      scratch.write(name, whole.substr(static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
      const ProbedTimes want = probed(scratch, name);
      ASSERT_GT(want.pictures, std::size_t{20});
      ASSERT_GE(want.ticks.size() + 1, want.pictures);
      const auto opened = open_test_clip(scratch / name);
      ASSERT_EQ(opened->info().sample_count, want.pictures);
      EXPECT_EQ(read_all(*opened).size(), want.pictures);
      if (!std::ranges::is_sorted(want.ticks, std::ranges::less_equal())) {
        // What tells the first pictures' times was cut away, and FFmpeg makes up some.
        expect_clip_refused(scratch / name, {}, "if they were taken at a constant rate, state it");
        continue;
      }
      ++compared;
      const auto says = [&](const std::string& words) {
        return std::ranges::any_of(opened->info().notes, [&](const Note& note) {
          return note.text.find(words) != std::string::npos;
        });
      };
      EXPECT_TRUE(says("packets give no picture, as where it was cut in its middle"));
      // Those of a broadcast have 188 bytes, and are not held together by anything else.
      const bool is_within_packet = name.ends_with(".ts") && std::filesystem::file_size(scratch / name) % 188 != 0;
      EXPECT_EQ(says("cut off within one of its packets"), is_within_packet);
      EXPECT_EQ(opened->info().notes.size(), is_within_packet ? 2u : 1u);
      const Timeline timeline = timeline_of(name, opened->info(), {}, {360, 1}, want.pictures);
      const double tick_ns = want.tick_s.value() * 1e9;
      for (std::size_t k = 0; k < want.ticks.size(); ++k) {
        EXPECT_NEAR(static_cast<double>(timeline.start_ns(k)),
                    static_cast<double>(want.ticks[k] - want.ticks[0]) * tick_ns, tick_ns)
            << k;
      }
      EXPECT_TRUE(clip.is_constant || !timeline.is_constant());
    }
  }
  EXPECT_GE(compared, 15);
}

// Packets of GXF say that they last a field, and only their decoding is timed: the picture that a decoder holds at the
// end would come half a picture early.
TEST(ClipTimes, OfFramesThatLastAFieldAreThoseOfFrames) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  make(scratch, "-f lavfi -i testsrc2=s=720x576:r=25 -frames:v 8 a.gxf");
  EXPECT_EQ(open_test_clip(scratch / "a.gxf", {.interlaced = Interlaced::ignored})->info().timing.rate,
            (Rational{25, 1}));
}

TEST(ClipTimes, OfASinglePictureAreNoClocksTicks) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  const std::string one = "-f lavfi -i testsrc2=s=64x48:r=90000 -frames:v 1 -c:v mjpeg -pix_fmt yuvj420p ";
  make(scratch, one + "-video_track_timescale 90000 one.mov");
  expect_clip_refused(scratch / "one.mov", {}, "one.mov does not say how fast it was taken; state the rate");
}

TEST(ClipTimes, NoRateIsInventedFromThreePictures) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  make_timed(scratch, {"three.mov", "eq(n,2)", "-c:v mjpeg -video_track_timescale 30", {30, 1}, false}, 3);
  const auto clip = open_test_clip(scratch / "three.mov");
  ASSERT_EQ(clip->info().sample_count, 3u);
  EXPECT_EQ(clip->info().timing.starts_ns, (std::vector<std::int64_t>{0, 33'333'333, 100'000'000}));
}

// Camera files, against bytes picked out of them by hand.
TEST(ClipTimes, GivesTheCodesThatCineFilesHold) {
  const std::filesystem::path media = NUTIK_TEST_MEDIA;
  if (!std::filesystem::exists(media / "cine_781.cine")) GTEST_SKIP() << "no clips in " << media;
  const std::string file = read_file(media / "cine_781.cine");
  const auto u32 = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, file.data() + at, 4);
    return value;
  };
  const auto clip = open_test_clip(media / "cine_781.cine");
  EXPECT_EQ(clip->info().format.shape, (Shape{256, 256, 1}));
  EXPECT_EQ(clip->info().format.white_code, 4095u);
  EXPECT_EQ(clip->info().format.transfer, Transfer::linear());
  // Every tenth picture of nominally 90 000 a second.
  const Timeline timeline = timeline_of("", clip->info(), {}, {360, 1}, 15);
  EXPECT_NEAR(timeline.rate().value(), 9003.21, 0.01);
  EXPECT_NEAR(static_cast<double>(timeline.start_ns(14)), 14 * 111'071.36, 10);
  // Its clock has 28 MHz, of which 311 ticks are the period next to 1/90000 s.
  EXPECT_NEAR(timeline.rate().value(), 28e6 / 311 / 10, 1e-3);
  expect_says(clip->info().notes.front().text, "the file has 9003.22, one in 10 of 90032.2.");
  const auto rasters = read_all(*clip);
  ASSERT_EQ(rasters.size(), 15u);
  for (std::size_t k = 0; k < 15; ++k) {
    const std::size_t image = u32(u32(32) + 8 * k);
    Picture want({256, 256, 1}, ValueType::code16, 4095);
    for (std::size_t y = 0; y < 256; ++y) {
      std::memcpy(want.bytes.data() + y * 512, file.data() + image + u32(image) + y * 512, 512);
    }
    EXPECT_EQ(difference(rasters[k], want), "") << k;
  }

  const auto packed = open_test_clip(media / "data_small_cine.cine");
  EXPECT_EQ(packed->info().format.white_code, 4095u);
  EXPECT_EQ(packed->info().timing.rate, (Rational{100, 1})) << "its last picture is stamped 292 days late";
  EXPECT_EQ(packed->info().notes.size(), 2u);
}

}  // namespace
}  // namespace nutik::test
