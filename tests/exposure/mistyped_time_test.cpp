// Lost digits: every one whose loss turns a step of the paper's functions into a ramp is named, with what
// stood there, and nothing else is.
#include "exposure/function_check.hpp"

#include <gtest/gtest.h>

#include <cctype>
#include <map>
#include <optional>
#include <string>

#include "exposure/function_file.hpp"
#include "support/random_case.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

struct Place {
  std::size_t at;      // of the time in the text
  std::size_t length;  // in characters
};

// The times of a function file, found without its parser.
std::vector<Place> times_in(const std::string& text) {
  std::vector<Place> places;
  std::size_t line_start = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] == '\n') line_start = at + 1;
    if (text[at] != '[' || text[line_start] == '#') continue;
    places.push_back({at + 1, text.find(':', at) - at - 1});
  }
  return places;
}

struct Point {
  std::size_t at;
  long long time;
  double gain;
};

// Functions as lists of points; nothing where a time is missing or not after the one before.
std::optional<std::map<int, std::vector<Point>>> read(const std::string& text) {
  std::map<int, std::vector<Point>> functions;
  int tag = -1;
  std::size_t line_start = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] == '\n') line_start = at + 1;
    if (text[line_start] == '#') continue;
    if (text[at] == 'M') tag = std::stoi(text.substr(at + 1));
    if (text[at] != '[') continue;
    if (text[at + 1] == ':') return std::nullopt;
    const Point point{at + 1, std::stoll(text.substr(at + 1)),
                      std::stod(text.substr(text.find(':', at) + 1))};
    auto& points = functions[tag];
    if (!points.empty() && point.time <= points.back().time) return std::nullopt;
    points.push_back(point);
  }
  return functions;
}

bool is_step(const Point& a, const Point& b) { return a.gain != b.gain && b.time - a.time <= 1000; }

std::string figure(const std::string& name) {
  return read_file(std::filesystem::path(NUTIK_TEST_CORPUS) / (name + ".fn"));
}

constexpr const char* kFigures[] = {"figure04", "figure07", "figure14-restored", "figure16"};

TEST(MistypedTime, TheFiguresAreSilent) {
  for (const char* name : kFigures) {
    for (const auto& [tag, function] : parse_functions(figure(name)).functions) {
      EXPECT_TRUE(mistyped_times(function.function).empty()) << name << " M" << int{tag};
    }
  }
}

TEST(MistypedTime, TheLostZeroOfFigure14IsNamed) {
  for (const auto& [tag, function] : parse_functions(figure("figure14")).functions) {
    const auto found = mistyped_times(function.function);
    ASSERT_EQ(found.size(), tag == 0 ? 1u : 0u);
    if (tag != 0) continue;
    EXPECT_EQ(found[0].point, 2u);
    EXPECT_EQ(found[0].likely_ns, 1'000'000'000);
    EXPECT_EQ(found[0].step_ns, 2);
    EXPECT_TRUE(found[0].is_digit_lost);
  }
}

TEST(MistypedTime, EveryLostDigitOfTheFiguresIsNamed) {
  int steps_lost = 0, others = 0, refused = 0;
  for (const std::string name : kFigures) {
    const std::string whole = figure(name);
    const auto original = read(whole);
    ASSERT_TRUE(original);
    for (const Place& place : times_in(whole)) {
      for (std::size_t digit = 0; digit < place.length; ++digit) {
        ASSERT_TRUE(std::isdigit(static_cast<unsigned char>(whole[place.at + digit])));
        std::string text = whole;
        text.erase(place.at + digit, 1);
        SCOPED_TRACE(name + ": " + whole.substr(place.at, place.length) + " without its digit " +
                     std::to_string(digit + 1));
        const auto changed = read(text);
        const FunctionFile file = parse_functions(text);
        ASSERT_EQ(file.has_errors(), !changed.has_value());
        if (!changed) {
          ++refused;
          continue;
        }
        for (const auto& [tag, points] : *changed) {
          const std::vector<Point>& before = original->at(tag);
          const auto found = mistyped_times(file.functions.at(static_cast<std::uint8_t>(tag)).function);
          // The step that is one no more, and the time in it that changed.
          std::optional<std::size_t> lost;
          for (std::size_t i = 0; i + 1 < points.size(); ++i) {
            if (is_step(before[i], before[i + 1]) && !is_step(points[i], points[i + 1])) lost = i;
          }
          if (!lost) {
            EXPECT_TRUE(found.empty()) << "M" << tag;
            ++others;
            continue;
          }
          ++steps_lost;
          ASSERT_EQ(found.size(), 1u) << "M" << tag;
          const std::size_t point = points[*lost].time != before[*lost].time ? *lost : *lost + 1;
          EXPECT_EQ(found[0].point, point);
          EXPECT_EQ(found[0].likely_ns, before[point].time);
          EXPECT_EQ(found[0].step_ns, before[*lost + 1].time - before[*lost].time);
        }
      }
    }
  }
  std::printf("%d lost steps named, %d functions silent, %d files refused\n", steps_lost, others, refused);
  EXPECT_GT(steps_lost, 0);
  EXPECT_GT(others, 0);
  EXPECT_GT(refused, 0);
}

TEST(MistypedTime, AnyLostDigitOfAStepIsNamed) {
  Random random(11);
  int named = 0;
  for (int i = 0; i < 20'000; ++i) {
    const std::int64_t begin = random.whole(-1'000'000'000, 1'000'000'000);
    const std::int64_t end = begin + random.whole(1, 1000);
    const std::int64_t before = begin - random.whole(1, 2'000'000'000);
    const bool at_begin = random.chance(0.5);
    std::string digits = std::to_string(std::abs(at_begin ? begin : end));
    if (digits.size() == 1) continue;
    digits.erase(static_cast<std::size_t>(random.whole(0, static_cast<std::int64_t>(digits.size()) - 1)), 1);
    if (digits.front() == '0') continue;
    const std::int64_t changed = ((at_begin ? begin : end) < 0 ? -1 : 1) * std::stoll(digits);
    const std::int64_t new_begin = at_begin ? changed : begin;
    const std::int64_t new_end = at_begin ? end : changed;
    if (new_begin <= before || new_end - new_begin <= 1000) continue;
    const GainFunction function({{before, 1}, {new_begin, 1}, {new_end, -25}});
    const auto found = mistyped_times(function);
    ASSERT_EQ(found.size(), 1u) << before << " " << new_begin << " " << new_end;
    EXPECT_LE(found[0].step_ns, 1000);
    ++named;
  }
  EXPECT_GT(named, 1000);
}

TEST(MistypedTime, RampsBetweenWholeMillisecondsAreSilent) {
  Random random(12);
  for (int i = 0; i < 20'000; ++i) {
    const std::int64_t begin = random.whole(0, random.chance(0.5) ? 20 : 20'000);
    const std::int64_t end = begin + random.whole(1, random.chance(0.5) ? 20 : 20'000);
    const GainFunction function({{begin * 1'000'000, 0}, {end * 1'000'000, 1}});
    EXPECT_TRUE(mistyped_times(function).empty()) << begin << " ms to " << end << " ms";
  }
}

TEST(MistypedTime, ADigitTooManyIsNamedToo) {
  // 10000000 with a 7 in it. (In most cases a digit too many could as well have been lost before it.)
  const auto found = mistyped_times(GainFunction({{0, 1}, {9'999'999, 1}, {107'000'000, 0}}));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].point, 2u);
  EXPECT_EQ(found[0].likely_ns, 10'000'000);
  EXPECT_FALSE(found[0].is_digit_lost);
}

TEST(MistypedTime, LooksOnlyAtRamps) {
  EXPECT_TRUE(mistyped_times(GainFunction({{100'000'000, 1}, {1'000'000'002, 1}})).empty());  // flat
  EXPECT_TRUE(mistyped_times(GainFunction({{10, 1}, {102, 0}})).empty());                     // a step
  EXPECT_TRUE(mistyped_times(GainFunction({{5, 1}})).empty());
  EXPECT_EQ(mistyped_times(GainFunction({{100'000'000, 1}, {1'000'000'002, 0}})).size(), 1u);
  // The largest times: candidates beyond them are none.
  EXPECT_TRUE(mistyped_times(GainFunction({{-kLargestTimeNs, 1}, {kLargestTimeNs, 0}})).empty());
}

}  // namespace
}  // namespace nutik::test
