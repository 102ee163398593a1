// Where built kernels are kept.
#include "opencl/cache_folder.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <optional>
#include <string>

namespace nutik {
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

}  // namespace
}  // namespace nutik
