#include "features/check/input_check.hpp"

#include <gtest/gtest.h>

namespace nutik {
namespace {

constexpr std::string_view kFunctions = "M0 [0:1], [10000000:0]\nM9 [0:1], [20000000:0]\n";

std::vector<std::string> kinds(const InputCheck& check) {
  std::vector<std::string> kinds;
  for (const Finding& finding : check.findings) kinds.push_back(finding.kind);
  return kinds;
}

TEST(InputCheck, ComparesFunctionsAndMask) {
  InputCheck check;
  check.add_functions("f.fn", kFunctions);
  check.add_mask("m.pgm", {4, 1, {0, 0, 128, 128}});
  check.finish(false);
  EXPECT_EQ(kinds(check), (std::vector<std::string>{"unused_function", "unmapped_mask_values"}));
  EXPECT_EQ(std::get<std::uint8_t>(check.findings[0].details), 9);
  ASSERT_EQ(check.figures.size(), 2u);
  EXPECT_EQ(check.figures[0].pixels, 2u);
  EXPECT_FALSE(check.figures[0].samples) << "there is no capture";
  EXPECT_EQ(check.domain.duration_ns, 20'000'000) << "to the last control point";
}

TEST(InputCheck, TakesUnmappedValuesForBlackWhereAskedTo) {
  InputCheck check;
  check.add_functions("f.fn", "M0 [0:1], [10000000:0]");
  check.add_mask("m.pgm", {2, 1, {0, 128}});
  check.finish(true);
  EXPECT_TRUE(check.findings.empty());
}

TEST(InputCheck, CountsTheSamplesOfACapture) {
  InputCheck check;
  check.add_functions("f.fn", "M0 [0:1], [20000000:0]");
  check.capture = {"c.tik", {.shape = {4, 3, 1}}, Timeline::constant({100, 1}, {360, 1}, 10)};
  check.add_mask("m.pgm", {2, 1, {0, 0}});
  check.finish(false);
  EXPECT_EQ(kinds(check), (std::vector<std::string>{"mask_size"}));
  EXPECT_EQ(check.figures[0].samples, 2u);
  EXPECT_TRUE(check.domain.is_capture);
}

}  // namespace
}  // namespace nutik
