// Tables of stills: real exposure times, gaps and all, from the table or from EXIF data.
#include "media/stills/stills_table.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "capture/error.hpp"
#include "support/bytes.hpp"
#include "support/ffmpeg.hpp"
#include "support/messages.hpp"
#include "support/stills.hpp"

namespace nutik::test {
namespace {

constexpr Shape kStillShape{16, 8, 1};

// Three stills, a.pgm, b.pgm and `c, 2.pgm`, in a folder of their own.
std::vector<Picture> write_stills(const Scratch& scratch) {
  std::filesystem::create_directory(scratch / "shots");
  const auto stills = random_stills(kStillShape, 255, 3, 4);
  scratch.write("shots/a.pgm", netpbm_file(stills[0], false));
  scratch.write("shots/b.pgm", netpbm_file(stills[1], false));
  scratch.write("shots/c, 2.pgm", netpbm_file(stills[2], false));
  return stills;
}

Timeline timeline_of_table(const std::filesystem::path& path) {
  const auto clip = open_test_clip(path);
  return timeline_of(path.string(), clip->info(), {}, Timeline::kFullShutter, clip->info().sample_count);
}

TEST(StillsTable, GivesEachPictureItsRealExposure) {
  const Scratch scratch;
  const auto stills = write_stills(scratch);
  const char* const tables[] = {
      "file,start_ns,exposure_ns\na.pgm,500,1000\nb.pgm,4500,2000\n\"c, 2.pgm\",6500,3\n",
      // As a spreadsheet may have it: byte-order mark, CRLF, blanks, blank lines, no header, no last line end.
      "\xEF\xBB\xBF"
      "a.pgm , 500 ,1000\r\n\r\n b.pgm,4500,2000\r\n \"c, 2.pgm\" ,6500,3",
      // Times of any clock.
      "a.pgm,1700000000000000000,1000\nb.pgm,1700000000000004000,2000\n\"c, 2.pgm\",1700000000000006000,3\n"};
  for (const char* table : tables) {
    const auto path = scratch.write("shots/stills.csv", table);
    const auto clip = open_test_clip(path);
    const auto rasters = read_all(*clip);
    ASSERT_EQ(rasters.size(), 3u) << table;
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(difference(rasters[k], stills[k]), "") << table;
    const Timeline timeline = timeline_of_table(path);
    const auto exposures = timeline.table();
    const std::vector<Exposure> expected{{0, 1000}, {4000, 6000}, {6000, 6003}};
    EXPECT_EQ(std::vector<Exposure>(exposures.begin(), exposures.end()), expected) << table;
    EXPECT_EQ(timeline.duration_ns(), 6003);
  }
}

TEST(StillsTable, WithoutExposuresTheShutterAngleCounts) {
  const Scratch scratch;
  write_stills(scratch);
  const auto path = scratch.write("shots/stills.csv", "a.pgm,0\nb.pgm,1000\n\"c, 2.pgm\",4000\n");
  const auto clip = open_test_clip(path);
  const Timeline timeline = timeline_of(path.string(), clip->info(), {}, {180, 1}, 3);
  EXPECT_EQ(timeline.end_ns(0), 500);
  EXPECT_EQ(timeline.end_ns(1), 2500);
  // A rate that is stated goes before the table's times, which need not even be there.
  scratch.write("shots/stills.csv", "file\na.pgm\nb.pgm\n\"c, 2.pgm\"\n");
  const ClipOptions options{.rate = Rational{100, 1}};
  const auto constant = open_test_clip(path, options);
  EXPECT_TRUE(timeline_of(path.string(), constant->info(), options, {360, 1}, 3).is_constant());
}

TEST(StillsTable, NamesFileAndBothValuesOfWhatIsWrong) {
  const Scratch scratch;
  write_stills(scratch);
  scratch.write("shots/large.pgm", netpbm_file(random_stills({17, 8, 1}, 255, 1, 1)[0], false));
  scratch.write("shots/deep.pgm", netpbm_file(random_stills(kStillShape, 4095, 1, 1)[0], false));
  scratch.write("shots/pages.tif", tiff_file(random_stills(kStillShape, 65'535, 2, 1), {}));
  struct Case {
    const char* table;
    std::vector<const char*> parts;
  };
  const Case cases[] = {
      {"a.pgm,0,1000\nb.pgm,999,10\n",
       {"stills.csv:2: ", "b.pgm starts at 999 ns, before the end of ", "a.pgm at 1000 ns"}},
      {"a.pgm,50\nb.pgm,50\n", {"stills.csv:2: ", "b.pgm starts at 50 ns, not after ", "a.pgm at 50 ns"}},
      {"a.pgm,0,10\nlarge.pgm,10,10\n",
       {"large.pgm is 17 x 8 grey of 8 bits", "a.pgm, is 16 x 8 grey of 8 bits"}},
      {"a.pgm,0,10\ndeep.pgm,10,10\n",
       {"deep.pgm is 16 x 8 grey of 16 bits", "a.pgm, is 16 x 8 grey of 8 bits"}},
      {"\xFF\xFE" "a", {"stills.csv:1: UTF-16; save the table as UTF-8"}},
      {"a.pgm;0;10\n", {"a.pgm;0;10 is no file; columns are separated by commas"}},
      {"a.pgm,0,10\nd.pgm,10,10\n", {"stills.csv:2: ", "d.pgm is no file"}},
      {"a.pgm,0,10\nb.pgm,,10\n", {"stills.csv:2: ", "b.pgm has no start_ns here and ", "a.pgm has 0"}},
      {"a.pgm,0,\nb.pgm,10,5\n", {"stills.csv:2: ", "b.pgm has the exposure_ns 5 and ", "a.pgm has none"}},
      {"a.pgm,,\nb.pgm,,\n", {"stills.csv:1: ", "a.pgm has no start_ns, neither here nor in EXIF data"}},
      {"a.pgm,0,0\n", {"stills.csv:1: exposure_ns '0' is no whole number of nanoseconds from 1 to"}},
      {"a.pgm,0.5,1\n", {"stills.csv:1: start_ns '0.5' is no whole number"}},
      {"file,start,exposure\na.pgm,0,1\n", {"stills.csv:1: start_ns 'start' is no whole number"}},
      {"c, 2.pgm,0,1\n", {"stills.csv:1: 4 columns, and a table of stills has three", "stands in quotes"}},
      {"a.pgm,-4000000000000000000,1\nb.pgm,4000000000000000000,4000000000000000000\n",
       {"stills.csv:2: ",
        "b.pgm starts 8000000000000000000 ns after the first picture and is exposed for "
        "4000000000000000000 ns; a clip lasts 4611686018427387904 ns"}},
      {"a.pgm,-4000000000000000000\nb.pgm,4000000000000000000\n",
       {"stills.csv:2: ", "b.pgm starts 8000000000000000000 ns after the first picture; a clip"}},
      {"\"a.pgm,0,1\n", {"stills.csv:1: a quote is not closed"}},
      {",0,1\n", {"stills.csv:1: the file's name is missing"}},
      {"file,start_ns,exposure_ns\n", {"stills.csv lists no picture"}},
      {"pages.tif,0,1\n", {"pages.tif has 2 pages; in a table with times each picture is a file of its own"}},
  };
  for (const Case& tested : cases) {
    const auto path = scratch.write("shots/stills.csv", tested.table);
    for (const char* part : tested.parts) expect_clip_refused(path, {}, part);
  }
}

// What cannot be read, as a folder cannot, is no table that ends there.
TEST(StillsTable, TellsAReadErrorFromTheEnd) {
  const Scratch scratch;
  expect_error<InputError>([&] { return read_stills_table(scratch.folder()); }, {"cannot be read to its end"});
}

// A JPEG with EXIF data: an APP1 segment put behind the start of what OpenCV writes.
void write_jpeg(const std::filesystem::path& path, int grey, const std::string& date,
                const std::string& fraction, std::uint32_t exposure_numerator,
                std::uint32_t exposure_denominator, const std::string& zone = "") {
  cv::Mat picture(8, 16, CV_8UC1, cv::Scalar(grey));
  std::vector<unsigned char> jpeg;
  ASSERT_TRUE(cv::imencode(".jpg", picture, jpeg));
  std::string tiff("MM\0\x2A\0\0\0\x08", 8);
  const auto entry = [](std::uint32_t tag, std::uint32_t type, std::uint32_t count, std::uint32_t value) {
    return big_endian(tag, 2) + big_endian(type, 2) + big_endian(count, 4) + big_endian(value, 4);
  };
  tiff += big_endian(1, 2) + entry(0x8769, 4, 1, 26) + big_endian(0, 4);  // the EXIF directory at 26
  constexpr std::uint32_t kValues = 26 + 2 + 4 * 12 + 4;
  const auto fraction_at = static_cast<std::uint32_t>(kValues + 8 + date.size() + 1);
  const auto zone_at = static_cast<std::uint32_t>(fraction_at + fraction.size() + 1);
  tiff += big_endian(4, 2) + entry(0x829A, 5, 1, kValues) +
          entry(0x9003, 2, static_cast<std::uint32_t>(date.size() + 1), kValues + 8) +
          entry(0x9011, 2, static_cast<std::uint32_t>(zone.size() + 1), zone_at) +
          entry(0x9291, 2, static_cast<std::uint32_t>(fraction.size() + 1), fraction_at) + big_endian(0, 4);
  tiff += big_endian(exposure_numerator, 4) + big_endian(exposure_denominator, 4) + date + '\0' + fraction + '\0' +
          zone + '\0';
  const std::string body = std::string("Exif\0\0", 6) + tiff;
  const std::string segment = "\xFF\xE1" + big_endian(static_cast<std::uint32_t>(body.size() + 2), 2) + body;
  std::string file(jpeg.begin(), jpeg.end());
  std::ofstream(path, std::ios::binary) << file.insert(2, segment);
}

TEST(StillsTable, ReadsTimesFromExifDataWhereColumnsAreEmpty) {
  const Scratch scratch;
  write_jpeg(scratch / "a.jpg", 10, "2026:02:28 23:59:59", "90000", 1, 60);
  write_jpeg(scratch / "b.jpg", 20, "2026:03:01 00:00:00", "10000", 1, 30);
  const auto path = scratch.write("stills.csv", "a.jpg\nb.jpg,,\n");
  const Timeline timeline = timeline_of_table(path);
  EXPECT_EQ(timeline.end_ns(0), 16'666'667);
  EXPECT_EQ(timeline.start_ns(1), 200'000'000);
  EXPECT_EQ(timeline.end_ns(1), 233'333'333);
  // One column from the table, the other from the files.
  scratch.write("stills.csv", "a.jpg,0\nb.jpg,70000000\n");
  EXPECT_EQ(timeline_of_table(path).end_ns(1), 103'333'333);
  scratch.write("stills.csv", "a.jpg,,5\nb.jpg,,7\n");
  EXPECT_EQ(timeline_of_table(path).end_ns(1), 200'000'007);
  // Clocks were put forward.
  write_jpeg(scratch / "a.jpg", 10, "2026:03:29 01:59:50", "", 1, 60, "+01:00");
  write_jpeg(scratch / "b.jpg", 20, "2026:03:29 03:00:00", "", 1, 30, "+02:00");
  scratch.write("stills.csv", "a.jpg\nb.jpg\n");
  EXPECT_EQ(timeline_of_table(path).start_ns(1), 10'000'000'000);
  // No clock is so far ahead.
  write_jpeg(scratch / "b.jpg", 20, "2026:03:29 02:00:00", "", 1, 30, "+99:99");
  write_jpeg(scratch / "a.jpg", 10, "2026:03:29 01:59:50", "", 1, 60);
  EXPECT_EQ(timeline_of_table(path).start_ns(1), 10'000'000'000);
  for (const char* time : {"24:00:00", "10:60:00", "10:00:61", "99:99:99"}) {
    write_jpeg(scratch / "a.jpg", 10, std::string("2026:03:29 ") + time, "", 1, 60);
    expect_clip_refused(path, {}, "a.jpg has no start_ns, neither here nor in EXIF data");
  }
  // Two pictures of one second that does not tell its fraction.
  for (const char* name : {"a.jpg", "b.jpg"}) write_jpeg(scratch / name, 20, "2026:02:28 23:59:59", "", 1, 30);
  scratch.write("stills.csv", "a.jpg\nb.jpg\n");
  expect_clip_refused(path, {}, "these are EXIF times, which often have whole seconds only; state start_ns, or a rate");
  // A table reads what a folder does not.
  expect_clip_refused(scratch / "*.jpg", {}, "EXIF times, which are read where a table (.csv) lists the files");
  write_jpeg(scratch / "b.jpg", 20, "2026:02:28 23:59:57", "", 1, 30);
  expect_clip_refused(path, {}, "which run back where a clock was set or files are in another order; state start_ns");
  write_jpeg(scratch / "b.jpg", 20, "", "", 1, 30);
  expect_clip_refused(path, {}, "a.jpg has 1772323199000000000; state it for all files, or a rate");
}

}  // namespace
}  // namespace nutik::test
