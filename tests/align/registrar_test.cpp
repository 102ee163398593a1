// Motions that are known: scenes are drawn where the camera looks, each value from a formula, so that nothing is
// resampled.
#include "align/registrar.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "support/clips.hpp"
#include "system/parallel.hpp"

namespace nutik::test {
namespace {

constexpr double kMaxPixels = 0.05, kMaxDegrees = 0.01;  // root of the mean square
constexpr std::uint32_t kSceneWidth = 320, kSceneHeight = 240;
constexpr std::size_t kPictures = 8;

// Waves of many directions, none shorter than three pixels.
class Texture {
 public:
  explicit Texture(unsigned seed, double longest = 120) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0, 1);
    for (Wave& wave : waves_) {
      const double turn = 2 * std::numbers::pi * share(random);
      const double length = 3 * std::pow(longest / 3, share(random));
      const double pulse = 2 * std::numbers::pi / length;
      wave = {pulse * std::cos(turn), pulse * std::sin(turn), 2 * std::numbers::pi * share(random)};
    }
  }

  // About 0, rarely beyond -1 … 1.
  [[nodiscard]] double at(const Place& place) const {
    double sum = 0;
    for (const Wave& wave : waves_) sum += std::sin(wave.x * place.x + wave.y * place.y + wave.phase);
    return sum / 10;
  }

 private:
  struct Wave {
    double x, y, phase;
  };
  Wave waves_[40];
};

struct Look {
  std::uint32_t channels = 1, code_bytes = 1, white = 255;
};

CaptureFormat format_of(const Look& look) {
  return {.shape = {kSceneWidth, kSceneHeight, look.channels}, .code_bytes = look.code_bytes, .white_code = look.white};
}

std::unique_ptr<Registrar> registrar_of(const CaptureFormat& format, std::span<const std::byte> reference) {
  use_modules();
  return open_registrar(format, reference);
}

// A scene before which a disc, a fifth of the picture, moves by itself: eleven pixels a picture, turning.
class Scene {
 public:
  explicit Scene(const Look& look) : look_(look) {}

  // As a camera sees it in whose pictures the scene's places lie where `warp` says.
  [[nodiscard]] std::vector<std::byte> seen(const Warp& warp, std::size_t picture, double gain = 1) {
    const Warp back = inverse(warp);
    std::vector<std::byte> raster(format_of(look_).sample_bytes());
    std::normal_distribution<double> noise(0, 0.006);
    for (std::uint32_t y = 0; y < kSceneHeight; ++y) {
      for (std::uint32_t x = 0; x < kSceneWidth; ++x) {
        const Place place = back.at(x, y);
        const double light = 0.5 + gain * 0.25 * grey(place, static_cast<double>(picture));
        for (std::uint32_t channel = 0; channel < look_.channels; ++channel) {
          const double code = std::round(look_.white * std::clamp(light + noise(random_), 0.0, 1.0));
          const std::size_t value = (std::size_t{y} * kSceneWidth + x) * look_.channels + channel;
          if (look_.code_bytes == 1) {
            raster[value] = static_cast<std::byte>(code);
          } else {
            const auto wide = static_cast<std::uint16_t>(code);
            std::memcpy(raster.data() + 2 * value, &wide, sizeof wide);
          }
        }
      }
    }
    return raster;
  }

 private:
  [[nodiscard]] double grey(const Place& place, double time) const {
    const double radius = std::sqrt(kSceneWidth * kSceneHeight / 5.0 / std::numbers::pi);
    const double x = place.x - 100 - 11 * time, y = place.y - 120;
    if (std::hypot(x, y) > radius) return scene_.at(place);
    const double c = std::cos(0.05 * time), s = std::sin(0.05 * time);
    return subject_.at({c * x - s * y, s * x + c * y});
  }

  Look look_;
  Texture scene_{11}, subject_{12};
  std::mt19937 random_{13};
};

// Turned about the picture's middle, then moved, then seen from the side.
Warp moved(double x, double y, double degrees, double tilt_x = 0, double tilt_y = 0) {
  const double turn = degrees / 180 * std::numbers::pi, c = std::cos(turn), s = std::sin(turn);
  const double mx = (kSceneWidth - 1) / 2.0, my = (kSceneHeight - 1) / 2.0;
  const Warp rigid{{c, -s, mx + x - c * mx + s * my, s, c, my + y - s * mx - c * my, 0, 0, 1}};
  const Warp to_middle{{1, 0, -mx, 0, 1, -my, 0, 0, 1}}, back{{1, 0, mx, 0, 1, my, 0, 0, 1}};
  return chained(rigid, chained(chained(to_middle, Warp{{1, 0, 0, 0, 1, 0, tilt_x, tilt_y, 1}}), back));
}

std::vector<Warp> hand_held(CameraMotion motion) {
  std::vector<Warp> warps{Warp()};
  std::mt19937 random(14);
  std::uniform_real_distribution<double> share(-1, 1);
  for (std::size_t picture = 1; picture < kPictures; ++picture) {
    const double x = 14 * share(random), y = 10 * share(random);
    const double degrees = motion == CameraMotion::translation ? 0 : 2.5 * share(random);
    const double tilt_x = motion == CameraMotion::homography ? 1e-4 * share(random) : 0;
    const double tilt_y = motion == CameraMotion::homography ? 1e-4 * share(random) : 0;
    warps.push_back(moved(x, y, degrees, tilt_x, tilt_y));
  }
  return warps;
}

struct Case {
  CameraMotion motion;
  Look look;
  double gain_step = 0;  // by which pictures become brighter
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << to_text(c.motion) << ' ' << c.look.channels << " channels, white " << c.look.white;
}

class Recovery : public testing::TestWithParam<Case> {};

TEST_P(Recovery, FindsShiftsAndTurnsWithASubjectOverAFifthOfThePicture) {
  const Case& c = GetParam();
  const std::vector<Warp> truth = hand_held(c.motion);
  Scene scene(c.look);
  const auto reference = scene.seen(truth[0], 0);
  const auto registrar = registrar_of(format_of(c.look), reference);
  double squared_pixels = 0, squared_degrees = 0;
  std::size_t places = 0, pictures = 0;
  Warp guess;
  for (std::size_t picture = 1; picture < truth.size(); ++picture) {
    const Registered found = registrar->find(
        scene.seen(truth[picture], picture, 1 + c.gain_step * static_cast<double>(picture)), c.motion, guess);
    EXPECT_TRUE(is_sure(found)) << "picture " << picture << ": " << found.agreeing;
    EXPECT_LT(found.residual_pixels, 0.5) << "picture " << picture;
    for (double y = 0; y < kSceneHeight; y += 16) {
      for (double x = 0; x < kSceneWidth; x += 16) {
        const Place is = found.warp.at(x, y), should = truth[picture].at(x, y);
        squared_pixels += std::pow(is.x - should.x, 2) + std::pow(is.y - should.y, 2);
        ++places;
      }
    }
    const double turned = found.warp.degrees_at(kSceneWidth / 2.0, kSceneHeight / 2.0) -
                          truth[picture].degrees_at(kSceneWidth / 2.0, kSceneHeight / 2.0);
    squared_degrees += turned * turned;
    ++pictures;
    if (is_sure(found)) guess = found.warp;
  }
  const double pixels = std::sqrt(squared_pixels / static_cast<double>(places));
  const double degrees = std::sqrt(squared_degrees / static_cast<double>(pictures));
  EXPECT_LE(pixels, kMaxPixels);
  EXPECT_LE(degrees, kMaxDegrees);
  std::printf("%s: off by %.4f pixels and %.5f degrees RMS\n", std::string(to_text(c.motion)).c_str(), pixels,
              degrees);
}

INSTANTIATE_TEST_SUITE_P(Motions, Recovery,
                         testing::Values(Case{CameraMotion::translation, {}}, Case{CameraMotion::rigid, {}},
                                         Case{CameraMotion::homography, {}},
                                         Case{CameraMotion::rigid, {3, 1, 255}, 0.04},
                                         Case{CameraMotion::rigid, {1, 2, 4095}}));

TEST(Registrar, FindsAPictureThatLiesFarFromWhereItWasExpected) {
  const Look look;
  Scene scene(look);
  const Warp far = moved(90, -55, 20);
  const auto registrar = registrar_of(format_of(look), scene.seen(Warp(), 0));
  const Registered found = registrar->find(scene.seen(far, 0), CameraMotion::rigid, Warp());
  EXPECT_TRUE(is_sure(found));
  const Place is = found.warp.at(160, 120), should = far.at(160, 120);
  EXPECT_NEAR(is.x, should.x, 0.1);
  EXPECT_NEAR(is.y, should.y, 0.1);
}

// Light of each place, a column and a row, as codes.
template <typename LightAt>
std::vector<std::byte> raster_of(LightAt light_at) {
  std::vector<std::byte> raster;
  for (int y = 0; y < static_cast<int>(kSceneHeight); ++y) {
    for (int x = 0; x < static_cast<int>(kSceneWidth); ++x)
      raster.push_back(static_cast<std::byte>(std::clamp(std::round(light_at(x, y)), 0.0, 255.0)));
  }
  return raster;
}

// Before texture that no coarser level shows a smooth thing moves from one side to the other.
TEST(Registrar, FollowsFineTextureBehindWhatLeftItsPlace) {
  const Texture texture(16, 6);
  const auto seen = [&](double shift, int left) {
    return raster_of([&](int x, int y) {
      const bool is_thing = x >= left && x < left + 128 && y >= 60 && y < 180;
      return is_thing ? 180 + 20 * std::sin((x - left) / 7.0) : 110 + 40 * texture.at({x - shift, double(y)});
    });
  };
  for (const CameraMotion motion :
       {CameraMotion::translation, CameraMotion::rigid, CameraMotion::homography}) {
    const auto registrar = registrar_of(format_of({}), seen(0, 0));
    const Registered found = registrar->find(seen(1.5, 160), motion, Warp());
    EXPECT_TRUE(is_sure(found)) << to_text(motion) << ": " << found.agreeing;
    EXPECT_NEAR(found.warp.at(160, 120).x, 161.5, 0.05) << to_text(motion);
    EXPECT_NEAR(found.warp.at(160, 120).y, 120, 0.05) << to_text(motion);
  }
}

// The thing, two fifths of the picture, moves right as the room moves left.
TEST(Registrar, FollowsTheRoomOfAPanAndNotWhatMovesAgainstIt) {
  const Texture room(23), thing(73);
  const auto seen = [&](int shift) {
    return raster_of([&](int x, int y) {
      const int across = x - 60 - shift;
      const bool is_thing = across >= 0 && across < 120 && y >= 20;
      return is_thing ? 128 + 60 * thing.at({double(across), double(y)})
                      : 128 + 40 * room.at({double(x + shift), double(y)});
    });
  };
  for (const CameraMotion motion : {CameraMotion::rigid, CameraMotion::homography}) {
    const Registered found = registrar_of(format_of({}), seen(0))->find(seen(4), motion, Warp());
    EXPECT_NEAR(found.warp.at(160, 120).x, 156, 0.05) << to_text(motion) << ": " << found.agreeing;
    EXPECT_NEAR(found.warp.at(160, 120).y, 120, 0.05) << to_text(motion);
  }
}

TEST(Registrar, GivesTheSameTwice) {
  const Look look;
  Scene scene(look);
  const auto reference = scene.seen(Warp(), 0), other = scene.seen(moved(90, -55, 20), 1);
  const auto find = [&] {
    return registrar_of(format_of(look), reference)->find(other, CameraMotion::homography, Warp());
  };
  EXPECT_EQ(find(), find());
}

// Searches work in memory that searches before them leave.
TEST(Registrar, GivesTheSameWhateverItFoundBefore) {
  const Look look;
  Scene scene(look);
  const auto reference = scene.seen(Warp(), 0);
  std::vector<std::vector<std::byte>> others;
  for (std::size_t i = 0; i < kPictures; ++i) {
    const auto far = static_cast<double>(i);
    others.push_back(scene.seen(moved(2 * far, -far, far / 2), i));
  }
  const auto shared = registrar_of(format_of(look), reference);
  std::vector<Registered> found(kPictures);
  for (int time = 0; time < 2; ++time) {
    parallel_for(kPictures, [&](std::uint64_t i) {
      found[i] = shared->find(others[i], CameraMotion::homography, Warp());
    });
    for (std::size_t i = 0; i < kPictures; ++i) {
      const auto alone = registrar_of(format_of(look), reference);
      EXPECT_EQ(found[i], alone->find(others[i], CameraMotion::homography, Warp())) << i;
    }
  }
}

TEST(Registrar, LeavesNearByWhatRests) {
  Scene scene({});
  const auto registrar = registrar_of(format_of({}), scene.seen(Warp(), 0));
  EXPECT_EQ(registrar->find(scene.seen(Warp(), 5), CameraMotion::rigid, Warp(), Reach::near).warp, Warp())
      << "only the subject moved";
  const Registered found = registrar->find(scene.seen(moved(3, 0, 0), 5), CameraMotion::rigid, Warp(), Reach::near);
  EXPECT_TRUE(is_sure(found));
  EXPECT_NEAR(found.warp.at(160, 120).x, 163, 0.05);
}

TEST(Registrar, TakesNoThingBeforeABareWallForTheCamera) {
  const Texture texture(15);
  const auto wall = [&](int left) {
    return raster_of([&](int x, int y) {
      const bool is_thing = x >= left && x < left + 50 && y >= 90 && y < 140;
      return is_thing ? std::floor(130 + 50 * texture.at({double(x - left), double(y)})) : 100;
    });
  };
  const auto registrar = registrar_of(format_of({}), wall(120));
  EXPECT_FALSE(is_sure(registrar->find(wall(125), CameraMotion::rigid, Warp(), Reach::near)));
}

// A pole swings by up to three pixels, and of a fainter edge that rests parts lie within a pixel of where that leads.
TEST(Registrar, TakesNoPoleThatSwingsBesideWhatRestsForTheCamera) {
  const auto wall = [](double turn) {
    return raster_of([&](int x, int y) {
      const double pole = std::clamp(8.5 - std::abs(x - 140 + turn * y), 0.0, 1.0);
      return std::lerp(x < 300 ? 20 : 60, y % 40 < 6 ? 60 : 200, pole);
    });
  };
  const auto registrar = registrar_of(format_of({}), wall(0));
  EXPECT_EQ(registrar->find(wall(0.012), CameraMotion::rigid, Warp(), Reach::near).warp, Warp());
}

TEST(Registrar, IsNotSureOfAnotherScene) {
  const Look look;
  Scene scene(look);
  const auto registrar = registrar_of(format_of(look), scene.seen(Warp(), 0));
  EXPECT_FALSE(is_sure(registrar->find(scene.seen(moved(5000, 3000, 0), 0), CameraMotion::rigid, Warp())));
}

std::string why_not(const CaptureFormat& format, const std::vector<std::byte>& reference) {
  try {
    static_cast<void>(registrar_of(format, reference));
  } catch (const TooLittleTexture& error) {
    return error.what();
  }
  return "it can be registered";
}

TEST(Registrar, SaysWhyNothingCanBeRegistered) {
  std::vector<std::byte> raster(kSceneWidth * kSceneHeight, std::byte{99});
  EXPECT_EQ(why_not(format_of({}), raster), "it has 0 pixels whose surroundings can be recognized, and 60 are needed");
  for (std::size_t i = 0; i < raster.size(); ++i)
    raster[i] = static_cast<std::byte>(100 + 50 * (i % 20 / 10));
  EXPECT_EQ(why_not(format_of({}), raster),
            "all its edges run in one direction, along which nothing tells where a picture lies");
}

// Halved until there are few pixels, such pictures would have no row or no column.
TEST(Registrar, SaysThatNothingCanBeRegisteredToThinPictures) {
  constexpr std::uint32_t kLong = 1 << 20;
  for (const Shape& shape : {Shape{kLong, 3, 3}, Shape{3, kLong, 1}, Shape{kLong / 2 + 1, 1, 1}, Shape{1, kLong, 1}}) {
    const CaptureFormat format{.shape = shape};
    std::vector<std::byte> raster(format.sample_bytes());
    for (std::size_t i = 0; i < raster.size(); ++i) raster[i] = static_cast<std::byte>(i * 7919 % 251);
    EXPECT_EQ(why_not(format, raster), "it has 0 pixels whose surroundings can be recognized, and 60 are needed")
        << shape.width << " x " << shape.height;
  }
}

TEST(Registrar, CountsTheMemoryOfThinPictures) {
  const auto bytes_of = [](std::uint32_t width, std::uint32_t height) {
    return registered_bytes({.shape = {width, height, 1}});
  };
  EXPECT_EQ(bytes_of(1 << 20, 1), 2 * bytes_of(1 << 19, 1));
  EXPECT_EQ(bytes_of(1 << 10, 1 << 10), bytes_of(1 << 10, 1 << 9));
}

}  // namespace
}  // namespace nutik::test
