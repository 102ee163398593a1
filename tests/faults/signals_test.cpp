// A signal is answered within a second, whatever the program does at the moment.
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "support/hostile.hpp"
#include "support/made_up_tik.hpp"
#include "support/program_test.hpp"
#include "support/running_program.hpp"

namespace nutik::test {
namespace {

struct Signals : ProgramTest {
  // Far above what it takes, and far below what the work would.
  void expect_quick_end(const std::vector<std::string>& words) const {
    SCOPED_TRACE(words.front());
    RunningProgram running(words, scratch_.folder());
    ASSERT_TRUE(running.reaches([&] { return running.catches(SIGTERM); }));
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(running.end_with(SIGTERM), 128 + SIGTERM) << read_file(scratch_ / "log");
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    EXPECT_LT(took.count(), 1.5);
    expect_says(read_file(scratch_ / "log"), "terminated");
    EXPECT_TRUE(files_with(scratch_.folder(), ".part").empty());
  }
};

TEST_F(Signals, EndTheMakingOfAMask) {
  expect_quick_end({"mask", "--size", "12000x12000", "--ellipse", "6000,6000,5000,4000", "--smooth", "200",
                    "-o", "m.pgm"});
}

// Inside a library that asks nobody.
TEST_F(Signals, EndTheDecodingOfAPicture) {
  scratch_.write("p.png", black_png(30'000, 30'000, 30'000));
  expect_quick_end({"encode", "-f", "10", "p.png", "c.tik"});
}

TEST_F(Signals, EndTheReadingOfFunctions) {
  write_made_up_tik(scratch_ / "c.tik", MadeUpTile::rows({0, 3, 9}), {tik::CodecId::none, 0});
  std::ofstream functions(scratch_ / "f.fn");
  functions << "M0 {";
  for (int i = 0; i < 10'000'000; ++i) functions << (i == 0 ? "" : ",") << "[" << 100 * i << ":1]\n";
  functions << "}\n";
  functions.close();
  expect_quick_end({"check", "-k", "f.fn", "c.tik"});
}

// Not a signal's matter: it takes no time at all.
TEST_F(Signals, AreNotNeededForALongLine) {
  write_made_up_tik(scratch_ / "c.tik", MadeUpTile::rows({0, 3, 9}), {tik::CodecId::none, 0});
  scratch_.write("list.txt", "--" + std::string(8'000'000, 'x') + "\n");
  const auto start = std::chrono::steady_clock::now();
  const auto result = run({"batch", "--renderer", "reference", "list.txt", "c.tik"});
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LT(took.count(), 3.0);
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("list.txt:1: there is no option --xxxx"), std::string::npos)
      << result.err.substr(0, 300);
  EXPECT_LT(result.err.size(), 300u);
}

}  // namespace
}  // namespace nutik::test
