// What pictures of a moving camera saw, beside each pixel's own place in them.
#include "align/camera_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "capture/error.hpp"
#include "support/messages.hpp"

namespace nutik::test {
namespace {

Warp shifted(double x, double y) { return {{1, 0, x, 0, 1, y, 0, 0, 1}}; }

CameraPath path_of(std::vector<Warp> warps) {
  CameraPath path;
  path.shape = {64, 48, 1};
  for (const Warp& warp : warps) path.pictures.push_back({warp, 0.9, 0.125});
  return path;
}

TEST(CameraPath, SaysHowFarTheCameraMoved) {
  const double turn = 0.01;
  const Warp turned{{std::cos(turn), -std::sin(turn), 0, std::sin(turn), std::cos(turn), 0, 0, 0, 1}};
  const CameraPath path = path_of({Warp(), shifted(3, -4), turned});
  EXPECT_EQ(path.furthest().picture, 1u);
  EXPECT_EQ(path.max_turned(), 2u);
  EXPECT_NEAR(path.step(2).degrees, 0.572958, 1e-6);
  EXPECT_EQ(path.summary(), "moved by up to 5.00 pixels, turned by up to 0.573 degrees");
  // The middle rests while a corner, 31.5 and 23.5 pixels from it, goes a tenth of that.
  const CameraPath zoomed = path_of({Warp(), {{1.1, 0, -3.15, 0, 1.1, -2.35, 0, 0, 1}}});
  EXPECT_NEAR(zoomed.furthest().pixels(), 0.1 * std::hypot(31.5, 23.5), 1e-9);
  EXPECT_NEAR(zoomed.step(1).x, 0, 1e-9);
}

TEST(CameraPath, IsReadAsItWasWritten) {
  CameraPath path =
      path_of({Warp(), shifted(1.0 / 3, -2e-17), {{0.99, 0.01, 3, -0.01, 1.01, 2, 1e-5, -2e-5, 1}}});
  path.reference = 1;
  path.motion = CameraMotion::homography;
  CameraPath read = parse_camera_path(camera_path_text(path), "path.csv");
  EXPECT_FALSE(read.residual_pixels());
  // Which is said for people.
  for (CameraPath* each : {&read, &path}) {
    for (Registered& picture : each->pictures) picture = {picture.warp};
  }
  EXPECT_EQ(read, path);
}

std::string complaint(const std::string& text) {
  return message_of<InputError>([&] { return parse_camera_path(text, "path.csv"); });
}

TEST(CameraPath, SaysWhatIsWrongInAFile) {
  const std::string title = "# nutik camera path,rigid,0,64,48\n";
  const std::string columns = "picture,x,y,degrees,residual_pixels,agreeing,m0,m1,m2,m3,m4,m5,m6,m7,m8\n";
  const auto starts = [](const std::string& text, const std::string& start) {
    EXPECT_EQ(complaint(text).substr(0, start.size()), start);
  };
  starts("", "path.csv:1: this is no camera's path");
  starts("# nutik camera path,affine,0,64,48\n", "path.csv:1: it names no motion");
  starts("# nutik camera path,rigid,0,0,48\n", "path.csv:1: its pictures have no pixels");
  starts(title, "path.csv:2: its columns are not");
  starts(title + columns, "path.csv:2: it has 0 pictures");
  starts(title + columns + "1,0,0,0,0,1,1,0,0,0,1,0,0,0,1\n", "path.csv:3: picture 0 is expected here");
  starts(title + columns + "0,0,0,0,0,1,1,0,0,0,1,0,0,0\n", "path.csv:3: the warp is");
  starts(title + columns + "0,0,0,0,0,1,1,0,nan,0,1,0,0,0,1\n", "path.csv:3: the warp is");
  starts(title + columns + "0,0,0,0,0,1,1,0,1e300,0,1,0,0,0,1\n", "path.csv:3: the warp has 1e+300");
  starts(title + columns + "0,0,0,0,0,1,1,0,0,0,1,0,0,0,1,5\n", "path.csv:3: there is more");
  starts(title + columns + "0,0,0,0,0,1,1,0,0,0,1,0,-0.02,0,1\n", "path.csv:3: the warp has no place");
  starts(title + columns + "0,0,0,0,0,1,-1,0,0,0,1,0,0,0,1\n", "path.csv:3: the warp makes the picture flat");
}

TEST(SeenArea, IsWhatEveryPictureSaw) {
  EXPECT_EQ(seen_by_all(path_of({Warp()})), Rectangle({0, 0, 64, 48}));
  // What lies at x in the reference lies at x + 2.5 in the picture, whose last is 63.
  EXPECT_EQ(seen_by_all(path_of({Warp(), shifted(2.5, 0), shifted(-1, -3)})), Rectangle({1, 3, 60, 45}));
  EXPECT_EQ(seen_by_all(path_of({shifted(40, 0), shifted(-40, 0)})), std::nullopt);
}

TEST(SeenArea, IsFullySeenWhenTheCameraTurned) {
  const double turn = 0.1;
  const Warp turned{{std::cos(turn), -std::sin(turn), 4, std::sin(turn), std::cos(turn), -2, 1e-4, 2e-4, 1}};
  const CameraPath path = path_of({Warp(), turned});
  const auto area = seen_by_all(path);
  ASSERT_TRUE(area);
  EXPECT_GT(area->width * area->height, 1200u);
  for (const std::uint32_t x : {area->x, area->x + area->width - 1}) {
    for (const std::uint32_t y : {area->y, area->y + area->height - 1}) {
      const Place place = turned.at(x, y);
      EXPECT_TRUE(place.x > -1e-5 && place.y > -1e-5 && place.x < 63.00001 && place.y < 47.00001)
          << place.x << ", " << place.y;
    }
  }
  // And each pixel of it counts as seen by both.
  const Picture coverage = coverage_of(path);
  for (std::uint32_t y = area->y; y < area->y + area->height; ++y) {
    for (std::uint32_t x = area->x; x < area->x + area->width; ++x) {
      ASSERT_EQ(coverage.values<std::uint8_t>()[y * 64 + x], 255);
    }
  }
}

TEST(SeenArea, CountsWhoSawAPixel) {
  const Picture coverage = coverage_of(path_of({Warp(), shifted(2, 0)}));
  EXPECT_EQ(coverage.values<std::uint8_t>()[61], 255);
  EXPECT_EQ(coverage.values<std::uint8_t>()[62], 127);
}

constexpr Shape kShape{23, 17, 1};
constexpr double kOfRounding = 1e-4;  // pixels from the border within which a place may count or not

// By how much a pixel lies inside of what a picture saw: negative outside, and behind the camera.
double depth_inside(const Warp& warp, std::uint32_t x, std::uint32_t y) {
  if (warp.m[6] * x + warp.m[7] * y + warp.m[8] <= 0) return -1;
  const Place place = warp.at(x, y);
  return kSeenBeyond + std::min({place.x, place.y, kShape.width - 1 - place.x, kShape.height - 1 - place.y});
}

// Turned, shifted, and seen from another side, some so far that the horizon is in the picture.
Warp random_warp(std::mt19937& random) {
  const auto within = [&](double most) { return std::uniform_real_distribution(-most, most)(random); };
  const double angle = within(0.6), scale = 1 + within(0.4), far = random() % 4 == 0 ? 0.2 : 0.02;
  return {{scale * std::cos(angle), -scale * std::sin(angle), within(8), scale * std::sin(angle),
           scale * std::cos(angle), within(8), within(far), within(far), 1}};
}

TEST(SeenArea, OfARowIsWhatHasItsPlaceInThePicture) {
  std::mt19937 random(1);
  std::uint64_t seen = 0, unseen = 0;
  for (int repetition = 0; repetition < 2000; ++repetition) {
    const Warp warp = random_warp(random);
    for (std::uint32_t y = 0; y < kShape.height; ++y) {
      const PixelSpan span = seen_span(warp, kShape, y);
      for (std::uint32_t x = 0; x < kShape.width; ++x) {
        const double depth = depth_inside(warp, x, y);
        if (std::fabs(depth) < kOfRounding) continue;
        ASSERT_EQ(x >= span.first && x<span.end, depth> 0)
            << "pixel " << x << "," << y << " of warp " << repetition << " lies " << depth
            << " pixels inside";
        ++(depth > 0 ? seen : unseen);
      }
    }
  }
  EXPECT_GT(seen, 100'000u);
  EXPECT_GT(unseen, 100'000u);
}

// Which registering finds a little beside where it is.
TEST(SeenArea, ACameraThatRestsSawItsWholePicture) {
  for (const double found : {-0.03, 0.0, 0.03}) {
    const Warp warp{{1, 1e-4, found, -1e-4, 1, -found, 0, 0, 1}};
    for (std::uint32_t y = 0; y < kShape.height; ++y) {
      const PixelSpan span = seen_span(warp, kShape, y);
      EXPECT_EQ(span.first, 0u) << found;
      EXPECT_EQ(span.end, kShape.width) << found;
    }
  }
}

}  // namespace
}  // namespace nutik::test
