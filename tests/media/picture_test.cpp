// Pictures are read back bit for bit by a second program's reader: OpenCV's.
#include <gtest/gtest.h>

#include <sys/resource.h>

#include <csignal>
#include <cstring>
#include <opencv2/imgcodecs.hpp>

#include "capture/error.hpp"
#include "media/writers/picture_writer.hpp"
#include "support/clips.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

Picture random_picture(Shape shape, ValueType type, std::uint64_t seed) {
  Picture picture(shape, type, type == ValueType::code16 ? 65'535 : 255);
  Random random(seed);
  for (std::uint64_t i = 0; i < shape.value_count(); ++i) {
    if (type == ValueType::code8)
      picture.values<std::uint8_t>()[i] = static_cast<std::uint8_t>(random.whole(0, 255));
    if (type == ValueType::code16) {
      picture.values<std::uint16_t>()[i] = static_cast<std::uint16_t>(random.whole(0, 65'535));
    }
    // Light below 0, above 1, tiny and huge: floating point keeps all of it.
    if (type == ValueType::light32) {
      picture.values<float>()[i] =
          static_cast<float>(random.real(-3, 3) * std::pow(10.0, random.real(-20, 20)));
    }
  }
  return picture;
}

void expect_read_back(const Picture& picture, const std::filesystem::path& path) {
  const cv::Mat read = cv::imread(path.string(), cv::IMREAD_UNCHANGED);
  ASSERT_FALSE(read.empty()) << path;
  const std::uint32_t channels = picture.shape.channels;
  ASSERT_EQ(read.channels(), static_cast<int>(channels)) << path;
  ASSERT_EQ(read.elemSize1(), value_bytes(picture.type)) << path;
  ASSERT_TRUE(read.isContinuous());
  const std::size_t bytes = value_bytes(picture.type);
  for (std::uint64_t i = 0; i < picture.shape.value_count(); ++i) {
    const std::uint64_t bgr = channels == 3 ? i / 3 * 3 + 2 - i % 3 : i;
    ASSERT_EQ(std::memcmp(picture.bytes.data() + i * bytes, read.data + bgr * bytes, bytes), 0)
        << path << ", value " << i;
  }
}

TEST(PictureWriter, WritesWhatASecondProgramReadsBack) {
  struct Kind {
    const char* extension;
    std::vector<ValueType> types;
    std::vector<std::uint32_t> channels;
  };
  const Kind kinds[] = {
      {".png", {ValueType::code8, ValueType::code16}, {1, 3}},
      {".tif", {ValueType::code8, ValueType::code16, ValueType::light32}, {1, 3}},
      {".tiff", {ValueType::code8}, {3}},
      {".ppm", {ValueType::code8, ValueType::code16}, {3}},
      {".pgm", {ValueType::code8, ValueType::code16}, {1}},
      {".pfm", {ValueType::light32}, {1, 3}},
  };
  const Scratch scratch;
  for (const Kind& kind : kinds) {
    for (const ValueType type : kind.types) {
      for (const std::uint32_t channels : kind.channels) {
        for (const auto& [width, height] : {std::pair{1u, 1u}, {17u, 9u}, {64u, 65u}}) {
          const Picture picture = random_picture({width, height, channels}, type, width);
          const auto path = scratch / ("picture" + std::string(kind.extension));
          write_picture(path, picture);
          expect_read_back(picture, path);
        }
      }
    }
  }
}

// From 64 MiB on rows are compressed one by one.
TEST(PictureWriter, WritesLargePngsRowByRow) {
  const Scratch scratch;
  Picture picture({8192, 4097, 1}, ValueType::code16, 65'535);
  for (std::uint64_t i = 0; i < picture.shape.value_count(); ++i) {
    picture.values<std::uint16_t>()[i] = static_cast<std::uint16_t>(i * i >> 12);
  }
  write_picture(scratch / "large.png", picture);
  const cv::Mat read = cv::imread((scratch / "large.png").string(), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(read.total() * read.elemSize(), picture.bytes.size());
  EXPECT_EQ(std::memcmp(read.data, picture.bytes.data(), picture.bytes.size()), 0);
}

// Each looks again and again whether it should end; one that ends leaves nothing.
TEST(PictureWriter, EndsWhereItIsTold) {
  use_modules();
  const Scratch scratch;
  for (const char* name : {"p.png", "p.tif", "p.jpg", "p.exr", "p.pfm", "p.npy"}) {
    const bool is_light = value_type_for(name, {}, ValueType::code8, 3) == ValueType::light32;
    const Picture picture = random_picture({640, 480, 3}, is_light ? ValueType::light32 : ValueType::code8, 1);
    int looks = 0;
    FileWishes wishes;
    wishes.check = [&] { ++looks; };
    write_picture(scratch / name, picture, {}, wishes);
    EXPECT_GE(looks, 1) << name;
    std::filesystem::remove(scratch / name);
    wishes.check = [&] {
      if (--looks == 0) throw Cancelled();
    };
    EXPECT_THROW(write_picture(scratch / name, picture, {}, wishes), Cancelled) << name;
    EXPECT_TRUE(std::filesystem::is_empty(scratch.folder())) << name;
  }
}

TEST(PictureWriter, ChoosesTheTypeByNameAndWish) {
  const auto type = [](const char* name, std::optional<Depth> wish) {
    return value_type_for(name, wish, ValueType::code16, 3);
  };
  EXPECT_EQ(type("a.png", {}), ValueType::code16);
  EXPECT_EQ(type("a.PNG", Depth::bits8), ValueType::code8);
  EXPECT_EQ(type("a.pfm", {}), ValueType::light32);
  EXPECT_EQ(type("a.tif", Depth::floating), ValueType::light32);
  const auto refused = [&](const char* name, std::optional<Depth> wish, const char* part) {
    expect_error<UsageError>([&] { return type(name, wish); }, {part});
  };
  refused("a.png", Depth::floating, "cannot hold floating point; write a .tif, .exr, .pfm or .npy");
  refused("a.pfm", Depth::bits8, "holds floating point only");
  refused("a.gif", {}, "not as '.gif'");
  refused("a", {}, "not as ''");
  refused("a.pgm", {}, "holds grey pictures only and this one has colour");
}

// As on a disk that is full.
TEST(PictureWriter, SaysWhyItCannotWrite) {
  const Scratch scratch;
  const Picture picture = random_picture({64, 64, 3}, ValueType::light32, 1);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  for (const std::string name : {"p.tif", "p.pfm", "p.npy"}) {
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit few{4096, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &few);
    const std::string said = message_of<OutputError>([&] { write_picture(scratch / name, picture); });
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(said, (scratch / name).string() + " cannot be written: File too large");
  }
}

TEST(PictureWriter, LeavesNothingBehindWhereItCannotWrite) {
  const Scratch scratch;
  const Picture picture = random_picture({4, 4, 3}, ValueType::code8, 1);
  EXPECT_THROW(write_picture(scratch / "absent/picture.png", picture), OutputError);
  std::filesystem::create_directory(scratch / "folder.png");
  EXPECT_THROW(write_picture(scratch / "folder.png", picture), OutputError);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scratch.folder()), {}), 1);
}

}  // namespace
}  // namespace nutik::test
