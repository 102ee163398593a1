// Contact sheets, activity and sweeps as a user makes them.
#include <gtest/gtest.h>

#include <regex>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <thread>

#include "capture/format.hpp"
#include "support/ffmpeg.hpp"
#include "support/moving_square_test.hpp"

namespace nutik::test {
namespace {

class Moment : public MovingSquareTest {
 protected:
  // Pixels that differ between two neighbouring pictures by more than `ignored` codes.
  [[nodiscard]] int changed_pixels(std::size_t sample, int ignored) const {
    int count = 0;
    for (std::size_t i = 0; i < scene_.pictures[sample].size(); ++i) {
      count += std::abs(scene_.pictures[sample][i] - scene_.pictures[sample - 1][i]) > ignored ? 1 : 0;
    }
    return count;
  }
};

TEST_F(Moment, ContactSheetShowsEveryPictureOfAShortCapture) {
  const auto json = answer("contact clip.tik");
  EXPECT_EQ(json["sheet"], "clip-contact.png");
  ASSERT_EQ(json["exposures"].size(), 20u);
  for (const char* key : {"saturated_above_pixels", "precision", "renderer", "seconds"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["exposures"][3], nlohmann::json::parse(R"({"start_ns":30000000,"end_ns":40000000})"));
  // A picture of 96 pixels keeps its size, one picture's exposure its codes: the first lies at (12, 38).
  const cv::Mat sheet = picture("clip-contact.png");
  ASSERT_EQ(sheet.channels(), 3);
  const auto columns = json["columns"].get<int>();
  for (int k = 0; k < 20; ++k) {
    const int left = 12 + k % columns * (96 + 8), top = 38 + k / columns * (48 + 20 + 8);
    for (int y = 0; y < 48; ++y) {
      for (int x = 0; x < 96; ++x) {
        ASSERT_EQ(sheet.at<cv::Vec3b>(top + y, left + x)[1],
                  scene_.pictures[std::size_t(k)][std::size_t(y * 96 + x)])
            << "picture " << k << " at " << x << ", " << y;
      }
    }
  }
}

TEST_F(Moment, ContactSheetTakesTimesOfAnyKind) {
  EXPECT_EQ(answer("contact --every 0.04s --exposure 10ms clip.tik")["exposures"],
            answer("contact --every 4f clip.tik")["exposures"]);
  const auto thirds = answer("contact --every 1/30s --exposure 1ms --start 50ms clip.tik");
  ASSERT_EQ(thirds["exposures"].size(), 5u);
  EXPECT_EQ(thirds["exposures"][1]["start_ns"], 83'333'333);
  EXPECT_EQ(thirds["exposures"][4]["end_ns"], 184'333'333);
  // The last is cut at the capture's end.
  EXPECT_EQ(answer("contact --every 0.15s --exposure 1s clip.tik")["exposures"][1]["end_ns"], 200'000'000);
  EXPECT_EQ(run("contact --every 50ms --exposure 51ms clip.tik").err,
            "warning: 150 ms   15f: the exposure: parts that are not zero lie after the capture's end at "
            "0.2 s and do not count\n");
  EXPECT_EQ(run("contact --every 50ms --exposure 50ms clip.tik").err, "");
  const ProgramResult pictures = run("contact --every 5f --exposure 7f clip.tik");
  EXPECT_TRUE(pictures.err.starts_with("warning: 150 ms   15f: the exposure: parts")) << pictures.err;
  EXPECT_EQ(answer("contact --every 5f --exposure 7f clip.tik")["exposures"],
            answer("contact --every 5f --exposure 70ms clip.tik")["exposures"]);
  const auto later = answer("contact --start 10f --every 5f --columns 1 clip.tik x.ppm");
  EXPECT_EQ(later["exposures"].size(), 2u);
  EXPECT_EQ(later["rows"], 2);
  EXPECT_EQ(picture("x.ppm").rows, 2 * 12 + 26 + 2 * (48 + 20) + 8);
}

TEST_F(Moment, ContactSheetRefusesWhatMakesNoSense) {
  expect_refused(2, {{"contact", "an input is missing"},
                     {"contact --every 1us clip.tik",
                      "makes 200000 pictures and a sheet holds 400; take --every 500us or more"},
                     {"contact --every 0s clip.tik", "--every '0s' is not longer than nothing"},
                     {"contact --every 1.5f clip.tik", "is not a whole number of pictures"},
                     {"contact --exposure 1.5f clip.tik", "is not a whole number of pictures"},
                     {"contact --exposure 30.5f clip.tik", "is not a whole number of pictures"},
                     {"contact --every often clip.tik", "--every 'often' is no time"},
                     {"contact --start 3s clip.tik", "outside the capture, which lasts 200 ms"},
                     {"contact --columns 0 clip.tik", "--columns '0' is no whole number"},
                     {"contact --columns 20 --width 300 clip.tik",
                      "choose fewer columns or a larger width (--columns, --width)"},
                     {"contact clip.tik sheet.pgm", "sheet.pgm holds grey pictures only"},
                     {"contact clip.tik sheet.pfm", "sheet.pfm holds floating point only"},
                     {"contact clip.tik clip.tik", "is also an input"},
                     {"contact -f 100 clip.tik", "--fps describes a clip"}});
}

TEST_F(Moment, ActivityCountsChangesAtEachSample) {
  for (const int ignored : {0, 8}) {
    const ProgramResult result =
        make({"activity", "--csv", "-", "--by", std::to_string(ignored), "clip.tik"});
    std::istringstream lines(result.out);
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line, "sample,start_ns,end_ns,changed_pixels,changed_share,redrawn");
    for (std::size_t k = 0; k < 20; ++k) {
      const int changes = k == 0 ? 0 : changed_pixels(k, ignored);
      // Two columns in front of the square, two behind it.
      if (ignored > 0) {
        EXPECT_EQ(changes, k > 0 && k <= 12 ? 32 : 0);
      }
      std::getline(lines, line);
      const std::string start = std::to_string(k) + "," + std::to_string(k * 10'000'000) + "," +
                                std::to_string((k + 1) * 10'000'000) + "," + std::to_string(changes) + ",";
      ASSERT_TRUE(line.starts_with(start)) << line;
      EXPECT_NEAR(std::stod(line.substr(start.size())), changes / 4608.0, 1e-9);
    }
    EXPECT_FALSE(std::getline(lines, line)) << line;
  }
}

// A square that moves over a still scene of much detail: at its key frames H.264 draws all of it anew.
TEST_F(Moment, ActivityIsThatOfTheSceneNotOfTheCodec) {
  NEEDS_FFMPEG();
  test::make(scratch_,
             "-f lavfi -i mandelbrot=s=320x180:r=60,trim=end_frame=1,loop=59:1:0,noise=alls=4:allf=t "
             "-f lavfi -i color=red:s=32x32:r=60 -filter_complex "
             "'[0][1]overlay=x=10+n*4:y=70:shortest=1,format=yuv420p' -frames:v 60 -c:v libx264 -threads 1 -g 12 "
             "-bf 0 -crf 26 key.mp4");
  const auto scene = answer("activity key.mp4"), all = answer("activity --count-redrawn key.mp4");
  for (std::size_t k = 1; k < 60; ++k) {
    const double share = scene["samples"][k]["changed_share"];
    EXPECT_EQ(scene["samples"][k]["redrawn"], k % 12 == 0) << k;
    EXPECT_EQ(all["samples"][k]["redrawn"], false) << k;
    if (k % 12 != 0) {
      EXPECT_EQ(share, all["samples"][k]["changed_share"]) << k;
      continue;
    }
    EXPECT_GT(all["samples"][k]["changed_share"], 0.9) << k;
    const double beside = (all["samples"][k - 1]["changed_share"].get<double>() +
                           all["samples"][k + 1]["changed_share"].get<double>()) /
                          2;
    EXPECT_NEAR(share, beside, 1.0 / (320 * 180)) << k;
  }
  const std::string said = run("activity key.mp4").err;
  expect_says(said, "at 4 samples (12f … 48f) the whole picture changed a little at once");
}

// A camera that closes its aperture a little, while a square moves on.
TEST_F(Moment, ActivityTakesAStepOfTheExposureForNoMotion) {
  std::filesystem::create_directory(scratch_ / "steps");
  for (int k = 0; k < 12; ++k) {
    cv::Mat frame(48, 96, CV_8UC1, cv::Scalar::all(k < 7 ? 120 : 112));
    frame(cv::Rect(4 + 6 * k, 20, 8, 8)) = 250;
    cv::imwrite((scratch_ / ("steps/" + std::to_string(10 + k) + ".png")).string(), frame);
  }
  const auto json = answer("activity -f 100 steps");
  for (std::size_t k = 1; k < 12; ++k) {
    EXPECT_EQ(json["samples"][k]["redrawn"], k == 7) << k;
    EXPECT_EQ(json["samples"][k]["changed_pixels"], 2 * 6 * 8) << k;
  }
  expect_says(run("activity -f 100 steps").err,
              "as with a codec's key frame or a camera's new exposure");
  const std::string help = std::regex_replace(run("activity --help=all").out, std::regex("\\s+"), " ");
  expect_says(help, "or the camera changed");
}

TEST_F(Moment, ActivityCountsEachTagForItself) {
  make("mask --grid 4x2 clip.tik grid.pgm");
  const ProgramResult lines = make("activity --by 8 -m grid.pgm --tag all --moment quietest clip.tik");
  const auto json = answer("activity --by 8 -m grid.pgm --tag all clip.tik");
  ASSERT_EQ(json["tags"].size(), 8u);
  EXPECT_EQ(json["counted_pixels"], 96 * 48) << "all of them, as without a mask";
  std::string expected;
  bool differs = false;
  for (int tag = 0; tag < 8; ++tag) {
    const std::string name = std::to_string(tag);
    // What one tag alone has.
    const auto alone = answer({"activity", "--by", "8", "-m", "grid.pgm", "--tag", name, "clip.tik"});
    const auto& each = json["tags"][static_cast<std::size_t>(tag)];
    EXPECT_EQ(each["tag"], tag);
    EXPECT_EQ(each["counted_pixels"], 24 * 24);
    EXPECT_EQ(each.contains("quietest"), alone.contains("quietest")) << tag;
    if (each.contains("quietest")) {
      EXPECT_EQ(each["quietest"], alone["quietest"]) << tag;
      EXPECT_EQ(each["busiest"], alone["busiest"]) << tag;
      differs |= each["quietest"] != json["quietest"];
    }
    expected +=
        "--tag " + name + " " +
        run({"activity", "--by", "8", "-m", "grid.pgm", "--tag", name, "--moment", "quietest", "clip.tik"})
            .out;
  }
  EXPECT_EQ(lines.out, expected);
  EXPECT_TRUE(differs) << "the square is not everywhere at once";
  expect_says(make("activity --by 8 -m grid.pgm --tag all --moment busiest clip.tik", 3).err,
              "clip.tik has no busiest moment where the mask is ");  // a tag in which nothing moves
  const std::string text = run("activity --by 8 -m grid.pgm --tag all clip.tik").out;
  expect_says(text, "  M7: 576 pixels, quietest ");
}

TEST_F(Moment, ActivityCountsTheMemoryOfEachTag) {
  std::string mask = "P5 96 48 255\n";
  for (int pixel = 0; pixel < 96 * 48; ++pixel) mask += static_cast<char>(pixel % 256);
  scratch_.write("all-values.pgm", mask);
  const auto with_tag = [&](const char* tag) {
    return run({"activity", "-m", "all-values.pgm", "--tag", tag, "--memory", "220kB", "clip.tik"});
  };
  EXPECT_EQ(with_tag("3").status, 0) << with_tag("3").err;
  const ProgramResult refused = with_tag("all");
  EXPECT_EQ(refused.status, 2);
  // Counts of 20 samples for all pixels and for each tag, twice, and once for each thread.
  const double threads = std::max(1U, std::thread::hardware_concurrency());
  expect_says(refused.err, format("changes of samples {:.3g} MB", (2 * 20 + threads * 20) * (3 + 256) * 8 * 1e-6));
}

TEST_F(Moment, ActivitySaysWhereItIsQuiet) {
  const auto json = answer("activity --by 8 clip.tik");
  EXPECT_EQ(json["busiest"]["first_sample"], 1);
  EXPECT_EQ(json["quietest"]["first_sample"], 13);
  EXPECT_EQ(json["quietest"]["mean_changed_share"], 0.0);
  EXPECT_EQ(json["samples"].size(), 20u);
  EXPECT_EQ(json["samples"][5]["changed_pixels"], 32);
  const ProgramResult text = run("activity --by 8 clip.tik");
  expect_says(text.out, {"quietest      130 ms to 140 ms (13f to 13f), 0 % of pixels",
                         "try: nutik-cl --start 13f --exposure 1f clip.tik quiet.png"});
  std::filesystem::copy(scratch_ / "clip.tik", scratch_ / "my clip.tik");
  const std::string spaced = run({"activity", "my clip.tik"}).out;
  expect_says(spaced, "try: nutik-cl --start 13f --exposure 1f 'my clip.tik' quiet.png");
  EXPECT_EQ(text.err, "");
  expect_says(run("activity clip.tik").err, "--by CODES counts larger changes only");
  expect_says(run("activity --by 200 clip.tik").out, "nothing changes");
}

TEST_F(Moment, ActivityNamesAMomentForAnotherCommand) {
  const auto moment = [&](std::string_view wanted, std::string_view by) {
    return run({"activity", "--by", std::string(by), "--moment", std::string(wanted), "clip.tik"}).out;
  };
  EXPECT_EQ(moment("quietest", "8"), "--start 13f --exposure 1f\n");
  EXPECT_EQ(moment("busiest", "8"), "--start 1f --exposure 1f\n");
  EXPECT_EQ(moment("quietest", "200"), "--start 0f --exposure 20f\n");  // nothing changes by that much
  expect_refused("activity --by 200 --moment busiest clip.tik", 3, "nothing changes");
  expect_refused(2, {{"activity --moment calmest clip.tik", "neither quietest nor busiest"},
                     {"activity --moment busiest --json clip.tik", "prints nothing else"}});
}

TEST_F(Moment, ActivityOfARegion) {
  make("mask --tag 7 --rectangle 0,20,20,8 --tag 9 --rectangle 40,0,10,10 clip.tik mask.pgm");
  const auto region = answer("activity --by 8 -m mask.pgm --tag 7 clip.tik");
  EXPECT_EQ(region["counted_pixels"], 160);
  EXPECT_EQ(region["samples"][1]["changed_pixels"], 32);  // from 4 to 14
  EXPECT_EQ(region["samples"][8]["changed_pixels"], 16);  // only its tail, from 18 to 20
  EXPECT_EQ(region["samples"][11]["changed_pixels"], 0);
  EXPECT_EQ(answer("activity -m mask.pgm clip.tik")["counted_pixels"], 260);  // every tag but 0
  expect_refused("activity -m mask.pgm --tag 8 clip.tik", 3, "mask.pgm has no pixel with tag 8");
  expect_refused("activity --tag 8 clip.tik", 2, "add -m mask.pgm");
  make("mask --size 30x20 --tag 7 --rectangle 0,0,5,5 -o small.pgm");
  expect_refused("activity -m small.pgm clip.tik", 3, "small.pgm: the mask is 30 x 20 pixels, the capture");
  expect_refused("activity -m small.pgm clip.tik", 3, "draw on a picture of the same part (--crop)");
}

TEST_F(Moment, ActivityWritesTableChartAndMap) {
  make("activity --csv a.csv --map map.png clip.tik chart.png");
  EXPECT_EQ(file("a.csv"), run("activity --csv - clip.tik").out);
  EXPECT_EQ(picture("chart.png").cols, 1200);
  make("info --activity same.png clip.tik");
  EXPECT_EQ(file("map.png"), file("same.png"));
  make("activity --csv a.csv --overwrite clip.tik");  // its own kind
  scratch_.write("notes.csv", "my notes");
  expect_refused(2, {{"activity --csv notes.csv clip.tik", "notes.csv exists and is no table"},
                     {"activity --csv a.txt clip.tik", "tables are written as .csv"},
                     {"activity --csv - --json clip.tik", "both go to standard output"},
                     {"activity --map x.png clip.tik x.png", "is also an input"},
                     {"activity --by few clip.tik", "--by 'few' is no whole number"}});
}

TEST_F(Moment, SweepExposesEachShift) {
  const auto json =
      answer("sweep --start 0s --exposure 10ms --shift 0..50ms/10ms --each s%d.png --no-recipe clip.tik");
  ASSERT_EQ(json["pictures"].size(), 6u);
  EXPECT_EQ(json["pictures"][3], nlohmann::json::parse(R"({"shift_ns":30000000,"file":"s3.png"})"));
  for (const int k : {0, 3, 5}) {
    make("--exposure 10ms --no-recipe --overwrite clip.tik alone.png --start " + std::to_string(10 * k) + "ms");
    EXPECT_EQ(file("s" + std::to_string(k) + ".png"), file("alone.png")) << k;
  }
  EXPECT_EQ(json["sheet"], "clip-0s-10ms-sweep.png");
  EXPECT_FALSE(picture("clip-0s-10ms-sweep.png").empty());
  const auto pictures =
      answer("sweep --start 9f --exposure 1f --shift -5f..5f/5f --each p%d.png --no-recipe clip.tik");
  EXPECT_EQ(pictures["pictures"][0]["shift_samples"], -5);
  make("--start 4f --exposure 1f --no-recipe --overwrite clip.tik alone.png");
  EXPECT_EQ(file("p0.png"), file("alone.png"));
}

TEST_F(Moment, SweepVariesGainAndLength) {
  scratch_.write("f.fn", "M0 [0:0], [20000000:0], [40000000:1], [40000001:0]\n");
  const auto json = answer(
      "sweep -k f.fn --scale-gain 0.5..1.5/0.5 --stretch 1..2/1 --each v%02d.png --no-recipe clip.tik "
      "sheet.png");
  EXPECT_EQ(json["columns"], 3);
  EXPECT_EQ(json["rows"], 2);
  ASSERT_EQ(json["pictures"].size(), 6u);
  EXPECT_EQ(json["pictures"][5],
            nlohmann::json::parse(R"({"gain_factor":1.5,"stretch_factor":2.0,"file":"v05.png"})"));
  // It begins to expose at 20 ms, which stays.
  scratch_.write("last.fn", "M0 [-20000000:0], [20000000:0], [60000000:1.5], [60000002:0]\n");
  make("-k last.fn --no-recipe clip.tik alone.png");
  EXPECT_EQ(file("v05.png"), file("alone.png"));
  make("-k f.fn --no-recipe --overwrite clip.tik alone.png");
  EXPECT_EQ(file("v01.png"), file("alone.png"));
}

TEST_F(Moment, SweepWarnsOnceOfWhatLiesOutside) {
  expect_says(make("sweep --start 0.15s --exposure 40ms --shift 0..0.1s/20ms clip.tik").err,
              "warning: +20 ms and 4 more: ");
}

// As expose warns of each of them.
TEST_F(Moment, SweepWarnsOfPicturesThatComeOutBlack) {
  scratch_.write("negative.fn", "M0 [0:-1], [10000000:-1], [10000001:0]\n");
  expect_says(make("sweep -k negative.fn --shift 0..20ms/10ms clip.tik sheet.png").err,
              "warning: as it is and 2 more: M0: the still gain is -1: whatever does not move "
              "comes out black; --negative offset shows light below 0");
}

TEST_F(Moment, SweepRefusesWhatMakesNoSense) {
  const Words exposure("sweep --start 0s --exposure 1f clip.tik");
  const auto refused = [&](const Words& more, std::string_view part) { expect_refused(exposure + more, 2, part); };
  refused({}, "what is varied? Add --shift 0..1s/0.1s");
  refused({"--shift", "1s"}, "--shift '1s' is no range; write FROM..TO/STEP: 0..1s/0.1s");
  refused({"--shift", "0..1/0.1s"}, "'1' is no time");
  refused({"--shift", "0..5f/0.1s"}, "mixes times and pictures");
  refused({"--shift", "0..5f/0.5f"}, "0.5f is not a whole number of pictures");
  refused({"--shift", "1s..0s/0.1s"}, "FROM must not be above TO, STEP must be above 0");
  refused({"--shift", "0..1s/0s"}, "STEP must be above 0");
  refused({"--shift", "0..1s/1ms"},
          "a sheet holds 400 pictures and this sweep makes 1001; take a larger STEP");
  refused({"--shift", "0..29f/1f", "--scale-gain", "1..2/0.05"}, "makes 30 x 21; take a larger STEP");
  refused({"--stretch", "0..1/0.5"}, "a function cannot be made 0 times as long");
  refused({"--stretch", "1..2/0.1234567"}, "too many digits");
  refused({"--shift", "0..1f/1f", "--stretch", "1..2/1", "--scale-gain", "1..2/1"},
          "three parameters do not fit a sheet");
  refused({"--shift", "0..1f/1f", "--stretch", "1..2/1", "--columns", "3"}, "leave out --columns");
  refused({"--shift", "0..1f/1f", "--each", "same.png"},
          "--each needs a number in its pictures' name, as in same-%03d.png");
  refused({"--shift", "0..1f/1f", "--each", "x%d.gif"}, "pictures are written as .png");
  refused({"--shift", "0..1f/1f", "--each", "x%d.pfm"}, "x0.pfm holds floating point only; write a .png");
  expect_refused(2, {{"sweep --shift 0..1f/1f clip.tik", "an exposure needs a plain interval"},
                     {"sweep --shift 0..1f/1f", "an input is missing"}});
}

TEST_F(Moment, ThumbnailShowsTheFirstSample) {
  make("thumbnail clip.tik");
  const cv::Mat small = picture("clip-thumbnail.png");
  ASSERT_EQ(small.size(), cv::Size(96, 48)) << "no picture is enlarged";
  for (int i = 0; i < 96 * 48; ++i) ASSERT_EQ(small.data[i], scene_.pictures[0][std::size_t(i)]) << i;
  EXPECT_EQ(answer("thumbnail --width 24 clip.tik small.png")["height"], 12);
  EXPECT_EQ(picture("small.png").size(), cv::Size(24, 12));
  expect_refused("thumbnail frames/00.pgm t.png", 3, "is a Netpbm picture, not a .tik file");
  expect_refused(
      2, {{"thumbnail clip.tik clip.tik", "clip.tik"}, {"thumbnail --width 0 clip.tik t.png", "--width"}});
  EXPECT_FALSE(exists("t.png"));
}

}  // namespace
}  // namespace nutik::test
