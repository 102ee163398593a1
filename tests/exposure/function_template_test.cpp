// Function files with names in place of numbers.
#include "exposure/function_template.hpp"

#include <gtest/gtest.h>

#include "exposure/function_file.hpp"

namespace nutik {
namespace {

constexpr const char* kText =
    "# two unknown gains and a time\n"
    "M0{[0:0], [1:dim], [1000000000:dim],\n"
    "   [1000000001:rest], [1010000000:rest], [1010000001:0]}\n"
    "M7 [when-1:0], [when:2.5], [when+10000000:2.5], [when+10000001:0]   # a box that moves\n";

TEST(FunctionTemplate, KeepsNamesWithTheirPlaces) {
  const FunctionTemplate read = parse_template(kText);
  ASSERT_FALSE(read.has_errors()) << read.diagnostics.report("f.fn");
  EXPECT_EQ(read.gains, (std::vector<std::string>{"dim", "rest"}));
  EXPECT_EQ(read.times, std::vector<std::string>{"when"});
  ASSERT_EQ(read.functions.size(), 2u);
  const auto& first = read.functions.at(0);
  ASSERT_EQ(first.size(), 6u);
  EXPECT_EQ(first[1].gain_name, 0u);
  EXPECT_EQ(first[3].gain_name, 1u);
  EXPECT_FALSE(first[0].gain_name || first[5].gain_name || first[3].time_name);
  const auto& second = read.functions.at(7);
  EXPECT_EQ(second[0].time_name, 0u);
  EXPECT_EQ(second[0].time_ns, -1);
  EXPECT_EQ(second[2].time_ns, 10'000'000);
  EXPECT_EQ(second[2].gain, 2.5);
}

TEST(FunctionTemplate, IsAFunctionFileWithNumbersInPlaceOfNames) {
  const FunctionTemplate read = parse_template(kText);
  const std::string text = read.text_with({{0.1, -25.5}, {400'000'000}});
  EXPECT_EQ(text,
            "# two unknown gains and a time\n"
            "M0{[0:0], [1:0.1], [1000000000:0.1],\n"
            "   [1000000001:-25.5], [1010000000:-25.5], [1010000001:0]}\n"
            "M7 [399999999:0], [400000000:2.5], [410000000:2.5], [410000001:0]   # a box that moves\n");
  EXPECT_FALSE(parse_functions(text).has_errors());
  EXPECT_TRUE(parse_functions(kText).has_errors()) << "elsewhere a name is a mistake";
}

TEST(FunctionTemplate, WritesGainsThatAreReadBackIdentically) {
  const double third = 1.0 / 3;
  const FunctionFile file = parse_functions(parse_template("M0 [0:a], [5:-1]").text_with({{third}, {}}));
  EXPECT_EQ(file.functions.at(0).function.points()[0].gain, third);
}

TEST(FunctionTemplate, TellsWhereTimesAreOutOfOrder) {
  const FunctionTemplate read = parse_template("M0 [0:0], [when:1], [100:1], [101:0]");
  ASSERT_FALSE(read.has_errors());
  const auto& points = read.functions.at(0);
  EXPECT_TRUE(FunctionTemplate::points(points, {50}));
  EXPECT_FALSE(FunctionTemplate::points(points, {100}));
  EXPECT_FALSE(FunctionTemplate::points(points, {0}));
  EXPECT_FALSE(FunctionTemplate::points(points, {kLargestTimeNs + 1}));
}

struct Mistake {
  const char* text;
  const char* message;
};

TEST(FunctionTemplate, SaysWhatIsWrongWithANameAndWhere) {
  for (const Mistake& mistake : {
           Mistake{"M0 [0:a.b], [5:0]", "f.fn:1:7: 'a.b' is neither a number nor a name"},
           Mistake{"M0 [0:a+1], [5:0]", "f.fn:1:7: 'a+1' is neither a number nor a name"},
           Mistake{"M0 [0:nan], [5:0]", "f.fn:1:7: 'nan' is neither a number nor a name"},
           Mistake{"M0 [t+1m:0]", "f.fn:1:5: "},
           Mistake{"M0 [a:0], [a+5:a]", "f.fn:1:16: 'a' stands for a gain and for a time"},
           Mistake{"M0 [t+5:0], [t+5:1]", "f.fn:1:14: "},
           Mistake{"M0 [0:1 a]", "f.fn:1:9: "},
       }) {
    const FunctionTemplate read = parse_template(mistake.text);
    EXPECT_NE(read.diagnostics.report("f.fn").find(mistake.message), std::string::npos)
        << mistake.text << ": " << read.diagnostics.report("f.fn");
  }
}

}  // namespace
}  // namespace nutik
