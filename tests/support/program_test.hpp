// What tests share that run the program in a folder of their own.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "support/messages.hpp"
#include "support/program.hpp"
#include "support/scratch.hpp"

namespace nutik::test {

class ProgramTest : public testing::Test {
 protected:
  [[nodiscard]] ProgramResult run(const std::vector<std::string>& words) const {
    return run_program(words, scratch_.folder());
  }

  // Ends with `status`, says `part`, and prints nothing that a script could take for a result.
  void expect_refused(const std::vector<std::string>& words, int status, std::string_view part) const {
    const ProgramResult result = run(words);
    EXPECT_EQ(result.status, status) << result.err;
    expect_says(result.err, part);
    EXPECT_EQ(result.out, "");
  }

  Scratch scratch_;
};

}  // namespace nutik::test
