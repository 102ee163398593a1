// What tests of commands on the moving square share: the scene as stills and as a capture, frames/ and clip.tik at 100
// pictures a second, and the program.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "support/moving_square.hpp"
#include "support/program.hpp"
#include "support/scratch.hpp"

namespace nutik::test {

class MovingSquareTest : public testing::Test {
 protected:
  void SetUp() override {
    scene_.write(scratch_);
    ASSERT_EQ(run({"-f", "100", "frames", "clip.tik"}).status, 0);
  }

  [[nodiscard]] ProgramResult run(const std::vector<std::string>& words) const {
    return run_program(words, scratch_.folder());
  }

  // Ends with `status`, says `part`, and prints nothing that a script could take for a result.
  void expect_refused(const std::vector<std::string>& words, int status, std::string_view part) const {
    const ProgramResult result = run(words);
    EXPECT_EQ(result.status, status) << result.err;
    EXPECT_NE(result.err.find(part), std::string::npos) << "no '" << part << "' in: " << result.err;
    EXPECT_EQ(result.out, "");
  }

  Scratch scratch_;
  MovingSquare scene_;
};

}  // namespace nutik::test
