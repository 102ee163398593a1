// Clips whose camera moved, as a user aligns them. The scene is drawn where the camera looks, each value from a
// formula.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "capture/format.hpp"
#include "support/app_test.hpp"

namespace nutik::test {
namespace {

constexpr int kWidth = 160, kHeight = 120, kPictures = 12;

// Where the scene lies in a picture.
struct Shift {
  double x = 0, y = 0;
};

Shift hand(int picture) { return {3.5 * std::sin(0.6 * picture), 2.25 * std::sin(0.9 * picture)}; }

double texture(double x, double y) {
  double sum = 0;
  for (int wave = 0; wave < 24; ++wave) {
    const double turn = 2.4 * wave, pulse = 0.12 + 0.027 * wave;
    sum += std::sin(pulse * (x * std::cos(turn) + y * std::sin(turn)) + wave);
  }
  return sum;
}

// Before the scene a square of 20 pixels goes from left to right, 6 pixels a picture.
cv::Mat drawn(const Shift& shift, int picture, bool has_subject) {
  cv::Mat drawn(kHeight, kWidth, CV_8U);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double u = x - shift.x, v = y - shift.y, from_subject = u - 20 - 6 * picture;
      const bool is_subject = has_subject && std::abs(from_subject) < 10 && std::abs(v - 60) < 10;
      drawn.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(
          std::lround(is_subject ? 230 + 5 * std::sin(from_subject) : 110 + 7 * texture(u, v)));
    }
  }
  return drawn;
}

class Aligning : public AppTest {
 protected:
  void SetUp() override { write("frames", hand); }

  void write(const std::string& folder, const std::function<Shift(int)>& shift,
             bool has_subject = true) const {
    std::filesystem::create_directory(scratch_ / folder);
    for (int picture = 0; picture < kPictures; ++picture) {
      const std::string name = folder + (picture < 10 ? "/0" : "/") + std::to_string(picture) + ".pgm";
      cv::imwrite((scratch_ / name).string(), drawn(shift(picture), picture, has_subject));
    }
  }

  // What the capture shows at a picture, as the codes it holds.
  [[nodiscard]] cv::Mat shown(const std::string& capture, int picture) const {
    make({"--start", std::to_string(picture) + "f", "--exposure", "1f", "--out-transfer", "source", capture, "-o",
          "shown.pgm"});
    return this->picture("shown.pgm");
  }
};

Words encoding(const Words& words) { return "encode -f 100" + words; }

TEST_F(Aligning, HoldsStillThingsStillAndCropsToWhatEveryPictureSaw) {
  const json encoded = answer(encoding("--align translation frames a.tik"));
  double left = 0, right = 0, up = 0, down = 0;
  for (int picture = 0; picture < kPictures; ++picture) {
    left = std::max(left, -hand(picture).x);
    right = std::max(right, hand(picture).x);
    up = std::max(up, -hand(picture).y);
    down = std::max(down, hand(picture).y);
  }
  // Where the scene is moved to the left, its left border is not seen.
  const int x = static_cast<int>(std::ceil(left)), y = static_cast<int>(std::ceil(up));
  EXPECT_EQ(encoded["width"], kWidth - x - std::ceil(right));
  EXPECT_EQ(encoded["height"], kHeight - y - std::ceil(down));
  EXPECT_EQ(encoded["camera"]["motion"], "translation");
  const int furthest = encoded["camera"]["furthest_picture"];
  EXPECT_NEAR(encoded["camera"]["furthest_pixels"][0], hand(furthest).x, 0.05);
  EXPECT_NEAR(encoded["camera"]["furthest_pixels"][1], hand(furthest).y, 0.05);

  const cv::Mat first = drawn({}, 0, false);
  for (const int picture : {3, 7, 11}) {
    const cv::Mat is = shown("a.tik", picture);
    ASSERT_EQ(is.cols, encoded["width"]);
    double squares = 0;
    int count = 0;
    for (int v = 0; v < is.rows; ++v) {
      if (std::abs(v + y - 60) < 14) continue;  // the subject's rows
      for (int u = 0; u < is.cols; ++u, ++count) {
        squares += std::pow(is.at<std::uint8_t>(v, u) - first.at<std::uint8_t>(v + y, u + x), 2);
      }
    }
    // Unaligned they differ by ten times as much; what is left is the cubic's, on waves of nine pixels and more.
    EXPECT_LT(std::sqrt(squares / count), 3.0) << "picture " << picture;
  }
}

TEST_F(Aligning, WritesThePathThatMakesTheSameAgain) {
  const json encoded =
      answer(encoding("--align rigid --camera-path path.csv --camera-plot plot.png frames a.tik"));
  EXPECT_EQ(encoded["camera"]["path"], "path.csv");
  const cv::Mat plot = cv::imread((scratch_ / "plot.png").string());
  EXPECT_EQ(plot.cols, 1200);
  make(encoding("--align rigid --align-report seen absent b.tik"), 3);
  expect_refused(encoding("--align rigid --align-report no/seen frames b.tik"), 5, "no/seen");
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "seen")) << "nothing was written there";
  make(encoding("--align rigid --align-report seen/ frames b.tik"));
  EXPECT_EQ(file("seen/path.csv"), file("path.csv"));
  EXPECT_EQ(file("seen/plot.png"), file("plot.png"));
  EXPECT_FALSE(file("seen/coverage.png").empty());
  EXPECT_EQ(make(encoding("--align-along path.csv frames c.tik")).err.find("half of what has texture"),
            std::string::npos)
      << "it may be another clip's";
  EXPECT_EQ(file("a.tik"), file("b.tik"));
  for (const std::string name : {"a", "c"}) make("--start 0s --exposure 100ms " + name + ".tik " + name + ".pfm");
  EXPECT_EQ(file("a.pfm"), file("c.pfm"));
}

TEST_F(Aligning, AutoMovesByAsLittleAsExplainsThePictures) {
  EXPECT_EQ(answer(encoding("--align auto frames a.tik"))["camera"]["motion"], "rigid");
  make(encoding("--align rigid frames b.tik"));
  EXPECT_EQ(file("a.tik"), file("b.tik"));
  std::filesystem::create_directory(scratch_ / "tilted");
  for (int k = 0; k < kPictures; ++k) {
    const Shift tilt = hand(k);
    const cv::Matx33d warp(1, 0, 0, 0, 1, 0, 3e-5 * tilt.x, 3e-5 * tilt.y, 1);
    cv::Mat seen;
    cv::warpPerspective(drawn(tilt, k, true), seen, warp, {}, cv::INTER_CUBIC, cv::BORDER_REFLECT);
    cv::imwrite((scratch_ / format("tilted/{:02}.pgm", k)).string(), seen);
  }
  EXPECT_EQ(answer(encoding("--align auto tilted c.tik"))["camera"]["motion"], "homography");
  make(encoding("--align homography tilted d.tik"));
  EXPECT_EQ(file("c.tik"), file("d.tik"));
}

TEST_F(Aligning, KeepsThePictureAndSaysWhatWasSeenWhenAskedTo) {
  const json encoded =
      answer(encoding("--align translation --align-to 60ms --unseen hold --coverage seen.png frames a.tik"));
  EXPECT_EQ(encoded["width"], kWidth);
  EXPECT_EQ(encoded["camera"]["reference"], 6);
  const cv::Mat seen = picture("seen.png");
  ASSERT_EQ(seen.size(), cv::Size(kWidth, kHeight));
  EXPECT_EQ(seen.at<std::uint8_t>(kHeight / 2, kWidth / 2), 255);
  EXPECT_LT(seen.at<std::uint8_t>(0, 0), 255);
  // Every place was seen by the picture that others are moved onto, and shows that until it is seen again.
  const cv::Mat reference = drawn(hand(6), 6, true), is = shown("a.tik", 6);
  EXPECT_EQ(cv::norm(reference, is, cv::NORM_INF), 0);
  const auto corners = [](const cv::Mat& picture) {
    return std::pair(picture.at<std::uint8_t>(0, 0), picture.at<std::uint8_t>(kHeight - 1, kWidth - 1));
  };
  EXPECT_EQ(corners(shown("a.tik", 0)).second, corners(reference).second) << "not seen before";
  EXPECT_EQ(corners(shown("a.tik", 8)).first, corners(reference).first) << "not seen since";
}

TEST_F(Aligning, TellsWhatWasDoneToPicturesBefore) {
  write(
      "dimmed", [](int) { return Shift(); }, false);
  for (const char* name : {"dimmed/08.pgm", "dimmed/09.pgm"}) {
    const std::string file = (scratch_ / name).string();
    cv::imwrite(file, cv::imread(file, cv::IMREAD_UNCHANGED) * 0.7);
  }
  for (const char* unseen : {"crop", "hold"}) {
    const auto words = encoding({"--deflicker", "--align", "rigid", "--unseen", unseen, "dimmed", "a.tik"});
    expect_says(make(over(words)).err, "the exposure of 2 of 12 pictures was corrected");
  }
}

TEST_F(Aligning, IsToldByInfo) {
  make(encoding("--align rigid frames a.tik"));
  make(encoding("frames plain.tik"));
  expect_says(make("-v --start 0s --exposure 1f a.tik a.png --overwrite").out,
              {"\n  rounded codes bound ", "\n  interpolation no bound"});
  const json aligned = answer("info a.tik");
  EXPECT_EQ(aligned["alignment"]["motion"], "rigid");
  EXPECT_EQ(aligned["alignment"]["reference_sample"], 0);
  EXPECT_FALSE(aligned["alignment"]["holds_unseen"]);
  EXPECT_NEAR(aligned["alignment"]["moved_pixels"], 4.1, 0.3);
  expect_says(run("info a.tik").out, "  aligned     to picture 0 (rigid)");
  EXPECT_TRUE(answer("info plain.tik")["alignment"].is_null());
  // It stays when the capture is written again.
  make("retime -f 50 a.tik b.tik");
  EXPECT_EQ(answer("info b.tik")["alignment"], aligned["alignment"]);
}

TEST_F(Aligning, IsDoneToTheClipThatACaptureIsComparedWith) {
  make(encoding("--align rigid --align-to 2f --unseen hold frames a.tik"));
  make("validate --start 0f --exposure 2f --runs 1 --source frames a.tik");
  make(encoding("--align rigid --from 1f --to 4f frames part.tik"));
  make("validate --start 0f --exposure 2f --runs 1 --source frames part.tik");
}

TEST_F(Aligning, IsMissedWhereTheCameraMoved) {
  make(encoding("frames plain.tik"));
  make(encoding("--align rigid frames a.tik"));
  write("still", [](int) { return Shift(); });
  make(encoding("still still.tik"));
  const std::string told = "the camera moved by up to ";
  const auto says = [&](const Words& words) {
    const auto result = make(words.front() == "check" ? words : Words(over(words)));
    return (result.out + result.err).find(told) != std::string::npos;
  };
  EXPECT_EQ(answer("check plain.tik")["findings"][0]["kind"], "camera_moved");
  for (const char* capture : {"a.tik", "still.tik"}) {
    EXPECT_FALSE(says({"check", capture})) << capture;
    EXPECT_FALSE(says({"mask", "--moving", capture, "-o", "m.pgm"})) << capture;
    EXPECT_FALSE(says({"study", capture, "-o", "s.png"})) << capture;
  }
  EXPECT_TRUE(says({"mask", "--moving", "plain.tik", "-o", "m.pgm"}));
  EXPECT_TRUE(says({"background", "plain.tik", "p.png"}));
  EXPECT_FALSE(says({"background", "a.tik", "p.png"}));
  scratch_.write("all.fn", "M0{[0:all]}\n");
  EXPECT_TRUE(says({"solve", "-k", "all.fn", "--wish", "all = background", "plain.tik", "-o", "s.fn"}));
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"mask", "--rectangle", "1,1,9,9", "plain.tik", "-o", "m.pgm"},
        {"solve", "-k", "all.fn", "--wish", "all = 0.2", "plain.tik", "-o", "s.fn"}})
    EXPECT_FALSE(says(words)) << words[0] << ": the camera does not matter";
  // What cannot be compared may have moved further.
  write("lost", hand);
  for (const char* name : {"lost/04.pgm", "lost/05.pgm"}) {
    cv::Mat noise(kHeight, kWidth, CV_8U);
    cv::randu(noise, 0, 256);
    cv::imwrite((scratch_ / name).string(), noise);
  }
  make(encoding("lost lost.tik"));
  expect_says(run("check lost.tik").out, "degrees or more (at sample ");
  expect_says(run("check lost.tik").out, "2 of 9 pictures could not be compared");
  write("unlike", [](int picture) { return Shift{1000.0 * picture, 700.0 * picture}; });
  make(encoding("unlike unlike.tik"));
  expect_says(run("check unlike.tik").out, "whether the camera moved could not be told: 8 of 9 pictures");
  expect_says(run("check unlike").err, "whether the camera moved was not looked at");
  write("far", [](int picture) { return Shift{2 * hand(picture).x, 2 * hand(picture).y}; });
  // A clip is read again; a capture cannot be.
  EXPECT_FALSE(says({"study", "-f", "100", "far", "-o", "s2.png"}));
  expect_says(file("s2.txt"), " --align rigid ");
  EXPECT_FALSE(says({"study", "-f", "100", "--align", "rigid", "far", "-o", "s2.png"}));
  expect_says(file("s2.txt"), " --align rigid ");
  // Long enough that its first pictures tell: it is aligned at once.
  std::filesystem::create_directory(scratch_ / "long");
  for (int k = 0; k < 3 * kPictures; ++k)
    cv::imwrite((scratch_ / format("long/{:02}.pgm", k)).string(), drawn({2 * hand(k).x, 2 * hand(k).y}, k / 3, true));
  EXPECT_FALSE(says({"study", "-f", "100", "long", "-o", "s4.png"}));
  expect_says(file("s4.txt"), " --align rigid ");
  make("study -f 100 --align rigid long -o s5.png");
  for (const std::string extension : {".pgm", ".fn"}) EXPECT_EQ(file("s4" + extension), file("s5" + extension));
  make(encoding("far far.tik"));
  expect_refused(
      "study far.tik -o s3.png", 3,
      "A study needs pictures that lie on each other: encode the clip again. A camera that moved stands "
      "still with --align rigid");
}

TEST_F(Aligning, IsNotLookedForWithoutItsModule) {
  make(encoding("frames plain.tik"));
  std::filesystem::copy_file(NUTIK_TEST_PROGRAM, scratch_ / "alone");  // beside no modules
  const std::string alone = "env -u NUTIK_MODULES ./alone ";
  const std::string why = "no camera's motion can be found: nutik-motion.so was not found";
  expect_says(shell(alone + "check plain.tik").out, "plain.tik: warning: " + why);
  expect_says(shell(alone + "mask --moving plain.tik -o m.pgm", 3).err, why);
  EXPECT_FALSE(exists("m.pgm"));
  const auto called_so =
      shell("env -u NUTIK_MODULES bash -c 'exec -a ./alone \"" NUTIK_TEST_PROGRAM "\" check plain.tik'");
  EXPECT_EQ(called_so.out.find(why), std::string::npos) << "its modules are beside it, not beside ./alone";
}

TEST_F(Aligning, RefusesAModuleOfAnotherVersion) {
  make(encoding("frames plain.tik"));
  const std::string told = run("--version").out;
  const std::size_t begin = told.find_first_of("0123456789");
  const std::string version = told.substr(begin, told.find_last_of("0123456789") + 1 - begin);
  std::string module = read_file(std::filesystem::path(NUTIK_TEST_PROGRAM).parent_path() / "nutik-motion.so");
  std::string other = version;
  for (char& each : other) each = each == '.' ? '.' : '9';
  const std::string ended = version + '\0';
  std::size_t changed = 0;
  for (std::size_t at = module.find(ended); at != std::string::npos; at = module.find(ended, at + 1), ++changed)
    module.replace(at, version.size(), other);
  ASSERT_GE(changed, 1u);
  scratch_.write("nutik-motion.so", module);
  std::filesystem::copy_file(NUTIK_TEST_PROGRAM, scratch_ / "alone");
  const auto checked = run_shell("env -u NUTIK_MODULES ./alone check plain.tik", scratch_.folder());
  expect_says(checked.out, "nutik-motion.so: of version " + other + ", and this program is of " + version);
}

TEST_F(Aligning, IsPartOfARecipe) {
  make("-f 100 --align rigid --start 0f --exposure 12f frames -o mean.png");
  make("-f 100 --start 0f --exposure 12f frames -o blurred.png");
  const cv::Mat mean = cv::imread((scratch_ / "mean.png").string()),
                blurred = cv::imread((scratch_ / "blurred.png").string());
  EXPECT_LT(mean.cols, blurred.cols);
  expect_says(run("reproduce mean.png").out, " --align rigid ");
}

TEST_F(Aligning, SaysWhatDoesNotGoTogether) {
  expect_refused(
      2, {{encoding("--align affine frames a.tik"), "affine"},
          {encoding("--unseen hold frames a.tik"),
           "--unseen is said of pictures that are aligned: add --align rigid"},
          {encoding("--coverage c.png frames a.tik"), "--coverage is said of pictures"},
          {encoding("--align rigid --align-to 99f frames a.tik"),
           "picture 99 is outside the capture, which has 12"},
          {encoding("--align rigid --camera-path path.txt frames a.tik"), "tables are written as .csv"}});
  make(encoding("frames plain.tik"));
  expect_refused("--align rigid --start 0s --exposure 1f plain.tik -o p.png", 2,
                 "plain.tik was encoded already");
  make(encoding("--align rigid --camera-path path.csv frames a.tik"));
  expect_refused(encoding("--align rigid --align-along path.csv frames b.tik"), 2, "leave --align out");
  expect_refused(3, {{encoding("--align-along path.csv --crop 80x60+0+0 frames b.tik"),
                      "the camera's path is that of pictures of 160 x 120"},
                     {encoding("--align-along path.csv --to 3f frames b.tik"), "the camera's path"}});
}

TEST_F(Aligning, SaysWhichPictureCannotBeAlignedAndWhy) {
  write("cut", [](int picture) { return picture < 5 ? hand(picture) : Shift{3000, 5000}; });
  expect_refused(encoding("--align rigid cut a.tik"), 3,
                 "picture 5 cannot be aligned to picture 0: of what is seen in both ");
  const std::string others = "try another picture to align to";
  expect_refused(encoding("--align rigid cut a.tik"), 3, "try --align auto, another picture");
  expect_refused(encoding("--align homography cut a.tik"), 3, others);
  make(encoding("--align rigid --to 5f cut a.tik"));
  std::filesystem::create_directory(scratch_ / "blank");
  for (const char* name : {"blank/0.pgm", "blank/1.pgm"}) {
    cv::imwrite((scratch_ / name).string(), cv::Mat(kHeight, kWidth, CV_8U, 90));
  }
  expect_refused(
      encoding("--align rigid blank b.tik"), 3,
      "no picture can be aligned to picture 0: it has 0 pixels whose surroundings can be recognized");
  expect_refused(encoding("--align rigid blank b.tik"), 3, others);
  // A path by hand that leaves nothing.
  std::ofstream(scratch_ / "far.csv")
      << "# nutik camera path,translation,0,160,120\n"
         "picture,x,y,degrees,residual_pixels,agreeing,m0,m1,m2,m3,m4,m5,m6,m7,m8\n"
         "0,0,0,0,0,1,1,0,0,0,1,0,0,0,1\n1,0,0,0,0,1,1,0,200,0,1,0,0,0,1\n";
  expect_refused(
      3,
      {{encoding("--align-along far.csv --to 2f frames c.tik"),
        "no place was seen by all of its 2 pictures: in picture 1 the camera looks 200 pixels to the side"},
       {encoding("--align-along far.csv --to 2f frames c.tik"), "--unseen hold"}});
}

TEST_F(Aligning, SaysWhatMemoryItTakes) {
  expect_refused(encoding("--memory 1MB --align rigid frames a.tik"), 2, "a picture that is registered");
}

}  // namespace
}  // namespace nutik::test
