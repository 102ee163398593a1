// Which random cases a test draws, and how to draw one of them again.
//
//   NUTIK_TEST_SEED=n     the first seed, instead of the test's own
//   NUTIK_TEST_CASES=n    how many, instead of the few that every run of the tests has time for
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "capture/format.hpp"

namespace nutik::test {

struct Seeds {
  std::uint64_t first;
  std::uint64_t last;  // behind the last one
};

inline Seeds seeds(std::uint64_t first, std::uint64_t count) {
  const auto setting = [](const char* name, std::uint64_t otherwise) {
    const char* text = std::getenv(name);
    return text == nullptr ? otherwise : std::stoull(text);
  };
  const std::uint64_t from = setting("NUTIK_TEST_SEED", first);
  return {from, from + setting("NUTIK_TEST_CASES", count)};
}

// The command line that runs the current test again, by itself.
inline std::string rerun() {
  const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
  return format("{} --gtest_filter={}.{}", std::filesystem::read_symlink("/proc/self/exe").string(),
                test.test_suite_name(), test.name());
}

// The same, with this seed alone.
inline std::string rerun(std::uint64_t seed) {
  return format("NUTIK_TEST_SEED={} NUTIK_TEST_CASES=1 {}", seed, rerun());
}

}  // namespace nutik::test
