// What tests of motion studies have in common.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "support/moving_square_test.hpp"

namespace nutik::test {

class StudyTest : public MovingSquareTest {
 protected:
  // Whether a study without moments is what a plain exposure of all of the clip is, but for how its light was
  // corrected.
  void expect_mean_of_all(const std::string& clip, int pictures, const std::string& study) const {
    EXPECT_EQ(cv::countNonZero(picture(study + ".pgm")), 0) << study;
    make("expose " + clip + " --deflicker --start 0f --exposure " + std::to_string(pictures) +
         "f --overwrite -o all.png");
    EXPECT_LE(cv::norm(picture("all.png"), picture(study + ".png"), cv::NORM_INF), 1) << study;
  }
  // Whether the commands in study.txt make picture and mask, if there is one, byte for byte.
  void expect_the_same_by_hand(const std::string& what) const {
    const bool has_mask = std::filesystem::exists(scratch_ / "study.pgm");
    const std::string picture = read_file(scratch_ / "study.png"),
                      mask = has_mask ? read_file(scratch_ / "study.pgm") : "";
    std::filesystem::remove(scratch_ / "study.png");
    std::filesystem::remove(scratch_ / "study.pgm");
    const std::string folder = std::filesystem::path(NUTIK_TEST_PROGRAM).parent_path().string();
    const std::string command =
        "cd '" + scratch_.folder().string() + "' && PATH='" + folder + "':$PATH sh -e study.txt";
    ASSERT_EQ(std::system((command + " > log 2>&1").c_str()), 0) << read_file(scratch_ / "log");
    EXPECT_EQ(read_file(scratch_ / "log").find("later steps cover"), std::string::npos) << what;
    if (has_mask) {
      EXPECT_TRUE(read_file(scratch_ / "study.pgm") == mask) << what;
    }
    EXPECT_TRUE(read_file(scratch_ / "study.png") == picture) << what;
  }
};

}  // namespace nutik::test
