// Samples made between two pictures: their times, and what they show against the same scene drawn at these times.
#include "align/between.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <thread>

#include "capture/error.hpp"
#include "support/clips.hpp"

namespace nutik::between_test {
namespace {

constexpr std::uint32_t kWidth = 320, kHeight = 192;

// Draws a sample: a grey code of each pixel at a time, counted in pictures.
using Scene = std::function<double(double x, double y, double time)>;

double ground_at(double x, double y) {
  return 0.35 + 0.1 * std::sin(0.31 * x + 0.07 * y) * std::cos(0.23 * y) + 0.05 * std::sin(0.83 * x - 0.57 * y);
}

// A textured disc that flies across, ten pixels a picture and then more.
double disc_at(double x, double y, double time) {
  const double u = x - (60 + 14 * time), v = y - (90 - 6 * time + 1.0 * time * time);
  return std::hypot(u, v) < 26 ? 0.7 + 0.15 * std::sin(0.4 * u) * std::cos(0.35 * v) : ground_at(x, y);
}

CaptureFormat format() {
  return {.shape = {kWidth, kHeight, 1}, .code_bytes = 1, .white_code = 255, .transfer = Transfer::srgb()};
}

std::vector<std::byte> drawn(const Scene& scene, double time, double noise = 0, unsigned seed = 0) {
  std::mt19937 random(seed);
  std::normal_distribution<double> error(0, 1);
  std::vector<std::byte> raster(format().sample_bytes());
  for (std::size_t i = 0; i < raster.size(); ++i) {
    // Four places a pixel, so that edges are soft.
    double sum = 0;
    for (const double dx : {-0.25, 0.25}) {
      for (const double dy : {-0.25, 0.25})
        sum += scene(static_cast<double>(i % kWidth) + dx, static_cast<double>(i / kWidth) + dy, time);
    }
    const double code = 255 * sum / 4 + noise * error(random);
    raster[i] = static_cast<std::byte>(std::lround(std::clamp(code, 0.0, 255.0)));
  }
  return raster;
}

std::vector<std::vector<std::byte>> filmed(const Scene& scene, int count) {
  std::vector<std::vector<std::byte>> pictures;
  for (int k = 0; k < count; ++k) pictures.push_back(drawn(scene, k));
  return pictures;
}

class DrawnClip final : public Clip {
 public:
  explicit DrawnClip(std::vector<std::vector<std::byte>> pictures) : pictures_(std::move(pictures)) {
    info_.format = format();
    info_.sample_count = pictures_.size();
  }
  [[nodiscard]] const ClipInfo& info() const override { return info_; }
  bool read(std::span<std::byte> raster) override {
    if (next_ == pictures_.size()) return false;
    std::ranges::copy(pictures_[next_++], raster.begin());
    return true;
  }

 private:
  std::vector<std::vector<std::byte>> pictures_;
  ClipInfo info_;
  std::size_t next_ = 0;
};

ClipToAlign clip_of(const std::vector<std::vector<std::byte>>& pictures) {
  test::use_modules();
  return {"drawn", format(), pictures.size(), 0, [pictures] { return std::make_unique<DrawnClip>(pictures); }};
}

MadeSamples planned(const ClipToAlign& clip, std::optional<std::uint32_t> each = std::nullopt) {
  return plan_between(clip, {.each = each}, std::uint64_t{1} << 32, {}, {});
}

std::vector<std::vector<std::byte>> filled(const ClipToAlign& clip, const MadeSamples& made) {
  return test::read_all(*open_between(clip, Shared(made)));
}

// A long exposure of a scene that was filmed so many times: its error beside that of straight lines from picture to
// picture.
double share_of_error(const Scene& scene, int count, const MadeSamples& made,
                      const std::vector<std::vector<std::byte>>& samples) {
  const std::vector<bool> marks = made.marks();
  std::vector<double> shown(format().sample_bytes()), truth(shown), line(shown);  // sums over all times
  std::size_t i = 0;
  for (int picture = 0; picture < count; ++picture) {
    const auto before = drawn(scene, picture), after = drawn(scene, picture + 1);
    EXPECT_EQ(samples[i++], before) << "filmed";
    const int steps = made.after[static_cast<std::size_t>(picture)] + 1;
    for (int step = 1; step < steps; ++step, ++i) {
      EXPECT_TRUE(marks[i]);
      const double share = static_cast<double>(step) / steps;
      const auto drawn_then = drawn(scene, picture + share);
      for (std::size_t p = 0; p < truth.size(); ++p) {
        const auto code = [p](const auto& raster) { return std::to_integer<int>(raster[p]); };
        shown[p] += code(samples[i]);
        truth[p] += code(drawn_then);
        line[p] += (1 - share) * code(before) + share * code(after);
      }
    }
  }
  const auto error = [&](const std::vector<double>& sums) {
    double squares = 0;
    for (std::size_t p = 0; p < truth.size(); ++p) squares += (sums[p] - truth[p]) * (sums[p] - truth[p]);
    return std::sqrt(squares);
  };
  return error(shown) / error(line);
}

TEST(Between, ShowsWhatFliesWhereItIsAtThatTime) {
  auto pictures = filmed(disc_at, 5);
  const ClipToAlign clip = clip_of(pictures);
  const MadeSamples made = planned(clip);
  // 14 to 15 pixels a picture: steps of 0.7 to 1.4.
  EXPECT_EQ(made.after, (std::vector<std::uint8_t>{15, 15, 15, 15, 0}));
  EXPECT_LT(made.unfollowed, made.changed / 3) << made.text();
  const auto samples = filled(clip, made);
  ASSERT_EQ(samples.size(), made.total());
  // Light on a trail: a row of discs where it goes in straight lines.
  EXPECT_LT(share_of_error(disc_at, 4, made, samples), 0.5);
}

TEST(Between, ArePlannedBetweenThePicturesThatAreNamed) {
  auto pictures = filmed(disc_at, 5);
  const auto planned_by = [&](std::string_view text) {
    const auto request = parse_between(text);
    EXPECT_EQ(request->text(), text);
    return plan_between(clip_of(pictures), *request, std::uint64_t{1} << 32, {}, {}).after;
  };
  EXPECT_EQ(planned_by("auto:1f..3f"), (std::vector<std::uint8_t>{0, 15, 15, 0, 0}));
  EXPECT_EQ(planned_by("2:0f..1f"), (std::vector<std::uint8_t>{2, 0, 0, 0, 0}));
  EXPECT_EQ(planned_by("2:3f..9f"), (std::vector<std::uint8_t>{0, 0, 0, 2, 0}));
  EXPECT_THROW(planned_by("auto:4f..9f"), UsageError) << "behind the last pair";
  EXPECT_FALSE(parse_between("off"));
  for (const char* text : {"auto:", "auto:1f", "auto:3f..3f", "auto:4f..3f", "2:1..3", "0:1f..3f", "64", "auto:1f..3ff",
                           "off:1f..3f", "auto:1s..3s", "auto:-1f..3f"})
    EXPECT_THROW(static_cast<void>(parse_between(text)), UsageError) << text;
}

// A ball of ten pixels that goes five times as far from picture to picture, on a parabola.
double ball_at(double x, double y, double time) {
  const double u = x - (30 + 52 * time), v = y - (150 - 60 * time + 12 * time * time);
  return std::hypot(u, v) < 5 ? 0.85 : ground_at(x, y);
}

TEST(Between, FollowsSmallThingsThatFlyFurtherThanTheyAreLarge) {
  auto pictures = filmed(ball_at, 6);
  const ClipToAlign clip = clip_of(pictures);
  const MadeSamples made = planned(clip);
  // 59 to 79 pixels a picture: steps of 0.9 to 1.2.
  EXPECT_EQ(made.after, (std::vector<std::uint8_t>{63, 63, 63, 63, 63, 0}));
  EXPECT_LT(made.unfollowed, made.changed / 3) << made.text();
  const MadeSamples few = planned(clip, 15);
  const auto samples = filled(clip, few);
  ASSERT_EQ(samples.size(), few.total());
  EXPECT_LT(share_of_error(ball_at, 5, few, samples), 0.25);
}

TEST(Between, LetsNothingFlyOfWhatVanishes) {
  // Two lamps that go out while another, larger one goes on: none flies to another.
  std::vector<std::vector<std::byte>> pictures;
  for (int k = 0; k < 4; ++k) {
    pictures.push_back(drawn(
        [k](double x, double y, double) {
          const auto shines = [&](double at_x, double at_y, double radius) {
            return std::hypot(x - at_x, y - at_y) < radius;
          };
          const bool is_on = k < 2 ? shines(60, 60, 5) || shines(60, 130, 5) : shines(240, 90, 11);
          return is_on ? 0.9 : ground_at(x, y);
        },
        0));
  }
  EXPECT_EQ(planned(clip_of(pictures)).count(), 0U);
}

// It gains 6 pixels a picture: in the middle it is 0.75 pixels from where a straight way would have it.
TEST(Between, BendsWaysAsThePicturesRoundThemShow) {
  const Scene falls = [](double x, double y, double time) {
    const double u = x - (60 + 8 * time + 3 * time * time), v = y - 90;
    const double spot = std::exp(-(std::pow(u - 8, 2) + std::pow(v + 6, 2)) / 60);
    return std::hypot(u, v) < 26 ? 0.65 + 0.2 * spot : ground_at(x, y);
  };
  // Of the disc, without its edge.
  const auto error = [&](int first, int last) {
    std::vector<std::vector<std::byte>> pictures;
    for (int k = first; k <= last; ++k) pictures.push_back(drawn(falls, k));
    const ClipToAlign clip = clip_of(pictures);
    const auto made = filled(clip, planned(clip, 1)).at(static_cast<std::size_t>(2 * (1 - first) + 1));
    const auto truth = drawn(falls, 1.5);
    double squares = 0;
    for (std::size_t p = 0; p < truth.size(); ++p) {
      if (std::hypot(static_cast<double>(p % kWidth) - 78.75, static_cast<double>(p / kWidth) - 90) > 20) continue;
      squares += std::pow(std::to_integer<int>(made[p]) - std::to_integer<int>(truth[p]), 2);
    }
    return std::sqrt(squares);
  };
  EXPECT_LT(error(0, 3), error(1, 2) / 3) << "four pictures, and two";
}

// Two alike that come towards each other, in steps a little shorter than they are large.
TEST(Between, LetsNothingFlyFromOneThingToAnother) {
  const Scene meet = [](double x, double y, double time) {
    for (const auto& [left, top] :
         {std::pair(40 + 38 * time, 60 + 13 * time), std::pair(280 - 38 * time, 70 + 15 * time)}) {
      if (std::hypot(x - left, y - top) < 22) return std::sin(0.8 * (x - left)) > 0 ? 0.9 : 0.75;
    }
    return ground_at(x, y);
  };
  auto pictures = filmed(meet, 3);
  const ClipToAlign clip = clip_of(pictures);
  const auto samples = filled(clip, planned(clip, 1));
  for (std::size_t k = 0; k < samples.size(); ++k) {
    for (std::uint32_t x = 140; x < 180; ++x) {
      const std::size_t pixel = 72 * kWidth + x;
      EXPECT_NEAR(std::to_integer<int>(samples[k][pixel]), std::to_integer<int>(pictures[0][pixel]), 8)
          << k << " " << x;
    }
  }
}

TEST(Between, KeepsWhatIsStillAsItIs) {
  std::vector<std::vector<std::byte>> pictures;
  for (unsigned k = 0; k < 4; ++k) pictures.push_back(drawn(disc_at, k, 2.0, k));
  const ClipToAlign clip = clip_of(pictures);
  const auto samples = filled(clip, planned(clip, 3));
  ASSERT_EQ(samples.size(), 13U);
  for (std::size_t i = 0; i < 12; ++i) {
    for (std::size_t y = 160; y < kHeight; ++y) {  // below what flies
      for (std::size_t x = 0; x < kWidth; ++x) {
        const std::byte code = samples[i][y * kWidth + x];
        const bool is_filmed = code == pictures[i / 4][y * kWidth + x] || code == pictures[i / 4 + 1][y * kWidth + x];
        ASSERT_TRUE(is_filmed) << "sample " << i << ", pixel " << x << "," << y;
      }
    }
  }
}

// A wall without texture beside a dark thing looks as if it moved along, and would hide the post.
TEST(Between, DragsNoStillGroundAlong) {
  const Scene passing = [](double x, double y, double time) {
    const bool is_passing = std::hypot(x - (60 + 14 * time), (y - 110) / 2) < 30;
    return is_passing ? 0.05 : std::abs(x - 146) < 2.5 ? 0.35 : y > 150 ? ground_at(x, y) : 0.8;
  };
  auto pictures = filmed(passing, 9);
  const ClipToAlign clip = clip_of(pictures);
  const MadeSamples made = planned(clip, 7);
  const auto samples = filled(clip, made);
  ASSERT_EQ(samples.size(), 65U);
  // 0.36 where the wall moves along.
  EXPECT_LT(share_of_error(passing, 8, made, samples), 0.3);
}

TEST(Between, MakesNothingWhereNothingMovesNorAcrossACut) {
  std::vector<std::vector<std::byte>> still, cut, flash, dissolve;
  const Scene other = [](double x, double y, double) { return ground_at(0.7 * y + 300, 1.3 * x - 80); };
  for (unsigned k = 0; k < 4; ++k) {
    still.push_back(drawn([](double x, double y, double) { return ground_at(x, y); }, 0, 3.0, k));
    cut.push_back(drawn(k < 2 ? Scene(disc_at) : other, k));
    flash.push_back(drawn([&](double x, double y, double) { return (k == 2 ? 1.6 : 1.0) * ground_at(x, y); }, 0));
    dissolve.push_back(drawn(
        [&](double x, double y, double) { return (3 - k) / 3.0 * ground_at(x, y) + k / 3.0 * other(x, y, 0); }, 0));
  }
  EXPECT_EQ(planned(clip_of(still)).count(), 0U);
  EXPECT_EQ(planned(clip_of(cut)).after[1], 0) << "across the cut";
  EXPECT_GT(planned(clip_of(cut)).after[0], 0) << "before it";
  EXPECT_EQ(planned(clip_of(cut), 7).after[1], 0) << "also where 7 are wanted";
  EXPECT_EQ(planned(clip_of(flash)).count(), 0U);
  EXPECT_EQ(planned(clip_of(dissolve)).count(), 0U);
}

// A ball flies on before squares that turn into others, too slowly for a cut.
TEST(Between, MakesNothingAcrossADissolve) {
  std::mt19937 random(5);
  std::vector<double> squares(2 * 27 * 16);
  for (double& light : squares) light = std::uniform_real_distribution(0.0, 0.2)(random);
  std::vector<std::vector<std::byte>> pictures;
  for (int k = 0; k < 18; ++k) {
    const double way = std::clamp((k - 3.0) / 10, 0.0, 1.0);
    const Scene mixed = [&](double x, double y, double time) {
      const auto square = static_cast<std::size_t>(y / 12) * 27 + static_cast<std::size_t>(x / 12);
      const double ball = std::hypot(x - 20 - 12 * time, y - 90) < 10 ? 0.15 : 0;
      return 0.3 + (1 - way) * squares[square] + way * (0.12 + ball + squares[squares.size() / 2 + square]);
    };
    pictures.push_back(drawn(mixed, k));
  }
  const std::vector<std::uint8_t> after = planned(clip_of(pictures)).after;
  EXPECT_EQ(std::vector(after.begin() + 3, after.begin() + 13), std::vector<std::uint8_t>(10));
  EXPECT_GT(std::ranges::max(after), 0) << "beside it";
}

TEST(Between, RefusesAClipWithoutPictures) { EXPECT_THROW((void)planned(clip_of({})), InputError); }

TEST(Between, MakesNothingOfWhatTrembles) {
  // As codecs leave it: faint parts of the picture lie three pixels beside their place, by turns, five codes apart.
  std::vector<std::vector<std::byte>> pictures;
  for (int k = 0; k < 4; ++k) {
    pictures.push_back(drawn(
        [k](double x, double y, double) {
          const bool trembles = k % 2 == 1 && std::hypot(x - 160, y - 90) < 50;
          const double u = x + (trembles ? 3 : 0);
          return 0.35 + 0.04 * std::sin(0.31 * u + 0.07 * y) * std::cos(0.23 * y);
        },
        0));
  }
  EXPECT_EQ(planned(clip_of(pictures)).count(), 0U);
}

TEST(Between, IsTheSameWhoeverComputesBeside) {
  auto pictures = filmed(disc_at, 3);
  const ClipToAlign clip = clip_of(pictures);
  const MadeSamples made = planned(clip);
  const auto alone = filled(clip, made);
  std::vector<std::vector<std::vector<std::byte>>> beside(4);
  {
    std::vector<std::jthread> threads;
    for (auto& each : beside) threads.emplace_back([&] { each = filled(clip, planned(clip)); });
  }
  for (const auto& each : beside) EXPECT_EQ(each, alone);
}

TEST(Between, PassesOverWhatIsSkipped) {
  auto pictures = filmed(disc_at, 3);
  const ClipToAlign clip = clip_of(pictures);
  const MadeSamples made = planned(clip, 3);
  const auto all = filled(clip, made);
  const auto some = open_between(clip, Shared(made));
  std::vector<std::byte> raster(format().sample_bytes());
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(some->skip(raster));
  ASSERT_TRUE(some->read(raster));
  EXPECT_EQ(raster, all[5]);
}

TEST(Between, RefusesAClipThatIsNotTheOneItPlannedFor) {
  auto pictures = filmed(disc_at, 3);
  const MadeSamples made = planned(clip_of(pictures), 1);
  for (const std::size_t count : {2U, 4U}) {
    pictures.resize(count, pictures.front());
    EXPECT_THROW(filled(clip_of(pictures), made), InputError);
  }
}

MadeSamples made_after(std::vector<std::uint8_t> after) { return {std::move(after), 10, 4}; }

TEST(MadeSamples, HaveTimesBetweenThoseFilmed) {
  const Timeline filmed = Timeline::constant({10, 1}, Rational{90, 1}, 3);  // 0 … 25 ms, 100 … 125 ms, 200 … 225 ms
  const MadeSamples made = made_after({1, 7, 0});
  const Timeline all = made.times(filmed);
  ASSERT_EQ(all.sample_count(), 11U);
  EXPECT_EQ(all.duration_ns(), filmed.duration_ns());
  // Halfway from one middle to the next, as long as a filmed one.
  EXPECT_EQ(all.start_ns(1), 50'000'000);
  EXPECT_EQ(all.end_ns(1), 75'000'000);
  // Middles 12.5 ms apart, so that none can be exposed for 25 ms: up to halfway.
  EXPECT_EQ(all.start_ns(2), 100'000'000);
  EXPECT_EQ(all.end_ns(2), 118'750'000);
  EXPECT_EQ(all.start_ns(3), 118'750'000);
  EXPECT_EQ(all.end_ns(3), 131'250'000);
  EXPECT_EQ(all.end_ns(10), 225'000'000);
  EXPECT_EQ(made_after({0, 0, 0}).times(filmed), filmed);
}

TEST(MadeSamples, AreKeptInAFile) {
  const MadeSamples made = made_after({3, 3, 3, 0, 0, 63, 0});
  EXPECT_EQ(made.kept_text(), "10 4 3*3 0*2 63*1 0*1");
  EXPECT_EQ(MadeSamples::parse(made.kept_text()), made);
  EXPECT_EQ(made.marks()[1], true);
  EXPECT_EQ(made.marks()[4], false);
  EXPECT_EQ(made.total(), made.marks().size());
  // A capture may be cut off within a pair, or behind a filmed sample.
  for (const auto& [samples, after] : std::map<std::uint64_t, std::vector<std::uint8_t>>{
           {6, {3, 1}}, {9, {3, 3, 0}}, {77, {3, 3, 3, 0, 0, 62}}, {made.total(), made.after}}) {
    MadeSamples cut = made;
    EXPECT_TRUE(cut.cut_to(samples));
    EXPECT_EQ(cut.after, after);
    EXPECT_EQ(cut.total(), samples);
  }
  EXPECT_FALSE(MadeSamples(made).cut_to(made.total() + 1));
  for (const char* damaged : {"", "10", "10 4", "10 4 64*1 0*1", "10 4 3*99999999999 0*1", "10 4 3x3 0*1"})
    EXPECT_THROW(static_cast<void>(MadeSamples::parse(damaged)), UsageError) << damaged;
}

}  // namespace
}  // namespace nutik::between_test
