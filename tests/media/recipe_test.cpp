#include "media/writers/recipe.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <opencv2/imgcodecs.hpp>

#include "capture/error.hpp"
#include "media/input_checksum.hpp"
#include "media/stills/picture_text.hpp"
#include "media/writers/picture_writer.hpp"
#include "support/hostile.hpp"
#include "support/messages.hpp"
#include "support/scratch.hpp"
#include "support/stills.hpp"

namespace nutik::test {
namespace {

Recipe example(std::string functions) {
  Recipe recipe;
  recipe.version = "0.1.0";
  recipe.capture = {"clip \"two\".tik", "xxh3-64-tik:0123456789abcdef"};
  recipe.functions = Recipe::Text{"f.fn", std::move(functions)};
  recipe.mask = Recipe::Input{"mask.pgm", "xxh3-64:fedcba9876543210"};
  recipe.options = {{"normalize", "integral"}, {"gain", "0.5"}};
  recipe.renderer = "opencl";
  recipe.precision = "double";
  return recipe;
}

void expect_same(const Recipe& a, const Recipe& b) {
  EXPECT_EQ(a.text(), b.text());
  EXPECT_EQ(a.version, b.version);
  EXPECT_EQ(a.capture.name, b.capture.name);
  EXPECT_EQ(a.capture.checksum, b.capture.checksum);
  ASSERT_EQ(a.functions.has_value(), b.functions.has_value());
  if (a.functions) {
    EXPECT_EQ(a.functions->bytes, b.functions->bytes);
  }
  ASSERT_EQ(a.mask.has_value(), b.mask.has_value());
  if (a.mask) {
    EXPECT_EQ(a.mask->name, b.mask->name);
  }
  EXPECT_EQ(a.options, b.options);
  EXPECT_EQ(a.renderer, b.renderer);
  EXPECT_EQ(a.precision, b.precision);
}

TEST(Recipe, IsOneLineOfPrintableAscii) {
  const Recipe recipe = example("# größer\nM0 [0:1]\t, [5:0]\r\n");
  const std::string text = recipe.text();
  for (const char c : text) {
    EXPECT_GE(c, ' ');
    EXPECT_LT(c, 127);
  }
  EXPECT_TRUE(text.starts_with(kPictureTextStart));
  expect_same(Recipe::parse(text, "test"), recipe);
}

// Comments of function files may be in any encoding: what is written out must be what was read.
TEST(Recipe, KeepsEveryByteOfAFunctionFile) {
  std::string bytes;
  for (int c = 0; c < 256; ++c) bytes.push_back(static_cast<char>(c));
  for (const std::string& functions :
       {bytes, std::string("caf\xe9"), std::string("caf\xc3\xa9"), std::string()}) {
    expect_same(Recipe::parse(example(functions).text(), "test"), example(functions));
  }
}

// So may their names be.
TEST(Recipe, KeepsEveryByteOfAName) {
  Recipe recipe = example("M0 [0:1]\n");
  recipe.capture.name = "caf\xe9/*.png";
  recipe.functions->name = "caf\xe9.fn";
  recipe.mask = Recipe::Input{"\xff.pgm", "x"};
  const Recipe read = Recipe::parse(recipe.text(), "test");
  EXPECT_EQ(read.capture, recipe.capture);
  EXPECT_EQ(read.functions->name, recipe.functions->name);
  EXPECT_EQ(read.mask, recipe.mask);
  recipe.capture.name = "..\xe9/../x";
  EXPECT_THROW(static_cast<void>(Recipe::parse(recipe.text(), "test")), InputError);
}

TEST(Recipe, SaysWhatIsDamaged) {
  const auto message = [](const char* text) {
    return message_of<InputError>([&] { return Recipe::parse(text, "a.png"); });
  };
  for (const char* text :
       {"{\"nutik-cl\":", "{}", "[]", "{\"nutik-cl\":3}", "{\"nutik-cl\":\"1\",\"capture\":\"x\"}"}) {
    EXPECT_TRUE(message(text).starts_with("a.png: its recipe is damaged: ")) << text << ": " << message(text);
  }
}

class InPictures : public testing::TestWithParam<const char*> {};

// The text comes back, however long, and pictures are the same to other programs, with it and without.
TEST_P(InPictures, LeavesTheValuesAlone) {
  const Scratch scratch;
  const std::string extension = GetParam();
  const bool is_colour = extension != ".pgm";
  for (const std::uint32_t white : {255u, 65'535u}) {
    if (white > 255 && extension == ".jpg") continue;
    const Picture picture = random_stills({17, 9, is_colour ? 3u : 1u}, white, 1, 5).front();
    const auto plain = scratch / ("plain" + extension), with = scratch / ("with" + extension);
    write_picture(plain, picture);
    EXPECT_FALSE(read_recipe(plain));
    const cv::Mat wanted = cv::imread(plain.string(), cv::IMREAD_UNCHANGED);
    ASSERT_FALSE(wanted.empty());
    for (const std::size_t length : {std::size_t{1}, std::size_t{3000}, std::size_t{9'000'000}}) {
      if (length > 10'000 && white > 255) continue;  // takes a second
      const Recipe recipe = example(std::string(length, '#'));
      write_picture(with, picture, recipe.text());
      auto read = read_recipe(with);
      ASSERT_TRUE(read) << length;
      read->file = recipe.file;
      EXPECT_EQ(read->text(), recipe.text());
      // OpenCV itself refuses chunks and comments of some megabytes.
      if (length > 10'000) continue;
      const cv::Mat got = cv::imread(with.string(), cv::IMREAD_UNCHANGED);
      ASSERT_EQ(got.size(), wanted.size());
      EXPECT_EQ(cv::norm(got, wanted, cv::NORM_INF), 0) << extension << ", " << length;
    }
  }
}

// Whatever changes in a file changes what it is known by, but for the checksum of a PNG's chunk, which readers try.
TEST_P(InPictures, KnowTheirFiles) {
  const Scratch scratch;
  const std::string extension = GetParam();
  const Picture picture = random_stills({5, 4, extension == ".pgm" ? 1u : 3u}, 255, 1, 5).front();
  for (const std::size_t length : {1, 3000}) {
    const auto path = scratch / ("a" + extension);
    write_picture(path, picture, example(std::string(length, '#')).text());
    const std::string file = read_file(path);
    EXPECT_TRUE(is_as_sealed(path));
    std::size_t passed = 0;
    for (std::size_t at = 0; at < file.size(); at += length < 10 ? 1 : 97) {
      std::string changed = file;
      changed[at] = static_cast<char>(changed[at] ^ 1);
      passed += is_as_sealed(scratch.write("changed" + extension, changed)) ? 1 : 0;
    }
    EXPECT_LE(passed, extension == ".png" ? 4u : 0u);
    EXPECT_FALSE(is_as_sealed(scratch.write("longer" + extension, file + "x")));
    EXPECT_FALSE(is_as_sealed(scratch.write("cut" + extension, file.substr(0, file.size() - 1))));
    Recipe recipe = *read_recipe(path);
    EXPECT_NE(recipe.file, Recipe().file);
    recipe.file.clear();  // as earlier programs wrote it
    write_picture(path, picture, recipe.text());
    EXPECT_FALSE(is_as_sealed(path));
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, InPictures, testing::Values(".png", ".tif", ".jpg", ".ppm", ".pgm"),
                         [](const auto& tested) { return std::string(tested.param).substr(1); });

TEST(PictureText, IsOurOwnOnly) {
  const Scratch scratch;
  EXPECT_FALSE(read_picture_text(scratch.write("a.pgm", "P5\n# CREATOR: somebody\n1 1\n255\nx")));
  EXPECT_EQ(
      read_picture_text(scratch.write("b.pgm", "P5\n# CREATOR: somebody\n# {\"nutik-cl\":1}\n1 1\n255\nx")),
      "{\"nutik-cl\":1}");
  EXPECT_FALSE(read_picture_text(scratch.write("c.pfm", "Pf\n1 1\n-1.0\n1234")));
  expect_error<InputError>([&] { return read_picture_text(scratch.write("a.txt", "notes of mine")); },
                           {"is no PNG, JPEG, TIFF, Netpbm, OpenEXR: it can carry no recipe"});
  expect_error<InputError>([&] { return read_picture_text(scratch.write("cut.png", "\x89PNG\r\n\x1a\n")); },
                           {"it was cut off"});
  expect_error<InputError>([&] { return read_picture_text(scratch.write("cut.tif", {"II*\0", 4})); },
                           {"it is no TIFF, or was cut off"});
}

// A thousandth of it is enough to write 64 MiB into a PNG.
TEST(PictureText, HasALimit) {
  const Scratch scratch;
  write_picture(scratch / "without.png", random_stills({2, 2, 1}, 255, 1, 5).front());
  const std::string text = std::string(kPictureTextStart) + std::string(kMaxPictureTextBytes, '#');
  uLongf size = compressBound(text.size());
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(text.data()), text.size());
  const std::string begin = std::string(kPictureTextKeyword) + std::string(2, '\0');
  const auto path =
      scratch.write("a.png", with_chunk(read_file(scratch / "without.png"), "zTXt", begin + packed.substr(0, size)));
  EXPECT_LT(std::filesystem::file_size(path), 1u << 20);
  expect_error<InputError>([&] { return read_picture_text(path); }, {"a.png: a text in it cannot be read (zTXt"});
}

TEST(InputChecksum, FollowsContentAndNotNames) {
  const Scratch scratch;
  scratch.write("a", "content");
  scratch.write("b", "content");
  scratch.write("c", "contenu");
  EXPECT_EQ(input_checksum(scratch / "a"), input_checksum(scratch / "b"));
  EXPECT_NE(input_checksum(scratch / "a"), input_checksum(scratch / "c"));
  EXPECT_EQ(input_checksum(scratch / "a").substr(0, 8), "xxh3-64:");
  EXPECT_EQ(input_checksum(scratch / "a").size(), 8u + 16u);
  EXPECT_NE(input_checksum(scratch.write("empty", "")), input_checksum(scratch / "a"));
  EXPECT_THROW(static_cast<void>(input_checksum(scratch / "absent")), InputError);
}

TEST(InputChecksum, TakesStillsOneByOne) {
  const Scratch scratch;
  for (const char* folder : {"x", "y", "z"}) std::filesystem::create_directory(scratch / folder);
  // The same bytes behind one another, cut in another place.
  scratch.write("x/1.pgm", "ab");
  scratch.write("x/2.pgm", "c");
  scratch.write("y/1.pgm", "a");
  scratch.write("y/2.pgm", "bc");
  scratch.write("z/other1.pgm", "ab");
  scratch.write("z/other2.pgm", "c");
  EXPECT_NE(input_checksum(scratch / "x"), input_checksum(scratch / "y"));
  EXPECT_EQ(input_checksum(scratch / "x"), input_checksum(scratch / "z"));
  EXPECT_EQ(input_checksum(scratch / "x/*.pgm"), input_checksum(scratch / "x"));
}

TEST(InputChecksum, TakesTheTimesOfATableOfStills) {
  const Scratch scratch;
  scratch.write("a.pgm", "a");
  const std::string before = input_checksum(scratch.write("t.csv", "a.pgm,0,10\n"));
  EXPECT_EQ(input_checksum(scratch.write("t.csv", "a.pgm,0,10\n")), before);
  EXPECT_NE(input_checksum(scratch.write("t.csv", "a.pgm,0,11\n")), before);
  scratch.write("a.pgm", "b");
  EXPECT_NE(input_checksum(scratch.write("t.csv", "a.pgm,0,10\n")), before);
}

TEST(InputChecksum, TakesTheEndsOfLargeFiles) {
  const Scratch scratch;
  const auto large = scratch.write("large", "start");
  std::filesystem::resize_file(large, kWholeChecksumBytes + 1);  // a hole: takes no space
  const std::string checksum = input_checksum(large);
  EXPECT_EQ(checksum.substr(0, 13), "xxh3-64-ends:");
  std::filesystem::resize_file(large, kWholeChecksumBytes + 2);
  EXPECT_NE(input_checksum(large), checksum);
}

TEST(InputChecksum, NamesInputsWithoutTheirFolders) {
  const Scratch scratch;
  scratch.write("clip.mkv", "x");
  std::filesystem::create_directory(scratch / "frames");
  EXPECT_EQ(input_name(scratch / "clip.mkv"), "clip.mkv");
  EXPECT_EQ(input_name(scratch / "frames"), "frames");
  EXPECT_EQ(input_name(scratch / "frames/"), "frames");
  EXPECT_EQ(input_name(scratch / "frames/*.png"), "frames/*.png");
  EXPECT_EQ(input_name("shot%04d.png"), "shot%04d.png");
}

}  // namespace
}  // namespace nutik::test
