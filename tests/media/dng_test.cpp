// DNG sequences: light as the tags of the first picture tell it, computed here from the format's definition.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>

#include "capture/error.hpp"
#include "support/clips.hpp"
#include "support/scratch.hpp"

namespace nutik {
namespace {

using test::open_test_clip;
using test::read_all;
using test::Scratch;
using Matrix = std::array<std::array<double, 3>, 3>;
using Vector = std::array<double, 3>;

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix result{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) result[i][j] += a[i][k] * b[k][j];
  return result;
}

Matrix inverse(const Matrix& m) {
  Matrix result{};
  double determinant = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
      result[i][j] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
    }
    determinant += m[0][i] * result[i][0];
  }
  for (auto& row : result)
    for (double& value : row) value /= determinant;
  return result;
}

// ITU-R BT.709's primaries and D65, to six digits: linear RGB to XYZ.
constexpr Matrix kXyzOfRgb{
    {{0.412453, 0.357580, 0.180423}, {0.212671, 0.715160, 0.072169}, {0.019334, 0.119193, 0.950227}}};

struct Dng {
  std::uint16_t width = 64, height = 48;
  Vector field{3000, 9000, 5000};  // of the sensor, everywhere alike
  double black = 512, white = 16'383;
  Vector neutral{0.5, 1, 0.8};
  Matrix camera_of_rgb{{{0.8, 0.15, 0.05}, {0.2, 0.7, 0.1}, {0.05, 0.25, 0.7}}};

  // Little-endian TIFF: the tags, what does not fit into them, then the mosaic R G / G B.
  [[nodiscard]] std::string file() const {
    struct Tag {
      std::uint16_t tag, type;
      std::uint32_t count;
      std::string data;
    };
    const auto shorts = [](std::initializer_list<int> values) {
      std::string data;
      for (const int value : values) data += {static_cast<char>(value & 255), static_cast<char>(value >> 8)};
      return data;
    };
    const auto longs = [](std::initializer_list<std::int64_t> values) {
      std::string data;
      for (const std::int64_t value : values)
        for (int byte = 0; byte < 4; ++byte) data += static_cast<char>(value >> (8 * byte) & 255);
      return data;
    };
    constexpr std::int64_t kParts = 1'000'000;
    const auto fractions = [&](auto begin, auto end) {
      std::string data;
      for (; begin != end; ++begin) data += longs({std::llround(*begin * kParts), kParts});
      return data;
    };
    const Matrix camera_of_xyz = product(camera_of_rgb, inverse(kXyzOfRgb));
    std::vector<double> matrix;
    for (const auto& row : camera_of_xyz) matrix.insert(matrix.end(), row.begin(), row.end());
    const std::uint32_t bytes = 2u * width * height;
    const std::string model("Made up\0", 8);
    std::vector<Tag> tags{{254, 4, 1, longs({0})},
                          {256, 3, 1, shorts({width})},
                          {257, 3, 1, shorts({height})},
                          {258, 3, 1, shorts({16})},
                          {259, 3, 1, shorts({1})},
                          {262, 3, 1, shorts({32'803})},
                          {271, 2, 8, model},
                          {272, 2, 8, model},
                          {273, 4, 1, {}},
                          {274, 3, 1, shorts({1})},
                          {277, 3, 1, shorts({1})},
                          {278, 3, 1, shorts({height})},
                          {279, 4, 1, longs({bytes})},
                          {284, 3, 1, shorts({1})},
                          {33'421, 3, 2, shorts({2, 2})},
                          {33'422, 1, 4, std::string("\0\1\1\2", 4)},
                          {50'706, 1, 4, std::string("\1\4\0\0", 4)},
                          {50'707, 1, 4, std::string("\1\1\0\0", 4)},
                          {50'708, 2, 8, model},
                          {50'714, 4, 1, longs({std::llround(black)})},
                          {50'717, 4, 1, longs({std::llround(white)})},
                          {50'721, 10, 9, fractions(matrix.begin(), matrix.end())},
                          {50'728, 5, 3, fractions(neutral.begin(), neutral.end())},
                          {50'778, 3, 1, shorts({21})}};
    std::string head("II*\0\10\0\0\0", 8), behind;
    const std::size_t directory_end = 8 + 2 + 12 * tags.size() + 4;
    std::size_t held = 0;
    for (const Tag& tag : tags) held += tag.data.size() > 4 ? tag.data.size() : 0;
    head += shorts({static_cast<int>(tags.size())});
    for (Tag& tag : tags) {
      if (tag.tag == 273) tag.data = longs({static_cast<std::int64_t>(directory_end + held)});
      head += shorts({tag.tag, tag.type}) + longs({tag.count});
      if (tag.data.size() > 4) {
        head += longs({static_cast<std::int64_t>(directory_end + behind.size())});
        behind += tag.data;
      } else {
        tag.data.resize(4);
        head += tag.data;
      }
    }
    head += longs({0}) + behind;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        head += shorts({static_cast<int>(field[static_cast<std::size_t>(x % 2 + y % 2)])});
    return head;
  }

  // Of the middle of the picture, as shares of white: balanced so that the neutral colour is grey and none is darker
  // than the sensor saw it, then by the matrix that keeps grey grey.
  [[nodiscard]] Vector light() const {
    Vector balanced{};
    const double least = 1 / std::max({neutral[0], neutral[1], neutral[2]});
    for (std::size_t i = 0; i < 3; ++i) {
      balanced[i] = std::min((field[i] - black) / (white - black) / neutral[i] / least, 1.0);
    }
    Matrix camera = camera_of_rgb;
    for (auto& row : camera) {
      const double sum = row[0] + row[1] + row[2];
      for (double& value : row) value /= sum;
    }
    const Matrix rgb_of_camera = inverse(camera);
    Vector rgb{};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) rgb[i] += rgb_of_camera[i][j] * balanced[j];
    }
    return rgb;
  }
};

// Balancing cuts to whole codes, which the matrix, whose rows' magnitudes sum to less than 2, makes less than 2, and cuts
// again; beside it stand the six digits of the tags and single precision: codes are within 4 of 65535.
void expect_light(const std::vector<std::byte>& raster, const Dng& dng, const Vector& light) {
  const auto* codes = reinterpret_cast<const std::uint16_t*>(raster.data());
  const std::size_t middle = (std::size_t{dng.height} / 2 * dng.width + dng.width / 2) * 3;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(codes[middle + i], std::clamp(light[i], 0.0, 1.0) * 65'535, 4) << "channel " << i;
  }
}

TEST(Dng, IsDevelopedToTheLightItsTagsTell) {
  const Scratch scratch;
  for (const Vector& field : {Vector{3000, 9000, 5000}, Vector{1000, 1200, 900}, Vector{7000, 7000, 7000}}) {
    Dng dng;
    dng.field = field;
    const auto clip = open_test_clip(scratch.write("a.dng", dng.file()));
    const CaptureFormat& format = clip->info().format;
    EXPECT_EQ(format.shape, (Shape{dng.width, dng.height, 3}));
    EXPECT_EQ(format.white_code, 65'535u);
    EXPECT_EQ(format.transfer, Transfer::linear());
    EXPECT_EQ(format.primaries, Primaries::bt709);
    EXPECT_TRUE(clip->info().notes.empty());
    expect_light(read_all(*clip).at(0), dng, dng.light());
  }
}

// The camera's guesses change from picture to picture; the scene does not.
TEST(Dng, OfASequenceIsDevelopedByTheFirst) {
  const Scratch scratch;
  Dng first, second;
  second.neutral = {0.6, 1, 0.7};
  second.black = 500;
  second.white = 16'000;
  second.camera_of_rgb = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  scratch.write("f1.dng", first.file());
  scratch.write("f2.dng", second.file());
  const auto clip = open_test_clip(scratch / "f%d.dng");
  ASSERT_EQ(clip->info().notes.size(), 1u);
  EXPECT_NE(clip->info().notes[0].text.find("are those that f1.dng states"), std::string::npos);
  const auto rasters = read_all(*clip);
  ASSERT_EQ(rasters.size(), 2u);
  EXPECT_TRUE(rasters[0] == rasters[1]);
  // By its own tags it is another.
  expect_light(read_all(*open_test_clip(scratch / "f2.dng")).at(0), second, second.light());
  EXPECT_FALSE(read_all(*open_test_clip(scratch / "f2.dng")).at(0) == rasters[0]);
  // White does not follow the brightest pixel.
  first.field = {1000, 1200, 900};
  scratch.write("f2.dng", first.file());
  expect_light(read_all(*open_test_clip(scratch / "f%d.dng")).at(1), first, first.light());
}

TEST(Dng, ThatIsDamagedIsRefused) {
  const Scratch scratch;
  const std::string whole = Dng{}.file();
  for (const std::size_t bytes : {std::size_t{0}, std::size_t{20}, whole.size() / 2}) {
    EXPECT_THROW(read_all(*open_test_clip(scratch.write("a.dng", whole.substr(0, bytes)))), InputError)
        << bytes;
  }
}

}  // namespace
}  // namespace nutik
