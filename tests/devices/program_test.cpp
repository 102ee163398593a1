// The program on two devices: PoCL's, which share the processor. Files are those of one device.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <link.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "support/messages.hpp"
#include "support/program.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

class SeveralDevices : public testing::Test {
 protected:
  void SetUp() override {
    const ProgramResult devices = run({"devices", "--json"});
    if (devices.status != 0 || json::parse(devices.out)["devices"].size() < 2) {
      GTEST_SKIP() << "PoCL is not installed, or has one device whatever POCL_DEVICES says";
    }
    name_ = json::parse(devices.out)["devices"][0]["name"];
    write_clip();
    ASSERT_EQ(run({"-q", "encode", "-f", "100", "--codec", "zstd", "frames", "clip.tik"}).status, 0);
    ASSERT_EQ(run({"-q", "encode", "-f", "100", "--codec", "none", "frames", "plain.tik"}).status, 0);
    std::string mask = "P5\n40 37\n255\n";
    for (int pixel = 0; pixel < 40 * 37; ++pixel)
      mask.push_back(static_cast<char>(pixel % 40 < 13 || pixel > 900));
    scratch_.write("mask.pgm", mask);
    scratch_.write("two.fn",
                   "M0 [0:1], [90000000:1], [90000001:0]\nM1 [50000000:0], [60000000:-1], [150000000:2]\n");
    scratch_.write("list.txt", "--start 0s --exposure 60ms batch-a.png\n-m mask.pgm -k two.fn batch-b.pfm\n");
  }

  // 24 pictures of 40 x 37 pixels, of which a square moves downwards.
  void write_clip() const {
    std::filesystem::create_directory(scratch_ / "frames");
    for (int k = 0; k < 24; ++k) {
      std::string text = "P5\n40 37\n255\n";
      for (int y = 0; y < 37; ++y) {
        for (int x = 0; x < 40; ++x) {
          text.push_back(
              static_cast<char>(y > k && y < k + 9 && x > 4 && x < 30 ? 230 : 20 + 3 * y + (x * k) % 5));
        }
      }
      scratch_.write("frames/" + std::to_string(100 + k) + ".pgm", text);
    }
  }

  [[nodiscard]] ProgramResult run(Words words, Words settings = {}) const {
    settings.insert(settings.end(), {"POCL_DEVICES=pthread pthread"});
    return run_program(words, scratch_.folder(), settings);
  }
  // The bytes of the files that a command writes on these devices.
  [[nodiscard]] std::vector<std::string> files_of(Words words, const std::string& device,
                                                  const Words& files) const {
    for (const std::string& file : files) std::filesystem::remove(scratch_ / file);
    words.insert(words.begin() + 1, {"--device", device, "--precision", "fixed"});
    const ProgramResult result = run(words);
    EXPECT_EQ(result.status, 0) << result.err;
    std::vector<std::string> bytes;
    for (const std::string& file : files) bytes.push_back(read_file(scratch_ / file));
    return bytes;
  }
  void expect_refused(const Words& words, int status, std::string_view part) const {
    const ProgramResult result = run(words);
    EXPECT_EQ(result.status, status) << result.err;
    expect_says(result.err, part);
    EXPECT_FALSE(std::filesystem::exists(scratch_ / "new.png"));
  }

  void for_each_fault(const Words& words, const std::string& call,
                      const std::function<void(const ProgramResult&)>& look) const;
  void expect_end_where_one_is_lost(const Words& words) const;

  Scratch scratch_;
  std::string name_;  // of each: drivers of several ages name one processor in several ways
};

TEST_F(SeveralDevices, WriteTheFilesOfOne) {
  const Words kInterval{"--start", "20ms", "--exposure", "100ms"};
  const auto command = [&](const Words& front, const Words& back) {
    Words words = front;
    words.insert(words.end(), kInterval.begin(), kInterval.end());
    words.insert(words.end(), back.begin(), back.end());
    return words;
  };
  const std::vector<std::pair<Words, Words>> commands{
      {command({"expose"}, {"clip.tik", "new.png"}), {"new.png"}},
      {command({"expose"}, {"frames", "-f", "100", "new.tif"}), {"new.tif"}},
      {command({"expose"}, {"--delay", "rows:0s..50ms", "clip.tik", "new.pfm"}), {"new.pfm"}},
      {{"expose", "-m", "mask.pgm", "--feather", "6px", "-k", "two.fn", "clip.tik", "new.pfm"}, {"new.pfm"}},
      {command({"expose"}, {"--every", "50ms", "--count", "3", "clip.tik", "-o", "s-%d.png"}),
       {"s-0.png", "s-1.png", "s-2.png"}},
      {{"video", "--out-fps", "25", "clip.tik", "new.avi"}, {"new.avi"}},
      {{"batch", "list.txt", "clip.tik"}, {"batch-a.png", "batch-b.pfm"}},
      // From a capture that is not packed each device makes pictures of its own.
      {command({"expose"}, {"--every", "20ms", "--count", "8", "plain.tik", "-o", "s-%d.png"}),
       {"s-0.png", "s-1.png", "s-2.png", "s-3.png", "s-4.png", "s-5.png", "s-6.png", "s-7.png"}},
      {{"video", "--out-fps", "50", "plain.tik", "new.avi"}, {"new.avi"}},
      {{"batch", "list.txt", "plain.tik"}, {"batch-a.png", "batch-b.pfm"}},
      {{"contact", "--every", "60ms", "--exposure", "40ms", "clip.tik", "sheet.png"}, {"sheet.png"}},
  };
  for (const auto& [words, files] : commands) {
    SCOPED_TRACE(words.front() + " " + files.front());
    const auto alone = files_of(words, "1", files);
    for (const std::string& bytes : alone) EXPECT_FALSE(bytes.empty());
    EXPECT_EQ(files_of(words, "0,1", files), alone);
    EXPECT_EQ(files_of(words, "all", files), alone);
  }
}

TEST_F(SeveralDevices, AreNamedInTheAnswer) {
  const auto renderer_of = [&](const Words& words, const Words& settings = {}) -> std::string {
    Words all{"expose", "--json", "--start", "20ms", "--exposure", "100ms"};
    all.insert(all.end(), words.begin(), words.end());
    const ProgramResult result = run(all, settings);
    EXPECT_EQ(result.status, 0) << result.err;
    return result.status == 0 ? json::parse(result.out)["renderer"] : json();
  };
  const std::string one = renderer_of({"--device", "1", "clip.tik", "a.png"});
  EXPECT_EQ(renderer_of({"--device", "0, 1", "clip.tik", "a.png"}), "2 x " + one);
  EXPECT_EQ(renderer_of({"clip.tik", "a.png"}, {"NUTIK_DEVICE=all"}), "2 x " + one);
  EXPECT_EQ(renderer_of({"--device", "1,0", "-f", "100", "frames", "a.png"}), one);
}

TEST_F(SeveralDevices, LeaveAClipForOnePictureToTheFirstAndSaySo) {
  const ProgramResult result = run(
      {"expose", "--device", "all", "-f", "100", "--start", "0s", "--exposure", "50ms", "frames", "a.png"});
  EXPECT_EQ(result.status, 0) << result.err;
  expect_says(result.err, "note: a clip that is read for one picture is exposed by the first device alone");
}

TEST_F(SeveralDevices, AreRefusedWithTheWayOut) {
  const auto with = [](const std::string& device) {
    return Words{"expose", "--device", device, "--start", "0s", "--exposure", "50ms", "clip.tik", "new.png"};
  };
  expect_refused(with("0,0"), 4, "'0,0' names device 0 twice (" + name_);
  expect_refused(with("1," + name_), 4, "more than one OpenCL device's name contains '" + name_ + "'");
  expect_refused(with("0,2"), 4, "there is no OpenCL device 2; these were found:\n  0  " + name_);
  expect_refused(with("0,nosuch"), 4,
                 "no OpenCL device's name contains 'nosuch'; these were found:\n  0  " + name_);
  expect_refused(with("0,"), 4, "'0,' names no device before or after a comma");
  expect_refused({"validate", "--device", "0,1", "--start", "0s", "--exposure", "50ms", "clip.tik"}, 2,
                 "each is validated alone; name one of them: --device 0");
  Words reference = with("0,1");
  reference.insert(reference.begin() + 1, {"--renderer", "reference"});
  expect_refused(reference, 2, "--device chooses an OpenCL device; the reference uses none");
}

TEST_F(SeveralDevices, KeepToTheMemoryThatTheyAskFor) {
  const Words words{"--device", "0,1",        "--precision", "fixed",    "--start",
                    "0s",       "--exposure", "50ms",        "clip.tik", "new.png"};
  Words little = words;
  little.insert(little.begin(), {"expose", "--memory", "1kB"});
  const ProgramResult refused = run(little);
  EXPECT_EQ(refused.status, 2) << refused.err;
  std::smatch least;
  ASSERT_TRUE(std::regex_search(refused.err, least, std::regex("allow more: --memory ([0-9]+MB)")))
      << refused.err;
  Words enough = words;
  enough.insert(enough.begin(), {"expose", "--memory", least[1]});
  const ProgramResult made = run(enough);
  EXPECT_EQ(made.status, 0) << made.err;
}

// A call of either device fails, early and late, once: the message says on which, and there is no picture.
TEST_F(SeveralDevices, EndWhereOneIsLost) {
  expect_end_where_one_is_lost({"expose", "--device", "0,1", "--precision", "fixed", "-m", "mask.pgm", "-k", "two.fn",
                                "clip.tik", "new.png"});
}

// Nobody named a device: the other one takes over, and makes the same picture or film.
TEST_F(SeveralDevices, TakeOverFromOneThatFails) {
  for (const Words& words :
       {Words{"expose", "--json", "--precision", "fixed", "-m", "mask.pgm", "-k", "two.fn", "clip.tik", "new.png"},
        Words{"video", "--json", "--precision", "fixed", "--out-fps", "50", "plain.tik", "new.avi"}}) {
    SCOPED_TRACE(words.front());
    ASSERT_EQ(run(words).status, 0);
    const std::string whole = read_file(scratch_ / words.back());
    for (const char* call : {"start", "enqueue", "allocate", "wait"}) {
      for_each_fault(words, call, [&](const ProgramResult& result) {
        EXPECT_EQ(result.status, 0) << result.err;
        // To people, and to scripts.
        for (const auto& [text, is_said] :
             {std::pair(result.err, "warning: "), {result.out, "\"warnings\": [\n    \""}}) {
          const auto said = text.find(is_said);
          ASSERT_NE(said, std::string::npos) << text;
          EXPECT_TRUE(text.find("device 0: " + name_, said) != std::string::npos ||
                      text.find("device 0, " + name_, said) != std::string::npos)
              << text;
        }
        EXPECT_EQ(read_file(scratch_ / words.back()), whole);
      });
    }
  }
}

// What was read of a clip that is read for one picture is gone.
TEST_F(SeveralDevices, EndAClipForOnePictureWhereOneFails) {
  const Words words{"expose", "-f", "100", "--start", "0s", "--exposure", "50ms", "frames", "new.png"};
  ASSERT_EQ(run(words).status, 0);
  for_each_fault(words, "wait", [&](const ProgramResult& result) { EXPECT_EQ(result.status, 4) << result.err; });
}

// The same of a film whose frames are shared out.
TEST_F(SeveralDevices, EndAFilmWhereOneIsLost) {
  expect_end_where_one_is_lost({"video", "--device", "0,1", "--precision", "fixed", "--out-fps", "50", "plain.tik",
                                "new.avi"});
}

// `look` at what a command says where one call fails, early, in between and late.
void SeveralDevices::for_each_fault(const Words& words, const std::string& call,
                                    const std::function<void(const ProgramResult&)>& look) const {
  const std::string& output = words.back();
  const std::string library =
      (std::filesystem::path(NUTIK_TEST_PROGRAM).parent_path() / "tests" / "libfail_device.so").string();
  const std::string report = (scratch_ / "calls").string();
  const Words fault{"LD_PRELOAD=" + library, "NUTIK_FAIL_CALL=" + call, "NUTIK_SELF_TEST=off",
                    "NUTIK_FAIL_REPORT=" + report};
  std::filesystem::remove(report);
  std::filesystem::remove(scratch_ / output);
  ASSERT_EQ(run(words, fault).status, 0);
  const int calls = std::stoi(read_file(report));
  ASSERT_GT(calls, 0);
  for (const int at : std::set{1, (calls + 1) / 2, calls}) {
    SCOPED_TRACE(call + " " + std::to_string(at) + " of " + std::to_string(calls));
    std::filesystem::remove(scratch_ / output);
    Words settings = fault;
    settings.push_back("NUTIK_FAIL_AT=" + std::to_string(at));
    look(run(words, settings));
  }
}

void SeveralDevices::expect_end_where_one_is_lost(const Words& words) const {
  ASSERT_EQ(run(words).status, 0);  // kernels are built
  for (const char* call : {"enqueue", "allocate", "wait"}) {
    for_each_fault(words, call, [&](const ProgramResult& result) {
      EXPECT_EQ(result.status, 4) << result.err;
      EXPECT_TRUE(result.err.find("nutik-cl: device 0: " + name_) != std::string::npos ||
                  result.err.find("nutik-cl: device 1: " + name_) != std::string::npos)
          << result.err;
      expect_says(result.err, "another device");
      EXPECT_FALSE(std::filesystem::exists(scratch_ / words.back()));
    });
  }
}

// As it comes in an archive: no driver is installed, and PoCL lies beside the program.
TEST(OwnDriver, IsTakenWhereTheSystemHasNoneForTheProcessor) {
  std::string line = read_file("/etc/OpenCL/vendors/pocl.icd");
  void* const loaded = dlopen(line.erase(line.find_last_not_of(" \n") + 1).c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (line.empty() || loaded == nullptr) GTEST_SKIP() << "PoCL is not installed";
  link_map* map = nullptr;
  ASSERT_EQ(dlinfo(loaded, RTLD_DI_LINKMAP, static_cast<void*>(&map)), 0);
  const auto driver = std::filesystem::canonical(map->l_name);
  const Scratch scratch;
  std::filesystem::copy_file(NUTIK_TEST_PROGRAM, scratch / "nutik-cl");
  const std::string list = "env OCL_ICD_VENDORS=" + scratch.folder().string() + " ./nutik-cl devices --json";
  expect_says(run_shell(list, scratch.folder()).err, "no OpenCL device was found");

  const std::filesystem::path folder = scratch / "pocl/lib/opencl";
  std::filesystem::create_directories(folder);
  std::filesystem::create_directory_symlink("/usr/share", scratch / "pocl/share");
  std::filesystem::create_directory_symlink(driver.parent_path() / "pocl", folder / "pocl");
  std::filesystem::create_symlink(driver, folder / "libpocl.so");
  const ProgramResult devices = run_shell(list, scratch.folder());
  ASSERT_EQ(devices.status, 0) << devices.err;
  EXPECT_EQ(json::parse(devices.out)["devices"][0]["kind"], "CPU");

  // Called by its name alone, where another file has that name.
  std::filesystem::create_directories(scratch / "elsewhere/nutik-cl");
  const std::string here = scratch.folder().string();
  const ProgramResult called = run_shell(
      "env OCL_ICD_VENDORS=" + here + " PATH=" + here + ":$PATH nutik-cl devices --json", scratch / "elsewhere");
  ASSERT_EQ(called.status, 0) << called.err;
  EXPECT_EQ(json::parse(called.out)["devices"][0]["kind"], "CPU");
}

}  // namespace
}  // namespace nutik::test
