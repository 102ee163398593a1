// Where built kernels are kept.
#include "opencl/cache_folder.hpp"

#include <gtest/gtest.h>

#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>

#include "capture/format.hpp"
#include "support/messages.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

// Variables of the environment as a test wants them, until it ends.
class DefaultCacheFolder : public testing::Test {
 protected:
  ~DefaultCacheFolder() override {
    for (const auto& [name, value] : before_) put(name, value);
  }

  void set(const std::string& name, const std::optional<std::string>& value) {
    const char* now = std::getenv(name.c_str());
    before_.emplace(name, now == nullptr ? std::nullopt : std::optional<std::string>(now));
    put(name, value);
  }

 private:
  static void put(const std::string& name, const std::optional<std::string>& value) {
    if (value) {
      ::setenv(name.c_str(), value->c_str(), 1);
    } else {
      ::unsetenv(name.c_str());
    }
  }

  std::map<std::string, std::optional<std::string>> before_;
};

TEST_F(DefaultCacheFolder, IsTheOneForCachesElseInTheHome) {
  set("XDG_CACHE_HOME", "/caches");
  set("HOME", "/home/someone");
  EXPECT_EQ(default_cache_folder(), "/caches/nutik-cl");
  set("XDG_CACHE_HOME", std::nullopt);
  EXPECT_EQ(default_cache_folder(), "/home/someone/.cache/nutik-cl");
  set("XDG_CACHE_HOME", "");
  EXPECT_EQ(default_cache_folder(), "/home/someone/.cache/nutik-cl");
}

TEST_F(DefaultCacheFolder, IsNoneWithoutAHome) {
  set("XDG_CACHE_HOME", std::nullopt);
  set("HOME", std::nullopt);
  EXPECT_EQ(default_cache_folder(), "");
  set("HOME", "");
  EXPECT_EQ(default_cache_folder(), "") << "not in the folder that happens to be the current one";
}

// As the XDG Base Directory Specification wants it: code that is loaded from there lies where its user wants it to lie.
TEST_F(DefaultCacheFolder, IsNeverBelowTheCurrentFolder) {
  set("HOME", "/home/someone");
  for (const char* const relative : {"caches", "./caches", "../caches", "."}) {
    set("XDG_CACHE_HOME", relative);
    EXPECT_EQ(default_cache_folder(), "/home/someone/.cache/nutik-cl") << relative;
  }
  set("HOME", "someone");
  EXPECT_EQ(default_cache_folder(), "");
}

// PoCL would take /tmp/pocl/kcache, where anybody may have put code of theirs.
TEST_F(DefaultCacheFolder, IsForPoclOneOfThisUsersAlone) {
  const Scratch scratch;
  const std::filesystem::path own = scratch / format("nutik-pocl-{}", geteuid()), home = scratch / "home";
  std::filesystem::create_directory(home);
  set("TMPDIR", scratch.folder().string());
  set("XDG_CACHE_HOME", std::nullopt);
  const auto chosen = [&](const std::optional<std::string>& in_home) {
    set("HOME", in_home);
    set("POCL_CACHE_DIR", std::nullopt);
    choose_cache_of_pocl();
    const char* folder = std::getenv("POCL_CACHE_DIR");
    return std::string(folder == nullptr ? "its usual one" : folder);
  };
  EXPECT_EQ(chosen(home), "its usual one");
  EXPECT_EQ(chosen(std::nullopt), own / "kcache");
  EXPECT_EQ(chosen("relative"), own / "kcache");
  EXPECT_EQ(flaw_of_pocl_cache(), "");
  EXPECT_EQ(std::filesystem::status(own / "kcache").permissions(), std::filesystem::perms::owner_all);
  set("XDG_CACHE_HOME", "relative");
  EXPECT_EQ(chosen(home), own / "kcache") << "PoCL would take the relative one";
  set("XDG_CACHE_HOME", std::nullopt);
  std::filesystem::create_directories(home / ".cache/pocl");
  std::filesystem::permissions(home / ".cache/pocl", std::filesystem::perms::all);
  EXPECT_EQ(chosen(home), own / "kcache");
  set("POCL_CACHE_DIR", "/somewhere");
  choose_cache_of_pocl();
  EXPECT_STREQ(std::getenv("POCL_CACHE_DIR"), "/somewhere");
}

// What somebody else planted there is not used.
TEST_F(DefaultCacheFolder, IsNotForPoclWhatOthersMayWriteTo) {
  const Scratch scratch;
  const std::filesystem::path own = scratch / format("nutik-pocl-{}", geteuid());
  set("TMPDIR", scratch.folder().string());
  set("XDG_CACHE_HOME", std::nullopt);
  set("HOME", std::nullopt);
  set("POCL_CACHE_DIR", std::nullopt);
  choose_cache_of_pocl();
  std::filesystem::create_directories(own / "kcache");
  for (const std::filesystem::path& folder : {own, own / "kcache"}) {
    std::filesystem::permissions(folder, std::filesystem::perms::all);
    EXPECT_EQ(flaw_of_pocl_cache(),
              format("other users may write to {} and put code of their own there", folder.string()));
    std::filesystem::permissions(folder, std::filesystem::perms::owner_all);
  }
  EXPECT_EQ(flaw_of_pocl_cache(), "");
  std::filesystem::remove_all(own);
  std::ofstream(own) << "a file";
  EXPECT_EQ(flaw_of_pocl_cache(), format("{} cannot be made", (own / "kcache").string()));
  std::filesystem::remove(own);
  if (::geteuid() != 0) GTEST_SKIP() << "only root can give a folder away";
  std::filesystem::create_directories(scratch / "theirs/kcache");
  ASSERT_EQ(::chown((scratch / "theirs").c_str(), 12'345, 12'345), 0);
  std::filesystem::create_symlink(scratch / "theirs", own);
  expect_says(flaw_of_pocl_cache(), "belongs to another user");
  ASSERT_EQ(::chown((scratch / "theirs").c_str(), 0, 0), 0);
  ASSERT_EQ(::lchown(own.c_str(), 12'345, 12'345), 0);
  EXPECT_NE(flaw_of_pocl_cache().find("belongs to another user"), std::string::npos) << "a link of theirs";
}

TEST(KernelCacheFile, ThatIsTooLargeToBeOursIsNotRead) {
  const Scratch scratch;
  const mode_t before = ::umask(S_IWOTH);  // many systems' for their users
  write_to_cache(scratch / "cache/kernel.bin", "a kernel");
  ::umask(before);
  EXPECT_EQ(read_from_cache(scratch / "cache/kernel.bin"), "a kernel");
  std::filesystem::resize_file(scratch / "cache/kernel.bin", 3ull << 30);
  EXPECT_EQ(read_from_cache(scratch / "cache/kernel.bin").size(), 0u);
}

}  // namespace
}  // namespace nutik::test
