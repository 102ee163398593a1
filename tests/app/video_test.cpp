// Videos of a capture: its own frames back, means in light, any speed; from a capture and from a clip, with
// both renderers.
#include <gtest/gtest.h>

#include "capture/transfer.hpp"
#include "support/app_test.hpp"
#include "support/clips.hpp"
#include "support/stills.hpp"

namespace nutik::test {
namespace {

constexpr Shape kShape{19, 11, 3};
constexpr int kCount = 70;  // more than a block

// A folder of stills, and a capture of them.
class Video : public AppTest {
 protected:
  void make_capture(const std::string& rate, const std::string& angle) {
    stills_ = random_stills(kShape, 255, kCount, 11);
    std::filesystem::create_directory(scratch_ / "frames");
    for (int k = 0; k < kCount; ++k) {
      scratch_.write("frames/" + std::to_string(k) + ".ppm", netpbm_file(stills_[static_cast<std::size_t>(k)], false));
    }
    source_ = {"-f", rate, "-a", angle};
    run({"-f", rate, "-a", angle, "frames", "c.tik", "-q"});
  }

  ProgramResult run(const Words& words) const { return make(over(words)); }

  // The frames of `video OPTIONS INPUT`, as stills.
  std::vector<std::vector<std::byte>> frames(const Words& options, bool from_clip = false) {
    std::filesystem::remove_all(scratch_ / "out");
    std::filesystem::create_directory(scratch_ / "out");
    run("video -q" + options + (from_clip ? source_ + "frames" : "c.tik") + "out/%05d.ppm");
    const auto clip = open_test_clip(scratch_ / "out/%05d.ppm");
    return read_all(*clip);
  }

  // A frame that exposes samples for these shares of its time is their mean in light, encoded again. Both
  // codes are right where the mean lies half way between them (dark codes are proportional to light).
  void expect_mean(const std::vector<std::byte>& frame,
                   const std::vector<std::pair<int, double>>& shares) const {
    const Transfer srgb = Transfer::srgb();
    ASSERT_EQ(frame.size(), kShape.value_count());
    for (std::size_t i = 0; i < frame.size(); ++i) {
      double light = 0.0;
      for (const auto& [k, share] : shares) {
        light +=
            share * srgb.light_of(static_cast<int>(stills_[static_cast<std::size_t>(k)].bytes[i]) / 255.0);
      }
      constexpr double kRounding = 1e-9;  // of a few sums and powers in double, in codes
      ASSERT_NEAR(static_cast<int>(frame[i]), srgb.fraction_of(light) * 255, 0.5 + kRounding)
          << "sample " << shares.front().first << ", value " << i;
    }
  }
  std::vector<Picture> stills_;
  Words source_ = {};
};

TEST_F(Video, OfTheSourcesRateAndAngleIsTheSource) {
  const std::pair<const char*, const char*> sources[] = {
      {"30000/1001", "360"}, {"30000/1001", "180"}, {"29.97", "172.8"}};
  for (const auto& [rate, angle] : sources) {
    SCOPED_TRACE(std::string(rate) + " a second, " + angle + " degrees");
    make_capture(rate, angle);
    for (const auto& [renderer, from_clip] :
         {std::pair{"opencl", false}, std::pair{"reference", false}, std::pair{"opencl", true}}) {
      const auto got = frames({"--out-fps", rate, "--out-angle", angle, "--renderer", renderer}, from_clip);
      ASSERT_EQ(got.size(), stills_.size());
      for (std::size_t k = 0; k < got.size(); ++k) {
        ASSERT_EQ(difference(got[k], stills_[k]), "") << renderer << ", frame " << k;
      }
    }
    // From a picture on, up to another.
    const auto part = frames({"--out-fps", rate, "--out-angle", angle, "--from", "13f", "--to", "20f"});
    ASSERT_EQ(part.size(), 7u);
    for (std::size_t k = 0; k < part.size(); ++k) ASSERT_EQ(difference(part[k], stills_[13 + k]), "");
    // An end behind the capture's own changes nothing, and is told.
    expect_says(run("video --to 9s c.tik v.mkv").err, "warning: the video's end 9s lies after the capture's end at ");
    EXPECT_EQ(run({"video", "--to", std::to_string(kCount) + "f", "c.tik", "v.mkv"}).err, "");
  }
}

TEST_F(Video, OfHalfTheRateIsTheMeanInLightOfEachPair) {
  make_capture("100", "360");
  for (const char* renderer : {"opencl", "reference"}) {
    const auto got = frames({"--out-fps", "50", "--out-angle", "360", "--renderer", renderer});
    ASSERT_EQ(got.size(), kCount / 2u);
    for (int k = 0; k < kCount / 2; ++k) {
      expect_mean(got[static_cast<std::size_t>(k)], {{2 * k, 0.5}, {2 * k + 1, 0.5}});
    }
  }
}

TEST_F(Video, TakesAnyRateAngleAndSpeed) {
  make_capture("100", "360");
  // Faster than the source: each sample four times.
  const auto fast = frames("--out-fps 400 --out-angle 360");
  ASSERT_EQ(fast.size(), 4u * kCount);
  for (std::size_t k = 0; k < fast.size(); ++k) ASSERT_EQ(difference(fast[k], stills_[k / 4]), "") << k;
  // Slow motion and time-lapse: a tenth of a second takes a second, or two samples a frame at 25 a second.
  const auto slow = frames("--out-fps 10 --out-angle 90 --speed 0.1");
  ASSERT_EQ(slow.size(), static_cast<std::size_t>(kCount));
  for (std::size_t k = 0; k < slow.size(); ++k) ASSERT_EQ(difference(slow[k], stills_[k]), "") << k;
  const auto lapse = frames("--out-fps 25 --out-angle 360 --speed 1/2");
  ASSERT_EQ(lapse.size(), kCount / 2u);
  expect_mean(lapse[3], {{6, 0.5}, {7, 0.5}});
  // Exposures that overlap: the last frame that is whole starts a sample earlier.
  const auto overlapping = frames("--out-fps 100 --out-angle 720");
  ASSERT_EQ(overlapping.size(), kCount - 1u);
  expect_mean(overlapping[30], {{30, 0.5}, {31, 0.5}});
  // An interval that cuts samples: [0.0025 s, 0.0175 s] · n.
  const auto cut = frames("--out-fps 50 --out-angle 270 --from 2.5ms");
  expect_mean(cut[0], {{0, 0.5}, {1, 0.5}});
  EXPECT_EQ(cut.size(), kCount / 2u);
  const auto uneven = frames("--out-fps 50 --out-angle 180 --from 7.5ms");
  expect_mean(uneven[4], {{8, 0.25}, {9, 0.75}});
}

TEST_F(Video, ExposesEachFrameWithFunctionsFromItsStartOn) {
  make_capture("100", "360");
  Picture mask({kShape.width, kShape.height, 1}, ValueType::code8, 255);
  for (std::size_t i = 0; i < mask.bytes.size(); ++i) mask.bytes[i] = std::byte(i % 3 == 0 ? 7 : 0);
  scratch_.write("m.pgm", netpbm_file(mask, false));
  const auto functions = [](std::int64_t at) {
    const auto point = [&](std::int64_t time, const char* gain) {
      return "[" + std::to_string(at + time) + ":" + gain + "]";
    };
    return "M0 " + point(0, "1") + ", " + point(25'000'000, "-0.5") + ", " + point(25'000'001, "0") +
           "\nM7 " + point(-1, "0") + ", " + point(0, "2") + ", " + point(5'000'000, "0") + "\n";
  };
  // The first point of M0 holds 1 from the capture's start: an anchor before it.
  const auto anchored = [&](std::int64_t at) {
    std::string text = functions(at);
    return text.replace(0, 3, "M0 [" + std::to_string(at - 1) + ":0], ");
  };
  scratch_.write("f.fn", anchored(0));
  const auto got = frames("-m m.pgm -k f.fn --out-fps 40 --from 5ms");
  // 0.7 s are 27.6 starts from 5 ms on, and the last that leaves 25 ms and 1 ns is number 26.
  ASSERT_EQ(got.size(), 27u);
  for (const int k : {0, 1, 13, 26}) {
    scratch_.write("k.fn", anchored(5'000'000 + k * 25'000'000ll));
    run("-m m.pgm -k k.fn c.tik one.ppm -q");
    const auto one = read_all(*open_test_clip(scratch_ / "one.ppm"));
    EXPECT_EQ(got[static_cast<std::size_t>(k)], one.front()) << k;
  }
}

TEST_F(Video, ShapesAndBrightensEachFrame) {
  make_capture("100", "360");
  const Words bright("--shutter hann --normalize integral --ev -1");
  const auto got = frames("--out-fps 20 --out-angle 270 --from 12ms" + bright);
  ASSERT_EQ(got.size(), 14u);  // the last ends at 12 + 13 · 50 + 37.5 ms, of 700
  for (const int k : {0, 7, 13}) {
    run("expose --exposure 37.5ms c.tik one.ppm -q --start " + std::to_string(12 + k * 50) + "ms" + bright);
    const auto one = read_all(*open_test_clip(scratch_ / "one.ppm"));
    EXPECT_EQ(got[static_cast<std::size_t>(k)], one.front()) << k;
  }
}

TEST_F(Video, GoesIntoContainers) {
  make_capture("960", "360");
  expect_says(run("video --out-fps 30000/1001 --speed 0.5 c.tik v.mkv").out,
              "v.mkv: 19 x 11 colour, 4 frames (30000/1001 frames a second, 180 degrees, speed 0.5), "
              "from 0 ns to 58.39 ms of the capture, ffv1");
  const auto stills = frames("--out-fps 30000/1001 --speed 0.5");
  const auto clip = open_test_clip(scratch_ / "v.mkv");
  EXPECT_EQ(clip->info().timing.rate, (Rational{30000, 1001}));
  EXPECT_EQ(read_all(*clip), stills);
  // Without a name, and with a codec for pairs of pixels.
  const ProgramResult named = run("video c.tik");
  expect_says(named.out, "c-24fps.mp4: ");
  expect_says(named.err, "19 x 11 became 20 x 12");
  EXPECT_EQ(open_test_clip(scratch_ / "c-24fps.mp4")->info().format.shape, (Shape{20, 12, 3}));
  run("video --depth float c.tik light-%d.pfm -q");
  EXPECT_TRUE(exists("light-0.pfm"));
}

TEST_F(Video, SaysWhatMakesNoSense) {
  make_capture("100", "360");
  scratch_.write("f.fn", "M0 [0:1], [10000000:1], [10000001:0]\n");
  scratch_.write("long.fn", "M0 [0:1], [900000000:1], [900000001:0]\n");
  scratch_.write("v.mov", "no video");
  struct Case {
    Words words;
    int status;
    const char* part;
  };
  const Case cases[] = {
      {{"v.mp4", "--out-fps", "0"}, 2, "frame rate 0 is not positive"},
      {{"v.mp4", "--out-fps", "fast"}, 2, "--out-fps 'fast' is not a number"},
      {{"v.mp4", "--speed", "-1"}, 2, "speed -1 is not positive"},
      {{"v.mp4", "--from", "3"}, 2, "--from '3' is no time"},
      {{"v.mp4", "--from", "0.7s"}, 2, "the video's start 0.7s lies outside the capture, which lasts 700 ms"},
      {{"v.mp4", "--from", "71f"}, 2, "picture 71 is outside the capture"},
      {{"v.mp4", "--from", "0.5s", "--to", "0.5s"}, 2, "would end at 0.5s, which is not after its start at 0.5s"},
      {{"v.mp4", "--from", "0.5s", "--to", "0.4s"}, 2, "would end at 0.4s, which is not after its start at 0.5s"},
      {{"v.mp4", "--out-fps", "1", "--out-angle", "360"}, 2, "each is exposed for 1 s, and between"},
      {{"v.mp4", "-k", "f.fn", "--out-angle", "90"}, 2, "with -k the functions say"},
      {{"v.mp4", "-k", "long.fn", "--from", "1ms"}, 2, "the last function ends 900 ms after its frame's start, and"},
      {{"v.mp4", "-m", "m.pgm"}, 2, "a mask goes with gain functions (-k)"},
      {{"v.mp4", "--start", "0s"}, 2, "--start does not go with video; --from and --to say which part."},
      {{"v.mp4", "--exposure", "10ms"}, 2, "--out-angle says how long each frame is exposed."},
      {{"v.png"}, 2, "v.png is one picture and a video has many; number them: v-%05d.png"},
      {{"v-%d.png", "--video-codec", "h264"}, 2, "stills (--video-codec)"},
      {{"v.ogg"}, 2, "videos are written as .mp4"},
      {{"v.mp4", "--depth", "16"}, 2, "h264 holds 8 bits"},
      {{"v.mov"}, 2, "v.mov exists and is no video; it is not replaced"},
      {{"v.mp4", "-f", "30"}, 2, "--fps describes a clip that is encoded"},
      {{"/nowhere/v.mp4"}, 5, "/nowhere/v.mp4 cannot be created"},
  };
  for (const Case& tested : cases) {
    expect_refused("video c.tik" + tested.words, tested.status, tested.part);
  }
  EXPECT_EQ(file("v.mov"), "no video");
  // A still that is an input is not replaced.
  expect_refused({"video", "-f", "100", "frames", "frames/%d.ppm"}, 2, "the output frames/0.ppm is also an input");
}

}  // namespace
}  // namespace nutik::test
