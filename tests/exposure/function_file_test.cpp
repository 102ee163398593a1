#include "exposure/function_file.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace nutik {
namespace {

std::vector<ControlPoint> points_of(const FunctionFile& file, std::uint8_t tag) {
  const auto points = file.functions.at(tag).function.points();
  return {points.begin(), points.end()};
}

TEST(FunctionFile, ReadsBothForms) {
  const FunctionFile file = parse_functions(
      "a comment\n"
      "M0 [0:1], [10000000:1], [10000001:0]\n"
      "  M128{[0:0], [399999999:0],\r\n"
      "     [400000000:-1.5e0]}\n");
  EXPECT_EQ(file.report("t"), "");
  EXPECT_EQ(points_of(file, 0), (std::vector<ControlPoint>{{0, 1}, {10000000, 1}, {10000001, 0}}));
  EXPECT_EQ(points_of(file, 128), (std::vector<ControlPoint>{{0, 0}, {399999999, 0}, {400000000, -1.5}}));
}

// The messages of all kinds of mistakes are in tests/corpus/functions; see
// function_corpus_test.cpp.
TEST(FunctionFile, ShowsTheLineAndThePlace) {
  EXPECT_EQ(parse_functions("M0 [0:1], [5:oops]").report("f.fn"),
            "f.fn:1:14: 'oops' is no gain; write a number such as 1, -0.5 or 2e-3\n"
            "    M0 [0:1], [5:oops]\n"
            "                 ^");
}

TEST(FunctionFile, PutsTheMarkUnderThePlaceBehindTabsAndOtherCharacters) {
  EXPECT_EQ(parse_functions("M0{ # \xC2\xB5\n\t[0:1],\xC2\xA0[5:0]}").report("f.fn"),
            "f.fn:2:8: '\\u00a0' where a control point [time:gain] should start; a comment starts "
            "with #\n"
            "    \t[0:1],\\u00a0[5:0]}\n"
            "    \t      ^");
  EXPECT_EQ(parse_functions("M0{[0:1]} # \xC2\xB5\x1B\xE9\nM0 [0:1]\x1B\xC2\xB5\xE9\n").report("f.fn"),
            "f.fn:2:1: M0 has a function already, on line 1; each mask value has one\n"
            "    M0 [0:1]\\x1b\xC2\xB5\\xe9\n"
            "    ^\n"
            "f.fn:2:9: '\\x1b\xC2\xB5\\xe9' after a control point; a comma or the line's end should "
            "follow, "
            "and a comment starts with #\n"
            "    M0 [0:1]\\x1b\xC2\xB5\\xe9\n"
            "            ^");
}

// A function on one line whose point number `mistake` has a word for a gain.
std::string long_line(int points, int mistake) {
  std::string text = "M0 ";
  for (int i = 0; i < points; ++i) {
    text += (i ? ",[" : "[") + std::to_string(1000 + i) + (i == mistake ? ":oops]" : ":0.25]");
  }
  return text;
}

TEST(FunctionFile, ShowsAPartOfALongLine) {
  EXPECT_EQ(parse_functions(long_line(1000, 500)).report("f.fn"),
            "f.fn:1:6010: 'oops' is no gain; write a number such as 1, -0.5 or 2e-3\n"
            "    … 6:0.25],[1497:0.25],[1498:0.25],[1499:0.25],[1500:"
            "oops],[1501:0.25],[1502:0.25],[1503:0.25],[1504:0. …\n"
            "                                                        ^");
  EXPECT_EQ(parse_functions(long_line(1000, 0)).report("f.fn"),
            "f.fn:1:10: 'oops' is no gain; write a number such as 1, -0.5 or 2e-3\n"
            "    M0 [1000:oops],[1001:0.25],[1002:0.25],[1003:0.25],"
            "[1004:0.25],[1005:0.25],[1006:0.25],[1007:0.25],[ …\n"
            "             ^");
}

TEST(FunctionFile, CutsALongLineBetweenCharacters) {
  for (int blanks = 0; blanks < 4; ++blanks) {
    std::string text = "M0 {[0:1] # " + std::string(static_cast<std::size_t>(blanks), ' ');
    for (int i = 0; i < 200; ++i) text += "\xE2\x82\xAC";  // €
    const std::string report = parse_functions(text).report("f.fn");
    EXPECT_EQ(report.find("\\x"), std::string::npos) << report;
    EXPECT_NE(report.find("\xE2\x82\xAC …\n       ^"), std::string::npos) << report;
  }
}

TEST(FunctionFile, FindsEveryMistakeAndKeepsTheRest) {
  const FunctionFile file = parse_functions(
      "M0 [0:1], [10:1], [5:0], [4:1]\n"
      "M1 [0:1] [2:1]\n"
      "M2{[0:1]\n"
      "M3 [0:1]\n"
      "M4 [7:2]\n");
  std::vector<std::size_t> lines;
  for (const Diagnostic& diagnostic : file.diagnostics.shown()) lines.push_back(diagnostic.place.line);
  EXPECT_EQ(lines, (std::vector<std::size_t>{1, 1, 2, 3}));
  EXPECT_EQ(file.functions.size(), 2u);  // M3 and M4
}

TEST(FunctionFile, ReportsMistakesAndWarningsInTheOrderOfTheText) {
  const FunctionFile file = parse_functions("Mask 128 is the ball\nM0{[0:1], [0:2]\nm1 [0:1]\n");
  EXPECT_TRUE(file.has_errors());
  EXPECT_EQ(file.report("f.fn"),
            "f.fn:1:1: warning: taken as a comment: M is not followed by a mask value, as in M128\n"
            "    Mask 128 is the ball\n"
            "    ^\n"
            "f.fn:2:12: time 0 stands twice; a jump takes 1 ns: write 1 for the second\n"
            "    M0{[0:1], [0:2]\n"
            "               ^\n"
            "f.fn:3:1: 'm1' after a control point; a comma or '}' should follow, and a comment "
            "starts with #\n"
            "    m1 [0:1]\n"
            "    ^");
}

TEST(FunctionFile, ShowsTheFirstMistakesAndCountsTheOthers) {
  // The open brace is found last, but stands first.
  std::string text = "M0{[0:1]";
  for (int i = 0; i < 30; ++i) text += ",\n[0:1]";
  for (int i = 0; i < 21; ++i) text += "\nM1 [0:1]";
  for (int i = 0; i < 21; ++i) text += "\nM";
  const FunctionFile file = parse_functions(text);
  EXPECT_EQ(file.diagnostics.count(Diagnostic::Severity::error), 51u);
  EXPECT_EQ(file.diagnostics.count(Diagnostic::Severity::warning), 21u);
  ASSERT_EQ(file.diagnostics.shown().size(), 40u);
  EXPECT_EQ(file.diagnostics.shown().front().message,
            "a brace that is not closed before the function on line 32; '}' ends the function");
  EXPECT_EQ(file.diagnostics.shown()[19].place, (TextPlace{20, 2}));
  EXPECT_TRUE(file.report("f.fn").ends_with("\nf.fn: and 31 more mistakes\nf.fn: and 1 more warning"));
}

// A report of any file is a few kilobytes of printable text, also where the file is made to break
// it.
TEST(FunctionFile, KeepsMillionsOfMistakesShort) {
  const std::string inputs[] = {
      long_line(1, 0) + std::string(1'000'000, ','),
      std::string(1'000'000, '['),
      "M0" + std::string(1'000'000, '{'),
      "M0 [0:" + std::string(1'000'000, 'x') + "]",
      "M0 [" + std::string(1'000'000, '9') + ":1]",
      "M" + std::string(1'000'000, '9'),
      "M0 [0:1]" + std::string(1'000'000, '\x80'),
      std::string(1'000'000, '\0'),
      std::string(1'000'000, '\xFF') + "\nM",
  };
  for (const std::string& input : inputs) {
    const std::string report = parse_functions(input).report("f.fn");
    EXPECT_GT(report.size(), 0u);
    EXPECT_LT(report.size(), 2000u) << report.substr(0, 300);
    for (const char c : report) ASSERT_TRUE(c == '\n' || (c >= ' ' && c != '\x7F') || (c & 0x80)) << int{c};
  }
  std::string disorder = "M0 ", functions;
  for (int i = 200'000; i > 0; --i) disorder += "[" + std::to_string(i) + ":1],";
  for (int i = 0; i < 200'000; ++i) functions += "M0 x\n";
  EXPECT_EQ(parse_functions(disorder).diagnostics.count(Diagnostic::Severity::error), 200'000u);
  EXPECT_LT(parse_functions(disorder).report("f.fn").size(), 10'000u);
  EXPECT_EQ(parse_functions(functions).diagnostics.count(Diagnostic::Severity::error), 399'999u);
}

TEST(FunctionFile, ReadsAMillionPoints) {
  std::string text = "M7{";
  for (int i = 0; i < 1'000'000; ++i) text += (i ? ",\n[" : "[") + std::to_string(i * 3) + ":0.5]";
  const FunctionFile file = parse_functions(text + "}");
  EXPECT_FALSE(file.has_errors());
  EXPECT_EQ(file.functions.at(7).function.points().size(), 1'000'000u);
}

}  // namespace
}  // namespace nutik
