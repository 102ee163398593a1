#include "exposure/function_file.hpp"

#include <gtest/gtest.h>

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
  EXPECT_TRUE(file.diagnostics.empty()) << file.report(Diagnostic::Severity::error, "t");
  EXPECT_EQ(points_of(file, 0), (std::vector<ControlPoint>{{0, 1}, {10000000, 1}, {10000001, 0}}));
  EXPECT_EQ(points_of(file, 128), (std::vector<ControlPoint>{{0, 0}, {399999999, 0}, {400000000, -1.5}}));
}

struct Mistake {
  const char* text;
  const char* report;
};

// Every message says where, what is wrong and what would be right.
TEST(FunctionFile, ExplainsMistakes) {
  const Mistake mistakes[] = {
      {"M0 [0:1], [2000000:1], [1000000:0]",
       "f.fn:1:25: time 1000000 is not after 2000000; control points must be in time order"},
      {"M0 [0:1], [5:1], [5:0]", "f.fn:1:19: time 5 stands twice; a jump takes 1 ns: write 6 for the second"},
      {"M300 [0:1]", "f.fn:1:2: mask value 300 is above 255, the largest an 8-bit mask has"},
      {"M1 [0:1]\nM1 [0:2]", "f.fn:2:1: M1 stands a second time; the first is on line 1"},
      {"M0 [0:nan]", "f.fn:1:7: gain nan is not finite; gains are numbers up to 1.79e308"},
      {"M0 [0:1e999]", "f.fn:1:7: gain 1e999 is not finite"},
      {"M0 {}", "f.fn:1:5: a function without control points; write at least one, as in [0:1]"},
      {"M0 {[0:1],", "f.fn:1:4: a brace that is never closed; '}' ends the function"},
      {"M0 [0:1", "f.fn:1:4: a bracket that is not closed on its line; ']' ends a control point"},
      {"M0 [1.5:1]", "f.fn:1:5: time 1.5 is not a whole number of nanoseconds; 10 ms are 10000000"},
      {"M0 [10ms:1]", "f.fn:1:5: '10ms' is no time; write whole nanoseconds without a unit"},
      {"M0 [0:1] [1:1]", "f.fn:1:10: a comma is missing between two control points"},
      {"M0 [0:1],", "f.fn:1:9: a comma at the end of a line; to go on over several lines write M0{"},
      {"[0:1]", "f.fn:1:1: a line of control points outside braces"},
      {"M0x [0:1]", "f.fn:1:2: 'M0x' is no mask value"},
      {"M0 [0:1] end", "f.fn:1:10: 'e' after a control point; a comma or the end should follow"},
      {"M0 {[0:1]} end", "f.fn:1:12: 'e' after the end of a function; the next one starts on a line of its own"},
      {"nothing here", "f.fn:1:1: no function in this file"},
  };
  for (const Mistake& mistake : mistakes) {
    const FunctionFile file = parse_functions(mistake.text);
    EXPECT_TRUE(file.has_errors()) << mistake.text;
    EXPECT_EQ(file.report(Diagnostic::Severity::error, "f.fn").rfind(mistake.report, 0), 0u)
        << "expected: " << mistake.report << "\ngot: " << file.report(Diagnostic::Severity::error, "f.fn");
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
  for (const Diagnostic& diagnostic : file.diagnostics) lines.push_back(diagnostic.place.line);
  EXPECT_EQ(lines, (std::vector<std::size_t>{1, 1, 2, 3}));
  EXPECT_EQ(file.functions.size(), 2u);  // M3 and M4
}

TEST(FunctionFile, WarnsOfWhatLooksLikeAFunction) {
  const FunctionFile file = parse_functions("Mask 128 is the ball\nM0 [0:1]\nm1 [0:1]\n");
  EXPECT_FALSE(file.has_errors());
  ASSERT_EQ(file.diagnostics.size(), 2u);
  EXPECT_EQ(file.diagnostics[0].text("f.fn").rfind("f.fn:1:1: warning: taken as a comment", 0), 0u);
  EXPECT_EQ(file.diagnostics[1].place, (TextPlace{3, 1}));
}

TEST(FunctionFile, ShowsTheLineAndThePlace) {
  const FunctionFile file = parse_functions("M0 [0:1], [5:oops]");
  EXPECT_EQ(file.diagnostics.front().text("f.fn"),
            "f.fn:1:14: 'oops' is no gain; write a number such as 1, -0.5 or 2e-3\n"
            "    M0 [0:1], [5:oops]\n"
            "                 ^");
}

TEST(FunctionFile, ReadsAHundredThousandPoints) {
  std::string text = "M7{";
  for (int i = 0; i < 100'000; ++i) text += (i ? ",\n[" : "[") + std::to_string(i * 3) + ":0.5]";
  const FunctionFile file = parse_functions(text + "}");
  EXPECT_FALSE(file.has_errors());
  EXPECT_EQ(file.functions.at(7).function.points().size(), 100'000u);
}

}  // namespace
}  // namespace nutik
