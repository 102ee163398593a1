// Stills of every kind give their codes back, say what is white, and are refused with a reason.
#include <gtest/gtest.h>

#include <csignal>
#include <opencv2/imgcodecs.hpp>

#include "capture/error.hpp"
#include "media/stills/mask_reader.hpp"
#include "media/writers/picture_writer.hpp"
#include "support/clips.hpp"
#include "support/hostile.hpp"
#include "support/messages.hpp"
#include "support/scratch.hpp"
#include "support/stills.hpp"
#include "system/interruption.hpp"

namespace nutik::test {
namespace {

constexpr Shape kGreyShape{17, 9, 1}, kColourShape{17, 9, 3};

void expect_refused(const std::filesystem::path& path, const std::vector<std::string>& parts,
                    const ClipOptions& options = {}) {
  SCOPED_TRACE(path);
  expect_error<InputError>([&] { return read_all(*open_test_clip(path, options)); }, parts);
}

void write_with_opencv(const std::filesystem::path& path, const Picture& still) {
  const int depth = still.type == ValueType::code8 ? CV_8U : CV_16U;
  const auto& shape = still.shape;
  cv::Mat picture(static_cast<int>(shape.height), static_cast<int>(shape.width),
                  CV_MAKETYPE(depth, static_cast<int>(shape.channels)));
  const std::size_t bytes = picture.elemSize1();
  for (std::uint64_t i = 0; i < shape.value_count(); ++i) {
    const std::uint64_t to = shape.channels == 3 ? i / 3 * 3 + 2 - i % 3 : i;
    std::copy_n(reinterpret_cast<const std::uint8_t*>(still.bytes.data()) + i * bytes, bytes,
                picture.data + to * bytes);
  }
  ASSERT_TRUE(cv::imwrite(path.string(), picture));
}

TEST(StillClip, GivesTheCodesOfPngAndTiffBack) {
  for (const char* extension : {".png", ".tif"}) {
    for (const Shape shape : {kGreyShape, kColourShape, Shape{1, 1, 1}, Shape{64, 65, 3}}) {
      for (const std::uint32_t white : {255u, 65'535u}) {
        SCOPED_TRACE(std::string(extension) + ", white " + std::to_string(white));
        const Scratch scratch;
        const auto stills = random_stills(shape, white, 3, white + shape.width);
        for (std::size_t k = 0; k < 3; ++k) {
          write_with_opencv(scratch / ("f" + std::to_string(k) + extension), stills[k]);
        }
        const auto clip = open_test_clip(scratch.folder(), {});
        const CaptureFormat& format = clip->info().format;
        EXPECT_EQ(format.white_code, white);
        EXPECT_EQ(format.transfer, white == 255 ? Transfer::srgb() : Transfer::linear());
        // 16 bits of which the files do not say how many are used.
        EXPECT_EQ(clip->info().notes.size(), white == 255 ? 0u : 1u);
        expect_codes(*clip, stills);
      }
    }
  }
}

TEST(StillClip, TakesTheWhiteCodeOfNetpbm) {
  for (const Shape shape : {kGreyShape, kColourShape}) {
    for (const std::uint32_t white : {1u, 100u, 255u, 256u, 1023u, 4095u, 65'535u}) {
      for (const bool plain : {false, true}) {
        SCOPED_TRACE("white " + std::to_string(white) + (plain ? ", plain" : ", raw"));
        const Scratch scratch;
        const auto stills = random_stills(shape, white, 2, white);
        const std::string extension = shape.channels == 1 ? ".pgm" : ".ppm";
        for (std::size_t k = 0; k < 2; ++k) {
          scratch.write("f" + std::to_string(k) + extension, netpbm_file(stills[k], plain));
        }
        const auto clip = open_test_clip(scratch / ("f%d" + extension), {});
        EXPECT_EQ(clip->info().format.white_code, white);
        EXPECT_TRUE(clip->info().notes.empty());
        expect_codes(*clip, stills);
      }
    }
  }
}

TEST(StillClip, ReadsPam) {
  const Scratch scratch;
  const auto pam = [](const Picture& still, const std::string& type) {
    const std::size_t bytes = still.shape.value_count() * (still.white_code > 255 ? 2 : 1);
    const std::string raster = netpbm_file(still, false);
    return "P7\n# in any order\nMAXVAL " + std::to_string(still.white_code) + "\nDEPTH " +
           std::to_string(still.shape.channels) + "\nTUPLTYPE " + type + "\nHEIGHT 9\nWIDTH 17\nENDHDR\n" +
           raster.substr(raster.size() - bytes);
  };
  for (const std::uint32_t white : {1u, 100u, 255u, 4095u, 65'535u}) {
    for (const Shape& shape : {kGreyShape, kColourShape}) {
      const auto stills = random_stills(shape, white, 2, white);
      const std::string type = shape.channels == 3 ? "RGB" : white == 1 ? "BLACKANDWHITE" : "GRAYSCALE";
      for (const char* name : {"a.pam", "a.dat"}) {
        const auto clip = open_test_clip(scratch.write(name, pam(stills[0], type) + pam(stills[1], type)), {});
        EXPECT_EQ(clip->info().format.white_code, white);
        expect_codes(*clip, stills);
      }
    }
  }
  const std::string colour = pam(Picture({17, 9, 3}, ValueType::code8, 255), "RGB");
  expect_refused(scratch.write("a.pam", colour.substr(0, 40)), {"a.pam cannot be read: it was cut off: its front"});
  expect_refused(scratch.write("a.pam", colour.substr(0, 200)), {"a.pam cannot be read: it was cut off: 17 x 9"});
}

TEST(StillClip, ReadsTiffStacksOfEveryLayout) {
  struct Case {
    const char* name;
    Shape shape;
    std::uint32_t white;
    TiffOptions options;
    std::uint32_t stated_white;
  };
  const Case cases[] = {
      {"16 bits", kGreyShape, 65'535, {}, 65'535},
      {"big-endian", kGreyShape, 65'535, {16, true}, 65'535},
      {"colour, big-endian", kColourShape, 65'535, {16, true}, 65'535},
      {"colour, planar", kColourShape, 65'535, {16, false, false, true}, 65'535},
      {"8 bits, planar, big-endian", kColourShape, 255, {8, true, false, true}, 255},
      {"12 bits packed", kGreyShape, 4095, {12}, 4095},
      {"10 bits packed, colour", kColourShape, 1023, {10}, 1023},
      {"14 bits packed, planar", kColourShape, 16'383, {14, true, false, true}, 16'383},
      {"inverted", kGreyShape, 255, {8, false, true}, 255},
      {"inverted, 12 bits", kGreyShape, 4095, {12, false, true}, 4095},
      {"states 4095", kGreyShape, 4095, {16, false, false, false, 4095}, 4095},
      {"inverted, states 4095", kGreyShape, 4095, {16, false, true, false, 4095}, 4095},
      {"of undefined values", kGreyShape, 255, {8, false, false, false, 0, 4}, 255},
      {"states a value that occurs", kGreyShape, 5000, {16, false, false, false, 5000}, 65'535},
  };
  for (const Case& tested : cases) {
    SCOPED_TRACE(tested.name);
    const Scratch scratch;
    const auto stills = random_stills(tested.shape, tested.white, 4, tested.white);
    const auto path = scratch.write("stack.tif", tiff_file(stills, tested.options));
    const auto clip = open_test_clip(path, {});
    EXPECT_EQ(clip->info().format.white_code, tested.stated_white);
    expect_codes(*clip, stills);
  }
}

// A reader that walks from the first page to the one wanted takes half a minute for this.
TEST(StillClip, ReadsLongStacksInOneGo) {
  const Scratch scratch;
  const auto stills = random_stills({4, 4, 1}, 65'535, 4000, 1);
  expect_codes(*open_test_clip(scratch.write("long.tif", tiff_file(stills, {})), {}), stills);
}

TEST(StillClip, ReadsJpeg) {
  for (const Shape shape : {kGreyShape, kColourShape}) {
    const Scratch scratch;
    const auto stills = random_stills(shape, 255, 1, 3);
    write_with_opencv(scratch / "f.jpg", stills[0]);
    const auto clip = open_test_clip(scratch / "f.jpg", {});
    EXPECT_EQ(clip->info().format.shape, shape);
    EXPECT_EQ(clip->info().format.code_bytes, 1u);
    EXPECT_EQ(read_all(*clip).size(), 1u);
  }
}

// Its decoder goes on behind damage; behind its end a phone may have a film.
TEST(StillClip, OfJpegEndsWhereItsPictureDoes) {
  const Scratch scratch;
  write_with_opencv(scratch / "a.jpg", random_stills({64, 48, 3}, 255, 1, 3)[0]);
  const std::string whole = read_file(scratch / "a.jpg"), head = whole.substr(0, whole.size() / 2);
  scratch.write("film.jpg", whole + std::string("\0\0\0\x18" "ftypmp42\xFF\xDA", 14));
  EXPECT_EQ(read_all(*open_test_clip(scratch / "film.jpg", {})), read_all(*open_test_clip(scratch / "a.jpg", {})));
  for (const std::string& damaged : {head + whole.substr(head.size() + 500), head + "\xFF\xD9"})
    expect_refused(scratch.write("b.jpg", damaged), {"b.jpg cannot be read: it is damaged"});
  expect_refused(
      scratch.write("c.jpg", std::string("\xFF\xD8\xFF\xC0\0\x14\x08\0\x10\0\x10\x04\1\x11\0\2\x11\0\3\x11\0\4\x11\0"
                                         "\xFF\xDA\0\x0E\x04\1\0\2\0\3\0\4\0\0\x3F\0",
                                         40)),
      {"its colours are CMYK"});
}

// Where pixel x, y of what is shown stands in what lies as EXIF numbers it: from 5 on rows are columns, and then sides
// are mirrored.
std::size_t lying_at(unsigned orientation, const Shape& lying, std::uint32_t x, std::uint32_t y) {
  const bool is_turned = orientation >= 5;
  std::uint32_t row = is_turned ? x : y, column = is_turned ? y : x;
  const bool from_right = orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
  const bool from_below = orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
  if (from_right) column = lying.width - 1 - column;
  if (from_below) row = lying.height - 1 - row;
  return std::size_t{row} * lying.width + column;
}

// A camera held upright stores what it sees lying on its side, and says so: one rule for all that can say it, and for
// whatever name a file has.
TEST(StillClip, StandsUprightHoweverItLies) {
  using namespace std::string_literals;
  const Scratch scratch;
  const Shape lying{24, 16, 1};
  const auto still = random_stills(lying, 255, 1, 3)[0];
  write_with_opencv(scratch / "flat.jpg", still);
  write_with_opencv(scratch / "flat.png", still);
  const std::string jpeg = read_file(scratch / "flat.jpg"), png = read_file(scratch / "flat.png");
  const auto lossy = cv::imread((scratch / "flat.jpg").string(), cv::IMREAD_UNCHANGED);
  for (int orientation = 0; orientation <= 9; ++orientation) {
    // One entry of a big-endian TIFF: Orientation, a short.
    const std::string tags =
        "MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0"s + static_cast<char>(orientation) + "\0\0\0\0\0\0"s;
    const std::string exif = "Exif\0\0"s + tags;
    const std::string segment = "\xff\xe1\0"s + static_cast<char>(exif.size() + 2) + exif;
    TiffOptions options{8};
    options.orientation = orientation <= 8 ? orientation : 0;  // with others libtiff takes it for damaged
    for (const auto& [name, bytes] : {std::pair("a.jpg", jpeg.substr(0, 2) + segment + jpeg.substr(2)),
                                      {"a.png", with_chunk(png, "eXIf", tags)},
                                      {"a.tif", tiff_file({still}, options)}}) {
      for (const std::string file : {name, "a.mp4", "a.pgm"}) {
        SCOPED_TRACE(std::string(name) + " as " + file + ", orientation " + std::to_string(orientation));
        const auto clip = open_test_clip(scratch.write(file, bytes), {});
        const Shape& shape = clip->info().format.shape;
        const bool is_turned = orientation >= 5 && orientation <= 8;
        ASSERT_EQ(shape, (is_turned ? Shape{lying.height, lying.width, 1} : lying));
        Picture shown(shape, ValueType::code8, 255);
        for (std::uint64_t i = 0; i < shape.pixel_count(); ++i) {
          const std::size_t at =
              lying_at(orientation <= 8 ? static_cast<unsigned>(orientation) : 1, lying,
                       static_cast<std::uint32_t>(i % shape.width), static_cast<std::uint32_t>(i / shape.width));
          shown.bytes[i] = std::string(name) == "a.jpg" ? static_cast<std::byte>(lossy.data[at]) : still.bytes[at];
        }
        EXPECT_EQ(difference(read_all(*clip).at(0), shown), "");
        if (std::string(name) == "a.png") {
          EXPECT_EQ(difference(read_mask(scratch / file).bytes, shown), "") << "as a mask";
        }
      }
    }
  }
}

// A name promises nothing that the bytes contradict.
TEST(StillClip, IsWhatItsBytesSay) {
  const Scratch scratch;
  const auto still = random_stills(kGreyShape, 1000, 1, 5)[0];
  for (const bool plain : {false, true}) {
    for (const char* name : {"a.pgm", "a.png", "a.jpg", "a.tif", "a.dng", "a.dat", "a.mp4", "a"}) {
      SCOPED_TRACE(name);
      const auto clip = open_test_clip(scratch.write(name, netpbm_file(still, plain)), {});
      EXPECT_EQ(clip->info().format.white_code, 1000u);
      EXPECT_TRUE(clip->info().notes.empty());
      expect_codes(*clip, {still});
    }
  }
}

TEST(StillClip, ThatACameraWroteWithOthersOfItsMomentIsOne) {
  const Scratch scratch;
  const auto stills = random_stills(kColourShape, 255, 1, 3);
  write_with_opencv(scratch / "one.jpg", stills[0]);
  const std::string one = read_file(scratch / "one.jpg");
  const std::string more_follow("\xFF\xE2\0\x06MPF\0", 8);
  const auto samples_of = [&](const std::string& bytes) {
    return open_test_clip(scratch.write("a.jpg", bytes), {})->info().sample_count;
  };
  EXPECT_EQ(samples_of(one), 1u);
  EXPECT_EQ(samples_of(one.substr(0, 2) + more_follow + one.substr(2) + one), 1u);
  EXPECT_EQ(samples_of(one + one), 2u);
}

TEST(StillClip, AStatedWhiteCodeGoesBeforeTheFiles) {
  const Scratch scratch;
  const auto stills = random_stills(kGreyShape, 4095, 1, 3);
  write_with_opencv(scratch / "f.png", stills[0]);
  const auto clip = open_test_clip(scratch / "f.png", {.white_code = 4095});
  EXPECT_EQ(clip->info().format.white_code, 4095u);
  EXPECT_TRUE(clip->info().notes.empty());
}

// A stack's pages are chained: where a link leads nowhere the rest would be lost without a word.
TEST(StillClip, RefusesAStackThatWasCutOff) {
  const Scratch scratch;
  const std::string whole = tiff_file(random_stills(kGreyShape, 65'535, 4, 1), {});
  for (const std::size_t eighths : {3u, 5u, 7u}) {
    expect_refused(scratch.write("cut.tif", whole.substr(0, whole.size() * eighths / 8)), {"cut.tif"});
  }
}

// Whole pages are taken up to there, also those that one directory stands for, and of the files before.
TEST(StillClip, OfAStackThatWasCutOffCanBeTakenUpToThere) {
  const Scratch scratch;
  const auto stills = random_stills(kGreyShape, 65'535, 4, 1);
  const std::string in_one = tiff_file(stills, {.description = "ImageJ=1.53t\nimages=9\n", .in_one = true});
  const std::string pages = tiff_file(stills, {});
  std::filesystem::create_directory(scratch / "b");
  scratch.write("b/f0.tif", tiff_file({stills[0], stills[1]}, {}));
  scratch.write("b/f1.tif", std::string("II*\0damaged", 11));
  for (const auto& [file, said, whole] :
       {std::tuple(scratch.write("one.tif", in_one), "says that it holds 9 pictures, and 4 are there", 4),
        {scratch.write("pages.tif", pages.substr(0, pages.size() - 400)), "breaks at page 4", 3},
        {scratch / "b", "f1.tif cannot be read: it is damaged", 2}}) {
    expect_refused(file, {said});
    const auto clip = open_test_clip(file, {.ends_at_damage = true});
    const auto rasters = read_all(*clip);
    ASSERT_EQ(rasters.size(), static_cast<std::size_t>(whole)) << file;
    for (std::size_t k = 0; k < rasters.size(); ++k) EXPECT_EQ(difference(rasters[k], stills[k]), "");
    EXPECT_TRUE(clip->ended_early()) << file;
  }
}

// The last bytes of a TIFF say that no page follows. Without them the picture may be whole, and the file is not.
TEST(StillClip, RefusesATiffThatLacksItsLastBytes) {
  const auto stills = random_stills(kGreyShape, 255, 3, 1);
  const auto file_of = [](const std::vector<Picture>& pages) { return tiff_file(pages, {8}); };
  for (std::size_t missing = 1; missing <= 8; ++missing) {
    SCOPED_TRACE(missing);
    const Scratch scratch;
    const auto cut = [&](const std::string& whole) { return whole.substr(0, whole.size() - missing); };
    scratch.write("f0.tif", file_of({stills[0]}));
    const auto damaged = scratch.write("f1.tif", cut(file_of({stills[1]})));
    scratch.write("f2.tif", file_of({stills[2]}));
    expect_refused(damaged, {"f1.tif cannot be read: it is damaged or"});
    expect_refused(scratch.folder(), {"f1.tif cannot be read: it is damaged or"});
    expect_refused(
        scratch.write("table.csv", "file,start_ns,exposure_ns\nf0.tif,0,10\nf1.tif,10,10\nf2.tif,20,10\n"),
        {"f1.tif cannot be read: it is damaged or"});
    expect_refused(
        scratch.write("stack.tif", cut(file_of(stills))),
        {"stack.tif cannot be read: it is damaged or was cut off: its list of pages breaks at page 3"});
  }
}

TEST(StillClip, SaysWhichStillDiffersAndHow) {
  const Scratch scratch;
  const auto write = [&](const std::string& name, Shape shape, std::uint32_t white) {
    std::filesystem::create_directories((scratch / name).parent_path());
    const Picture still = random_stills(shape, white, 1, 5)[0];
    if (name.ends_with(".pgm")) {
      scratch.write(name, netpbm_file(still, false));
    } else {
      write_with_opencv(scratch / name, still);
    }
  };
  for (const char* folder : {"size", "depth", "channels"}) {
    write(std::string(folder) + "/f0.png", kGreyShape, 255);
    write(std::string(folder) + "/f1.png", kGreyShape, 255);
  }
  write("size/f2.png", {18, 9, 1}, 255);
  write("depth/f2.png", kGreyShape, 65'535);
  write("channels/f2.png", kColourShape, 255);
  expect_refused(scratch / "size",
                 {"size/f2.png is 18 x 9 grey of 8 bits", "size/f0.png, is 17 x 9 grey of 8 bits"});
  expect_refused(scratch / "depth", {"depth/f2.png is 17 x 9 grey of 16 bits", "17 x 9 grey of 8 bits"});
  expect_refused(scratch / "channels", {"channels/f2.png is 17 x 9 colour", "17 x 9 grey"});

  write("white/f0.pgm", kGreyShape, 1023);
  write("white/f1.pgm", kGreyShape, 4095);
  expect_refused(scratch / "white", {"f1.pgm is 17 x 9 grey of 16 bits, white code 4095", "white code 1023",
                                     "state what is white"});
  EXPECT_EQ(read_all(*open_test_clip(scratch / "white", {.white_code = 4095})).size(), 2u);

  auto pages = random_stills(kGreyShape, 65'535, 2, 1);
  pages.push_back(random_stills({9, 17, 1}, 65'535, 1, 1)[0]);
  expect_refused(scratch.write("stack.tif", tiff_file(pages, {})), {"page 3 of ", "stack.tif is 9 x 17 grey"});
}

TEST(StillClip, RefusesWhatIsDamagedOrOfAnotherKind) {
  const Scratch scratch;
  const auto stills = random_stills({40, 30, 1}, 65'535, 3, 8);
  for (const char* extension : {".png", ".tif", ".pgm", ".jpg"}) {
    const auto path = [&](int k) { return scratch / ("f" + std::to_string(k) + extension); };
    for (int k = 0; k < 3; ++k) {
      const Picture& still = stills[static_cast<std::size_t>(k)];
      if (std::string(extension) == ".pgm") {
        scratch.write(path(k).filename().string(), netpbm_file(still, false));
      } else if (std::string(extension) == ".jpg") {
        write_with_opencv(path(k), random_stills({40, 30, 1}, 255, 1, 8)[0]);
      } else {
        write_with_opencv(path(k), still);
      }
    }
    const std::string whole = read_file(path(1));
    scratch.write(path(1).filename().string(), std::string_view(whole).substr(0, whole.size() / 2));
    expect_refused(scratch / (std::string("f%d") + extension), {path(1).string() + " cannot be read"});
    // Also where it is the first.
    expect_refused(path(1), {path(1).string() + " cannot be read"});
    scratch.write(path(1).filename().string(), "no picture at all");
    expect_refused(scratch / (std::string("f%d") + extension), {path(1).string() + " cannot be read"});
  }
  // Its name alone says so.
  expect_refused(scratch.write("medical.png", std::string(128, '\0') + "DICM and more"),
                 {"medical.png cannot be read", "neither a PNG nor a JPEG begins like that"});
  // Decoders show black where a palette ends before a pixel's colour.
  write_with_opencv(scratch / "grey.png", random_stills(kGreyShape, 3, 1, 5)[0]);
  const std::string grey = read_file(scratch / "grey.png");
  const std::string header = png_chunk("IHDR", grey.substr(16, 9) + std::string("\3\0\0\0", 4));
  const auto indexed = [&](std::size_t colours) {
    return scratch.write("indexed.png", with_chunk(grey.substr(0, 8) + header + grey.substr(33), "PLTE",
                                                   std::string(3 * colours, '\1')));
  };
  EXPECT_EQ(open_test_clip(indexed(4))->info().sample_count, 1u);
  expect_refused(indexed(3), {"indexed.png cannot be read: it is damaged: a pixel has colour 3, and its palette 3,"});
  for (const auto& [number, word] : {std::pair(2, "signed"), {5, "complex"}, {6, "complex"}}) {
    TiffOptions of_format;
    of_format.sample_format = number;
    expect_refused(scratch.write("a.tif", tiff_file(stills, of_format)),
                   {"page 1 of ", "a.tif cannot be read: it has 16-bit " + std::string(word) + " values"});
  }
  expect_refused(scratch.write("a.tif", tiff_file(random_stills(kColourShape, 15, 1, 1), {4})),
                 {"it is of a kind that is not read (RGB, 4 bits)"});
  expect_refused(scratch.write("a.tif", tiff_file(stills, {16, false, true, false, 4095})),
                 {"is above its MaxSampleValue, 4095"});
}

TEST(StillClip, AStackThatIsCutOffNamesThePage) {
  const Scratch scratch;
  const auto stills = random_stills(kGreyShape, 65'535, 4, 8);
  std::string bytes = tiff_file(stills, {});
  // The third page's pixels lie where the file says that they do no more: behind its end.
  const std::string two = tiff_file({stills[0], stills[1]}, {});
  const std::size_t third = two.size();
  const auto position = bytes.find(bytes.substr(third, 16), third);
  ASSERT_EQ(position, third);
  for (std::size_t at = two.size(); at + 12 < bytes.size(); ++at) {
    if (bytes.compare(at, 8, std::string("\x11\x01\x04\x00\x01\x00\x00\x00", 8)) == 0) {  // StripOffsets
      bytes.replace(at + 8, 4, std::string("\x00\x00\x00\x7F", 4));
      break;
    }
  }
  expect_refused(scratch.write("cut.tif", bytes),
                 {"page 3 of ", "cut.tif cannot be read: it is damaged or was cut off at row 0"});
}

// A folder says that a picture is missing; a pattern is taken at its word. Neither loses a code.
TEST(StillClip, NotesAHoleInAFolderOfNumberedStills) {
  const Scratch scratch;
  std::filesystem::create_directory(scratch / "frames");
  const auto stills = random_stills(kGreyShape, 255, 3, 11);
  const char* names[] = {"frames/f1.pgm", "frames/f2.pgm", "frames/f4.pgm"};
  for (std::size_t k = 0; k < 3; ++k) scratch.write(names[k], netpbm_file(stills[k], false));
  const auto folder = open_test_clip(scratch / "frames");
  ASSERT_EQ(folder->info().notes.size(), 1u);
  expect_says(folder->info().notes[0].text, "f3.pgm is missing between f2.pgm and f4.pgm");
  expect_codes(*folder, stills);
  const auto pattern = open_test_clip(scratch / "frames/*.pgm");
  EXPECT_TRUE(pattern->info().notes.empty());
  expect_codes(*pattern, stills);
}

// A module is a library of its own, and a signal the program's.
TEST(StillClip, NotesWhatAPatternMatchesBesides) {
  const Scratch scratch;
  for (const char* name : {"f1.pgm", "f2.pgm", "f3.pgm"})
    write_with_opencv(scratch / name, random_stills(kGreyShape, 255, 1, 3)[0]);
  EXPECT_TRUE(open_test_clip(scratch / "*.pgm", {})->info().notes.empty());
  write_with_opencv(scratch / "f-0s-3s.pgm", random_stills(kGreyShape, 255, 1, 3)[0]);
  const auto notes = open_test_clip(scratch / "*.pgm", {})->info().notes;
  ASSERT_EQ(notes.size(), 1U);
  expect_says(notes[0].text, "1 of 4 pictures have names of another kind than the others: f-0s-3s.pgm");
}

TEST(StillClip, EndsAtASignal) {
  const Scratch scratch;
  const auto path = scratch.write("a.tif", tiff_file(random_stills(kGreyShape, 255, 1, 1), {8}));
  EXPECT_EQ(read_all(*open_test_clip(path)).size(), 1u);
  catch_interruptions();
  std::raise(SIGTERM);
  EXPECT_THROW(open_test_clip(path), Interrupted);
  clear_interruption();
  EXPECT_EQ(read_all(*open_test_clip(path)).size(), 1u);
}

// As our own pictures carry it, and as others write it.
TEST(StillClip, TakesThePixelAspectFromTheFile) {
  const Scratch scratch;
  for (const std::string name : {"a.png", "a.tif", "a.jpg"}) {
    for (const auto& [aspect, text] :
         {std::pair(Rational{32, 27}, "pixels 32:27"), {Rational{10, 11}, "pixels 10:11"}}) {
      Picture picture = random_stills(kGreyShape, 255, 1, 3).front();
      picture.pixel_aspect = aspect;
      write_picture(scratch / name, picture);
      const auto clip = open_test_clip(scratch / name);
      EXPECT_EQ(clip->info().format.pixel_aspect, aspect) << name;
      EXPECT_EQ(clip->info().facts.back().line(), std::string(text) + ", from the file");
      EXPECT_EQ(open_test_clip(scratch / name, {.pixel_aspect = Rational{2, 1}})->info().format.pixel_aspect,
                (Rational{2, 1}));
    }
    Picture square = random_stills(kGreyShape, 255, 1, 3).front();
    write_picture(scratch / name, square);
    EXPECT_EQ(open_test_clip(scratch / name)->info().format.pixel_aspect, (Rational{1, 1}));
  }
}

TEST(StillClip, OfPixelsOfOtherShapesIsRefused) {
  const Scratch scratch;
  const auto pictures = random_stills(kGreyShape, 255, 2, 3);
  for (const std::string name : {"a.png", "a.tif", "a.jpg"}) {
    const auto folder = scratch / ("of " + name);
    std::filesystem::create_directories(folder);
    Picture wide = pictures[0];
    wide.pixel_aspect = {32, 27};
    write_picture(folder / name, wide);
    write_picture(folder / ("b" + name), pictures[1]);
    expect_refused(folder, {"b" + name + " has square pixels, the first still, " + (folder / name).string() +
                            ", pixels 32:27. All must be alike; state what all have"});
    EXPECT_EQ(read_all(*open_test_clip(folder, {.pixel_aspect = Rational{4, 3}})).size(), 2u);
  }
}

// As we write them ourselves; gAMA alone is written by programs that know nothing of the codes.
TEST(StillClip, OfPngStandsForWhatItsChunksName) {
  const Scratch scratch;
  const auto facts_of = [&](const Picture& picture, const ClipOptions& options = {}) {
    write_picture(scratch / "a.png", picture);
    const auto clip = open_test_clip(scratch / "a.png", options);
    std::vector<std::string> lines;
    for (const Fact& fact : clip->info().facts) lines.push_back(fact.line());
    EXPECT_EQ(lines.front(), "white 65535, assumed");  // of 16 bits: many pictures use fewer
    lines.erase(lines.begin());
    return std::pair(clip->info().format.transfer, lines);
  };
  Picture picture = random_stills(kColourShape, 65'535, 1, 3).front();
  EXPECT_EQ(facts_of(picture).second[0], "transfer linear, assumed");
  EXPECT_EQ(facts_of(picture).second[1], "primaries bt709, assumed");
  for (const Transfer& transfer : {Transfer::srgb(), Transfer::bt709(), Transfer::linear(), Transfer::hlg(),
                                   Transfer::pq(), Transfer::gamma(2.2), Transfer::gamma(2.8)}) {
    picture.transfer = transfer;
    for (const Primaries primaries : {Primaries::bt709, Primaries::bt2020, Primaries::p3}) {
      picture.primaries = primaries;
      const auto [read, facts] = facts_of(picture);
      EXPECT_EQ(read, transfer);
      EXPECT_EQ(facts[0], "transfer " + transfer.text() + ", from the file");
      EXPECT_EQ(facts[1], "primaries " + std::string(to_text(primaries)) + ", from the file");
    }
  }
  // Programs that do not know cICP read a profile, or older chunks.
  picture.transfer = Transfer::srgb();
  facts_of(picture);
  expect_says(read_file(scratch / "a.png"), "iCCP");
  picture.transfer = Transfer::linear();
  facts_of(picture);
  std::string older = read_file(scratch / "a.png");
  older.erase(older.find("cICP") - 4, 16);
  scratch.write("older.png", older);
  EXPECT_EQ(open_test_clip(scratch / "older.png")->info().facts[2].line(), "primaries p3, from the file");
  picture.transfer = Transfer::gamma(3);
  EXPECT_EQ(facts_of(picture).second[0], "transfer gamma:3, from the ICC profile 'p3, gamma:3'");
  EXPECT_EQ(facts_of(picture, {.transfer = Transfer::srgb()}).second[0], "transfer srgb, as stated");
  std::string png = read_file(scratch / "a.png");
  const auto profile = png.find("iCCP");
  ASSERT_NE(profile, std::string::npos);
  const auto byte = [&](std::size_t at) { return std::size_t{static_cast<unsigned char>(png[at])}; };
  png.erase(profile - 4, 12 + (byte(profile - 2) << 8 | byte(profile - 1)));
  scratch.write("bare.png", png);
  EXPECT_EQ(open_test_clip(scratch / "bare.png")->info().facts[1].line(),
            "transfer linear, assumed; the file names gamma 3");
}

// Coding points that say nothing, or what is not known here, leave the word to other chunks.
TEST(StillClip, OfPngFollowsCodingPointsThatAreKnown) {
  const Scratch scratch;
  write_with_opencv(scratch / "a.png", random_stills(kColourShape, 255, 1, 3)[0]);
  const std::string png = read_file(scratch / "a.png");
  const std::string gamma = with_chunk(png, "gAMA", std::string("\0\0\xB1\x8F", 4));
  const std::string srgb = with_chunk(png, "sRGB", std::string(1, '\0'));
  const auto points = [](int primaries, int transfer, int matrix = 0, int range = 1) {
    return std::string{static_cast<char>(primaries), static_cast<char>(transfer), static_cast<char>(matrix),
                       static_cast<char>(range)};
  };
  const auto expect_facts = [&](const std::string& bytes, const std::string& transfer, const std::string& primaries) {
    auto facts = test::facts_of(*open_test_clip(scratch.write("b.png", bytes), {}));
    EXPECT_EQ(facts.at(Setting::transfer).line(), "transfer " + transfer);
    EXPECT_EQ(facts.at(Setting::primaries).line(), "primaries " + primaries);
  };
  for (const auto& unknown : {points(2, 2), points(4, 17), points(2, 16)}) {
    expect_facts(with_chunk(srgb, "cICP", unknown), "srgb, from the file", "bt709, from the file");
    expect_facts(with_chunk(with_chunk(png, "cICP", unknown), "sRGB", std::string(1, '\0')), "srgb, from the file",
                 "bt709, from the file");
  }
  expect_facts(with_chunk(srgb, "cICP", points(9, 16)), "pq, from the file", "bt2020, from the file");
  expect_facts(with_chunk(png, "cICP", points(2, 16)), "pq, from the file", "bt709, assumed");
  expect_facts(with_chunk(png, "cICP", points(2, 2)), "srgb, assumed", "bt709, assumed");
  expect_facts(with_chunk(gamma, "cICP", points(4, 17)), "srgb, assumed; the file names number 17 of H.273",
               "bt709, assumed; the file names number 4 of H.273");
  expect_refused(scratch.write("b.png", with_chunk(png, "cICP", points(1, 13, 0, 0))),
                 {"b.png cannot be read: its cICP says limited range", "-level 6.27451%,92.15686% -depth 16 OUT.png"});
  expect_refused(scratch.write("b.png", with_chunk(png, "cICP", points(1, 13, 1))),
                 {"b.png cannot be read: its cICP names matrix 1, of codes that are not RGB"});
}

}  // namespace
}  // namespace nutik::test
