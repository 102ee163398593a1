// Stills and deep video through the whole program: codes come back, every codec gives the same
// picture, and what is wrong with an input is said.
#include <gtest/gtest.h>

#include <cstring>
#include <opencv2/imgcodecs.hpp>

#include "support/app_test.hpp"
#include "support/stills.hpp"

namespace nutik::test {
namespace {

class DeepInput : public AppTest {
 protected:
  void succeed(const Words& words) const { make(over(words)); }
  void expect_refused(const Words& words, int status, const std::vector<std::string>& parts) const {
    const ProgramResult result = make(words, status);
    for (const std::string& part : parts) expect_says(result.err, part);
  }
  void expect_said(const ProgramResult& result, const std::string& part) const {
    EXPECT_EQ(result.status, 0) << result.err;
    expect_says(result.out + result.err, part);
  }

  // Writes f000.pgm … into a folder.
  void write_netpbm(const std::string& folder, const std::vector<Picture>& stills) const {
    std::filesystem::create_directories(scratch_ / folder);
    for (std::size_t k = 0; k < stills.size(); ++k) {
      char name[32];
      std::snprintf(name, sizeof name, "/f%03zu.%s", k, stills[k].shape.channels == 1 ? "pgm" : "ppm");
      scratch_.write(folder + name, netpbm_file(stills[k], k % 2 == 0));
    }
  }

  // The picture's values must be the codes, and their type that of the capture.
  static void expect_codes(const std::filesystem::path& path, const Picture& want) {
    const cv::Mat picture = cv::imread(path.string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(picture.depth(), want.type == ValueType::code8 ? CV_8U : CV_16U);
    ASSERT_EQ(picture.total() * static_cast<std::size_t>(picture.channels()), want.shape.value_count());
    std::vector<std::byte> codes(want.bytes.size());
    const std::size_t bytes = picture.elemSize1(), channels = want.shape.channels;
    for (std::size_t i = 0; i < want.shape.value_count(); ++i) {
      const std::size_t from = channels == 3 ? i / 3 * 3 + 2 - i % 3 : i;
      std::memcpy(codes.data() + i * bytes, picture.data + from * bytes, bytes);
    }
    EXPECT_EQ(difference(codes, want), "");
  }
};

TEST_F(DeepInput, OneSampleIsTheSourceCodeForCode) {
  for (const std::uint32_t channels : {1u, 3u}) {
    for (const std::uint32_t white : {100u, 255u, 1023u, 4095u, 65'535u}) {
      SCOPED_TRACE(std::to_string(channels) + " channels, white " + std::to_string(white));
      const auto stills = random_stills({33, 17, channels}, white, 5, white);
      const std::string folder = "c" + std::to_string(channels) + "w" + std::to_string(white);
      write_netpbm(folder, stills);
      std::vector<std::string> transfers{"linear", "srgb"};
      if (white == 4095) transfers.insert(transfers.end(), {"bt709", "gamma:2.2"});
      for (const std::string& transfer : transfers) {
        succeed({"encode", "-q", "-f", "100", "-a", "180", "--transfer", transfer, folder, "x.tik"});
        for (const char* renderer : {"opencl", "reference"}) {
          const Words words = "--start 3f --exposure 1f x.tik x.png --renderer" + Words(renderer);
          succeed(words + "--out-transfer source");
          expect_codes(scratch_ / "x.png", stills[3]);
          if (transfer != "srgb" || (white != 255 && white != 65'535)) continue;
          succeed(words);
          expect_codes(scratch_ / "x.png", stills[3]);
        }
      }
      succeed(
          {"-f", "100", "--start", "4f", "--exposure", "1f", "--out-transfer", "source", folder, "y.tif"});
      expect_codes(scratch_ / "y.tif", stills[4]);
      if (white != 1023 && white != 4095) continue;
      const std::string own = "white " + std::to_string(white);
      expect_said(run("-f 1 --overwrite --start 0f --exposure 1f y.tif again.pfm"), own + " (from the file)");
      expect_said(run("video -f 100 --overwrite --out-angle 360 --out-transfer source " + folder + " y.mkv"),
                  "codes linear with white 65535 (the capture's: linear with " + own + ")");
    }
  }
}

TEST_F(DeepInput, EveryCodecAndNoneGiveTheSamePicture) {
  scratch_.write("f.fn", "M0 [0:0], [20000000:1.5], [50000000:-0.75], [79000000:0]\n");
  for (const auto& [channels, white] : {std::pair{1u, 4095u}, {3u, 65'535u}, {3u, 255u}}) {
    write_netpbm("frames", random_stills({70, 41, channels}, white, 9, white));
    std::string first;
    for (const std::string codec : {"none", "rice", "lz4", "zstd", "zstd:19"}) {
      succeed({"encode", "-q", "-f", "100", "-a", "200", "--codec", codec, "frames", "x.tik"});
      succeed("-k f.fn x.tik x.pfm");
      const std::string picture = file("x.pfm");
      EXPECT_GT(picture.size(), 70u * 41 * channels * 4);
      if (first.empty()) first = picture;
      EXPECT_EQ(picture == first, true) << codec << ", white " << white;
    }
    // Straight from the stills, with no capture between.
    succeed("-f 100 -a 200 -k f.fn frames x.pfm");
    EXPECT_EQ(file("x.pfm") == first, true) << "from the stills";
    std::filesystem::remove_all(scratch_ / "frames");
  }
}

TEST_F(DeepInput, EveryNameOfASequenceGivesTheSameCapture) {
  const auto stills = random_stills({17, 9, 1}, 4095, 4, 1);
  write_netpbm("frames", stills);
  scratch_.write("stack.tif", tiff_file(stills, {12}));
  std::string first;
  for (const std::string source : {"frames", "frames/", "frames/*.pgm", "frames/f%03d.pgm", "stack.tif"}) {
    succeed({"encode", "-q", "-f", "30000", source, "x.tik"});
    const std::string capture = file("x.tik");
    if (first.empty()) first = capture;
    EXPECT_EQ(capture == first, true) << source;
  }
}

TEST_F(DeepInput, SaysWhatItTookForWhite) {
  write_netpbm("twelve", random_stills({17, 9, 1}, 4095, 2, 1));
  expect_said(run("encode -f 10 twelve"), "twelve.tik: 17 x 9 grey, 2 samples");
  expect_said(run("info twelve.tik"), "17 x 9 grey, 16 bits, white code 4095, transfer linear");
  scratch_.write("stack.tif", tiff_file(random_stills({17, 9, 1}, 4095, 2, 1), {}));
  expect_said(run("-f 10 stack.tif x.tik"),
              "white is taken to be 65535; state another, 4095 for 12 bits (--white)");
  expect_said(run("-f 10 --start 0f --exposure 1f stack.tif x.png"), "white is taken to be 65535");
  expect_said(run("-f 10 --white 4095 --overwrite stack.tif x.tik"), "2 samples");
  expect_said(run("info x.tik"), "white code 4095, transfer linear");
  expect_refused("-f 10 --white 1000 stack.tif y.tik", 3,
                 {"sample 0 has a code of 4095, above the white code 1000"});
}

TEST_F(DeepInput, RefusesWithTheFileBothValuesAndTheWayOut) {
  const auto stills = random_stills({17, 9, 1}, 4095, 3, 1);
  write_netpbm("frames", stills);
  expect_refused("frames x.tik", 3, {"frames does not say how fast it was taken; state the rate (--fps)"});
  expect_refused("-f 10 absent/*.png x.tik", 3, {"absent/*.png: no file matches"});
  expect_refused("-f 10 frames/f%d.pgm x.tik", 3, {"f002.pgm is there: its zeros are written %03d"});
  std::filesystem::remove(scratch_ / "frames/f001.pgm");
  expect_refused("-f 10 frames/f%03d.pgm x.tik", 3,
                 {"f001.pgm is missing between f000.pgm and f002.pgm", "'frames/f*.pgm'"});
  scratch_.write("frames/f003.pgm", netpbm_file(random_stills({16, 9, 1}, 4095, 1, 1)[0], false));
  expect_refused("-f 10 frames x.tik", 3,
                 {"frames/f003.pgm is 16 x 9 grey", "frames/f000.pgm, is 17 x 9 grey"});
  scratch_.write("frames/f003.pgm", "P5 17 9 4095\nshort");
  expect_refused(
      "-f 10 frames x.tik", 3,
      {"frames/f003.pgm cannot be read: it was cut off: 17 x 9 pixels need 306 bytes, 5 are left"});
  expect_refused("-f 10 frames/f000.pgm frames/f002.pgm x.tik", 2,
                 {"'x.tik' is one file too many", "a pattern in quotes"});
  EXPECT_FALSE(exists("x.tik"));
}

// A picture that is exposed from a sequence into its own folder must not replace one of its stills.
TEST_F(DeepInput, NeverReplacesAStillOfItsSource) {
  write_netpbm("frames", random_stills({17, 9, 1}, 255, 3, 1));
  const std::string before = file("frames/f001.pgm");
  for (const std::string source : {"frames", "frames/*", "frames/f%03d.pgm"}) {
    expect_refused({"-f", "10", "--start", "0s", "--exposure", "100ms", source, "frames/f001.pgm"}, 2,
                   {"the output frames/f001.pgm is also an input"});
  }
  EXPECT_EQ(file("frames/f001.pgm"), before);
}

TEST_F(DeepInput, NamesOutputsAfterTheSequence) {
  write_netpbm("frames", random_stills({17, 9, 1}, 255, 3, 1));
  for (const std::string source : {"frames/", "frames/*.pgm"}) {
    expect_said(run({"encode", "-f", "10", "--overwrite", source}), "frames.tik: ");
    std::filesystem::remove(scratch_ / "frames.tik");
  }
  expect_said(run("-f 10 --start 0f --exposure 1f frames/f%03d.pgm"), "f-0f-1f.png: ");
}

// The camera files that people send, where the folder of clips is there.
TEST_F(DeepInput, ReadsTheRecordedFiles) {
  const std::filesystem::path media = NUTIK_TEST_MEDIA;
  if (!std::filesystem::exists(media / "stuck.tif")) GTEST_SKIP() << "no clips in " << media;
  const auto info = [&](const Words& words, const std::string& said) {
    succeed("encode -q" + words + "x.tik");
    expect_said(run("info x.tik"), said);
  };
  info({"-f", "30000", "--white", "4095", (media / "ball_12bit_png").string()},
       "384 x 384 grey, 16 bits, white code 4095, transfer linear");
  info({"-f", "10", (media / "stuck.tif").string()},
       "512 x 512 grey, 16 bits, white code 65535, transfer linear");
  info({(media / "cine_781.cine").string()}, "256 x 256 grey, 16 bits, white code 4095, transfer linear");
  info({(media / "data_small_cine.cine").string()},
       "256 x 32 grey, 16 bits, white code 4095, transfer linear");
  info({"-f", "24", "--raw", "480x270:yuv420p10le", (media / "sparks_ref_480x270.yuv42010le.yuv").string()},
       "480 x 270 colour, 16 bits, white code 65535, transfer srgb");
}

}  // namespace
}  // namespace nutik::test
