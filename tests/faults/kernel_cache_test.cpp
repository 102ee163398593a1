// Kernels that were kept are native code: others' are not loaded, and the program says so. Whatever lies there, and
// however many programs are at it, pictures are right.
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <future>

#include "capture/format.hpp"
#include "opencl/cache_folder.hpp"
#include "support/made_up_tik.hpp"
#include "support/program_test.hpp"
#include "support/running_program.hpp"

namespace nutik::test {
namespace {

namespace fs = std::filesystem;

struct KernelCache : ProgramTest {
  void SetUp() override {
    write_made_up_tik(scratch_ / "c.tik", MadeUpTile::rows({0, 3, 9}), {tik::CodecId::none, 0});
    fs::create_directories(cache_);
  }
  [[nodiscard]] ProgramResult expose(const std::string& picture = "p.png",
                                     std::vector<std::string> settings = {}) const {
    settings.insert(settings.begin(), "POCL_CACHE_DIR=" + cache_of_pocl().string());  // of other tests
    settings.push_back("XDG_CACHE_HOME=" + (scratch_ / "home").string());
    return run_program({"--start", "0s", "--exposure", "1s", "--no-recipe", "--overwrite", "c.tik", picture},
                       scratch_.folder(), settings);
  }
  [[nodiscard]] std::vector<fs::path> kept() const {
    const fs::directory_iterator files(cache_);
    return {begin(files), end(files)};
  }

  [[nodiscard]] std::string right_picture() const {
    const auto result = run_program({"--start", "0s", "--exposure", "1s", "--no-recipe", "--overwrite", "--renderer",
                                     "reference", "c.tik", "right.png"},
                                    scratch_.folder());
    EXPECT_EQ(result.status, 0) << result.err;
    return read_file(scratch_ / "right.png");
  }

  // So many programs at a time make the picture that is right, and say `note`.
  void expect_right(int programs, std::string_view note = {}, std::vector<std::string> settings = {}) const {
    const std::string right = right_picture();
    std::vector<std::future<ProgramResult>> running;
    for (int i = 0; i < programs; ++i) {
      running.push_back(std::async(std::launch::async, [=, this] { return expose(format("p{}.png", i), settings); }));
    }
    for (int i = 0; i < programs; ++i) {
      const ProgramResult result = running[i].get();
      EXPECT_EQ(result.status, 0) << result.err;
      expect_says(result.err, note);
      EXPECT_EQ(read_file(scratch_ / ("p" + std::to_string(i) + ".png")), right) << i;
    }
  }

  fs::path cache_ = scratch_ / "home/nutik-cl";
};

// A relative path names none: it would be another folder in each one that the program is started in.
TEST_F(KernelCache, ThatIsNowhereIsNotPromised) {
  const std::string building = "building and testing kernels for ",
                    kept = "; they are kept for the next time";
  for (const char* const stated : {"", "relative", "/dev/null"}) {
    const auto result =
        run_program({"--start", "0s", "--exposure", "1s", "--no-recipe", "--overwrite", "c.tik", "p.png"},
                    scratch_.folder(), {"HOME=", format("XDG_CACHE_HOME={}", stated)});
    EXPECT_EQ(result.status, 0) << result.err;
    expect_says(result.err, building);
    EXPECT_EQ(result.err.find(kept), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(scratch_ / "relative/nutik-cl"));
  }
  const auto result = expose();
  expect_says(result.err, building);
  expect_says(result.err, kept);
}

TEST_F(KernelCache, OfPoclIsNamedWhereItIsDamaged) {
  ASSERT_EQ(expose("p.png", {"PATH=", "POCL_CACHE_DIR="}).status, 0) << "PoCL ends a program that has no linker";
  fs::remove_all(cache_);
  const fs::path of_pocl = scratch_ / "home/pocl/kcache";
  for (const auto& each : fs::recursive_directory_iterator(of_pocl))
    if (each.path().filename() == "program.bc") fs::resize_file(each, 0);
  const auto result = expose("p.png", {"POCL_CACHE_DIR="});
  EXPECT_EQ(result.status, 4);
  expect_says(result.err, "its cache may be damaged or not writable: delete " + of_pocl.string());
}

TEST_F(KernelCache, ThatIsStatedEmptyIsNoneThatIsStated) {
  EXPECT_EQ(run_shell(format("POCL_CACHE_DIR= '{}' devices", NUTIK_TEST_PROGRAM), scratch_.folder()).status, 0);
}

TEST_F(KernelCache, ThatOthersMayWriteToIsNotUsed) {
  fs::permissions(cache_, fs::perms::all);
  const auto result = expose();
  EXPECT_EQ(result.status, 0) << result.err;
  expect_says(result.err, "built kernels are not kept: other users may write to " + cache_.string());
  EXPECT_TRUE(fs::is_empty(cache_));
  EXPECT_EQ(run_program({"devices"}, scratch_.folder(), {"XDG_CACHE_HOME=" + (scratch_ / "home").string()}).status, 0);
}

// PoCL's compiler would end the process with "LLVM ERROR". In a namespace of its own, in which disks can be mounted.
TEST_F(KernelCache, OnAFullDiskIsNotPocls) {
  fs::create_directories(scratch_ / "disk");
  fs::create_directories(scratch_ / "temporary");
  const auto expose_on_full_disk = [&](const std::string& settings) {
    return run_shell(format("unshare -rm sh -c 'mount -t tmpfs -o size=1M none disk || exit 77; {} \"{}\" --start "
                            "0s --exposure 1s --no-recipe --overwrite c.tik p.png'",
                            settings, NUTIK_TEST_PROGRAM),
                     scratch_.folder());
  };
  const auto made = expose_on_full_disk("XDG_CACHE_HOME=$PWD/disk TMPDIR=$PWD/temporary");
  if (made.err.find("unshare") != std::string::npos || made.status == 77) GTEST_SKIP() << made.err;
  EXPECT_EQ(made.status, 0) << made.err;
  EXPECT_EQ(read_file(scratch_ / "p.png"), right_picture());
  for (const char* settings : {"XDG_CACHE_HOME=$PWD/disk TMPDIR=$PWD/disk", "POCL_CACHE_DIR=$PWD/disk"}) {
    const auto result = expose_on_full_disk(settings);
    EXPECT_EQ(result.status, 4) << result.err;
    expect_says(result.err, "there are not 8 MB of room for " + (scratch_ / "disk").string());
    expect_says(result.err, "set POCL_CACHE_DIR to a folder of yours alone with room");
  }
  EXPECT_TRUE(files_with(scratch_.folder(), ".part").empty());
}

TEST_F(KernelCache, WithFoldersForFilesFailsNoExposure) {
  fs::permissions(cache_, fs::perms::owner_all);
  ASSERT_EQ(expose().status, 0);
  ASSERT_GE(kept().size(), 3u);  // both kernels, and the verdict on them
  for (const fs::path& file : kept()) {
    fs::remove(file);
    fs::create_directory(file);
  }
  const auto result = expose();
  EXPECT_EQ(result.status, 0) << result.err;
  const auto devices = run_program({"devices"}, scratch_.folder(), {"XDG_CACHE_HOME=" + (scratch_ / "home").string()});
  EXPECT_EQ(devices.status, 0) << devices.err;
}

TEST_F(KernelCache, ThatIsEmptyServesFourPrograms) {
  fs::remove_all(scratch_ / "home");
  expect_right(4, {}, {"POCL_CACHE_DIR="});  // PoCL's is empty, too
  EXPECT_EQ(fs::status(cache_).permissions(), fs::perms::owner_all);
  for (const fs::path& file : kept()) {
    EXPECT_TRUE(file.extension() == ".bin" || file.extension() == ".txt") << file << " was left unfinished";
  }
  EXPECT_EQ(expose().err.find("testing kernels"), std::string::npos);
}

TEST_F(KernelCache, ThatIsDamagedServesTenPrograms) {
  fs::permissions(cache_, fs::perms::owner_all);
  ASSERT_EQ(expose().status, 0);
  int kind = 0;
  for (const fs::path& file : kept()) {
    std::string bytes = read_file(file);
    switch (kind++ % 3) {
      case 0: bytes[bytes.size() - bytes.size() / 4] ^= 0x10; break;
      case 1: bytes.resize(bytes.size() - 5); break;
      case 2: bytes.clear(); break;
    }
    std::ofstream(file, std::ios::binary) << bytes;
  }
  ASSERT_GE(kind, 3);
  expect_right(10);
}

// Kernels that compute wrongly lie there under the names of the right ones. Where the cache is our own alone they are
// taken, for nothing tells them apart.
TEST_F(KernelCache, OfOthersIsNotLoaded) {
  fs::permissions(cache_, fs::perms::owner_all);
  const std::string untested = "NUTIK_SELF_TEST=off";
  ASSERT_EQ(expose("wrong.png", {untested, "LD_PRELOAD=" NUTIK_TEST_MUTATION,
                                 "NUTIK_MUTATE_FROM=  return multiply_add(weights, lights, sums);",
                                 "NUTIK_MUTATE_TO=  return multiply_add(weights, lights * (real)0.5, sums);"})
                .status,
            0);
  ASSERT_EQ(expose("p.png", {untested}).status, 0);
  ASSERT_EQ(read_file(scratch_ / "p.png"), read_file(scratch_ / "wrong.png"));
  ASSERT_NE(read_file(scratch_ / "p.png"), right_picture());

  fs::permissions(cache_, fs::perms::group_write, fs::perm_options::add);
  expect_right(10, "other users may write to " + cache_.string());
  fs::permissions(cache_, fs::perms::owner_all);
  if (::chown(cache_.c_str(), 12'345, 12'345) != 0) GTEST_SKIP() << "only root can give a folder away";
  expect_right(1, cache_.string() + " belongs to another user");
  ASSERT_EQ(::chown(cache_.c_str(), ::geteuid(), ::getegid()), 0);
  for (const fs::path& file : kept()) ASSERT_EQ(::chown(file.c_str(), 12'345, 12'345), 0);
  expect_right(1);
}

}  // namespace
}  // namespace nutik::test
