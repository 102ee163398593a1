// Clips of which a part is taken, that come through a pipe, or end too early, from the command line to the picture.
#include <gtest/gtest.h>

#include "support/app_test.hpp"
#include "support/ffmpeg.hpp"
#include "support/stills.hpp"

namespace nutik::test {
namespace {

class PartOfAClip : public AppTest {
 protected:
  static constexpr Shape kShape{40, 24, 3};
  static constexpr int kStills = 6;

  void SetUp() override {
    std::filesystem::create_directory(scratch_ / "frames");
    const auto stills = random_stills(kShape, 65'535, kStills, 3);
    for (int k = 0; k < kStills; ++k) {
      scratch_.write("frames/" + std::to_string(k) + ".ppm", netpbm_file(stills[static_cast<std::size_t>(k)], false));
    }
  }

  void expose(const Words& words, const std::string& picture) const {
    make("expose --renderer reference -f 100 frames -o " + picture + words);
  }
};

TEST_F(PartOfAClip, IsExposedAsThatPartOfTheWhole) {
  expose("--start 2f --exposure 3f", "whole.pfm");
  expose("--start 1f --exposure 3f --from 1f --to 5f --crop 30x20+4+3", "part.pfm");
  const cv::Mat whole = picture("whole.pfm")(cv::Rect(4, 3, 30, 20)), part = picture("part.pfm");
  ASSERT_EQ(part.size(), whole.size());
  EXPECT_EQ(cv::norm(whole, part, cv::NORM_INF), 0.0);
}

// The moment that activity names counts in the part, which its words state for another command. The mask is activity's.
TEST_F(PartOfAClip, IsStatedWithItsQuietestMoment) {
  scratch_.write("all.pgm", "P5 30 20 255\n" + std::string(600, '\1'));
  const Words activity("activity -f 100 --from 2f --to 5f --crop 30x20+4+3 --transfer linear -m all.pgm frames");
  const std::string words = "--fps 100 --from 2f --to 5f --crop 30x20+4+3 --transfer linear --start 1f --exposure 1f";
  EXPECT_EQ(run(activity + Words("--moment quietest")).out, words + "\n");
  expect_says(run(activity).out, "try: nutik-cl " + words + " frames quiet.png");
}

// Light adds up whichever comes first. A mean is off by half a code of 65535 at most, in every picture and so in what
// is exposed; beside it stand the roundings of a float.
TEST_F(PartOfAClip, IsAsBrightScaledBeforeAsAfter) {
  const Words exposure("--start 0s --exposure 60ms");
  expose(exposure, "whole.pfm");
  expose(exposure + "--scale 1/4", "scaled.pfm");
  const cv::Mat whole = picture("whole.pfm"), part = picture("scaled.pfm");
  ASSERT_EQ(part.size(), cv::Size(10, 6));
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 10; ++x) {
      const cv::Scalar mean = cv::mean(whole(cv::Rect(4 * x, 4 * y, 4, 4)));
      for (int channel = 0; channel < 3; ++channel) {
        EXPECT_NEAR(part.at<cv::Vec3f>(y, x)[channel], mean[channel], 0.5 / 65'535 + 2e-7);
      }
    }
  }
}

TEST_F(PartOfAClip, IsToldAndCheckedAndStatedInRecipes) {
  const auto encoded = make("encode -f 100 --from 20ms --scale 1/2 frames part.tik");
  expect_says(encoded.out,
              "part: pictures 2 … 5 of 6, whose time 0 is 0.02 s after the clip's (--from), "
              "20 x 12 as means of light (--scale)");
  const auto info = run("info part.tik");
  expect_says(info.out, "pictures 2 … 5 of 6");
  const Words validate("validate --source frames --start 0s --exposure 10ms --runs 1 --scale 1/2 part.tik");
  make(validate + "--from 2f");
  EXPECT_NE(run(validate + "--from 1f").status, 0);
  expose("--start 0f --exposure 1f --from 1f --crop 8x8+0+0 --ignore-errors", "p.png");
  const auto again = run("reproduce p.png");
  expect_says(again.out, {"--ignore-errors", "--crop 8x8+0+0", "--from 1f"});
  expect_refused(
      2, {{"expose --from 1f --exposure 1f part.tik", "--from describes a clip"},
          {"encode -f 100 --from 6f frames x.tik", "which has 6 pictures (0f … 5f, the last from 0.05 s on) (--from)"},
          {"encode -f 100 --from 1/3f frames x.tik", "is not a whole number of pictures"}});
}

// In a video's source --from and --to are where it starts and ends in the capture: frames, not what is read.
TEST_F(PartOfAClip, OfAVideosSourceIsCropped) {
  make(
      "video -f 100 --crop 16x8+2+2 --from 1f --to 5f --out-fps 100 --out-angle 360 --renderer reference "
      "frames v-%02d.png");
  EXPECT_EQ(picture("v-00.png").size(), cv::Size(16, 8));
}

TEST_F(PartOfAClip, ComesThroughAPipe) {
  NEEDS_FFMPEG();
  const std::string program = NUTIK_TEST_PROGRAM, tail = " --renderer reference --no-recipe -o ";
  test::make(scratch_, "-f lavfi -i testsrc2=size=64x48:rate=25 -frames:v 12 -pix_fmt yuv420p a.y4m");
  std::filesystem::create_directory(scratch_ / "tmp");
  shell(program + " expose a.y4m --start 80ms --exposure 120ms" + tail + "named.png");
  shell("ffmpeg -v error -i a.y4m -f yuv4mpegpipe - | TMPDIR=tmp " + program +
        " expose - --start 80ms --exposure 120ms" + tail + "piped.png");
  const std::string wanted = file("named.png");
  EXPECT_TRUE(file("piped.png") == wanted);
  EXPECT_TRUE(std::filesystem::is_empty(scratch_ / "tmp"));
  // A file is read where it lies; and what is read twice, as a series is.
  shell(program + " expose - --start 80ms --exposure 120ms" + tail + "- < a.y4m > sent.png");
  EXPECT_TRUE(file("sent.png") == wanted);
  shell("cat a.y4m | " + program + " expose - --every 2f --exposure 2f" + tail + "s%d.png");
  expect_says(shell("cat a.y4m | " + program + " encode - && " + program + " info standard-input.tik").out,
              "12 samples");
  shell("cat a.y4m | " + program + " - short.tik");
  EXPECT_TRUE(file("short.tik") == file("standard-input.tik"));

  scratch_.write("f.fn", "M0 [0:1], [10000000:0]\n");
  expect_says(shell("cat f.fn | " + program + " expose -k - - -o x.png", 2).err,
              "the clip - and -k - would both read standard input");
  expect_says(shell(program + " expose --exposure 1f - -o x.png < /dev/null | cat").err, "standard input is empty");
  expect_says(shell("echo nonsense | " + program + " expose --exposure 1f - -o x.png", 3).err,
              "nutik-cl: standard input is a text, and no clip");
  expect_says(shell("cat a.y4m | " + program + " encode --from 9s - x.tik", 2).err,
              "no picture begins that late in standard input, which has 12");
  const auto cut = shell("head -c 40000 a.y4m | " + program + " encode - cut.tik");
  expect_says(cut.err, "warning: it was cut off within picture ");
  const auto quiet = shell("head -c 40000 a.y4m | " + program + " encode -q - quiet.tik");
  expect_says(quiet.err, "warning: it was cut off within picture ");
  EXPECT_EQ(cut.err.find("/dev/stdin"), std::string::npos) << cut.err;
}

TEST_F(PartOfAClip, EndsAtItsDamageWhereThatIsAsked) {
  NEEDS_FFMPEG();
  test::make(scratch_,
             "-f lavfi -i testsrc2=size=64x48:rate=25 -frames:v 30 -c:v ffv1 -level 3 -slicecrc 1 a.mkv");
  std::string bytes = file("a.mkv");
  bytes[bytes.size() * 2 / 3] = static_cast<char>(bytes[bytes.size() * 2 / 3] ^ 8);
  scratch_.write("a.mkv", bytes);
  expect_refused("encode a.mkv a.tik", 3, "pictures before it can be taken (--ignore-errors)");
  const auto encoded = make("encode --ignore-errors a.mkv a.tik");
  expect_says(encoded.err, {"warning: a.mkv is taken as far as it goes, ", " of 30 pictures: "});
  // Straight from the clip it is the same picture, with the same warning; one before the damage has none.
  const Words all("--start 0s --exposure 5s --renderer reference --no-recipe");
  expect_says(make("expose --ignore-errors a.mkv -o clip.png" + all).err, "is taken as far as it goes");
  make("expose a.tik -o capture.png" + all);
  EXPECT_TRUE(file("clip.png") == file("capture.png"));
}

}  // namespace
}  // namespace nutik::test
