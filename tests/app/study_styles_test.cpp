// Styles and trails of motion studies, how faint a subject they find, and how softly it ends.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/imgproc.hpp>

#include "support/drawn_clip.hpp"
#include "support/study_test.hpp"

namespace nutik::test {
namespace {

using StudyChoices = StudyTest;

// A square that goes its way over a texture after six empty pictures: 7 pixels to the right from one to the next.
class StudyStyles : public StudyTest {
 protected:
  static constexpr int kTop = 40, kSide = 12, kEmpty = 6, kMoving = 20;

  StudyStyles() {
    DrawnClip clip(scratch_ / "way");
    for (int k = 0; k < kEmpty + kMoving; ++k) {
      cv::Mat frame = ground_of(7);
      if (k >= kEmpty) frame(cv::Rect(left(k), kTop, kSide, kSide)) = 250;
      clip.add(frame);
    }
  }

  static int left(int picture) { return 4 + 7 * (picture - kEmpty); }

  // By how much the study differs from the scene without the square.
  [[nodiscard]] cv::Mat difference(const Words& words) const {
    make("study -f 100 way -o styled.png" + words);
    cv::Mat difference;
    cv::subtract(picture("styled.png"), ground_of(7), difference, {}, CV_16S);
    return difference;
  }
  // An sRGB code's light.
  static double light_of(int code) {
    const double share = code / 255.0;
    return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
  }
  // On the square's way, on average.
  static double trail(const cv::Mat& difference, int from, int to) {
    return cv::mean(difference(cv::Rect(from, kTop + 2, to - from, kSide - 4)))[0];
  }
  static bool shows_square(const cv::Mat& difference, int picture) {
    cv::Mat shown;
    cv::add(ground_of(7), difference, shown, {}, CV_16S);
    const cv::Mat inner = shown(cv::Rect(left(picture) + 2, kTop + 2, kSide - 4, kSide - 4));
    return cv::countNonZero(cv::abs(inner - 250) > 1) == 0;
  }
};

// Moments are pictures that were filmed, and the trail is exposed from what was made between them: as it is asked for,
// or by itself where copies of a thing lie apart.
TEST_F(StudyStyles, JoinTheTrailBetweenPictures) {
  constexpr int kStep = 14;
  const auto left_of = [](int picture) { return 4 + kStep * picture; };
  const auto drawn = [&](int picture, int wide) {
    cv::Mat frame = ground_of(7) / 8 + 40;
    cv::Mat thing = ground_of(3)(cv::Rect(0, 0, wide, wide)) / 4 + 170;
    thing.copyTo(frame(cv::Rect(left_of(picture), kTop, wide, wide)));
    return frame;
  };
  const int last = (ground_of(7).cols - 20 - 4) / kStep;
  for (const auto& [wide, between] : {std::pair(20, " --between auto"), {8, ""}}) {
    SCOPED_TRACE(wide);
    DrawnClip clip(scratch_ / format("fast{}", wide));
    for (int k = 0; k <= last; ++k) clip.add(drawn(k, wide));
    const std::string asked = format("study -f 100 fast{} --moments 1f,{}f --trail even --overwrite", wide, last);
    make(asked + " --between off -o filmed.png");
    const std::string told = make(asked + between + " --json -o made.png").out;
    expect_says(told, format(R"("sample": {})", last));
    EXPECT_EQ(told.find(format("the subject goes {} pixels", kStep)) != told.npos, between == std::string_view())
        << told;
    EXPECT_EQ(told.find("join its trail, but for ") != told.npos, between == std::string_view()) << told;
    // How much the trail changes from column to column, away from the moments.
    const auto ripple = [&](const char* name) {
      cv::Mat columns, deviation, mean;
      const int from = left_of(3), to = left_of(last - 2);
      cv::reduce(picture(name)(cv::Rect(from, kTop + 2, to - from, wide - 4)), columns, 0, cv::REDUCE_AVG, CV_64F);
      cv::meanStdDev(columns, mean, deviation);
      return deviation.at<double>(0);
    };
    EXPECT_LT(ripple("made.png"), 0.5 * ripple("filmed.png"));
    for (const int moment : {1, last}) {
      const cv::Rect inner(left_of(moment) + 2, kTop + 2, wide - 4, wide - 4);
      EXPECT_LE(cv::norm(picture("made.png")(inner), drawn(moment, wide)(inner), cv::NORM_INF), 1) << moment;
    }
    const std::string by_hand = file("made.txt");
    expect_says(by_hand, between == std::string_view() ? format("--between auto:0f..{}f", last) : "--between auto");
    EXPECT_EQ(by_hand.find("--between"), by_hand.rfind("--between")) << "of the picture, not of the mask:\n" << by_hand;
    expect_made_again("made.png");
  }
  // A scene in which nothing goes anywhere is one long exposure, with samples between its pictures or without.
  DrawnClip still(scratch_ / "still");
  for (int k = 0; k < 12; ++k) still.add(ground_of(7));
  make("study -f 100 still --between auto -o still.png");
  expect_says(run(format("study -f 100 fast20 --moments 1f,{}f --trail even --overwrite", last)).err,
              format("a row of copies, {} pixels apart", kStep));
}

TEST_F(StudyStyles, HaveNoStepAlongRegionsEdges) {
  for (const char* style : {"trail", "strobe", "rear-curtain", "frozen"}) {
    const cv::Mat is = difference({"--style", style});
    // Beside the way nothing ever moved; regions reach into that.
    const cv::Mat mask = picture("styled.pgm");
    EXPECT_GT(cv::countNonZero(mask.row(kTop - 2)), 0) << style;
    int most = 0;
    for (int y = 0; y + 1 < is.rows; ++y) {
      if (y + 1 >= kTop && y < kTop + kSide) continue;
      for (int x = 0; x + 1 < is.cols; ++x) {
        const int here = is.at<short>(y, x);
        most = std::max(
            {most, std::abs(here - is.at<short>(y, x + 1)), std::abs(here - is.at<short>(y + 1, x))});
      }
    }
    EXPECT_LE(most, 2) << style;
  }
}

TEST_F(StudyStyles, ShowWhatTheirNamesSay) {
  const cv::Mat strobe = difference("--style strobe --moments 8f,22f");
  EXPECT_TRUE(shows_square(strobe, 8) && shows_square(strobe, 22));
  EXPECT_NEAR(trail(strobe, 50, 100), 0, 1) << "nothing between the moments";

  const cv::Mat curtain = difference("--style rear-curtain");
  EXPECT_TRUE(shows_square(curtain, kEmpty + kMoving - 1));
  EXPECT_GT(trail(curtain, 90, 120), 2 * trail(curtain, 20, 50)) << "the trail grows towards it";

  const cv::Mat frozen = difference("--style frozen --moments 15f");
  EXPECT_TRUE(shows_square(frozen, 15));
  EXPECT_GT(trail(frozen, 20, 50), 5);
  EXPECT_NEAR(trail(frozen, 20, 50), trail(frozen, 90, 120), 0.2 * trail(frozen, 20, 50)) << "and goes on";
}

TEST_F(StudyStyles, HaveTheTrailThatIsNamed) {
  const auto early_and_late = [&](const char* shape) {
    const cv::Mat is = difference({"--moments", "15f", "--trail", shape});
    EXPECT_TRUE(shows_square(is, 15)) << shape;
    return std::pair(trail(is, 20, 50), trail(is, 90, 120));
  };
  const auto even = early_and_late("even"), fade = early_and_late("fade"), ramp = early_and_late("ramp"),
             none = early_and_late("none");
  EXPECT_GT(even.first, 5);
  EXPECT_NEAR(even.first, even.second, 0.2 * even.first);
  EXPECT_GT(fade.first, 2 * fade.second);
  EXPECT_GT(ramp.second, 2 * ramp.first);
  EXPECT_NEAR(none.first, 0, 1);
  EXPECT_NEAR(none.second, 0, 1);
}

// A region whose edge lies 6 pixels outside the square shows half of the trail there; one at 2 shows all of it.
TEST_F(StudyStyles, AreBlendedAsFarAsIsStated) {
  const auto beside = [&](const char* feather) {
    const cv::Mat is = difference({"--moments", "15f", "--feather", feather});
    EXPECT_TRUE(shows_square(is, 15)) << feather;
    double light = 0;  // beyond the ground's
    for (int y = kTop + 2; y < kTop + kSide - 2; ++y) {
      for (int x = left(15) + kSide + 5; x < left(15) + kSide + 7; ++x) {
        const int ground = ground_of(7).at<std::uint8_t>(y, x);
        light += light_of(ground + is.at<short>(y, x)) - light_of(ground);
      }
    }
    return light;
  };
  const double narrow = beside("2px"), wide = beside("6px");
  EXPECT_GT(narrow, 0);
  EXPECT_NEAR(wide, narrow / 2, narrow / 10);
  for (const auto& [style, feather] : {std::pair("trail", "6px"), std::pair("trail", "0px"),
                                       std::pair("trail", "3.51px"), std::pair("slit", "M1=4px")}) {
    make({"study", "-f", "100", "way", "--moments", "2", "--style", style, "--feather", feather, "-o", "study.png"});
    expect_the_same_by_hand(std::string(style) + " " + feather);
  }
  for (const auto& [words, why] :
       {std::pair("--feather 33px", "the feather of a study reaches 32 pixels at most"),
        std::pair("--feather M1=6px", "the feather of a study is one width"),
        std::pair("--style clean --feather 6px", "--feather says nothing to --style clean"),
        std::pair("--style slit --by 6", "--by says nothing to --style slit")}) {
    expect_refused("study -f 100 way -o no.png" + Words(words), 2, why);
  }
}

// A square that is 10 codes brighter than the scene: 16 are the usual threshold.
TEST_F(StudyChoices, FindsWhatDiffersByAsMuchAsIsStated) {
  DrawnClip clip(scratch_ / "faint");
  for (int k = 0; k < 20; ++k) {
    cv::Mat frame = ground_of(7);
    const cv::Rect square(4 + 7 * k, 40, 12, 12);
    frame(square) += 10;
    clip.add(frame);
  }
  const Words study("study -f 100 faint -o study.png");
  const auto unseen = make(study);
  expect_mean_of_all("-f 100 faint", 20, "study");
  expect_says(unseen.err, "nothing moves: no part of it differs from the rest of the time by more than 16 codes");
  make(study + "--by 6 --moments 2f,15f");
  const cv::Mat mask = picture("study.pgm");
  EXPECT_EQ(cv::countNonZero(mask(cv::Rect(4 + 7 * 2, 40, 12, 12)) != 1), 0);
  EXPECT_EQ(cv::countNonZero(mask(cv::Rect(4 + 7 * 15, 40, 12, 12)) != 2), 0);
  expect_the_same_by_hand("--by 6");
  expect_refused(2,
                 {{study + "--by 255", "faint: no codes differ by more than 255, for white is 255; state fewer codes"},
                  {study + "--by 0", "--by '0'"}});
}

}  // namespace
}  // namespace nutik::test
