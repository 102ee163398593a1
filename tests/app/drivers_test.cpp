// What a user sees of drivers that compute wrongly, and the program on a second driver: Mesa's, for the processor.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "opencl/cache_folder.hpp"
#include "support/messages.hpp"
#include "support/program.hpp"
#include "support/scratch.hpp"
#include "support/still_clip.hpp"

namespace nutik::test {
using nlohmann::json;

namespace {

class Drivers : public testing::Test {
 protected:
  void SetUp() override {
    write_still_clip(scratch_.folder(), 24, 20);
    ASSERT_EQ(run({"-q", "encode", "-f", "100", "--tolerance", "4", "frames", "clip.tik"}).status, 0);
  }

  // With kernels of its own, which PoCL need not compile again.
  ProgramResult run(const std::vector<std::string>& words) const {
    std::vector<std::string> settings{"XDG_CACHE_HOME=" + (scratch_ / "cache").string(),
                                      "POCL_CACHE_DIR=" + cache_of_pocl().string()};
    if (on_mesa_) settings.insert(settings.end(), {"RUSTICL_ENABLE=llvmpipe", "NUTIK_DEVICE=rusticl"});
    return run_program(words, scratch_.folder(), settings);
  }
  ProgramResult expose(std::vector<std::string> words) const {
    words.insert(words.begin(), {"expose", "--start", "0s", "--exposure", "100ms"});
    return run(words);
  }

  // Has every kept verdict say what `to` says where it says `from`.
  void turn_verdicts(const std::string& from, const std::string& to) const {
    for (const auto& file : std::filesystem::directory_iterator(scratch_ / "cache" / "nutik-cl")) {
      if (file.path().extension() != ".txt") continue;
      std::string text = read_file(file.path());
      if (const std::size_t at = text.find(from); at != std::string::npos) {
        std::ofstream(file.path(), std::ios::binary) << text.replace(at, from.size(), to);
      }
    }
  }

  Scratch scratch_;
  bool on_mesa_ = false;
};

TEST_F(Drivers, VerdictsAreShown) {
  expect_says(run({"devices"}).out, "self-test: single not tested yet");
  ASSERT_EQ(expose({"clip.tik", "right.png"}).status, 0);
  expect_says(run({"devices"}).out, "self-test: single right");
  const json right = json::parse(run({"devices", "--json"}).out)["devices"][0]["arithmetics"];
  EXPECT_EQ(right[0]["precision"], "single");
  EXPECT_EQ(right[0]["is_right"], true);
  EXPECT_EQ(right[1]["is_right"], nullptr);

  turn_verdicts("single right", "single wrong");
  expect_says(run({"devices"}).out, "self-test: single WRONG (");
  EXPECT_EQ(json::parse(run({"devices", "--json"}).out)["devices"][0]["arithmetics"][0]["is_right"], false);
}

TEST_F(Drivers, AWrongArithmeticIsAvoidedOrRefused) {
  ASSERT_EQ(expose({"clip.tik", "right.png"}).status, 0);
  turn_verdicts("single right", "single wrong");
  const ProgramResult automatic = expose({"--json", "clip.tik", "auto.png"});
  ASSERT_EQ(automatic.status, 0) << automatic.err;
  EXPECT_NE(json::parse(automatic.out)["precision"], "single");
  EXPECT_EQ(automatic.err.find("wrongly"), std::string::npos) << automatic.err;
  const ProgramResult asked = expose({"--precision", "single", "clip.tik", "asked.png"});
  EXPECT_EQ(asked.status, 4) << asked.err;
  expect_says(asked.err, "this driver computes `single` wrongly (self-test: ");
  expect_says(asked.err, "use auto or another arithmetic, another device or the reference (--precision, --renderer)");
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "asked.png"));
}

TEST_F(Drivers, ADeviceThatIsAlwaysWrongEndsWithTheWayOut) {
  for (const char* precision : {"single", "double", "fixed", "compensated"}) {
    const ProgramResult result = expose({"--precision", precision, "clip.tik", "right.png"});
    if (result.status != 0) expect_says(result.err, "has no double precision");
  }
  turn_verdicts(" right ", " wrong ");
  const ProgramResult result = expose({"clip.tik", "wrong.png"});
  EXPECT_EQ(result.status, 4) << result.err;
  for (const char* part : {"computes every arithmetic wrongly", "use another device or the reference"}) {
    expect_says(result.err, part);
  }
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "wrong.png"));
}

class SecondDriver : public Drivers {
 protected:
  void SetUp() override {
    on_mesa_ = true;
    const ProgramResult devices = run({"devices"});
    if (devices.out.find("rusticl") == std::string::npos) {
      GTEST_SKIP() << "Mesa's OpenCL driver is not installed (apt install mesa-opencl-icd)";
    }
    Drivers::SetUp();
  }
};

TEST_F(SecondDriver, IsListedBehindTheFirst) {
  const std::string devices = run({"devices"}).out;
  expect_says(devices, "llvmpipe");
  const ProgramResult unset = run_program({"devices"}, scratch_.folder(), {"RUSTICL_ENABLE="});
  EXPECT_EQ(unset.out.find("rusticl"), std::string::npos) << unset.out;
  if (unset.status == 0) {
    EXPECT_LT(devices.find(unset.out.substr(0, unset.out.find('\n'))), devices.find("llvmpipe"));
  }
}

TEST_F(SecondDriver, ComputesRightlyOrNotAtAll) {
  const ProgramResult picture = expose({"clip.tik", "mesa.pfm"});
  if (picture.status != 0) {
    EXPECT_EQ(picture.status, 4) << picture.err;
    expect_says(picture.err, "computes every arithmetic wrongly");
    return;
  }
  ASSERT_EQ(expose({"--renderer", "reference", "clip.tik", "reference.pfm"}).status, 0);
  const std::vector<float> mesa = read_pfm(scratch_ / "mesa.pfm");
  const std::vector<float> reference = read_pfm(scratch_ / "reference.pfm");
  ASSERT_EQ(mesa.size(), reference.size());
  for (std::size_t i = 0; i < mesa.size(); ++i) ASSERT_NEAR(mesa[i], reference[i], 1e-6f) << i;
}

// Debian 12's driver has no times of kernels, 13's has.
TEST_F(SecondDriver, IsValidatedWithTimesOfKernelsIfItHasThem) {
  const std::string version = json::parse(run({"devices", "--json"}).out)["devices"].back()["driver_version"];
  const bool has_times = std::stoi(version) > 22;
  const ProgramResult result =
      run({"validate", "--json", "--runs", "1", "--start", "0s", "--exposure", "100ms", "clip.tik"});
  const json validation = json::parse(result.out);
  for (const json& variant : validation["variants"]) {
    for (const char* figure : {"expose_ms", "gigabytes_per_second"}) {
      if (has_times) {
        EXPECT_GT(variant[figure], 0.0) << variant;
      } else {
        EXPECT_EQ(variant[figure], nullptr) << variant;
      }
    }
    EXPECT_GT(variant["render_ms"], 0.0);
    if (variant["is_chosen"] == true) {
      EXPECT_EQ(variant["is_within_bound"], true) << variant;
    }
  }
  const ProgramResult table =
      run({"validate", "--runs", "1", "--start", "0s", "--exposure", "100ms", "clip.tik"});
  EXPECT_EQ(table.out.find("not timed") == std::string::npos, has_times) << table.out;
}

}  // namespace
}  // namespace nutik::test
