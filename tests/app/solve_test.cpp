// Gains and times that are found for wishes, as a user asks for them.
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "support/app_test.hpp"

namespace nutik::test {
namespace {

constexpr int kSceneWidth = 96, kSceneHeight = 48;
// The paper's Figure 14, M0, with a name in place of its -25.
constexpr const char* kFigure14 =
    "# the trail, and the ball at rest\n"
    "M0{[0:0], [1:1], [1000000000:1], [1000000002:rest], [1010000000:rest], [1010000001:0]}\n";

// 1.2 s at 100 pictures a second: a ball (a square) that goes from left to right for 0.75 s and then rests at
// kRest, where nothing was before: 0.25 s of the second that the trail is exposed for.
class Solve : public AppTest {
 protected:
  static constexpr int kRest = 70, kTop = 20, kSide = 10;
  static constexpr const char* kAtRest = "72,22,6,6";

  void SetUp() override {
    std::filesystem::create_directory(scratch_ / "frames");
    for (int k = 0; k < 120; ++k) {
      cv::Mat frame(kSceneHeight, kSceneWidth, CV_8UC1);
      for (int y = 0; y < kSceneHeight; ++y) {
        for (int x = 0; x < kSceneWidth; ++x)
          frame.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(60 + x / 2 + y);
      }
      frame(cv::Rect(k < 75 ? 2 + 3 * k / 4 : kRest, kTop, kSide, kSide)) = 210;
      cv::imwrite((scratch_ / ("frames/" + std::to_string(1000 + k) + ".pgm")).string(), frame);
    }
    make("-f 100 frames clip.tik");
    scratch_.write("figure14.fn", kFigure14);
  }

  [[nodiscard]] json solved(const Words& words) const {
    const auto result = make("solve --json --overwrite" + words);
    return result.status == 0 ? json::parse(result.out) : json();
  }
  // What the first wish got.
  [[nodiscard]] static double mean_light(const json& answer) { return answer["wishes"][0]["reached"][0]; }
  // The mean light of a rectangle of a picture of light.
  [[nodiscard]] double mean(const char* name, const cv::Rect& at) const { return cv::mean(picture(name)(at))[0]; }
};

TEST_F(Solve, FindsThePapersGainForTheBallAtRest) {
  for (const char* wish : {"72,22,6,6 gone", "72,22,6,6 gone at 0s", "70,20,10,10 gone at 0.1s..0.2s"}) {
    const json answer = solved({"-k", "figure14.fn", "--wish", wish, "clip.tik", "-o", "solved.fn"});
    EXPECT_NEAR(answer["gains"]["rest"].get<double>(), -25, 1e-5) << wish;
    EXPECT_TRUE(answer["kept"]) << answer;
    EXPECT_EQ(answer["tried_exposures"], 1);
  }
  // It begins at -100, which takes away as much as the trail adds: nothing to divide by.
  const json from_nothing = solved({"-k", "figure14.fn", "--normalize", "integral", "--free", "rest=-200..0",
                                    "--wish", "72,22,6,6 gone at 0s", "clip.tik", "-o", "integral.fn"});
  EXPECT_NEAR(from_nothing["gains"]["rest"].get<double>(), -25, 1e-5);
  EXPECT_TRUE(from_nothing["kept"]) << from_nothing;

  // The ball is gone from the picture: there it has what the same functions make of the empty scene.
  make("-k solved.fn clip.tik picture.pfm");
  make("--start 0s --exposure 1f clip.tik empty.pfm");
  const cv::Rect rest(kRest, kTop, kSide, kSide), beside(kRest, 0, kSide, kSide);
  const double still_gain = mean("picture.pfm", beside) / mean("empty.pfm", beside);
  EXPECT_NEAR(still_gain, 0.742574, 1e-5) << "the paper's";
  EXPECT_NEAR(mean("picture.pfm", rest), still_gain * mean("empty.pfm", rest), 1e-6);
  EXPECT_EQ(file("solved.fn").substr(0, 34), std::string(kFigure14).substr(0, 34))
      << "the rest of the file is as it was";
}

TEST_F(Solve, ReachesConstructedWishes) {
  // What a known exposure has is wished for; regions with different courses of light.
  scratch_.write("known.fn", "M0{[0:0.3], [300000000:1.7], [800000000:-0.6], [1200000000:0.25]}");
  scratch_.write("named.fn", "M0{[0:a], [300000000:b], [800000000:c], [1200000000:d]}");
  make("-k known.fn clip.tik known.pfm");
  Words words("-k named.fn clip.tik -o solved.fn");
  std::vector<double> wanted;
  for (const int x : {0, 12, 30, 50, 71}) {
    wanted.push_back(mean("known.pfm", {x, kTop, 8, 8}));
    words.insert(words.end(), {"--wish", std::to_string(x) + ",20,8,8 = " + std::to_string(wanted.back())});
  }
  const json answer = solved(words);
  const double tolerance = 1e-6;  // of which to_string() takes the half
  for (std::size_t i = 0; i < wanted.size(); ++i)
    EXPECT_NEAR(answer["wishes"][i]["reached"][0].get<double>(), wanted[i], tolerance) << i;
  make("-k solved.fn clip.tik solved.pfm");
  EXPECT_NEAR(mean("solved.pfm", {50, kTop, 8, 8}), wanted[3], tolerance);
}

TEST_F(Solve, ExposesRegionsAsTheyAreWished) {
  make("mask --size 96x48 --tag 5 --rectangle 0,0,48,48 -o mask.pgm");
  make("mask --size 96x48 --tag 9 --ellipse 75,25,4,4 -o marks.pgm");
  scratch_.write("two.fn",
                 "M0{[0:0], [1:a], [500000000:a], [500000001:0]}\nM5{[0:b], [1000000000:b], [1000000001:0]}");
  const json answer =
      solved({"-k", "two.fn", "-m", "mask.pgm", "--regions", "marks.pgm", "--wish", "R9 = 0.25", "--wish",
              "M5 within 0,0,40,10 = 2 * M0 within 60,0,20,10", "clip.tik", "-o", "s.fn"});
  EXPECT_TRUE(answer["kept"]) << answer;
  make("-k s.fn -m mask.pgm clip.tik s.pfm");
  EXPECT_NEAR(mean("s.pfm", {0, 0, 40, 10}), 2 * mean("s.pfm", {60, 0, 20, 10}), 1e-6);
  EXPECT_NEAR(answer["wishes"][0]["reached"][0].get<double>(), 0.25, 1e-6);
}

TEST_F(Solve, SaysWhatIsSaturated) {
  const auto said = [&](const std::string& light) {
    return run({"solve", "--overwrite", "-k", "figure14.fn", "--wish", "70,20,10,10 = " + light, "clip.tik", "-o",
                "solved.fn"})
        .out;
  };
  expect_says(said("0.9"), "\nthe picture: no pixel below 0 or above 1\n");
  expect_says(said("1.5"), "\nthe picture: 100 pixels saturated above 1\n");
  const auto black =
      run({"solve", "--overwrite", "-k", "figure14.fn", "--wish", "72,22,6,6 = -1", "clip.tik", "-o", "solved.fn"});
  expect_says(black.err, "pixels come out below 0, which is black: bound the gains");
}

TEST_F(Solve, ComparesWithAnIntervalUpToTheCapturesEnd) {
  const json answer =
      solved({"-k", "figure14.fn", "--wish", "72,22,6,6 like 0.9s..1.2s", "clip.tik", "-o", "solved.fn"});
  make("--start 0.9s --exposure 0.3s clip.tik rest.pfm");
  EXPECT_NEAR(mean_light(answer), mean("rest.pfm", {72, 22, 6, 6}), 1e-6);
}

TEST_F(Solve, LooksForTimes) {
  // When 10 ms show the ball within its place at rest, and not elsewhere.
  scratch_.write("moved.fn", "M0{[when-1:0], [when:1], [when+10000000:1], [when+10000001:0]}");
  const Words words{"-k",       "moved.fn", "--wish", "70,20,10,10 like 0.9s", "--wish", "10,20,10,10 like 0s..0.02s",
                    "clip.tik", "-o",       "s.fn"};
  const json steps = solved(words + "--free when=0f..110f/1f");
  EXPECT_EQ(steps["tried_exposures"], 111);
  EXPECT_GE(steps["times_ns"]["when"], 750'000'000);
  EXPECT_EQ(steps["times_ns"]["when"].get<std::int64_t>() % 10'000'000, 0);

  // Half of the ball's light: half of the exposure lies behind the moment at which it comes to rest.
  const double rest = mean_light(steps);
  make("--start 0s --exposure 1f clip.tik empty.pfm");
  const double half = (rest + mean("empty.pfm", {kRest, kTop, kSide, kSide})) / 2;
  const json between = solved({"-k", "moved.fn", "--free", "when=0.5s..1s", "--wish",
                               "70,20,10,10 = " + std::to_string(half), "clip.tik", "-o", "s.fn"});
  EXPECT_NEAR(between["times_ns"]["when"].get<double>(), 745'000'000, 1e5);
  EXPECT_NEAR(between["wishes"][0]["reached"][0].get<double>(), half, 1e-6);
}

TEST_F(Solve, TellsWhatCannotBeKept) {
  const auto result =
      make({"solve", "-k", "figure14.fn", "--free", "rest=-20..0", "--wish", "72,22,6,6 gone", "clip.tik"});
  expect_says(result.err, "not all wishes could be kept");
  expect_says(result.err, "; rest came to an end of its range (--free): what lies beyond may come nearer");
  expect_says(result.out, {"figure14-solved.fn: rest = -20;",
                           "try: nutik-cl -k figure14-solved.fn clip.tik picture.png"});

  scratch_.write("more.fn",
                 "M0{[0:0], [1:1], [1000000000:1], [1000000002:rest], [1010000000:rest], [1010000001:0],\n"
                 "   [1500000000:0], [2000000000:late], [3000000000:0]}");
  const auto untold = make({"solve", "-k", "more.fn", "--wish", "72,22,6,6 gone", "clip.tik"});
  expect_says(untold.err, "no wish depends on late; it stays where it began, at 1");
}

TEST_F(Solve, NamesTheTimesThatCameToAnEndOfTheirRange) {
  scratch_.write("moved.fn", "M0{[when-1:0], [when:1], [when+10000000:1], [when+10000001:0]}");
  const auto at_ends = [&](const std::string& range) {
    return solved({"-k", "moved.fn", "--wish", "70,20,10,10 like 0.9s", "--free", "when=" + range, "clip.tik", "-o",
                   "s.fn"})["at_ends"];
  };
  EXPECT_EQ(at_ends("0.1s..0.3s"), json({"when"}));
  EXPECT_EQ(at_ends("0.1s..0.8s"), json::array());
}

TEST_F(Solve, SaysWhatMakesNoSense) {
  scratch_.write("plain.fn", "M0 [0:1], [1000000000:1], [1000000001:0]");
  scratch_.write("bad.fn", "M0 [0:a.b], [5:0]");
  scratch_.write("moved.fn", "M0{[when:1], [when+10000000:1], [when+10000001:0]}");
  const auto refused = [&](const Words& words, int status, std::string_view part) {
    expect_refused("solve" + words + "clip.tik", status, part);
  };
  refused({"--wish", "all = 1"}, 2, "solve needs gain functions");
  refused({"-k", "figure14.fn"}, 2, "what is wished? Add --wish");
  refused({"-k", "plain.fn", "--wish", "all = 1"}, 2, "plain.fn leaves nothing to be found");
  refused({"-k", "bad.fn", "--wish", "all = 1"}, 3, "bad.fn:1:7: 'a.b' is neither a number nor a name");
  refused({"-k", "figure14.fn", "--wish", "sky = 1"}, 2,
          "the wish 'sky = 1': 'sky' where a region should stand");
  refused({"-k", "figure14.fn", "--wish", "all is 1"}, 2, "'is' where =, <=, >=, like or gone should stand");
  refused({"-k", "figure14.fn", "--wish", "all like 0.5"}, 2, "behind like, which compares colours");
  refused({"-k", "figure14.fn", "--wish", "all = 0.5 now"}, 2, "'now' behind the wish");
  refused({"-k", "figure14.fn", "--wish", "all = "}, 2, "its end where light should stand");
  refused({"-k", "figure14.fn", "--wish", "M0 gone"}, 2, "add -m mask.pgm");
  refused({"-k", "figure14.fn", "--wish", "R1 gone"}, 2, "add --regions mask.pgm");
  refused({"-k", "figure14.fn", "--wish", "90,20,10,10 gone"}, 2,
          "90,20,10,10 does not lie in the picture, which has 96 x 48");
  refused({"-k", "figure14.fn", "--wish", "all like 2s"}, 2, "lies outside the capture, which lasts 1.2 s");
  for (const char* interval : {"0.5s..1.3s", "0.6s..0.5s", "0.9s..0.9s"}) {
    refused({"-k", "figure14.fn", "--wish", std::string("all like ") + interval}, 2,
            interval + std::string(" is no interval of the capture, which lasts 1.2 s"));
  }
  refused({"-k", "figure14.fn", "--wish", "all = 1", "--free", "best=0..1"}, 2,
          "no function has the name 'best'; there are rest");
  refused({"-k", "figure14.fn", "--wish", "all = 1", "--free", "rest=1..0"}, 2, "FROM must not be above TO");
  refused({"-k", "moved.fn", "--wish", "all = 1"}, 2, "say when it may be: --free when=0.6s..0.8s");
  refused({"-k", "moved.fn", "--wish", "all = 1", "--free", "when=0s..2s"}, 2, "does not lie in the capture");
  refused({"-k", "moved.fn", "--wish", "all = 1", "--free", "when=0s..1s/1ns"}, 2,
          "more than 1000000 combinations");
  refused({"-k", "figure14.fn", "--wish", "all = 1", "-o", "figure14.fn"}, 2, "is also an input");
  refused({"-k", "figure14.fn", "--wish", "all = 1", "-o", "solved.txt"}, 2,
          "gain functions are written as .fn");
  refused({"-k", "figure14.fn", "--wish", "72,22,6,6 gone", "--memory", "10kB"}, 2, "uncertain places");
  // A region of one function: of 120 samples the light, and of a block of them how it changes.
  refused({"-k", "figure14.fn", "--wish", "72,22,6,6 gone at 0s", "--memory", "10kB"}, 2, "light of regions");
  EXPECT_FALSE(exists("figure14-solved.fn"));
}

}  // namespace
}  // namespace nutik::test
