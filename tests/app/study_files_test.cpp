// What a study writes beside its picture, and what it leaves alone.
#include <gtest/gtest.h>

#include <cstdlib>

#include "capture/format.hpp"
#include "support/moving_square_test.hpp"

namespace nutik::test {
namespace {

class StudyFiles : public MovingSquareTest {
 protected:
  ProgramResult study(const char* output, const char* style = "trail", int status = 0) const {
    return make({"study", "clip.tik", "--style", style, "-o", output}, status);
  }
};

TEST_F(StudyFiles, AreReplacedWhereNobodyChangedThem) {
  for (const char* style : {"trail", "strobe", "clean", "trail"}) study("again.png", style);
}

TEST_F(StudyFiles, AreKeptAsTheyWereChangedByHand) {
  study("mine.png");
  for (const char* name : {"mine.fn", "mine.pgm", "mine.txt"}) {
    const std::string written = file(name);
    std::string changed = written;
    changed[changed.size() / 2] ^= 1;
    scratch_.write(name, changed);
    expect_says(study("mine.png", "strobe", 2).err,
                std::string(name) + " was changed since its study was made; it is not replaced");
    EXPECT_EQ(file(name), changed);
    scratch_.write(name, written);
  }
  const std::string commands = file("mine.txt");
  scratch_.write("mine.txt", commands + "# mine\n");
  expect_says(study("mine.png", "strobe", 2).err, "mine.txt was changed");
  scratch_.write("mine.txt", commands);
  study("mine.png", "strobe");
}

TEST_F(StudyFiles, ReplaceNoneThatIsOfNoStudy) {
  scratch_.write("other.pgm", "P5\n1 1\n255\nx");
  scratch_.write("notes.txt", "call home");
  scratch_.write("light.fn", "[0:1], [1000:1]\n");
  for (const auto& [picture, name] :
       {std::pair("other.png", "other.pgm"), std::pair("notes.png", "notes.txt"),
        std::pair("light.png", "light.fn")}) {
    const std::string before = file(name);
    expect_says(study(picture, "trail", 2).err, std::string(name) + " exists and is of no study; it is not replaced");
    EXPECT_EQ(file(name), before);
    EXPECT_FALSE(exists(picture));
  }
}

// Another picture's recipe and commands name them.
TEST_F(StudyFiles, ReplaceNoneOfAnotherPicture) {
  study("one.png");
  expect_says(study("one.jpg", "trail", 2).err,
              "one.pgm, one.fn and one.txt are those of one.png; they are not replaced");
  std::filesystem::remove(scratch_ / "one.png");
  study("one.jpg");
}

// A camera's files differ in nothing but their extensions, and outputs that nobody names are called alike.
TEST_F(StudyFiles, ReplaceNoneOfAnotherClip) {
  std::filesystem::copy_file(scratch_ / "clip.tik", scratch_ / "clip.mov.tik");
  make("study clip.tik", 0);
  std::filesystem::rename(scratch_ / "clip-study.png", scratch_ / "clip.mov-study.png");
  const std::string before = file("clip.mov-study.png");
  expect_refused("study clip.mov.tik", 2, "clip.mov-study.png is there already, made of clip.tik, and is not replaced");
  EXPECT_EQ(file("clip.mov-study.png"), before);
  make("--start 3f --exposure 1f clip.mov.tik -o clip.mov-study.png");
  EXPECT_NE(file("clip.mov-study.png"), before);
}

// Wherever a study is ended, the next one goes through; what was changed by hand since is still refused.
TEST_F(StudyFiles, AreReplacedByTheNextStudyWhereverOneEnds) {
  const std::string library =
      (std::filesystem::path(NUTIK_TEST_PROGRAM).parent_path() / "tests" / "libfail_calls.so").string();
  const auto faulty = [&](const char* call, int at, const char* error, const char* style) {
    return run_shell(format("LD_PRELOAD='{}' NUTIK_FAIL_FOLDER='{}' NUTIK_FAIL_CALL={} NUTIK_FAIL_AT={} "
                            "NUTIK_FAIL_ERROR={} NUTIK_FAIL_AFTER=on '{}' study clip.tik --style {} -o s.png",
                            library, scratch_.folder().string(), call, at, error, NUTIK_TEST_PROGRAM, style),
                     scratch_.folder())
        .status;
  };
  const std::vector<std::string> names{"s.fn", "s.pgm", "s.txt", "s.png"};
  study("right.png", "strobe");
  for (const bool is_first : {true, false}) {
    for (const auto& [call, error] : {std::pair("rename", "kill"), std::pair("rename", "28"),
                                      std::pair("fsync", "kill"), std::pair("write", "28")}) {
      int ended = 0;
      for (int at = 1;; ++at) {
        for (const std::string& name : names) std::filesystem::remove(scratch_ / name);
        if (!is_first) study("s.png", "trail");
        if (faulty(call, at, error, "strobe") == 0) break;
        ++ended;
        if (exists("s.pgm")) {
          const std::string written = file("s.pgm");
          scratch_.write("s.pgm", written + "mine");
          study("s.png", "strobe", 2);
          scratch_.write("s.pgm", written);
        }
        SCOPED_TRACE(format("{} {} {}", call, at, error));
        study("s.png", "strobe");
        EXPECT_TRUE(file("s.fn") == file("right.fn") && file("s.pgm") == file("right.pgm"));
        EXPECT_EQ(file("s.txt").find("not finished"), std::string::npos);
      }
      EXPECT_GE(ended, 4) << call << " " << error;
    }
  }
}

TEST_F(StudyFiles, HaveCommandsThatRunWhateverTheClipIsCalled) {
  std::filesystem::copy_file(scratch_ / "clip.tik", scratch_ / "-clip.tik");
  make("study -- -clip.tik");
  const std::string picture = file("-clip-study.png");
  std::filesystem::remove(scratch_ / "-clip-study.png");
  const std::string folder = std::filesystem::path(NUTIK_TEST_PROGRAM).parent_path().string();
  const std::string command = "cd '" + scratch_.folder().string() + "' && PATH='" + folder +
                              "':$PATH sh -e ./-clip-study.txt > log 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0) << file("log");
  EXPECT_TRUE(file("-clip-study.png") == picture);
  std::string changed = file("-clip-study.pgm");
  changed.back() = static_cast<char>(changed.back() ^ 1);
  scratch_.write("-clip-study.pgm", changed);
  ASSERT_EQ(std::system(command.c_str()), 0) << file("log");
  EXPECT_TRUE(file("-clip-study.pgm") == changed);
}

TEST_F(StudyFiles, AreNoneBesideStandardOutput) {
  for (const char* style : {"trail", "clean"}) {
    const auto result = study("-", style);
    EXPECT_TRUE(result.out.starts_with("\x89PNG")) << style;
    for (const char* name : {"-.pgm", "-.fn", "-.txt"}) EXPECT_FALSE(exists(name)) << name;
  }
}

}  // namespace
}  // namespace nutik::test
