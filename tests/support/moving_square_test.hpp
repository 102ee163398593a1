// What tests of commands on the moving square share: the scene as stills and as a capture, frames/ and clip.tik at 100
// pictures a second, and the program.
#pragma once

#include "support/moving_square.hpp"
#include "support/app_test.hpp"

namespace nutik::test {

class MovingSquareTest : public AppTest {
 protected:
  void SetUp() override {
    scene_.write(scratch_);
    ASSERT_EQ(run({"-f", "100", "frames", "clip.tik"}).status, 0);
  }

  MovingSquare scene_;
};

}  // namespace nutik::test
