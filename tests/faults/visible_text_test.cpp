// Names and texts of strangers are printed; a terminal is sent nothing of them that it obeys.
#include <gtest/gtest.h>

#include "support/made_up_tik.hpp"
#include "support/program_test.hpp"

namespace nutik::test {
namespace {

// Moves the cursor up and clears the line: what was printed before is gone. Then a C1 control, and an override of the
// direction that text is written in.
constexpr const char* kEvil = "\x1b[1A\x1b[2K\xc2\x9b\xe2\x80\xae\x7f\x07";

struct VisibleText : ProgramTest {
  static void expect_visible(const ProgramResult& result, const std::string& what) {
    const std::string text = result.out + result.err;
    for (const char* part : {"\x1b", "\xc2\x9b", "\xe2\x80\xae", "\x07", "\r"}) {
      EXPECT_EQ(text.find(part), std::string::npos) << what << " prints a control character";
    }
  }
  const std::string name_ = std::string("c") + kEvil + ".tik";
};

TEST_F(VisibleText, IsAllThatIsPrintedOfNames) {
  write_made_up_tik(scratch_ / name_, MadeUpTile::rows({0, 3, 9}), {tik::CodecId::none, 0});
  const std::vector<std::vector<std::string>> commands{
      {"info", name_},
      {"info", "--json", name_},
      {"check", "--json", name_},
      {"expose", "--renderer", "reference", "--start", "0s", "--exposure", "1s", name_,
       std::string("p") + kEvil + ".png"},
      {"reproduce", std::string("p") + kEvil + ".png"},
      {"activity", name_, "a.png"},
      {"trace", "--pixel", "1,1", "--start", "0s", "--exposure", "1s", name_},
      {"contact", "--renderer", "reference", name_, "s.png"},
      {"encode", std::string("absent") + kEvil + ".mp4", "d.tik"},
      {"expose", "-k", std::string("absent") + kEvil, name_, "p.png"},
      {std::string("unknown") + kEvil},
      {"expose", std::string("--unknown") + kEvil},
  };
  for (const auto& words : commands) expect_visible(run(words), words.front());
}

// Behind a line break a name could pass for a line of the program's own.
TEST_F(VisibleText, NamesOfSeveralLinesAreRefused) {
  const std::string name = "c.tik: cannot be read\nwarning: run this";
  write_made_up_tik(scratch_ / name, MadeUpTile::rows({0, 3, 9}), {tik::CodecId::none, 0});
  for (const std::vector<std::string>& words : {std::vector<std::string>{"info", name},
                                                {name, "o.tik"},
                                                {"info", "--json", name},
                                                {"check", "-k", name, "c.tik"}}) {
    const auto result = run(words);
    EXPECT_EQ(result.status, 2) << words.front();
    EXPECT_EQ((result.out + result.err).find("\nwarning"), std::string::npos) << result.out << result.err;
    expect_says(result.err, "holds a line break");
  }
}

TEST_F(VisibleText, OfAFunctionFileIsAllThatIsPrinted) {
  write_made_up_tik(scratch_ / "c.tik", MadeUpTile::rows({0, 3, 9}), {tik::CodecId::none, 0});
  scratch_.write("f.fn", std::string("M0 { [0:1] ") + kEvil + " }\n");
  const auto result = run({"check", "-k", "f.fn", "c.tik"});
  EXPECT_EQ(result.status, 3);
  expect_visible(result, "check");
  EXPECT_NE((result.out + result.err).find("\\x1b"), std::string::npos) << result.out << result.err;
}

// The command that `again` prints says what it does, and every shell takes it as it is meant.
TEST_F(VisibleText, OfACommandIsWhatTheCommandDoes) {
  write_made_up_tik(scratch_ / name_, MadeUpTile::rows({0, 3, 9}), {tik::CodecId::none, 0});
  ASSERT_EQ(
      run({"expose", "--renderer", "reference", "--start", "0s", "--exposure", "1s", name_, "p.png"}).status,
      0);
  const auto again = run({"reproduce", "p.png"});
  ASSERT_EQ(again.status, 0) << again.err;
  expect_says(again.out, "\"$(printf 'c\\033[1A\\033[2K\\302\\233\\342\\200\\256\\177\\007.tik')\"");
  const std::string before = read_file(scratch_ / "p.png");
  scratch_.write("again.sh", again.out);
  for (const std::string shell : {"sh", "dash", "bash", "zsh"}) {
    if (run_shell("command -v " + shell, scratch_.folder()).status != 0) continue;
    std::filesystem::remove(scratch_ / "p.png");
    const auto result = run_shell(shell + " again.sh", scratch_.folder());
    EXPECT_EQ(result.status, 0) << shell << result.err;
    EXPECT_TRUE(read_file(scratch_ / "p.png") == before) << shell;
  }
}

}  // namespace
}  // namespace nutik::test
