// What tests of the program's command lines share: a folder of their own, and the program in this process.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "support/messages.hpp"
#include "support/program.hpp"
#include "support/scratch.hpp"

namespace nutik::test {

using nlohmann::json;

// The words of a command line: "-k one.fn clip.tik" between blanks, or one by one.
struct Words : std::vector<std::string> {
  Words(const char* text) : Words(std::string(text)) {}
  Words(const std::string& text) {
    std::istringstream words(text);
    for (std::string word; words >> word;) push_back(word);
  }
  Words(std::initializer_list<std::string> words) : vector(words) {}
  Words(std::vector<std::string> words) : vector(std::move(words)) {}
  friend Words operator+(Words first, const Words& more) {
    first.insert(first.end(), more.begin(), more.end());
    return first;
  }
};

class AppTest : public testing::Test {
 protected:
  [[nodiscard]] ProgramResult run(const Words& words) const { return run_here(words, scratch_.folder()); }
  // Succeeds, or ends with this status.
  ProgramResult make(const Words& words, int status = 0) const {
    ProgramResult result = run(words);
    EXPECT_EQ(result.status, status) << result.out << result.err;
    return result;
  }
  // Ends with `status`, and says `part`, without a result on standard output.
  void expect_refused(const Words& words, int status, std::string_view part) const {
    const ProgramResult result = run(words);
    EXPECT_EQ(result.status, status) << result.err;
    expect_says(result.err, part);
    EXPECT_EQ(result.out, "");
  }
  // The same of a table of command lines, and what each is told.
  void expect_refused(int status, const std::vector<std::pair<Words, std::string>>& cases) const {
    for (const auto& [words, part] : cases) expect_refused(words, status, part);
  }
  // A command line of a shell, in a group, whose last command has no other input than the pipe's.
  ProgramResult shell(const std::string& command, int status = 0) const {
    ProgramResult result = run_shell("( " + command + " )", scratch_.folder());
    EXPECT_EQ(result.status, status) << command << "\n" << result.out << result.err;
    return result;
  }
  // The command that `reproduce` prints, which makes the picture again, byte for byte.
  std::string expect_made_again(const std::string& picture, const std::string& by = "expose") const {
    const std::string before = file(picture), command = make({"reproduce", picture}).out;
    EXPECT_FALSE(before.empty()) << picture;
    expect_says(command, " " + by + " ");
    std::filesystem::remove(scratch_ / picture);
    scratch_.write("again.sh", command);
    shell("sh again.sh");
    EXPECT_TRUE(file(picture) == before) << command;
    return command;
  }
  // What it answers to --json.
  [[nodiscard]] nlohmann::json answer(const Words& words, int status = 0) const {
    const ProgramResult result = run(words + "--json");
    EXPECT_EQ(result.status, status) << result.err;
    return nlohmann::json::parse(result.out);
  }
  // still0.pgm … still5.pgm, 9 x 7 pixels, each 20 codes brighter than the one before, and their capture scene.tik.
  void make_scene() const {
    for (int k = 0; k < 6; ++k) {
      std::string still = "P5\n9 7\n255\n";
      for (int i = 0; i < 9 * 7; ++i) still += static_cast<char>(40 + 20 * k + i);
      scratch_.write("still" + std::to_string(k) + ".pgm", still);
    }
    make("-f 100 still%d.pgm scene.tik");
  }
  // A folder `frames` of so many PGMs.
  void write_frames(int count, const std::function<cv::Mat(int)>& picture) const {
    std::filesystem::create_directory(scratch_ / "frames");
    for (int k = 0; k < count; ++k) {
      cv::imwrite((scratch_ / "frames" / (std::to_string(100 + k) + ".pgm")).string(), picture(k));
    }
  }
  // A picture that was made, as its file holds it.
  [[nodiscard]] cv::Mat picture(std::string_view name) const {
    return cv::imread((scratch_ / name).string(), cv::IMREAD_UNCHANGED);
  }
  [[nodiscard]] std::string file(const std::string& name) const { return read_file(scratch_ / name); }
  [[nodiscard]] bool exists(const std::string& name) const { return std::filesystem::exists(scratch_ / name); }

  Scratch scratch_;
};

}  // namespace nutik::test
