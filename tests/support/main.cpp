// GoogleTest in an environment like that of the program.
#include <gtest/gtest.h>

#include "opencl/device.hpp"

int main(int count, char** words) {
  nutik::prepare_for_pocl();
  ::testing::InitGoogleTest(&count, words);
  return RUN_ALL_TESTS();
}
