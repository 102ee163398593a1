// Which subject a study shows, or which subjects, and when none can be shown.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "support/app_test.hpp"
#include "support/drawn_clip.hpp"

namespace nutik::test {
namespace {

class StudySubjects : public AppTest {
 protected:
  void draw(const char* clip, int count, const std::function<void(cv::Mat&, int)>& add) const {
    DrawnClip drawn(scratch_ / clip);
    for (int k = 0; k < count; ++k) {
      cv::Mat frame = ground_of(7);
      add(frame, k);
      drawn.add(frame);
    }
  }
  ProgramResult study(const char* clip, const Words& words, int status = 0) const {
    return make(Words{"study", "-f", "100", clip, "-o", "study.png"} + words, status);
  }
  [[nodiscard]] nlohmann::json moments_of(const char* clip, const Words& words) const {
    return nlohmann::json::parse(study(clip, words + "--json").out)["moments"];
  }
  void expect_moments_before(int sample, const char* clip) const {
    const auto moments = moments_of(clip, "--style strobe --moments 3");
    EXPECT_GE(moments.size(), 2u) << moments;
    for (const auto& moment : moments) EXPECT_LT(moment["sample"].get<int>(), sample) << moments;
  }
  // Two squares, one above the other, on opposite ways.
  void draw_two() const {
    draw("two", 20, [](cv::Mat& frame, int k) {
      frame(upper(k)) = 250;
      frame(lower(k)) = 5;
    });
  }
  static cv::Rect upper(int k) { return {4 + 7 * k, 20, 12, 12}; }
  static cv::Rect lower(int k) { return {140 - 7 * k, 64, 12, 12}; }

  static Words in_both(const Words& words) { return words + "--region 0,0,160,48 --region 0,48,160,48"; }
};

// A thing that rests for half of the time is in the plate, and what it leaves behind is no ground to be taken away:
// where it lay is what lies there now, and no moment is seen in part before it.
TEST_F(StudySubjects, MayRestBeforeTheyGo) {
  const cv::Rect rest(20, 40, 14, 14);
  draw("kick", 40, [&](cv::Mat& frame, int k) { frame(rest + cv::Point(8 * std::max(0, k - 24), 0)) = 250; });
  for (const char* style : {"trail", "rear-curtain", "strobe"}) {
    expect_says(study("kick", {"--style", style, "--overwrite"}).out, "no pixel below 0 or above 1");
    const cv::Mat ground = ground_of(7), shown = picture("study.png");
    EXPECT_LE(cv::norm(shown(rest), ground(rest), cv::NORM_INF), 40) << style;  // and some trail
  }
  const cv::Mat mask = picture("study.pgm");
  double moments = 0;
  cv::minMaxLoc(mask, nullptr, &moments);
  EXPECT_EQ(moments, 5);
  for (int tag = 1; tag <= static_cast<int>(moments); ++tag) {
    EXPECT_GE(cv::countNonZero((mask == tag) & (picture("study.png") > 240)), 190) << tag;  // of 196, but for corners
  }
}

// One that is slow has few moments, at which the other one is elsewhere: no ghost of it stays in the scene.
TEST_F(StudySubjects, LeaveNoneOfThemselvesInTheEmptyScene) {
  draw("two speeds", 21, [](cv::Mat& frame, int k) {
    frame(cv::Rect(4 + 3 * k, 56, 24, 24)) = 250;
    frame(cv::Rect(4 + 7 * k, 12, 8, 8)) = 250;
  });
  expect_says(study("two speeds", "--style strobe").out, "subject 2 at");
  cv::Mat regions, difference;
  cv::dilate(picture("study.pgm"), regions, cv::Mat::ones(7, 7, CV_8U));
  cv::absdiff(picture("study.png"), ground_of(7), difference);
  EXPECT_EQ(cv::countNonZero((difference > 2) & (regions == 0)), 0);
}

// Their moments are the same samples.
TEST_F(StudySubjects, MayShareTheirMoments) {
  draw_two();
  for (const char* words : {"--style strobe --moments 3", "--trail none --moments 0.02s,0.1s,0.17s"}) {
    study("two", in_both(words));
    const cv::Mat mask = picture("study.pgm"), shown = picture("study.png");
    for (int tag = 1; tag <= 6; ++tag) {
      const cv::Mat values = shown.clone().setTo(128, mask != tag);
      double least = 0, most = 0;
      cv::minMaxLoc(values, &least, &most);
      EXPECT_NEAR(tag <= 3 ? most : least, tag <= 3 ? 250 : 5, 1) << tag;
    }
  }
}

TEST_F(StudySubjects, AreNamedWithTheirMoments) {
  draw_two();
  expect_says(study("two", in_both("--moments 1f,17f")).out,
              "subject 1 at 10 ms (1f), 170 ms (17f); subject 2 at 10 ms (1f), 170 ms (17f)");
  const auto moments = moments_of("two", in_both("--moments 1f,17f"));
  ASSERT_EQ(moments.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(moments[i]["mask"], i + 1);
    EXPECT_EQ(moments[i]["subject"], i / 2 + 1);
    EXPECT_EQ(moments[i]["sample"], i % 2 == 0 ? 1 : 17);
  }
  expect_says(study("two", in_both("--moments 13")).err, {"note: subject 1: ", "note: subject 2: "});
}

TEST_F(StudySubjects, AreTwoThingsNotOne) {
  draw("one", 20, [](cv::Mat& frame, int k) { frame(upper(k)) = 250; });
  expect_says(study("one", "--region 0,0,100,96 --region 40,0,120,96", 3).err,
              "region 0,0,100,96 and region 40,0,120,96 overlap, and hold the same subject");
}

TEST_F(StudySubjects, LeaveNoOtherUnmentioned) {
  draw_two();
  expect_says(study("two", "--moments 3").err,
              {"2 subjects are shown: another thing goes its way at the same time, within ",
               ". Name a region to show what moves in it"});
  const cv::Mat shown = picture("study.pgm");
  const auto is_above = [&](int tag) { return cv::countNonZero(shown(cv::Rect(0, 0, 160, 48)) == tag) > 0; };
  for (int tag = 1; tag <= 6; ++tag) {  // three of each
    EXPECT_EQ(is_above(tag), is_above(tag <= 3 ? 1 : 4)) << tag;
    EXPECT_GE(cv::countNonZero(shown == tag), 12 * 12) << tag;
  }
  EXPECT_NE(is_above(1), is_above(4));
  expect_says(study("two", "--style frozen").err,
              {"one subject is shown, and another thing goes its way at the same time, within ",
               ". Name a region for each of them to show both, or take the style trail or strobe"});
  draw("crossing", 20, [](cv::Mat& frame, int k) {
    frame(cv::Rect(4 + 7 * k, 8 + 3 * k, 12, 12)) = 250;
    frame(cv::Rect(140 - 7 * k, 80 - 2 * k, 12, 12)) = 5;
  });
  expect_says(study("crossing", {"--moments", "3"}).err,
              ". Their ways overlap, so no region holds one alone: take a part of the time in which they lie apart");
  draw("one", 20, [](cv::Mat& frame, int k) { frame(upper(k)) = 250; });
  const auto one = study("one", "--moments 3");
  EXPECT_EQ(one.err.find("another thing"), std::string::npos) << one.err;
  draw("lesser", 20, [](cv::Mat& frame, int k) {
    frame(upper(k)) = 250;
    frame(lower(0) - cv::Point(2 * k, 0)) = 250;
  });
  expect_says(study("lesser", "--moments 3").err,
              {"another thing goes its way and is not shown, within ", ". Name a region to show what moves in it"});
}

// A bright square in a soft shadow that is wider than it. Beside the square lies its trail, dimmed as the ground is;
// the trail alone is seen there at other moments.
TEST_F(StudySubjects, CastTheirShadowsOnTheirTrails) {
  constexpr int kWidth = 320, kHeight = 96, kSide = 20, kTop = 34;
  const auto left = [](int k) { return 10 + 7 * k; };
  cv::Mat ground(kHeight, kWidth, CV_32FC1);
  cv::RNG(7).fill(ground, cv::RNG::UNIFORM, 110, 131);
  std::vector<cv::Mat> frames;
  DrawnClip clip(scratch_ / "shadow");
  for (int k = 0; k < 40; ++k) {
    cv::Mat shadow(kHeight, kWidth, CV_32FC1, cv::Scalar(0)), lit, frame;
    cv::ellipse(shadow, {left(k) + kSide / 2, kTop + kSide / 2}, {20, 18}, 0, 0, 360, cv::Scalar(0.3), cv::FILLED);
    cv::GaussianBlur(shadow, shadow, {}, 5);
    cv::multiply(ground, 1 - shadow, lit);
    lit(cv::Rect(left(k), kTop, kSide, kSide)) = 240;
    lit.convertTo(frame, CV_8U);
    frames.push_back(frame);
    clip.add(frame);
  }
  const auto shown_at = [&](const char* moments) {
    study("shadow", {"--moments", moments});
    return picture("study.png");
  };
  const cv::Mat at_10 = shown_at("10f,30f"), at_20 = shown_at("20f,30f");
  cv::Mat mask = picture("study.pgm");
  cv::dilate(mask, mask, cv::Mat::ones(5, 5, CV_8U));  // as far as edges are blended
  for (const int y : {kTop + 5, kTop + 10, kTop + 15}) {
    for (int x = left(10); x < left(10) + kSide; ++x) {
      ASSERT_NEAR(at_10.at<std::uint8_t>(y, x), 240, 2) << x << ", " << y;
    }
    for (int away = 5; away < 40; ++away) {
      const int x = left(10) + kSide + away;
      if (away < 20) {
        ASSERT_EQ(mask.at<std::uint8_t>(y, x), 0) << "the trail alone is seen at the other moments";
      }
      if (mask.at<std::uint8_t>(y, x) != 0) continue;
      const int trail = at_20.at<std::uint8_t>(y, x), shaded = at_10.at<std::uint8_t>(y, x);
      const double left_of_light = frames[10].at<std::uint8_t>(y, x) / ground.at<float>(y, x);
      EXPECT_GE(shaded, left_of_light * trail - 4) << x << ", " << y;
      EXPECT_LE(shaded, trail + 4) << x << ", " << y;
    }
  }
}

// A small thing shakes where the square ends, so that no time shows that ground bare. What lies beside the square is
// the trail's.
TEST_F(StudySubjects, EndTheirTrailsWithoutHalo) {
  draw("halo", 20, [](cv::Mat& frame, int k) {
    if (k < 14) frame(cv::Rect(82 + 8 * (k % 3), 34, 7, 7)) = 250;
    frame(cv::Rect(4 + 4 * k, 30, 20, 20)) = 5;
  });
  study("halo", "--style rear-curtain");
  EXPECT_EQ(cv::boundingRect(picture("study.pgm")), cv::Rect(80, 30, 20, 20));
  const auto dimmed = [&](int x) {
    const cv::Rect strip(x, 42, 6, 6);
    return cv::mean(picture("study.png")(strip))[0] / cv::mean(ground_of(7)(strip))[0];
  };
  EXPECT_NEAR(dimmed(74), dimmed(66), 0.1);
}

// A camera brightens what lies around a dark thing: that is no part of the thing.
TEST_F(StudySubjects, LeaveNoHaloWhereTheCameraBrightensTheirGround) {
  draw("brightened", 24, [](cv::Mat& frame, int k) {
    const cv::Rect square(4 + 6 * k, 36, 14, 14);
    cv::Mat around = frame(cv::Rect(square.x - 4, 20, 40, 46) & cv::Rect(0, 0, frame.cols, frame.rows));
    around += 6;
    frame(square) = 5;
  });
  study("brightened", "--style frozen --moments 11f");
  cv::Mat brighter;
  cv::subtract(picture("study.png"), ground_of(7), brighter, {}, CV_32F);
  const auto above = [&](int y) { return cv::mean(brighter(cv::Rect(70, y, 14, 3)))[0]; };
  EXPECT_NEAR(above(32), above(24), 2);
}

// The region is empty while the square is elsewhere: no scene to be taken away.
TEST_F(StudySubjects, LeaveNothingDarkOutsideOfTheirRegion) {
  draw("one", 40, [](cv::Mat& frame, int k) { frame(cv::Rect(4 + 7 * k / 2, 20, 12, 12)) = 250; });
  study("one", "--region 60,0,40,96 --moments 1");
  cv::Mat difference;
  cv::subtract(picture("study.png"), ground_of(7), difference, {}, CV_16S);
  double darkest = 0;
  cv::minMaxLoc(difference, &darkest);
  EXPECT_GE(darkest, -2);
}

// A square of 24 pixels that goes 4 pixels a picture: in the middle of its way it is for six of ten pictures.
TEST_F(StudySubjects, AreNotShownWithHolesOfThePlate) {
  DrawnClip clip(scratch_ / "slow");
  for (int k = 0; k < 10; ++k) {
    cv::Mat frame(96, 160, CV_8UC1, cv::Scalar::all(90));
    frame(cv::Rect(40 + 4 * k, 30, 24, 24)) = 250;
    clip.add(frame);
  }
  const std::string why = "the scene at rest shows the subject, too";
  for (const char* style : {"frozen", "rear-curtain"}) {
    expect_says(study("slow", {"--style", style}).err,
                {why, "So the picture exposes all of the time and shows no moments"});
    EXPECT_EQ(cv::countNonZero(picture("study.pgm")), 0);
  }
  expect_says(study("slow", "--moments 0f,9f").err, "note: " + why);
}

// An arm puts a block down, and leaves it for the rest of the time: the plate has it, and the trail for a part of its
// time. A hole is where it will lie, and not taken for the arm that comes.
TEST_F(StudySubjects, ShowWhatTheyPutDown) {
  const cv::Rect block(71, 56, 20, 18);
  draw("put", 60, [&](cv::Mat& frame, int k) {
    const int tip = 8 * std::min(k - 17, 33 - k);
    if (tip > 0) frame(cv::Rect(70, 0, 22, std::min(tip, block.y))) = 10;
    if (k > 17) frame(k < 24 ? block + cv::Point(0, tip - block.y) : block) = 250;
  });
  study("put", "--moments 26f");
  EXPECT_GE(cv::mean(picture("study.png")(block))[0], 249.5);
}

// A square that is there for a third of the time.
TEST_F(StudySubjects, MayBeShownStillWhereTheyGoNowhere) {
  draw("comes", 30, [](cv::Mat& frame, int k) {
    if (k >= 10 && k < 20) frame(cv::Rect(40, 30, 24, 24)) = 250;
  });
  study("comes", "--style frozen");
  EXPECT_EQ(picture("study.png").at<std::uint8_t>(42, 52), 250);
  expect_says(study("comes", {}).err, "It comes and goes in its place. So a single moment of it is shown");
  EXPECT_EQ(picture("study.png").at<std::uint8_t>(42, 52), 250);
}

// All are exposed as the first one is.
TEST_F(StudySubjects, AreNotAsDarkAsAFadeBegins) {
  draw("fades", 30, [](cv::Mat& frame, int k) {
    frame(cv::Rect(4 + 4 * k, 40, 16, 16)) = 250;
    frame *= std::min(0.4 + 0.1 * k, 1.0);
  });
  const auto result = study("fades", "--json");
  expect_says(result.out + result.err, "those before 6 were left out");
  expect_says(file("study.txt"), " --from 6f --to 30f");
  EXPECT_NEAR(cv::mean(picture("study.png")(cv::Rect(0, 0, 160, 20)))[0],
              cv::mean(ground_of(7)(cv::Rect(0, 0, 160, 20)))[0], 3);
}

// It goes behind something: of 16 columns 10 are seen at 18, and 4 at the last.
TEST_F(StudySubjects, EndARearCurtainAsAWhole) {
  draw("hides", 22, [](cv::Mat& frame, int k) {
    const int left = 4 + 6 * k, right = std::min(left + 16, 122);
    if (right > left) frame(cv::Rect(left, 40, right - left, 16)) = 250;
  });
  EXPECT_EQ(moments_of("hides", "--style rear-curtain")[0]["sample"], 18);
}

// Its middle is in the plate, which shows it for most of the time.
TEST_F(StudySubjects, MayGrow) {
  draw("grows", 20, [](cv::Mat& frame, int k) { cv::circle(frame, {80, 48}, 4 + 2 * k, cv::Scalar(250), cv::FILLED); });
  study("grows", "--style frozen --moments 19f");
  EXPECT_EQ(picture("study.pgm").at<std::uint8_t>(48, 80), 1);
}

// One of them is the scene that the other is compared with.
TEST_F(StudySubjects, AreNotToldFromTheSceneInTwoPictures) {
  draw("pair", 2, [](cv::Mat& frame, int k) { frame(cv::Rect(4 + 90 * k, 40, 16, 16)) = 250; });
  expect_says(study("pair", {}).err, {"two pictures cannot tell what moves from the scene at rest"});
}

TEST_F(StudySubjects, MayBeTiny) {
  draw("tiny", 20, [](cv::Mat& frame, int k) { frame(cv::Rect(4 + 7 * k, 40, 3, 3)) = 250; });
  expect_moments_before(20, "tiny");
  EXPECT_EQ(moments_of("tiny", "--style frozen").size(), 1u);
}

// A block stands for most of the time, so that the background has it: a hole stays while it is gone, until something is
// seen elsewhere. A small square goes before.
TEST_F(StudySubjects, AreNoHolesThatStay) {
  draw("hole", 60, [](cv::Mat& frame, int k) {
    if (k < 34 || k >= 58) frame(cv::Rect(20, 60, 24, 24)) = 5;
    if (k >= 58) frame(cv::Rect(90, 50, 24, 24)) = 250;
    if (k < 12) frame(cv::Rect(4 + 3 * k, 16, 8, 8)) = 220;
  });
  expect_moments_before(12, "hole");
}

// A soft shade goes further than a small square did.
TEST_F(StudySubjects, AreNoShades) {
  draw("shade", 40, [](cv::Mat& frame, int k) {
    if (k < 14) frame(cv::Rect(4 + 2 * k, 6, 8, 8)) = 200;
    for (int y = 0; k >= 22 && y < frame.rows; ++y) {
      for (int x = 0; x < frame.cols; ++x) {
        auto& code = frame.at<std::uint8_t>(y, x);
        code = cv::saturate_cast<std::uint8_t>(code * std::min(0.5 + std::hypot(x - 9 * (k - 22), y - 56) / 56, 1.0));
      }
    }
  });
  expect_moments_before(14, "shade");
}

// A block crosses the picture; where it left, its edge flickers for longer than it was there, and so does a lamp.
TEST_F(StudySubjects, AreNotWhatIsFollowedOnWhenTheyHaveLeft) {
  draw("scraps", 60, [](cv::Mat& frame, int k) {
    if (k < 12) frame(cv::Rect(4 + 12 * k, 30, std::min(30, 156 - 12 * k), 30)) = 5;
    if (k >= 12 && k % 2 == 0) frame(cv::Rect(146, 40, 3, 12)) = frame(cv::Rect(146, 40, 12, 3)) = 5;
    if (k >= 12 && k % 3 != 0) frame(cv::Rect(20, 80, 40, 8)) = 250;
  });
  expect_moments_before(12, "scraps");
}

}  // namespace
}  // namespace nutik::test
