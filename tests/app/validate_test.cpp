// nutik-cl validate as a user meets it: the table, JSON, the source, exit status 1 where a device computes wrongly.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "opencl/cache_folder.hpp"
#include "support/app_test.hpp"
#include "support/still_clip.hpp"
#include "support/tik_files.hpp"

namespace nutik::test {
namespace {

const Words kInterval("--start 0s --exposure 100ms");

class Validate : public AppTest {
 protected:
  void SetUp() override {
    write_still_clip(scratch_.folder(), 24, 20);
    make("-q encode -f 100 --tolerance 4 frames clip.tik");
  }

  // In a process of its own.
  ProgramResult run(const Words& words, int status = 0, const std::vector<std::string>& settings = {}) const {
    ProgramResult result = run_program(words, scratch_.folder(), settings);
    EXPECT_EQ(result.status, status) << result.out << result.err;
    return result;
  }
  // validate of the interval, with more words.
  ProgramResult validate(const Words& words, int status = 0, const std::vector<std::string>& settings = {}) const {
    return run("validate" + words + kInterval, status, settings);
  }
  json json_of(const Words& words) const { return json::parse(validate(words + "--json").out); }
  void expect_refused(const Words& words, int status, std::string_view part) const {
    expect_says(validate(words, status).err, part);
  }
};

TEST_F(Validate, ShowsEveryArithmeticAndMarksTheChosenOne) {
  expect_says(validate("clip.tik").out,
              {"clip.tik: 24 x 24 grey, 10 of 20 samples, as 8-bit codes; medians of 5 on ", "\n*  single",
               "\n   fixed", "\n   compensated", "\n   reference", "\n* what --precision auto takes: light within "});
}

TEST_F(Validate, AnswersInJson) {
  const json eight = json_of({"--runs", "2", "clip.tik"});
  EXPECT_EQ(eight["width"], 24);
  EXPECT_EQ(eight["channels"], 1);
  EXPECT_EQ(eight["live_samples"], 10);
  EXPECT_EQ(eight["white_code"], 255);
  EXPECT_EQ(eight["runs"], 2);
  EXPECT_TRUE(eight["is_within_bounds"]);
  for (const json& variant : eight["variants"]) {
    EXPECT_TRUE(variant["is_within_bound"]) << variant;
    EXPECT_EQ(variant["is_chosen"], variant["precision"] == "single") << variant;
    EXPECT_LE(variant["worst_light"], variant["bound_light"]) << variant;
    EXPECT_LE(variant["rms_light"], variant["worst_light"]) << variant;
    EXPECT_EQ(variant["values"], 24 * 24) << variant;
    EXPECT_GT(variant["expose_ms"], 0) << variant;
  }
  const json sixteen = json_of({"--depth", "16", "clip.tik"});
  EXPECT_EQ(sixteen["white_code"], 65'535);
  for (const json& variant : sixteen["variants"])
    EXPECT_EQ(variant["is_chosen"], variant["precision"] == "single") << variant;
  const json floats = json_of({"--depth", "float", "clip.tik"});
  for (const json& variant : floats["variants"])
    EXPECT_FALSE(variant["precision"] == "single" && variant["is_chosen"]);
  EXPECT_FALSE(floats.contains("white_code"));
}

// In the table of a mask and functions, and of a clip that is no capture yet.
TEST_F(Validate, TakesMasksFunctionsAndClips) {
  std::ofstream(scratch_ / "mask.pgm", std::ios::binary)
      << "P5 24 24 255\n"
      << std::string(12 * 24, '\0') << std::string(12 * 24, '\7');
  scratch_.write("f.fn",
                 "M0 [0:0], [50000000:1], [100000000:0]\nM7 [0:1e4], [99999999:1e4], [100000000:-9e3], "
                 "[200000000:-9e3]\n");
  const json told = json::parse(run("validate --json -m mask.pgm -k f.fn -f 100 frames").out);
  for (const json& variant : told["variants"]) {
    EXPECT_FALSE(variant["is_chosen"] && variant["precision"] == "single") << variant;  // these gains cancel
  }
}

TEST_F(Validate, ComparesWithTheSource) {
  const json source = json_of({"clip.tik", "--source", "frames"})["source"];
  EXPECT_EQ(source["values_beyond"], 0);
  EXPECT_LE(source["worst_codes"], 4);
  EXPECT_GT(source["worst_codes"], 0);
  EXPECT_GT(source["psnr_db"], 30);
  EXPECT_EQ(source["values"], 24 * 24 * 20);
  EXPECT_EQ(source["source_bytes"], 24 * 24 * 20);
  EXPECT_EQ(source["file_bytes"], std::filesystem::file_size(scratch_ / "clip.tik"));
  EXPECT_GT(source["records"], 0);

  make("-q encode -f 100 frames exact.tik");
  EXPECT_TRUE(json_of({"exact.tik", "--source", "frames"})["source"]["psnr_db"].is_null());
  expect_says(validate("exact.tik --source frames").out, "frames: held exactly; ");
}

// The capture knows which pictures it has, and which rectangle of them.
TEST_F(Validate, ComparesAPartWithItsPartOfTheSource) {
  const Words validate("validate --runs 1 --start 0s --exposure 20ms part.tik --source frames");
  const auto encode = [&](const std::string& how) { run("encode --overwrite -f 100 " + how + " frames part.tik"); };
  for (const std::string part : {"--from 3f", "--from 3f --to 9f", "--crop 9x7+3+5 --to 4f"}) {
    encode(part);
    expect_says(run(validate).out, "frames: held exactly; ");
  }
  // Its edge tiles' padding is no change.
  encode("--crop 1x1+3+5");
  const json told = json::parse(run(validate + "--json").out);
  EXPECT_LE(told["source"]["records"], 19);
  const json known = answer("info part.tik");
  EXPECT_EQ(known["records"], told["source"]["records"]);
  EXPECT_EQ(known["are_records_exact"], false) << "earlier programs counted it";
  expect_says(make("info part.tik").out, "  changes     at most ");
  EXPECT_EQ(answer("info clip.tik")["are_records_exact"], true);
  encode("--scale 1/2");
  expect_refused({"part.tik", "--source", "frames"}, 3, "(--crop, --scale)");
}

TEST_F(Validate, SaysWhereTheSourceIsFurthestOff) {
  make("-q encode -f 100 frames exact.tik");
  std::vector<std::filesystem::path> pictures;
  for (const auto& entry : std::filesystem::directory_iterator(scratch_ / "frames"))
    pictures.push_back(entry.path());
  std::ranges::sort(pictures);
  std::string bytes = read_file(pictures[7]);
  char& pixel = bytes[bytes.size() - 24 * 24 + 3 * 24 + 5];
  pixel = static_cast<char>(static_cast<unsigned char>(pixel) ^ 64);
  std::ofstream(pictures[7], std::ios::binary) << bytes;
  expect_says(validate("exact.tik --source frames", 1).out,
              "worst error 64 codes at sample 7, pixel 5,3; 1 of 11520 values further off");
}

TEST_F(Validate, AnotherSourceIsNoSource) {
  std::filesystem::create_directory(scratch_ / "other");
  write_still_clip(scratch_ / "other", 24, 12);
  expect_refused({"clip.tik", "--source", "other/frames"}, 3, "it has 12 pictures, the capture 20");
  std::filesystem::create_directory(scratch_ / "large");
  write_still_clip(scratch_ / "large", 25, 20);
  expect_refused({"clip.tik", "--source", "large/frames"}, 3,
                 "it has 25 x 25 grey, 8 bits, white code 255, the capture 24 x 24 grey");
  std::ofstream(scratch_ / "frames/005.pgm", std::ios::binary) << "P5 24 24 255\n"
                                                               << std::string(24 * 24, 'x');
  expect_refused({"clip.tik", "--source", "frames"}, 1, "the capture is not true to frames");
  write_saying(tik::Reader(scratch_ / "clip.tik"), scratch_ / "old.tik",
               [](tik::Header& header) { header.roundings.add(0.0, 1.0, kUnknown); });
  expect_refused({"old.tik", "--source", "frames"}, 1, "An earlier version encoded it");
  expect_refused({"clip.tik", "--source", "missing"}, 3, "missing");
}

TEST_F(Validate, SaysWhatItCannotDo) {
  expect_refused({}, 2, "validate takes one capture or clip");
  expect_refused({"clip.tik", "--runs", "0"}, 2, "--runs '0' is no whole number of 1 … 10000");
  expect_refused({"clip.tik", "--device", "no such device"}, 4, "no such device");
  expect_refused({"clip.tik", "--precision", "single"}, 2, "--precision");
  expect_refused({"clip.tik", "--white", "255"}, 2, "was encoded already");
}

// A built kernel as it is kept: a text, then its key and its binary, each behind its length.
struct KeptKernel {
  std::string key, binary;
};
KeptKernel split(const std::string& bytes) {
  const std::size_t magic = bytes.find('\n') + 1;
  std::uint64_t key_bytes = 0;
  std::memcpy(&key_bytes, bytes.data() + magic, sizeof key_bytes);
  const std::size_t end = magic + sizeof key_bytes + key_bytes;
  return {bytes.substr(0, end), bytes.substr(end)};
}

std::filesystem::path kept_kernel(const std::filesystem::path& cache) {
  for (const auto& entry : std::filesystem::directory_iterator(cache / "nutik-cl")) {
    if (entry.path().filename().string().starts_with("expose-")) return entry.path();
  }
  return {};
}

// The kernel of `single` for codes that are sRGB is replaced by the one that takes them for linear light: a device
// that computes wrongly.
TEST_F(Validate, ExitsWithOneWhereADeviceComputesWrongly) {
  validate("clip.tik");
  const std::filesystem::path cache = scratch_ / "cache", other = scratch_ / "other-cache";
  const std::string of_pocl = "POCL_CACHE_DIR=" + cache_of_pocl().string();
  const auto expose = [&](const std::filesystem::path& folder, const Words& more) {
    run("expose --precision single clip.tik picture.png" + kInterval + more, 0,
        {"XDG_CACHE_HOME=" + folder.string(), of_pocl});
  };
  expose(cache, {});
  expose(other, "--transfer linear");
  const std::filesystem::path kept = kept_kernel(cache);
  const std::string wrong = split(read_file(kept)).key + split(read_file(kept_kernel(other))).binary;
  std::ofstream(kept, std::ios::binary) << wrong;
  std::filesystem::copy(default_cache_folder(), cache / "nutik-cl",
                        std::filesystem::copy_options::skip_existing);
  const ProgramResult result = validate("clip.tik", 1, {"XDG_CACHE_HOME=" + cache.string(), of_pocl});
  expect_says(result.out, "EXCEEDED");
  expect_says(result.err, "an arithmetic exceeds its bound");
}

}  // namespace
}  // namespace nutik::test
