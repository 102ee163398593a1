// nutik-cl check as a user meets it: everything at once, places, figures, exit status.
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "support/app_test.hpp"
#include "support/ffmpeg.hpp"

namespace nutik::test {
namespace {

constexpr int kClipWidth = 120;
constexpr int kClipHeight = 80;

// A capture of 30 pictures of 120 × 80 pixels at 10 a second, 3 s, and a mask of three regions.
class Check : public AppTest {
 protected:
  void SetUp() override {
    write_frames(30, [](int k) { return cv::Mat(kClipHeight, kClipWidth, CV_8UC1, cv::Scalar::all(8 * k)); });
    make("-f 10 frames clip.tik");
    mask_ = cv::Mat::zeros(kClipHeight, kClipWidth, CV_8UC1);
    cv::rectangle(mask_, {10, 10}, {39, 59}, cv::Scalar::all(128), cv::FILLED);
    cv::circle(mask_, {80, 40}, 25, cv::Scalar::all(255), cv::FILLED);
    save_mask();
    scratch_.write("good.fn",
                   "M0 [0:1], [1000000000:1], [1000000001:0]\n"
                   "M128 [399999999:0], [400000000:1], [410000000:1], [410000001:0]\n"
                   "M255 [999999999:0], [1000000000:0.5], [1200000000:0.5], [1200000001:0]\n");
  }

  [[nodiscard]] double still_gain(const Words& inputs) const {
    return answer("check" + inputs).at("functions").at(0).at("still_gain");
  }
  void save_mask() const { cv::imwrite((scratch_ / "mask.pgm").string(), mask_); }
  json findings(const Words& inputs, int status) const {
    const ProgramResult result = make("check --json" + inputs, status);
    EXPECT_EQ(result.err, "");
    return json::parse(result.out).at("findings");
  }
  // The kinds of what was found, in order.
  std::vector<std::string> kinds(const Words& inputs, int status) const {
    std::vector<std::string> kinds;
    for (const json& finding : findings(inputs, status)) kinds.push_back(finding.at("kind"));
    return kinds;
  }

  using Kinds = std::vector<std::string>;
  const Words all_ = "-m mask.pgm -k good.fn clip.tik";
  cv::Mat mask_;
};

TEST_F(Check, PrintsControlPointsAlone) {
  scratch_.write("two.fn", "M7 [-5:0.1], [10:1e-300]\nM0 [0:1]\n");
  EXPECT_EQ(run("check --points -k two.fn").out, "mask_value,time_ns,gain\n0,0,1\n7,-5,0.1\n7,10,1e-300\n");
  scratch_.write("warned.fn", "m1 [0:1]\nM0 [0:1]\n");
  const ProgramResult warned = make("check --points -k warned.fn");
  EXPECT_EQ(warned.out, "mask_value,time_ns,gain\n0,0,1\n");
  expect_says(warned.err, "warned.fn:1:1: warning: taken as a comment: a function starts with a capital M\n    m1");
  scratch_.write("bad.fn", "M0 [0:1],\n");
  expect_refused("check --points -k bad.fn", 3, "bad.fn has mistakes:\nbad.fn:1:9: a comma with no control point");
  expect_refused(2, {{"check --points", "--points prints those of a function file; add -k functions.fn"},
                     {"check --points --json -k two.fn", "--points prints nothing else"}});
}

// Figures are those of the exposure that is meant.
TEST_F(Check, TellsTheFiguresOfNormalizedFunctions) {
  scratch_.write("ramp.fn", "M0 [0:0], [1000000000:1], [1000000001:0]\n");
  EXPECT_NEAR(still_gain("-k ramp.fn clip.tik"), 0.5, 1e-6);
  EXPECT_NEAR(still_gain("-k ramp.fn --normalize integral clip.tik"), 1.0, 1e-6);
  EXPECT_NEAR(still_gain("-k ramp.fn --normalize seconds:1e-1 --ev 1 clip.tik"), 10.0, 1e-4);
  EXPECT_EQ(kinds("-k ramp.fn --normalize seconds:1e-1 clip.tik", 0),
            std::vector<std::string>{"still_gain_saturates"});
  scratch_.write("cancels.fn", "M0 [0:1], [100000000:1], [100000001:-1], [200000000:-1], [200000001:0]\n");
  const json found = findings("-k cancels.fn --normalize integral clip.tik", 3);
  EXPECT_EQ(found.at(0).at("kind"), "not_normalizable");
  EXPECT_EQ(found.at(0).at("line"), 1);
  EXPECT_EQ(found.at(0).at("message").get<std::string>().substr(0, 33), "M0: the positive and negative par");
}

// Steps of 1 ns stand for jumps: a picture that ends with the capture is one picture, and nothing is lost of it.
TEST_F(Check, CountsNoStepAsASample) {
  scratch_.write("last.fn", "M0 [2899999999:0], [2900000000:1], [3000000000:1], [3000000001:0]\n");
  EXPECT_TRUE(findings("-k last.fn clip.tik", 0).empty());
  EXPECT_EQ(answer("check -k last.fn clip.tik").at("functions").at(0).at("samples"), 1);
  const ProgramResult exposed = run("-k last.fn clip.tik p.png");
  expect_says(exposed.out, "1 of 30 samples");
  EXPECT_EQ(exposed.err, "");
}

TEST_F(Check, SaysWhatFunctionsComeTo) {
  const ProgramResult result = make("check -m mask.pgm -k good.fn clip.tik");
  EXPECT_EQ(result.err, "");
  expect_says(result.out,
              "good.fn: 3 functions; mask.pgm: 120 x 80; clip.tik: 120 x 80 grey, 30 samples, 3 s\n");
  expect_says(result.out, "M128        1500  400 ms … 410 ms   10 ms   10 ms           1      0        1\n");
  expect_says(result.out, "\nnothing wrong\n");

  const json figures = answer("check -m mask.pgm -k good.fn clip.tik").at("functions").at(2);
  EXPECT_EQ(figures.at("mask_value"), 255);
  EXPECT_EQ(figures.at("pixels"), cv::countNonZero(mask_ == 255));
  EXPECT_EQ(figures.at("live_start_ns"), 999'999'999);
  EXPECT_EQ(figures.at("live_end_ns"), 1'200'000'001);
  EXPECT_EQ(figures.at("nonzero_ns"), 200'000'002);
  EXPECT_DOUBLE_EQ(figures.at("integral_ns"), 100'000'000.5);
  EXPECT_NEAR(figures.at("still_gain"), 0.5, 1e-8);
  EXPECT_NEAR(figures.at("stops"), -1.0, 1e-7);
  const ProgramResult scaled = run("check --json --normalize seconds:1 -m mask.pgm -k good.fn clip.tik");
  EXPECT_EQ(json::parse(scaled.out).at("functions").at(2).at("integral_ns"), figures.at("integral_ns"));
  EXPECT_EQ(figures.at("samples"), 2);  // 1 s … 1.2 s are two tenths; the steps beside them count as none
}

TEST_F(Check, SaysEverythingThatIsWrongAtOnce) {
  scratch_.write(
      "bad.fn",
      "M0 [5:1], [5:0]\nM1{[0:0], [1:1], [100000000:1], [1000000002:-25], [1010000001:0]}\nM300 [0:1]\n");
  cv::imwrite((scratch_ / "small.pgm").string(),
              cv::Mat(kClipWidth / 2, kClipHeight / 2, CV_8UC1, cv::Scalar::all(7)));
  std::string capture = file("clip.tik");
  // In the first picture.
  capture[capture.size() / 2] ^= 0x55;
  scratch_.write("damaged.tik", capture);
  const ProgramResult result = make("check -m small.pgm -k bad.fn damaged.tik", 3);
  expect_says(
      result.out,
      {"bad.fn:1:12: time 5 stands twice", "\n    M0 [5:1], [5:0]\n               ^\n", "bad.fn:3:2: mask value 300",
       "bad.fn:2:19: warning: M1: time 100000000 probably has lost a digit: it is likely 1000000000",
       "bad.fn:2:1: warning: M1: no pixel of small.pgm has the value 1",
       "small.pgm: mask values without a function: 7 (2400 pixels)", "damaged.tik: "});
}

TEST_F(Check, ADamagedBlockIsNamedAndTheRestIsChecked) {
  std::string capture = file("clip.tik");
  // The one block lies somewhere behind the first picture; other damage there is named otherwise.
  bool is_found = false;
  for (std::size_t offset = kClipWidth * kClipHeight; offset < capture.size() && !is_found; offset += 16) {
    std::string damaged = capture;
    damaged[offset] = static_cast<char>(damaged[offset] ^ 0x55);
    scratch_.write("damaged.tik", damaged);
    const ProgramResult result = run("check --json -m mask.pgm -k good.fn damaged.tik");
    if (result.status != 3) continue;
    const json found = json::parse(result.out);
    if (found.at("findings").at(0).at("kind") != "capture_block") continue;
    is_found = true;
    expect_says(found.at("findings").at(0).at("message").get<std::string>(), "the block of samples 0 to 29");
    EXPECT_EQ(found.at("functions").at(0).at("samples"), 10);
  }
  EXPECT_TRUE(is_found);
}

TEST_F(Check, ReadsTheClipsPictures) {
  NEEDS_FFMPEG();
  std::string raw;
  for (int k = 0; k < 10; ++k)
    raw += std::string(2048, static_cast<char>(k % 2 == 0 ? 180 : 254)) + std::string(4096, '\x80');
  scratch_.write("raw", raw);
  test::make(scratch_, from_raw({64, 32, 1}, "yuv444p") + "-c:v ffv1 -color_range tv bright.mkv");
  expect_says(make("check bright.mkv").out,
              {"bright.mkv: warning: light above the limited range's white was cut off in up to 100 % of a picture",
               "-c:v ffv1 darker.mkv keeps it, at half of all light\n1 warning\n"});
  expect_says(make("check --range full bright.mkv").out, "\nnothing wrong\n");
  EXPECT_EQ(answer("check bright.mkv").at("findings").at(0).at("kind"), "clip_picture");
  // It is said of pictures that are made of the clip, too; of codes that were cut off, not of the exposure's.
  for (const char* words : {"expose -q --start 0f --exposure 2f bright.mkv bright.png", "encode -q bright.mkv b.tik"})
    expect_says(make(words).err, "warning: light above the limited range's white was cut off");
  // What comes before a cut counts, and the cut itself.
  const std::string whole = file("bright.mkv");
  scratch_.write("cut.mkv", whole.substr(0, whole.size() - 200));
  expect_says(make("check cut.mkv").out,
              {"cut.mkv: warning: the file says that it lasts 0.4 s, and its pictures end after ",
               "cut.mkv: warning: light above", "\n2 warnings\n"});
}

TEST_F(Check, EachInputIsOptional) {
  EXPECT_EQ(kinds("-k good.fn", 0), Kinds{});
  EXPECT_EQ(kinds("-m mask.pgm", 0), Kinds{});
  EXPECT_EQ(kinds("clip.tik", 0), Kinds{});
  EXPECT_EQ(kinds("-k good.fn -f 10 frames", 0), Kinds{});
  const ProgramResult alone = run("check -k good.fn");
  expect_says(alone.out, "good.fn: 3 functions; figures are for 0 … 1.2 s, not for a capture\n");
  EXPECT_EQ(alone.out.find("pixels"), std::string::npos);
  EXPECT_EQ(alone.out.find("samples"), std::string::npos);
  expect_refused("check", 2, "what should be checked?");
  EXPECT_EQ(run("check -q -k good.fn").out, "");
}

TEST_F(Check, WhatCannotBeReadIsOneFindingAmongOthers) {
  EXPECT_EQ(kinds("-m absent.pgm -k absent.fn absent.tik", 3),
            (Kinds{"function_file", "mask_file", "capture"}));
  expect_says(make("check -m good.fn clip.tik", 3).out, "good.fn: is neither a PGM nor a PNG");
  scratch_.write("deep.pgm", "P2 2 1 4095\n0 4095\n");
  expect_says(run("check -m deep.pgm").out, "16 bits");
}

TEST_F(Check, AFunctionThatNoPixelUses) {
  EXPECT_EQ(kinds(all_, 0), Kinds{});
  mask_.setTo(0, mask_ == 128);
  save_mask();
  const json found = findings(all_, 0);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].at("kind"), "unused_function");
  EXPECT_EQ(found[0].at("mask_value"), 128);
  EXPECT_EQ(found[0].at("line"), 2);
}

TEST_F(Check, MaskValuesWithoutAFunction) {
  mask_.setTo(9, mask_ == 128);
  save_mask();
  EXPECT_EQ(kinds(all_, 3), (Kinds{"unused_function", "unmapped_mask_values"}));
  EXPECT_EQ(kinds(all_ + "--unmapped zero", 0), Kinds{"unused_function"});
  // A function with a mistake is there all the same.
  scratch_.write("broken.fn", file("good.fn") + "M9 [0:x]\n");
  EXPECT_EQ(kinds("-m mask.pgm -k broken.fn clip.tik", 3), (Kinds{"function_file", "unused_function"}));
}

TEST_F(Check, MasksOfOtherSizes) {
  const auto message = [&](const cv::Mat& mask) {
    cv::imwrite((scratch_ / "other.pgm").string(), mask);
    const json found = findings("-m other.pgm -k good.fn clip.tik", 3);
    EXPECT_EQ(found.at(0).at("kind"), "mask_size");
    return found.at(0).at("message").get<std::string>();
  };
  cv::Mat turned, scaled;
  cv::transpose(mask_, turned);
  cv::resize(mask_, scaled, {}, 2, 2, cv::INTER_NEAREST);
  expect_says(message(turned), "80 x 120 pixels, the capture 120 x 80; turn it by 90 degrees");
  expect_says(message(scaled), "; scale it to 120 x 80 without smoothing");
  expect_says(message(mask_.colRange(0, 100)),
              "; both must have the same size; draw on a picture of the same part (--crop)");
}

TEST_F(Check, SpecksOfTheBrush) {
  mask_.at<std::uint8_t>(5, 60) = 128;
  mask_.at<std::uint8_t>(5, 61) = 128;
  save_mask();
  const json found = findings(all_, 0);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].at("kind"), "mask_specks");
  EXPECT_EQ(found[0].at("mask_value"), 128);
  EXPECT_EQ(found[0].at("specks"), json::parse(R"([{"x": 60, "y": 5, "pixels": 2}])"));
  expect_says(found[0].at("message").get<std::string>(), "at 60,5 (2 pixels)");
}

TEST_F(Check, MasksThatWereSmoothedOrKeptAsJpeg) {
  const auto blended = [&](const cv::Mat& mask) {
    cv::imwrite((scratch_ / "mask.pgm").string(), mask);
    std::size_t count = 0;
    for (const json& finding : findings(all_, 3)) {
      if (finding.at("kind") == "blended_mask_values") count += finding.at("values").size();
    }
    return count;
  };
  cv::Mat smooth;
  cv::GaussianBlur(mask_, smooth, {3, 3}, 0.6);
  EXPECT_GT(blended(smooth), 5u);
  for (const int quality : {95, 85}) {
    std::vector<std::uint8_t> bytes;
    cv::imencode(".jpg", mask_, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
    const cv::Mat damaged = cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
    std::vector<bool> is_new(256);
    for (int i = 0; i < kClipWidth * kClipHeight; ++i) is_new[damaged.data[i]] = true;
    const auto values = std::count(is_new.begin(), is_new.end(), true) - 3;
    ASSERT_GT(values, 10);
    // Some of what JPEG leaves lies in flat patches, where nothing tells it from paint but that it has no
    // function.
    EXPECT_GT(blended(damaged), static_cast<std::size_t>(values) / 2) << values << " at quality " << quality;
  }
}

TEST_F(Check, TheFiguresOfThePaper) {
  const auto figure = [&](const std::string& name) {
    scratch_.write(name + ".fn", read_file(std::filesystem::path(NUTIK_TEST_CORPUS) / (name + ".fn")));
    return kinds({"-k", name + ".fn", "clip.tik"}, 0);
  };
  EXPECT_EQ(figure("figure04"), Kinds{});
  EXPECT_EQ(figure("figure07"), Kinds{});
  EXPECT_EQ(figure("figure14-restored"), Kinds{});
  EXPECT_EQ(figure("figure16"), Kinds{});
  EXPECT_EQ(figure("figure14"), (Kinds{"still_gain_not_positive", "mistyped_time"}));
}

TEST_F(Check, ManyFindingsOfOneKindAreCounted) {
  std::string text;
  for (int tag = 0; tag < 30; ++tag) text += "M" + std::to_string(tag) + " [0:1], [5:0], [6:1]\n";
  scratch_.write("many.fn", text);
  const ProgramResult result = run("check -k many.fn");
  expect_says(result.out,
              {"many.fn: and 10 more like these (held_gain); --json lists all", "\n30 warnings\n"});
  EXPECT_EQ(kinds("-k many.fn", 0).size(), 30u);
}

TEST_F(Check, ReadsAllPicturesOfAClip) {
  const auto message = [&](const Words& clip) {
    const json found = findings("-f 10" + clip, 3);
    EXPECT_EQ(found.size(), 1u);
    EXPECT_EQ(found.at(0).at("kind"), "clip_picture");
    return found.at(0).at("message").get<std::string>();
  };
  const std::string name = "frames/112.pgm", whole = file(name);
  scratch_.write(name, whole.substr(0, whole.size() / 2));
  expect_says(message("frames"), "a folder or table without it keeps the others, and the 12 pictures before it");
  expect_says(make("check -f 10 frames", 3).out, "\n1 mistake\n");
  EXPECT_EQ(kinds("-f 10 --ignore-errors frames", 0), Kinds{"clip_end"});
  cv::imwrite((scratch_ / name).string(), cv::Mat(kClipWidth, kClipHeight, CV_8UC1, cv::Scalar::all(9)));
  expect_says(message("frames"), "112.pgm is 80 x 120 grey of 8 bits, white code 255; the first still");
  scratch_.write(name, whole);
  EXPECT_EQ(kinds("-f 10 frames", 0), Kinds{});
}

// An edit list of no length, as where an editor cut all away.
TEST_F(Check, AClipThatShowsNoPictureIsAMistake) {
  NEEDS_FFMPEG();
  test::make(scratch_, "-f lavfi -i testsrc2=s=64x48:r=25:d=0.2 -c:v mpeg4 -bf 0 none.mp4");
  std::string film = file("none.mp4");
  const auto edits = film.find("elst");
  ASSERT_NE(edits, film.npos);
  film.replace(edits + 12, 4, 4, '\0');
  scratch_.write("none.mp4", film);
  expect_says(make("check none.mp4", 3).out, "shows no picture; if its edit list leaves them all out, ffmpeg -ignore");
}

TEST_F(Check, RefusesWhatMakesNoSense) {
  expect_refused(2, {{"check clip.tik clip.tik", "is one file too many"},
                     {"check -k good.fn --unmapped black", "the only choice is --unmapped zero"},
                     {"check -k good.fn -o x.txt", "-o does not go with check"},
                     {"check -f 10 clip.tik", "--fps describes a clip"}});
}

}  // namespace
}  // namespace nutik::test
