// Motion studies as a user makes them.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <regex>

#include "support/drawn_clip.hpp"
#include "support/study_test.hpp"

namespace nutik::test {
namespace {

using Study = StudyTest;

TEST_F(Study, ShowsTheSubjectAsItWasAtEachMoment) {
  // Without the end, where it rests for so long that the plate shows it.
  const auto json = answer("study -f 100 --to 12f frames --moments 2 -o clip-study.png");
  ASSERT_EQ(json["moments"].size(), 2u);
  const cv::Mat study = picture("clip-study.png"), mask = picture("clip-study.pgm");
  ASSERT_EQ(study.size(), mask.size());
  std::uint8_t tag = 0;
  for (const auto& moment : json["moments"]) {
    ++tag;
    const int sample = moment["sample"].get<int>(), left = MovingSquare::left(sample);
    // All of the subject but where it is blended with what lies around it.
    for (int y = MovingSquare::kTop + 1; y < MovingSquare::kTop + MovingSquare::kSide - 1; ++y) {
      for (int x = left + 1; x < left + MovingSquare::kSide - 1; ++x) {
        ASSERT_EQ(mask.at<std::uint8_t>(y, x), tag) << sample << ": " << x << ", " << y;
        const int own =
            scene_.pictures[static_cast<std::size_t>(sample)][static_cast<std::size_t>(y * study.cols + x)];
        ASSERT_LE(std::abs(study.at<std::uint8_t>(y, x) - own), 1) << sample << ": " << x << ", " << y;
      }
    }
  }
  // Where it never was, the ground.
  for (int x = 0; x < study.cols; ++x)
    ASSERT_LE(std::abs(study.at<std::uint8_t>(2, x) - MovingSquare::kGround), 2 * MovingSquare::kNoise) << x;
}

TEST_F(Study, WritesTheCommandsThatMakeTheSame) {
  for (const char* style : {"trail", "strobe", "rear-curtain", "frozen", "slit", "slit bottom", "clean"}) {
    std::filesystem::remove(scratch_ / "study.pgm");
    const std::string_view all = style;
    const std::string name(all.substr(0, all.find(' ')));
    make("study clip.tik --depth 16 -o study.png --style " + name + (name != style ? " --slit-from bottom" : ""));
    ASSERT_EQ(std::filesystem::exists(scratch_ / "study.pgm"), std::string_view(style) != "clean") << style;
    expect_the_same_by_hand(style);
  }
}

// Before the work begins, and once.
TEST_F(Study, SaysTheLeastMemoryThatWorks) {
  for (const char* input : {"clip.tik", "frames"}) {
    const auto with = [&](const std::string& memory) {
      return run({"study", "-o", "least.png", "--memory", memory.c_str(), input,
                  std::string_view(input) == "frames" ? "--fps=100" : "--quiet"});
    };
    const auto refused = with("1kB");
    const std::string start = "allow more: --memory ";
    const auto at = refused.err.find(start);
    ASSERT_NE(at, std::string::npos) << refused.err;
    const auto allowed =
        with(refused.err.substr(at + start.size(), refused.err.find('\n', at) - at - start.size()));
    EXPECT_EQ(allowed.status, 0) << input << ": " << allowed.err;
  }
}

TEST_F(Study, TakesTheMomentsThatAreNamed) {
  const auto json = answer("study clip.tik --moments 2f,0.08s");
  EXPECT_EQ(json["moments"][0]["sample"], 2);
  EXPECT_EQ(json["moments"][1]["sample"], 8);
  expect_refused(
      2, {{"study clip.tik --moments 8f,2f", "state moments in the order of time"},
          {"study clip.tik --style frozen --moments 3", "--style frozen shows a single moment; leave --moments out"},
          {"study clip.tik --moments 51", "--moments says 51; a study has 1 to 50"},
          {"study clip.tik --moments 0", "--moments says 0; a study has 1 to 50"},
          {"study clip.tik --moments 8f,last", "--moments 'last' is no time"}});
}

// A square crosses the picture, is gone, and another thing stands there for a while.
TEST_F(Study, ShowsWhatDiffersAtANamedMomentAtWhichTheSubjectIsNotSeen) {
  std::filesystem::create_directory(scratch_ / "h");
  for (int k = 0; k < 40; ++k) {
    cv::Mat frame(48, 96, CV_8UC1, cv::Scalar::all(60));
    if (k < 20) frame(cv::Rect(4 + 4 * k, 20, 8, 8)) = 200;
    if (k >= 28 && k < 32) frame(cv::Rect(8, 30, 20, 12)) = 200;
    cv::imwrite((scratch_ / "h" / (std::to_string(1000 + k) + ".pgm")).string(), frame);
  }
  const auto result = make("study -f 100 h --moments 10f,24f,30f -o h.png");
  EXPECT_EQ(result.err.find("at 100 ms (10f)"), std::string::npos) << result.err;
  expect_says(result.err, {"at 240 ms (24f) the subject that was followed is not seen", "at 300 ms (30f)"});
  const cv::Mat mask = picture("h.pgm");
  EXPECT_EQ(mask.at<std::uint8_t>(24, 48), 1);
  EXPECT_EQ(cv::countNonZero(mask == 2), 0);
  const cv::Mat thing = mask(cv::Rect(8, 30, 20, 12));
  EXPECT_EQ(cv::countNonZero(thing == 3), 20 * 12 - 4) << "corners are smoothed";
}

TEST_F(Study, TakesMomentsThatFollowEachOther) {
  for (const char* style : {"trail", "strobe"}) {
    const auto json = answer({"study", "clip.tik", "--style", style, "--moments", "2f,3f,9f", "-o", "s.png"});
    ASSERT_EQ(json["moments"].size(), 3u) << style;
    const int samples[] = {2, 3, 9};
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(json["moments"][k]["sample"], samples[k]) << style;
      EXPECT_GT(cv::countNonZero(picture("s.pgm") == k + 1), 0) << style << k;
    }
  }
}

// A square that comes after six empty pictures; and one on its way that is gone for six of so many that only every
// third is looked at: it is one way still.
TEST_F(Study, TakesTheEmptySceneAwayWhereItLiesApart) {
  for (const auto& [count, empty_from] : {std::pair(18, 0), std::pair(780, 390)}) {
    const std::string folder = "g" + std::to_string(count);
    std::filesystem::create_directory(scratch_ / folder);
    for (int k = 0; k < count; ++k) {
      cv::Mat frame(48, 96, CV_8UC1, cv::Scalar::all(60));
      if (k < empty_from || k >= empty_from + 6) frame(cv::Rect(4 + 72 * k / count, 20, 8, 8)) = 200;
      cv::imwrite((scratch_ / folder / (std::to_string(1000 + k) + ".pgm")).string(), frame);
    }
    const double strength = answer("study --moments 3 -o g.png -f 100 " + folder)["trail_strength"];
    EXPECT_EQ(strength > 1, empty_from == 0) << strength;
  }
}

// The same clip by a camera that changed its exposure from picture to picture.
TEST_F(Study, UndoesWhatTheCameraDidToItsExposure) {
  std::filesystem::create_directory(scratch_ / "steady");
  std::filesystem::create_directory(scratch_ / "dim");
  for (int k = 0; k < 18; ++k) {
    cv::Mat frame(48, 96, CV_8UC1);
    for (int y = 0; y < 48; ++y) {
      for (int x = 0; x < 96; ++x) frame.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(20 + 2 * x);
    }
    frame(cv::Rect(4 + 4 * k, 20, 8, 8)) = 5;
    const std::string name = std::to_string(100 + k) + ".png";
    cv::imwrite((scratch_ / "steady" / name).string(), frame);
    frame = frame * (k % 3 == 0 ? 1.0 : k % 3 == 1 ? 0.7 : 0.85);
    cv::imwrite((scratch_ / "dim" / name).string(), frame);
  }
  for (const char* clip : {"steady", "dim"}) {
    const auto result = make({"study", "-f", "100", clip, "--moments", "3", "-o", std::string(clip) + ".png"});
    EXPECT_EQ(result.err.find("the exposure of 12 of 18 pictures was corrected") != std::string::npos,
              clip == std::string("dim"))
        << result.err;
  }
  EXPECT_LE(cv::norm(picture("steady.png"), picture("dim.png"), cv::NORM_INF), 2.0);
}

// A square that is ever faster.
TEST_F(Study, SpreadsMomentsOverTimeOrOverTheWay) {
  DrawnClip clip(scratch_ / "faster");
  const auto left = [](int k) { return 2 + k * k / 3; };
  for (int k = 0; k < 21; ++k) {
    cv::Mat frame = ground_of(7);
    frame(cv::Rect(left(k), 40, 12, 12)) = 250;
    clip.add(frame);
  }
  const auto middle = [&](const char* spacing) {
    const auto json =
        answer({"study", "-f", "100", "faster", "--moments", "3", "--spacing", spacing, "-o", "faster.png"});
    EXPECT_EQ(json["moments"].size(), 3u);
    const int first = json["moments"][0]["sample"], second = json["moments"][1]["sample"],
              last = json["moments"][2]["sample"];
    return std::pair(double(second - first) / (last - first),
                     double(left(second) - left(first)) / (left(last) - left(first)));
  };
  EXPECT_NEAR(middle("time").first, 0.5, 0.06);
  EXPECT_NEAR(middle("distance").second, 0.5, 0.06);
}

TEST_F(Study, RefusesASceneThatNeverRests) {
  DrawnClip clip(scratch_ / "leaves");
  for (int k = 0; k < 16; ++k) clip.add(ground_of(k));
  expect_refused("study -f 100 leaves -o leaves.png", 3, "everything moves");
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "leaves.png"));
}

TEST_F(Study, ShowsOneShotOfAClipWithCuts) {
  DrawnClip clip(scratch_ / "shots");
  for (int k = 0; k < 24; ++k) clip.add(ground_of(100 + k / 12 * 50));  // twelve still ones each
  for (int k = 0; k < 20; ++k) {
    cv::Mat frame = ground_of(7);
    frame(cv::Rect(4 + 7 * k, 40, 12, 12)) = 250;
    clip.add(frame);
  }
  expect_says(make("study -f 100 shots -o shots.png").err,
              "the clip has 3 shots, which begin at pictures 0, 12, 24: of the longest that makes a study, "
              "pictures 24 … 43 were taken");
  expect_says(read_file(scratch_ / "shots.txt"), "--from 24f --to 44f");
  clip.add(cv::Mat(96, 160, CV_8UC1, cv::Scalar::all(252)));  // as some cameras end a recording
  expect_says(make("study -f 100 shots -o shots.png").err,
              "the clip has 4 shots, which begin at pictures 0, 12, 24, 44 (a single one): of the "
              "longest that makes a study, pictures 24 … 43 were taken");
  std::filesystem::remove(scratch_ / "shots" / "1044.png");
  make("encode -f 100 shots shots.tik");
  expect_refused("study shots.tik -o none.png", 3, "it has 3 shots, which begin at pictures 0, 12, 24");
}

TEST_F(Study, TakesAShotWithoutTheDissolveBeforeIt) {
  DrawnClip clip(scratch_ / "mixed");
  for (int k = 0; k < 48; ++k) {
    cv::Mat frame = ground_of(7), mixed;
    if (k >= 20) frame(cv::Rect(4 + 5 * (k - 20), 40, 12, 12)) = 250;
    const double way = std::clamp((k - 10) / 12.0, 0.0, 1.0);
    cv::addWeighted(ground_of(100), 1 - way, frame, way, 0, mixed);
    clip.add(mixed);
  }
  expect_says(make("study -f 100 mixed -o mixed.png").err,
              {"the clip has 2 shots, which begin at pictures 0, 2", " (behind a dissolve or fade from ",
               " of the longest that makes a study, pictures 2"});
}

// Two cameras that turn, and a dissolve from one to the other: no motion explains that, and no single cut is there.
TEST_F(Study, TakesOneSceneOfADissolveBetweenCamerasThatMove) {
  DrawnClip clip(scratch_ / "turned");
  const auto wide = [](int number) {
    cv::Mat both;
    cv::hconcat(ground_of(number), ground_of(number + 1), both);
    return both;
  };
  const cv::Mat first = wide(100), second = wide(7);
  for (int k = 0; k < 60; ++k) {
    cv::Mat frame = second(cv::Rect(2 * k, 0, 160, 96)).clone(), mixed;
    frame(cv::Rect(140 - 3 * std::max(k - 34, 0), 40, 12, 12)) = 250;
    const double way = std::clamp((k - 24) / 12.0, 0.0, 1.0);
    cv::addWeighted(first(cv::Rect(120 - 2 * k, 0, 160, 96)), 1 - way, frame, way, 0, mixed);
    clip.add(mixed);
  }
  const std::string said = make("study -f 100 turned -o turned.png").err;
  const std::regex taken("pictures ([0-9]+) … ([0-9]+) were taken, the longest part that shows one scene");
  std::smatch part;
  ASSERT_TRUE(std::regex_search(said, part, taken)) << said;
  EXPECT_GE(std::stoi(part[1]), 34) << "more than a sixth of the first scene is left, 16 codes: a subject's";
  EXPECT_EQ(std::stoi(part[2]), 59);
}

TEST_F(Study, ShowsOneMomentOfWhatGoesLessThanItsOwnSize) {
  DrawnClip clip(scratch_ / "stirs");
  for (int k = 0; k < 20; ++k) {
    cv::Mat frame = ground_of(7);
    if (k >= 12) frame(cv::Rect(40 + 3 * (k - 12), 20, 60, 60)) = 250;
    clip.add(frame);
  }
  const auto result = make("study -f 100 stirs -o stirs.png");
  expect_says(result.err, "So a single moment of it is shown");
  expect_says(result.out, "stirs.png: 160 x 96 grey, the subject at ");
  expect_says(result.err, "goes 21 pixels, and is 60 pixels large: at no two moments does it lie apart from itself");
  EXPECT_EQ(picture("stirs.png").at<std::uint8_t>(50, 75), 250) << "within the square at each of its moments";
  make("study -f 100 stirs --style frozen -o stirs.png");
}

// A ball of 126 pixels that falls by 18 before and after the middle of the clip: it is in the plate, and its edges
// alone differ from that.
TEST_F(Study, SaysOfAThingThatNeverLeavesItsPlaceThatItCannotBeShownTwice) {
  const std::filesystem::path clip = std::filesystem::path(NUTIK_TEST_MEDIA) / "ball_12bit.cihx";
  if (!std::filesystem::exists(clip)) GTEST_SKIP() << clip << " is not there";
  const auto result = make({"study", clip.c_str(), "-o", "falls.png"});
  const std::regex cause(
      "Its box is [0-9]{2} pixels long and goes [0-9]{2}: a thing that goes less than its own size shows its edges "
      "only");
  EXPECT_TRUE(std::regex_search(result.err, cause)) << result.err;
  expect_says(result.err, "Take a clip in which it goes further");
  expect_says(result.err, "So the picture exposes all of the time");
  EXPECT_EQ(cv::countNonZero(picture("falls.pgm")), 0) << "no moments";
}

TEST_F(Study, ShowsOneMomentOfWhatFlickersHereAndThere) {
  DrawnClip clip(scratch_ / "flickers");
  cv::RNG random(5);
  for (int k = 0; k < 40; ++k) {
    cv::Mat frame = ground_of(7);
    frame(cv::Rect(50 + random.uniform(0, 30), 30 + random.uniform(0, 30), 12, 12)) = 250;
    clip.add(frame);
  }
  expect_says(make("study -f 100 flickers -o flickers.png").err,
              {"nothing seen moves as one whole thing. What differs from the scene at rest is scattered over ",
               "on no way of its own", "So a single moment of it is shown"});
  EXPECT_EQ(answer("study -f 100 flickers -o flickers.png")["moments"].size(), 1u);
  const cv::Mat seen = picture("flickers.png").clone().setTo(0, picture("flickers.pgm") != 1);
  EXPECT_GE(cv::countNonZero(seen > 200), 12 * 12) << "all of one square";
}

// Three lights in a row, each for an eighth of the time.
TEST_F(Study, ExposesAllOfTheTimeInWhichLightsComeAndGo) {
  DrawnClip clip(scratch_ / "lights");
  for (int k = 0; k < 24; ++k) {
    cv::Mat frame = ground_of(7);
    if (k % 8 < 3) frame(cv::Rect(8 + 60 * (k / 8), 40, 10, 10)) = 250;
    clip.add(frame);
  }
  expect_says(make("study -f 100 lights -o lights.png").err,
              {"nothing seen goes anywhere", "around it all of that time is exposed"});
}

// A pot plant by a window, filmed by somebody who walks round it.
TEST_F(Study, ShowsAllOfTheTimeBeforeTheParallaxOfAMovingCamera) {
  const std::filesystem::path clip = std::filesystem::path(NUTIK_TEST_MEDIA) / "realshort.mp4";
  if (!std::filesystem::exists(clip)) GTEST_SKIP() << clip << " is not there";
  const auto result = make({"study", clip.c_str(), "-o", "parallax.png"});
  expect_says(result.err, "one motion of the camera does not explain the pictures");
  expect_says(result.err, "So the picture exposes all of the time");
  EXPECT_EQ(result.err.find("The camera may have moved"), std::string::npos) << result.err;
  EXPECT_EQ(cv::countNonZero(picture("parallax.pgm")), 0) << "no moments";
}

// A man who leaves through the border: at picture 25 of the part a third of him is left, and his shadow.
TEST_F(Study, ARearCurtainShowsWhoLeavesWhole) {
  const std::filesystem::path clip = std::filesystem::path(NUTIK_TEST_MEDIA) / "one-by-one-person-detection.mp4";
  if (!std::filesystem::exists(clip)) GTEST_SKIP() << clip << " is not there";
  const auto told = answer(format("study --style rear-curtain --from 840f --to 885f {} -o man.png", clip.string()));
  EXPECT_LE(told["moments"][0]["sample"], 22);
}

// A thin line crosses the picture while a much larger place lights up and darkens.
TEST_F(Study, ShowsNoThinScrapsOfWhatMoves) {
  for (const bool has_lights : {false, true}) {
    DrawnClip clip(scratch_ / "thin");
    for (int k = 0; k < 24; ++k) {
      cv::Mat frame = ground_of(7);
      if (has_lights) frame(cv::Rect(60, 60, 28, 28)) = 60 + 90 * (k % 3);
      cv::line(frame, {4 + 5 * k, 10}, {34 + 5 * k, 40}, cv::Scalar(250), 2);
      clip.add(frame);
    }
    const auto result = make("study -f 100 thin --moments 2 -o thin.png");
    const std::regex refusal(
        "nothing seen moves as one whole thing. What goes furthest fills [0-9]+ % of its box, and is [0-9]+ % of what "
        "differs"
        ".* A thing that shakes, grows or shines shows its edges only");
    EXPECT_EQ(std::regex_search(result.err, refusal), has_lights) << result.err;
    if (has_lights) expect_mean_of_all("-f 100 thin", 24, "thin");
  }
  make("study -f 100 thin --moments 4f,16f -o named.png");
}

// A square that comes, rests for four fifths of its time, and goes on.
TEST_F(Study, LeavesRestsOutOfTheTrail) {
  DrawnClip clip(scratch_ / "rests");
  for (int k = 0; k < 100; ++k) {
    const int along = k < 10 ? k : k < 90 ? 10 : k - 80;
    cv::Mat frame = ground_of(7);
    frame(cv::Rect(4 + 7 * along, 40, 12, 12)) = 250;
    if (along != 10 || k % 2 == 0) clip.add(frame);
    if (along == 10 && k % 2 != 0) clip.add(ground_of(7));  // so that the plate is sure
  }
  make("study -f 100 rests --moments 2f,98f -o rests.png");
  // Beside the way the picture is the ground; where it rested, no more than a pass of it is left.
  const cv::Mat study = picture("rests.png"), ground = ground_of(7);
  EXPECT_NEAR(study.at<std::uint8_t>(10, 10), ground.at<std::uint8_t>(10, 10), 1);
  const auto max_within = [&](int from, int to) {
    int most = 0;
    for (int x = from; x < to; ++x) {
      most = std::max(most, std::abs(study.at<std::uint8_t>(46, x) - ground.at<std::uint8_t>(46, x)));
    }
    return most;
  };
  const int at_rest = max_within(76, 84), before = max_within(32, 68);
  EXPECT_GT(before, 2) << "there is a trail";
  EXPECT_LE(at_rest, before + 2);
}

// Two squares, one above the other, on opposite ways.
TEST_F(Study, FollowsASubjectInEachRegion) {
  DrawnClip clip(scratch_ / "two");
  const auto upper = [](int k) { return cv::Rect(4 + 7 * k, 20, 12, 12); };
  const auto lower = [](int k) { return cv::Rect(140 - 7 * k, 64, 12, 12); };
  for (int k = 0; k < 20; ++k) {
    cv::Mat frame = ground_of(7);
    frame(upper(k)) = 250;
    frame(lower(k)) = 5;
    clip.add(frame);
  }
  const auto json = answer("study -f 100 two --region 0,0,160,48 --region 0,48,160,48 --moments 3 -o two.png");
  ASSERT_EQ(json["moments"].size(), 6u);
  const cv::Mat mask = picture("two.pgm"), study = picture("two.png");
  for (int tag = 1; tag <= 6; ++tag) {
    const int sample = json["moments"][static_cast<std::size_t>(tag - 1)]["sample"].get<int>();
    const cv::Rect place = tag <= 3 ? upper(sample) : lower(sample);
    const int x = place.x + place.width / 2, y = place.y + place.height / 2;
    EXPECT_EQ(mask.at<std::uint8_t>(y, x), tag);
    EXPECT_NEAR(study.at<std::uint8_t>(y, x), tag <= 3 ? 250 : 5, 1);
  }
  expect_refused(2, {{"study -f 100 two --region 100,0,80,48 -o no.png",
                      "region 100,0,80,48 does not lie in the 160 x 96 pixels of two"},
                     {"study -f 100 two --region 1,2,3 -o no.png",
                      "--region '1,2,3' is no rectangle; write whole pixels"}});
  expect_says(make("study -f 100 two --region 0,84,160,12 -o no.png").err, "region 0,84,160,12: nothing moves");
  expect_mean_of_all("-f 100 two", 20, "no");
}

TEST_F(Study, ShowsEachStripOfASlitAtItsOwnMoment) {
  for (const std::string from : {"", "left", "right", "top", "bottom"}) {
    const auto json = answer("study clip.tik --style slit --moments 4 -o slit.png" +
                             Words(from.empty() ? "" : "--slit-from " + from));
    ASSERT_EQ(json["moments"].size(), 4u);
    std::vector<std::size_t> samples;
    for (const auto& moment : json["moments"]) samples.push_back(moment["sample"].get<std::size_t>());
    const bool are_rows = from == "top" || from == "bottom", is_back = from == "right" || from == "bottom";
    EXPECT_EQ(samples[is_back ? 3 : 0], 0u) << from;
    EXPECT_EQ(samples[is_back ? 0 : 3], scene_.pictures.size() - 1) << from;
    const cv::Mat slit = picture("slit.png");
    for (int x = 0; x < slit.cols; ++x) {
      for (int y = 0; y < slit.rows; ++y) {
        const auto strip = static_cast<std::size_t>(are_rows ? y * 4 / slit.rows : x * 4 / slit.cols);
        ASSERT_EQ(slit.at<std::uint8_t>(y, x),
                  scene_.pictures[samples[strip]][static_cast<std::size_t>(y * slit.cols + x)])
            << from << ": " << x << ", " << y;
      }
    }
  }
  expect_refused(2,
                 {{"study clip.tik --style slit --slit-from above",
                   "--slit-from 'above' is not known; choose left, right, top or bottom"},
                  {"study clip.tik --slit-from top", "--slit-from goes with --style slit only; leave it out"},
                  {"study clip.tik --style slit --moments 1f,3f", "how many there are, not which"}});
  expect_refused("study clip.tik --style clean --trail fade", 2, "--trail says nothing to --style clean");
}

TEST_F(Study, ShowsAllOfTheTimeWhereNothingMoves) {
  make("study -f 100 still -o study.png", 3);  // no such folder
  std::filesystem::create_directory(scratch_ / "rest");
  for (int k = 13; k < 20; ++k) {  // it rests from then on
    const std::string name = std::to_string(k) + ".pgm";
    std::filesystem::copy_file(scratch_ / "frames" / name, scratch_ / "rest" / name);
  }
  const auto rest = make("study -f 100 rest -o study.png");
  expect_says(rest.err, "nothing moves");
  expect_says(rest.out, "all of the time, exposed as one");
  expect_mean_of_all("-f 100 rest", 7, "study");
  expect_the_same_by_hand("all of the time");
}

}  // namespace
}  // namespace nutik::test
