#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "capture/error.hpp"
#include "media/stills/mask_reader.hpp"
#include "support/ffmpeg.hpp"
#include "support/hostile.hpp"
#include "support/messages.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

std::vector<int> tags_of(const Picture& mask) {
  const auto values = mask.values<std::uint8_t>();
  return {values.begin(), values.end()};
}

TEST(Mask, TagsAreLiteralWhateverTheMaximum) {
  const Scratch scratch;
  EXPECT_EQ(tags_of(read_mask(scratch.write("a.pgm", "P2\n# a comment\n3 1\n4\n0 1 4\n"))),
            (std::vector<int>{0, 1, 4}));
  EXPECT_EQ(tags_of(read_mask(scratch.write("b.pgm", std::string("P5 3 1 4\n\0\1\4", 12)))),
            (std::vector<int>{0, 1, 4}));
  EXPECT_EQ(tags_of(read_mask(scratch.write("c.pgm", "P2 3 1 255 0 128 255"))),
            (std::vector<int>{0, 128, 255}));
}

// Grey, or as painting programs make it: colour whose channels agree, and an alpha channel that says nothing.
TEST(Mask, ReadsGreyHoweverItIsStored) {
  const Scratch scratch;
  for (const auto& [name, type] :
       {std::pair("grey.png", CV_8UC1), {"colour.png", CV_8UC3}, {"colour.ppm", CV_8UC3}, {"opaque.png", CV_8UC4}}) {
    cv::Mat picture(5, 7, type);
    for (int i = 0; i < 35; ++i) picture(cv::Rect(i % 7, i / 7, 1, 1)) = cv::Scalar(i * 7, i * 7, i * 7, 255);
    cv::imwrite((scratch / name).string(), picture);
    const Picture mask = read_mask(scratch / name);
    EXPECT_EQ(mask.shape, (Shape{7, 5, 1})) << name;
    for (std::size_t i = 0; i < 35; ++i) EXPECT_EQ(mask.values<std::uint8_t>()[i], i * 7) << name;
  }
}

TEST(Mask, ReadsGreyPicturesThatAreOpaque) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  scratch.write("raw", "\x07\xFF\xC8\xFF\x01\xFF");
  test::make(scratch, "-f rawvideo -pix_fmt ya8 -s 3x1 -i raw mask.png");
  EXPECT_EQ(tags_of(read_mask(scratch / "mask.png")), (std::vector<int>{7, 200, 1}));
}

// A code that is clear is one only where a pixel has it.
TEST(Mask, IsOpaqueWhereNoPixelHasTheClearCode) {
  const Scratch scratch;
  cv::imwrite((scratch / "mask.png").string(), cv::Mat(1, 3, CV_8UC1, cv::Scalar(7)));
  const std::string png = read_file(scratch / "mask.png");
  scratch.write("mask.png", with_chunk(png, "tRNS", std::string("\0\x08", 2)));
  EXPECT_EQ(tags_of(read_mask(scratch / "mask.png")), (std::vector<int>{7, 7, 7}));
  scratch.write("mask.png", with_chunk(png, "tRNS", std::string("\0\x07", 2)));
  expect_error<InputError>([&] { return read_mask(scratch / "mask.png"); }, {"its pixel 0,0 has alpha 0 of 255"});
}

std::string message_of(const std::filesystem::path& path) {
  return test::message_of<InputError>([&] { return read_mask(path); });
}

TEST(Mask, SaysWhatIsWrong) {
  const Scratch scratch;
  cv::imwrite((scratch / "deep.png").string(), cv::Mat(2, 2, CV_16UC1, cv::Scalar(9)));
  cv::Mat colour(3, 4, CV_8UC3, cv::Scalar::all(9));
  colour.at<cv::Vec3b>(1, 2) = {9, 8, 9};
  cv::imwrite((scratch / "colour.png").string(), colour);
  cv::Mat clear(2, 2, CV_8UC4, cv::Scalar::all(255));
  clear.at<cv::Vec4b>(1, 0)[3] = 254;
  cv::imwrite((scratch / "clear.png").string(), clear);
  cv::imwrite((scratch / "deep-clear.png").string(), cv::Mat(2, 2, CV_16UC4, cv::Scalar::all(9)));
  cv::imwrite((scratch / "mask.jpg").string(), cv::Mat(2, 2, CV_8UC1, cv::Scalar(9)));
  expect_says(message_of(scratch / "deep.png"), "is a PNG of 16 bits, grey; it must be 8 bits, grey");
  expect_says(message_of(scratch / "colour.png"),
              "is a colour picture, and its pixel 2,1 is no grey: red 9, green 8, blue 9. A mask has one value "
              "for each");
  expect_says(message_of(scratch / "clear.png"),
              "is transparent, and its pixel 0,1 has alpha 254 of 255; save it without transparency");
  expect_says(message_of(scratch / "deep-clear.png"),
              "is a PNG of 16 bits, RGB with transparency; it must be 8 bits, grey");
  expect_says(message_of(scratch / "mask.jpg"), "neither a PGM nor a PNG");
  expect_says(message_of(scratch / "mask.jpg"), "of whole numbers: TIFF, OpenEXR, PFM, NumPy");
  expect_says(message_of(scratch / "absent.pgm"), "cannot be read: No such file");
  expect_says(message_of(scratch.write("rgb.ppm", "P3 1 1 255 1 2 3")),
              "is a colour picture, and its pixel 0,0 is no grey: red 1, green 2, blue 3");
  expect_says(message_of(scratch.write("two.pgm", "P2 1 1 255 1\nP2 1 1 255 2\n")),
              "holds several pictures; a mask is one");
  expect_says(message_of(scratch.write("deep.pgm", "P2 1 1 65535 300")), "is a picture of 16 bits (maximum 65535)");
  expect_says(message_of(scratch.write("cut.pgm", "P5 100 100 255\nabc")),
              "it was cut off: 100 x 100 pixels need 10000");
  expect_says(message_of(scratch.write("cut2.pgm", "P2 2 2 255 1 2 3")),
              "it was cut off: 2 x 2 pixels need 8 bytes, 6 are left");
  expect_says(message_of(scratch.write("over.pgm", "P2 1 1 10 11")), "value 11 is above its maximum of 10");
  expect_says(message_of(scratch.write("huge.pgm", "P5 4000000000 2 255\n")), "its width is above");
  expect_says(message_of(scratch.write("word.pgm", "P2 two 2 255")), "a width is missing at byte 3");
}

}  // namespace
}  // namespace nutik::test
