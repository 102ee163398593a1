// Masks as a user makes them: from shapes, pictures and motion.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "capture/format.hpp"
#include "media/stills/mask_reader.hpp"
#include "media/writers/picture_writer.hpp"
#include "support/clips.hpp"
#include "support/moving_square_test.hpp"
#include "support/stills.hpp"

namespace nutik::test {
namespace {

class MaskCommand : public MovingSquareTest {
 protected:
  // The tags that `nutik-cl mask` with these words gives, for a mask of the capture's size.
  std::vector<std::uint8_t> tags(const Words& words) const {
    const ProgramResult result = make("mask -q --overwrite" + words + "-o made.pgm");
    if (result.status != 0) return {};
    const Picture mask = read_mask(scratch_ / "made.pgm");
    EXPECT_EQ(mask.shape, (Shape{MovingSquare::kWidth, MovingSquare::kHeight, 1}));
    const auto codes = mask.values<std::uint8_t>();
    return {codes.begin(), codes.end()};
  }

  // 0 everywhere but in rectangles, each with its tag, later over earlier.
  struct Box {
    int x, y, width, height, tag;
  };
  static std::vector<std::uint8_t> boxes(const std::vector<Box>& boxes) {
    std::vector<std::uint8_t> tags(std::size_t{MovingSquare::kWidth} * MovingSquare::kHeight, 0);
    for (const Box& box : boxes) {
      for (int y = box.y; y < box.y + box.height; ++y) {
        for (int x = box.x; x < box.x + box.width; ++x) {
          tags[static_cast<std::size_t>(y * MovingSquare::kWidth + x)] = static_cast<std::uint8_t>(box.tag);
        }
      }
    }
    return tags;
  }
};

// A TIFF whose values pass the maximum that it states: neither a crash nor a mask.
TEST_F(MaskCommand, RefusesAPictureWithCodesAboveItsOwnWhite) {
  const auto stills = random_stills({MovingSquare::kWidth, MovingSquare::kHeight, 1}, 65'535, 1, 1);
  TiffOptions options;
  options.max_sample_value = 1023;
  scratch_.write("above.tif", tiff_file(stills, options));
  expect_refused("mask --threshold above.tif 0..500 -o m.pgm --preview p.png", 3,
                 "above the 1023 that it states");
  EXPECT_FALSE(exists("m.pgm"));
}

// The square's way, and the rest.
TEST_F(MaskCommand, KnowsWhatMoves) {
  EXPECT_EQ(tags("--moving clip.tik"), boxes({{4, 20, 32, 8, 255}}));
  EXPECT_EQ(tags("--still clip.tik"), boxes({{0, 0, 96, 48, 255}, {4, 20, 32, 8, 0}}));
  EXPECT_EQ(tags("--tag 9 --still --tag 7 --moving clip.tik"), boxes({{0, 0, 96, 48, 9}, {4, 20, 32, 8, 7}}));
  // Samples 5 to 10: the square from 14 to 32.
  EXPECT_EQ(tags("--changed-between 5f 10f clip.tik"), boxes({{14, 20, 18, 8, 255}}));
  EXPECT_EQ(tags("clip.tik --changed-between 0.05s 104ms"), boxes({{14, 20, 18, 8, 255}}));
  EXPECT_EQ(tags("--changed-between=5f 10f clip.tik"), boxes({{14, 20, 18, 8, 255}}));
  // What moved before and rests now.
  EXPECT_EQ(tags("--changed-between 13f 19f clip.tik"), boxes({}));
}

TEST_F(MaskCommand, TakesAClipAsWell) {
  EXPECT_EQ(tags("-f 100 --moving frames"), boxes({{4, 20, 32, 8, 255}}));
}

TEST_F(MaskCommand, SaysWhatCountsAsAChange) {
  // The noise spans up to 4 codes, the square 140.
  const auto more = [&](const char* codes) {
    const std::vector<std::uint8_t> made = tags({"--moving", "--by", codes, "clip.tik"});
    return std::count(made.begin(), made.end(), 255);
  };
  EXPECT_EQ(more("4"), 32 * 8);
  EXPECT_GT(more("2"), 32 * 8 + 1000);
  EXPECT_EQ(more("144"), 0);
  expect_says(run("mask --moving --by 144 clip.tik").err, "--moving for M255 selects no pixel");
}

TEST_F(MaskCommand, ComparesPicturesAndTimes) {
  const auto two_squares = boxes({{4, 20, 8, 8, 255}, {28, 20, 8, 8, 255}});
  EXPECT_EQ(tags("--difference 0f 19f clip.tik"), two_squares);
  EXPECT_EQ(tags("--difference frames/00.pgm frames/19.pgm"), two_squares);
  EXPECT_EQ(tags("--difference frames/00.pgm 0.195s clip.tik"), two_squares);
  EXPECT_EQ(tags("--threshold 0f 150..255 clip.tik"), boxes({{4, 20, 8, 8, 255}}));
  EXPECT_EQ(tags("--threshold frames/19.pgm 60%"), boxes({{28, 20, 8, 8, 255}}));
  EXPECT_EQ(tags("--threshold frames/19.pgm 0..150"), boxes({{0, 0, 96, 48, 255}, {28, 20, 8, 8, 0}}));
  EXPECT_EQ(tags("--threshold frames/19.pgm 0..150 --smooth holes"), boxes({{0, 0, 96, 48, 255}}));
}

// Light of 0 to 1 in as many steps as codes of 16 bits have; tags as they stand.
TEST_F(MaskCommand, TakesFloatingPointPicturesAndTiff) {
  for (const std::string extension : {"npy", "exr", "pfm", "tif"}) {
    for (const char* picture : {"0", "19"})
      make("--exposure 1f --depth float clip.tik --start " + std::string(picture) + "f " + picture + "." + extension);
    EXPECT_EQ(tags("--difference 0." + extension + " 19." + extension + " --by 4000"),
              boxes({{4, 20, 8, 8, 255}, {28, 20, 8, 8, 255}}));
  }
  const auto mask_of = [&](double value) {
    Picture light({MovingSquare::kWidth, MovingSquare::kHeight, 1}, ValueType::light32, 0);
    light.values<float>()[3] = static_cast<float>(value);
    for (const char* name : {"m.exr", "m.pfm", "m.npy", "m.tif"}) write_picture(scratch_ / name, light);
  };
  mask_of(4);
  for (const char* name : {"m.exr", "m.pfm", "m.npy", "m.tif"})
    EXPECT_EQ(tags("--base " + std::string(name)), boxes({{3, 0, 1, 1, 4}})) << name;
  mask_of(4.5);
  expect_refused("mask --base m.npy -o x.pgm", 3,
                 "m.npy: pixel 3,0 has no value of a mask, a whole number from 0 to 255");
  mask_of(256);
  expect_refused("mask --base m.exr -o x.pgm", 3, "m.exr: pixel 3,0 has the value 256, no value of a mask");
  mask_of(-1);
  expect_refused("mask --base m.npy -o x.pgm", 3,
                 "m.npy: pixel 3,0 has the value -1, no value of a mask, a whole number from 0 to 255");
  Picture deep({MovingSquare::kWidth, MovingSquare::kHeight, 1}, ValueType::code16, 65'535);
  deep.values<std::uint16_t>()[3] = 1;
  write_picture(scratch_ / "m.tif", deep);
  EXPECT_EQ(tags("--base m.tif"), boxes({{3, 0, 1, 1, 1}}));
  deep.values<std::uint16_t>()[3] = 257;
  write_picture(scratch_ / "m.tif", deep);
  expect_refused("mask --base m.tif -o x.pgm", 3, "m.tif: pixel 3,0 has the value 257, no value of a mask");
  // All three channels are the tag, as painting programs save it.
  Picture painted({MovingSquare::kWidth, MovingSquare::kHeight, 3}, ValueType::code8, 255);
  std::fill_n(painted.bytes.begin() + 9, 3, std::byte{4});
  write_picture(scratch_ / "m.tif", painted);
  EXPECT_EQ(tags("--base m.tif"), boxes({{3, 0, 1, 1, 4}}));
  painted.bytes[9] = std::byte{5};
  write_picture(scratch_ / "m.tif", painted);
  expect_refused("mask --base m.tif -o x.pgm", 3, "pixel 3,0 is no grey: red 5, green 4, blue 4");
  // None of several is meant more than another.
  const Picture page({MovingSquare::kWidth, MovingSquare::kHeight, 1}, ValueType::light32, 0);
  const std::vector<PictureLayer> pages{{"a", "", page}, {"b", "", page}};
  for (const std::string name : {"pages.tif", "pages.npy"}) {
    write_layers(scratch_ / name, pages);
    expect_refused("mask --base " + name + " -o x.pgm", 3, name + " holds several pictures; a mask is one");
    expect_refused("--start 0s --exposure 1f --delay " + name + ":0s..1s clip.tik x.png", 3, name + " holds several");
  }
}

TEST_F(MaskCommand, ChangesTheRegionBefore) {
  EXPECT_EQ(tags("--difference 0f 19f --largest clip.tik"), boxes({{4, 20, 8, 8, 255}}));
  EXPECT_EQ(tags("--moving --within 10,0,10,48 clip.tik"), boxes({{10, 20, 10, 8, 255}}));
  EXPECT_EQ(tags("--moving --shrink 2 clip.tik"), boxes({{6, 22, 28, 4, 255}}));
  EXPECT_EQ(tags("--moving --grow 1 clip.tik"),
            boxes({{3, 20, 34, 8, 255}, {4, 19, 32, 10, 255}}));  // a disc: no corners
  EXPECT_EQ(tags("--moving --invert clip.tik"), tags("--still clip.tik"));
  EXPECT_EQ(tags("--moving --by 2 --smooth 3 clip.tik")[20 * 96 + 20], 255);
  // In the order in which they are said.
  EXPECT_EQ(tags("--moving --within 10,0,10,48 --invert clip.tik"),
            boxes({{0, 0, 96, 48, 255}, {10, 20, 10, 8, 0}}));
  EXPECT_EQ(tags("--moving --invert --within 10,0,10,48 clip.tik"),
            boxes({{10, 0, 10, 48, 255}, {10, 20, 10, 8, 0}}));
}

TEST_F(MaskCommand, LaysLaterRegionsOverEarlierOnes) {
  EXPECT_EQ(tags("--size 96x48 --tag 3 --rectangle 10,10,20,20 --tag 4 --rectangle 20,20,20,20"),
            boxes({{10, 10, 20, 20, 3}, {20, 20, 20, 20, 4}}));
  EXPECT_EQ(tags("--size 96x48 --tag 4 --rectangle 20,20,20,20 --tag 3 --rectangle 10,10,20,20"),
            boxes({{20, 20, 20, 20, 4}, {10, 10, 20, 20, 3}}));
  EXPECT_EQ(tags("--size 96x48 --fill --tag 0 --polygon 10,10,30,10,30,20,10,20"),
            boxes({{0, 0, 96, 48, 255}, {10, 10, 20, 10, 0}}));
  EXPECT_EQ(tags("--size 96x48 --ellipse 50.5,20.5,0.9,0.9"), boxes({{50, 20, 1, 1, 255}}));
  make("mask --size 96x48 --tag 3 --rectangle 10,10,20,20 -o base.png");
  EXPECT_EQ(tags("--base base.png --tag 4 --moving clip.tik"),
            boxes({{10, 10, 20, 20, 3}, {4, 20, 32, 8, 4}}));
  EXPECT_EQ(tags("--base base.png"), boxes({{10, 10, 20, 20, 3}}));
}

TEST_F(MaskCommand, WritesEveryTagExactly) {
  std::string plain = "P2 96 48 255\n";
  for (int i = 0; i < 96 * 48; ++i) plain += std::to_string(i % 256) + "\n";
  scratch_.write("all.pgm", plain);
  make("mask --base all.pgm -o a.pgm");
  make("mask --base a.pgm -o b.png");
  const std::string raw = file("a.pgm");
  EXPECT_TRUE(raw.starts_with("P5\n96 48\n255\n"));
  EXPECT_EQ(read_mask(scratch_ / "a.pgm").bytes, read_mask(scratch_ / "all.pgm").bytes);
  EXPECT_EQ(read_mask(scratch_ / "b.png").bytes, read_mask(scratch_ / "all.pgm").bytes);
}

TEST_F(MaskCommand, ExposesWithWhatItMade) {
  make("mask --moving clip.tik mask.pgm");
  scratch_.write("two.fn", "M0 [0:1], [200000000:1]\nM255 [0:1], [10000000:1], [10000001:0]\n");
  make("-m mask.pgm -k two.fn clip.tik out.png");
  const cv::Mat out = picture("out.png"), mask = picture("mask.pgm"), first = picture("frames/00.pgm");
  // Where it moves the first picture alone is exposed.
  EXPECT_LE(cv::norm(out, first, cv::NORM_INF, mask), 1);
  EXPECT_GT(cv::norm(out, first, cv::NORM_INF, mask == 0), 1);
}

TEST_F(MaskCommand, ReportsAndShows) {
  const ProgramResult text = make("mask --tag 128 --moving clip.tik --preview seen.png");
  expect_says(text.out, {"clip-mask.pgm: 96 x 48, 2 tags", "256 pixels   5.56 %, by more than 15 codes"});
  EXPECT_TRUE(file("seen.png").starts_with("\x89PNG"));
  EXPECT_EQ(run("mask -q --overwrite --moving clip.tik").out, "clip-mask.pgm\n");
  const auto json = answer("mask --moving --grow 0 clip.tik m.png");
  EXPECT_EQ(json["mask"], "m.png");
  EXPECT_EQ(json["steps"][0]["more_than_codes"], 15);
  EXPECT_EQ(json["tags"],
            nlohmann::json::parse(R"([{"tag":0,"pixel_count":4352},{"tag":255,"pixel_count":256}])"));
  for (const Words when : {"--start 3f", "--start 30ms --exposure 10ms"}) {
    make("mask --overwrite --moving clip.tik m.png --preview " + when[1] + ".png" + when);
  }
  // Picture 3 was exposed from 30 to 40 ms.
  EXPECT_EQ(file("3f.png"), file("30ms.png"));
  expect_says(run("mask --fill clip.tik one.png").out, "one.png: 96 x 48, 1 tag\n");
}

TEST_F(MaskCommand, WarnsOfAPreviewBeyondTheCapture) {
  const auto said = [&](const std::string& length) {
    return run({"mask", "--overwrite", "--moving", "clip.tik", "m.png", "--preview", "p.png", "--start", "0.15s",
                "--exposure", length})
        .err;
  };
  EXPECT_EQ(said("50ms"), "");
  EXPECT_EQ(said("51ms"),
            "warning: the preview's exposure: parts that are not zero lie after the capture's end at 0.2 s "
            "and do not count\n");
}

// An exposure of the same name carries how it was made; a mask does not.
TEST_F(MaskCommand, ReplacesMasksAndNoExposures) {
  for (const std::string name : {"same.png", "same.pgm"}) {
    make({"--start", "0s", "--exposure", "50ms", "clip.tik", name});
    const std::string exposure = file(name);
    expect_refused({"mask", "--moving", "clip.tik", name}, 2,
                   name + " exists and is no mask; it is not replaced");
    EXPECT_EQ(file(name), exposure);
  }
  make("contact clip.tik colour.png");
  expect_refused("mask --moving clip.tik colour.png", 2, "colour.png exists and is no mask");
  for (const char* name : {"again.png", "again.pgm"}) {
    make({"mask", "--moving", "clip.tik", name});
    expect_refused({"mask", "--still", "clip.tik", name}, 2, "is there already and is not replaced");
    make({"mask", "--still", "--overwrite", "clip.tik", name});
  }
}

// A tag that was asked for and that no pixel has in the end.
TEST_F(MaskCommand, WarnsOfTagsThatLaterStepsCover) {
  const auto warned = [&](const Words& words) { return run("mask --overwrite" + words + "clip.tik covered.pgm").err; };
  EXPECT_EQ(warned({"--tag", "64", "--rectangle", "10,10,5,5", "--tag", "128", "--rectangle", "8,8,9,9"}),
            "warning: --rectangle: later steps cover all of M64, which no pixel has in the end\n");
  EXPECT_EQ(warned({"--tag", "64", "--rectangle", "10,10,5,5", "--tag", "128", "--rectangle", "10,10,5,4"}),
            "");
  EXPECT_EQ(
      warned({"--tag", "64", "--rectangle", "1,1,5,5", "--tag", "7", "--fill", "--tag", "64", "--moving"}),
      "");
  EXPECT_EQ(warned({"--grid", "4x1", "--tag", "9", "--rectangle", "0,0,50,48"}),
            "warning: --grid: later steps cover all of M0, M1, which no pixel has in the end\n");
}

TEST_F(MaskCommand, RefusesWhatMakesNoSense) {
  expect_refused(
      2, {{"mask clip.tik", "what is the mask made of? Add a step: --moving"},
          {"mask --moving", "the output is missing: nutik-cl mask --moving clip.tik mask.pgm"},
          {"mask --moving -o x.pgm", "--moving needs a capture or a clip"},
          {"mask --rectangle 1,1,2,2 -o x.pgm", "say --size 640x360"},
          {"mask --rectangle 1,1,2,2 x.pgm", "to write it: -o x.pgm"},
          {"mask --rectangle 1,1,2 clip.tik", "--rectangle needs 4 numbers, X,Y,WIDTH,HEIGHT"},
          {"mask --rectangle 1,1,2,0 clip.tik", "width and height must be above 0"},
          {"mask --ellipse 1,1,two,2 clip.tik", "'two' is no number"},
          {"mask --polygon 1,1,2,2 clip.tik", "--polygon needs three corners or more"},
          {"mask --tag 256 --moving clip.tik", "tag '256' is no whole number of 0 … 255"},
          {"mask --grow 2 clip.tik", "--grow changes the region before it: first select one"},
          {"mask --moving --tag 3 clip.tik",
           "--tag 3 has no region behind it: write --tag 3 before --moving"},
          {"mask --moving --tag 2 --grow 2 clip.tik", "after --tag there is none yet"},
          {"mask --moving --grow -1 clip.tik", "--grow '-1' is no number of pixels"},
          {"mask --fill --by 3 clip.tik", "--by says how much codes must change; --fill"},
          {"mask --moving --by 255 clip.tik", "--moving: no codes differ by more than 255, for white is 255"},
          {"mask --moving clip.tik m.pgm --preview p.pfm", "p.pfm holds floating point only"},
          {"mask --moving clip.tik m.pgm --preview p.pgm", "p.pgm holds grey pictures only"},
          {"mask --moving --by 0 clip.tik", "--by '0' is no whole number of 1"},
          {"mask --threshold 0f 9..1 clip.tik", "'9..1' is no range of codes"},
          {"mask --threshold 0f 40%..60 clip.tik", "is no range of codes"},
          {"mask --threshold 99999999999s 0..3 clip.tik", "--threshold '99999999999s' is longer than 126 years"},
          {"mask --difference 0f 0.12345678901234567s clip.tik", "'0.12345678901234567s' needs more than 15 digits"},
          {"mask --changed-between 0.3 0.5s clip.tik", "'0.3' is no time"},
          {"mask --changed-between 9f 3f clip.tik", "write the earlier first"},
          {"mask --changed-between 0s 9s clip.tik", "outside the capture, which lasts 200 ms"},
          {"mask --changed-between 0f 20f clip.tik", "picture 20 is outside the capture"},
          {"mask --moving clip.tik m.jpg", "masks are written as .pgm or .png"},
          {"mask --moving clip.tik -o clip.tik", "clip.tik: masks are written as .pgm"},
          {"mask --moving --size 9x9 clip.tik", "--size is 9 x 9, clip.tik is 96 x 48"},
          {"mask --moving --size 9 clip.tik", "size '9' is none; write WIDTHxHEIGHT"},
          {"mask --moving --start 1f clip.tik", "add --preview picture.png"},
          {"mask --moving clip.tik m.pgm --preview m.pgm", "is also an input"}});
  expect_refused("mask --threshold absent.png 1..2 clip.tik", 3, "absent.png");
  expect_refused("mask --threshold frames 1..2 clip.tik", 2, "frames is a sequence of 20");
  scratch_.write("small.pgm", "P2 2 1 255 0 1");
  expect_refused("mask --base small-%d.pgm --moving clip.tik", 3, "small-%d.pgm stands for the layers of a soft mask");
  expect_refused("mask --threshold small.pgm 1..2 clip.tik", 3, "the picture is 2 x 1, the mask 96 x 48");
  expect_refused(2, {{"mask --base small.pgm --moving clip.tik", "the sizes must agree"},
                     {"mask --threshold small.pgm 1..2 -o small.pgm", "is also an input"}});
  EXPECT_EQ(file("small.pgm"), "P2 2 1 255 0 1");
  expect_refused("expose --moving clip.tik", 2, "--moving does not go with expose; it is an option of: mask");
}

TEST_F(MaskCommand, CutsThePictureIntoAGrid) {
  const int half = MovingSquare::kWidth / 2, height = MovingSquare::kHeight;
  const int rest =
      MovingSquare::kWidth - half;  // of an odd width the middle pixel's centre lies on the line: right
  const std::vector<std::uint8_t> halves = boxes({{half, 0, rest, height, 1}});
  EXPECT_EQ(tags("--grid 2x1 clip.tik"), halves);
  EXPECT_EQ(tags("--tag 7 --grid 2x1 --within 0,0,3,2 clip.tik"), boxes({{0, 0, 3, 2, 7}}));
  const auto columns = tags({"--grid", format("{}x1", MovingSquare::kWidth), "clip.tik"});
  for (int x = 0; x < MovingSquare::kWidth; ++x) EXPECT_EQ(columns[static_cast<std::size_t>(x)], x);
  expect_refused(
      2, {{"mask --grid 4 clip.tik a.pgm", "write COLUMNSxROWS: 16x9"},
          {"mask --grid 0x4 clip.tik a.pgm", "1 … 256"},
          {"mask --tag 1 --grid 16x16 clip.tik a.pgm", "has 256 cells, tagged from 1 on: tags end at 255"}});
  expect_refused("mask --grid 256x1 clip.tik a.pgm", 3, "more cells than pixels along a side");
}

}  // namespace
}  // namespace nutik::test
