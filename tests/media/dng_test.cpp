// DNG sequences: light as the tags of the first picture tell it, computed here from the format's definition.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "capture/error.hpp"
#include "support/bytes.hpp"
#include "support/clips.hpp"
#include "support/messages.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

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

std::string shorts(std::initializer_list<int> values) {
  std::string data;
  for (const int value : values) data += little_endian(static_cast<std::uint64_t>(value), 2);
  return data;
}

std::string longs(std::initializer_list<std::int64_t> values) {
  std::string data;
  for (const std::int64_t value : values) data += little_endian(static_cast<std::uint64_t>(value), 4);
  return data;
}

struct Tag {
  std::uint16_t tag, type;
  std::uint32_t count;
  std::string data;
};

// A TIFF's directory that lies `at` a place in the file, and behind it what does not fit into it.
std::string directory(const std::vector<Tag>& tags, std::size_t at) {
  std::string head = shorts({static_cast<int>(tags.size())}), behind;
  const std::size_t end = at + 2 + 12 * tags.size() + 4;
  for (const Tag& tag : tags) {
    head += shorts({tag.tag, tag.type}) + longs({tag.count});
    std::string data = tag.data;
    if (data.size() > 4) {
      head += longs({static_cast<std::int64_t>(end + behind.size())});
      behind += data;
    } else {
      data.resize(4);
      head += data;
    }
  }
  return head + longs({0}) + behind;
}

struct Dng {
  std::uint16_t width = 64, height = 48;
  Vector field{3000, 9000, 5000};  // of the sensor, everywhere alike
  double black = 512, white = 16'383;
  Vector neutral{0.5, 1, 0.8};
  Matrix camera_of_rgb{{{0.8, 0.15, 0.05}, {0.2, 0.7, 0.1}, {0.05, 0.25, 0.7}}};
  std::array<std::int64_t, 2> exposure{}, rate{};  // fractions; 0/0: not stated
  std::string fraction;                            // of the second in which it was taken, or empty
  int orientation = 1;

  // Little-endian TIFF: the tags, what does not fit into them, those of EXIF likewise, then the mosaic R G / G B.
  [[nodiscard]] std::string file() const {
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
                          {273, 4, 1, longs({0})},
                          {274, 3, 1, shorts({orientation})},
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
    std::vector<Tag> exif;
    if (exposure[1] != 0) exif.push_back({33'434, 5, 1, longs({exposure[0], exposure[1]})});
    if (!fraction.empty()) {
      exif.push_back({36'867, 2, 20, std::string("2026:11:21 13:22:27\0", 20)});
      exif.push_back({37'521, 2, static_cast<std::uint32_t>(fraction.size() + 1), fraction + '\0'});
    }
    tags.push_back({34'665, 4, 1, longs({0})});
    if (rate[1] != 0) tags.push_back({51'044, 10, 1, longs({rate[0], rate[1]})});
    std::ranges::sort(tags, {}, &Tag::tag);
    constexpr std::size_t kHead = 8;
    const std::size_t exif_at = kHead + directory(tags, kHead).size();
    const std::string exif_directory = directory(exif, exif_at);
    for (Tag& tag : tags) {
      if (tag.tag == 34'665) tag.data = longs({static_cast<std::int64_t>(exif_at)});
      if (tag.tag == 273) tag.data = longs({static_cast<std::int64_t>(exif_at + exif_directory.size())});
    }
    std::string head = std::string("II*\0\10\0\0\0", kHead) + directory(tags, kHead) + exif_directory;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        head += shorts({static_cast<int>(field[static_cast<std::size_t>(x % 2 + y % 2)])});
    return head;
  }

  // The light in the middle of the picture, as shares of white: balanced so that the neutral colour is grey and none is
  // darker than the sensor saw it, then by the matrix that keeps grey grey.
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

// Balancing cuts to whole codes, which the matrix, whose rows' magnitudes sum to less than 2, makes less than 2, and
// cuts again; beside it stand the six digits of the tags and single precision: codes are within 4 of 65535.
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
  expect_says(clip->info().notes[0].text, "are those that f1.dng states");
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

TEST(Dng, TellsItsRateAndExposure) {
  const Scratch scratch;
  const auto write = [&](const std::string& name, const Dng& dng) { scratch.write(name, dng.file()); };
  Dng dng;
  dng.exposure = {1, 48};
  write("f1.dng", dng);
  write("f2.dng", dng);
  auto clip = open_test_clip(scratch / "f%d.dng");
  EXPECT_FALSE(clip->info().timing.is_known());
  EXPECT_EQ(timeline_of("", clip->info(), {.rate = Rational{24, 1}}, 2).end_ns(0), 20'833'333) << "1/48 s of 1/24 s";

  dng.rate = {24'000, 1001};
  write("f1.dng", dng);
  clip = open_test_clip(scratch / "f%d.dng");
  EXPECT_EQ(clip->info().timing.rate, (Rational{24'000, 1001}));
  EXPECT_EQ(clip->info().timing.rate_from, "f1.dng");
  EXPECT_EQ(clip->info().timing.exposed_ns, 20'833'333);

  // Each is another: none is that of all.
  dng.exposure = {1, 50};
  write("f2.dng", dng);
  clip = open_test_clip(scratch / "f%d.dng");
  EXPECT_EQ(clip->info().timing.exposed_ns, std::nullopt);
  ASSERT_EQ(clip->info().notes.size(), 2u);
  EXPECT_EQ(
      clip->info().notes[1].text,
      "exposures are not used, which differ: f1.dng was exposed for 20833333 ns, f2.dng for 20000000 ns; "
      "a table of stills takes each picture's own");
  EXPECT_EQ(clip->info().notes[1].settings, std::vector{Setting::shutter_angle});

  // What no camera means is not taken.
  dng.rate = {-24, 1};
  dng.exposure = {0, 50};
  write("f1.dng", dng);
  write("f2.dng", dng);
  clip = open_test_clip(scratch / "f%d.dng");
  EXPECT_EQ(clip->info().timing.rate, std::nullopt);
  EXPECT_EQ(clip->info().timing.exposed_ns, std::nullopt);
}

TEST(Dng, GivesATableItsTimes) {
  const Scratch scratch;
  Dng dng;
  dng.exposure = {1, 100};
  dng.fraction = "25";
  scratch.write("f1.dng", dng.file());
  dng.exposure = {1, 50};
  dng.fraction = "750";
  scratch.write("f2.dng", dng.file());
  const auto clip = open_test_clip(scratch.write("list.csv", "f1.dng\nf2.dng\n"));
  const Timeline timeline = timeline_of("", clip->info(), {}, 2);
  EXPECT_EQ(timeline.end_ns(0), 10'000'000);
  EXPECT_EQ(timeline.start_ns(1), 500'000'000);
  EXPECT_EQ(timeline.end_ns(1), 520'000'000);
}

TEST(Dng, IsTurnedUpright) {
  const Scratch scratch;
  for (const int orientation : {3, 6, 8}) {
    Dng dng;
    dng.orientation = orientation;
    const auto clip = open_test_clip(scratch.write("a.dng", dng.file()));
    const Shape upright = orientation == 3 ? Shape{64, 48, 3} : Shape{48, 64, 3};
    EXPECT_EQ(clip->info().format.shape, upright) << orientation;
  }
}

TEST(Dng, ThatIsDamagedIsRefused) {
  const Scratch scratch;
  const std::string whole = Dng{}.file();
  for (const std::size_t bytes : {std::size_t{0}, std::size_t{20}, whole.size() / 2}) {
    EXPECT_THROW(read_all(*open_test_clip(scratch.write("a.dng", whole.substr(0, bytes)))), InputError)
        << bytes;
  }
}

// `tag` of one value of two or four bytes, with another.
std::string with_value(std::string file, int tag, int type, std::int64_t value) {
  const std::size_t at = file.find(shorts({tag, type}) + longs({1}));
  EXPECT_NE(at, std::string::npos);
  return file.replace(at + 8, 4, longs({value}));
}

void expect_refused(const std::string& file, const std::string& part) {
  const Scratch scratch;
  expect_error<InputError>([&] { return read_all(*open_test_clip(scratch.write("a.dng", file))); }, {part});
}

TEST(Dng, ThatStatesMoreThanItsBytesHoldIsRefused) {
  const std::string large = with_value(with_value(Dng{}.file(), 256, 3, 40'000), 257, 3, 40'000);
  expect_refused(large, "it states 40000 x 40000 pixels, which its ");
}

// LibRaw would read it, whatever it is.
TEST(Dng, IsOneByWhatItHolds) {
  expect_refused("no picture" + std::string(16, 'a'), "it is damaged or no DNG");
  std::string nameless = Dng{}.file();
  nameless.replace(nameless.find(shorts({50'706, 1})), 2, shorts({50'705}));
  expect_refused(nameless, "it is damaged or no DNG");
}

// LibRaw leaves the picture black where no JPEG begins.
TEST(Dng, WhosePackedPictureDoesNotBeginIsRefused) {
  expect_refused(with_value(Dng{}.file(), 259, 3, 7), "it is damaged or was cut off");
}

}  // namespace
}  // namespace nutik::test
