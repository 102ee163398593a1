#include "capture/rational.hpp"

#include <gtest/gtest.h>

#include "capture/error.hpp"
#include "support/messages.hpp"

namespace nutik::test {
namespace {

TEST(Rational, ReadsWhatPeopleWriteExactly) {
  EXPECT_EQ(Rational::parse("120", "rate"), (Rational{120, 1}));
  EXPECT_EQ(Rational::parse("29.97", "rate"), (Rational{2997, 100}));
  EXPECT_EQ(Rational::parse("30000/1001", "rate"), (Rational{30000, 1001}));
  EXPECT_EQ(Rational::parse(".5", "rate"), (Rational{1, 2}));
  EXPECT_EQ(Rational::parse("-0.25", "rate"), (Rational{-1, 4}));
  EXPECT_EQ(Rational::parse("1e-3", "seconds"), (Rational{1, 1000}));
  EXPECT_EQ(Rational::parse("-2.50E+4", "seconds"), (Rational{-25'000, 1}));
  EXPECT_EQ(Rational::parse("12345e-14", "seconds"), (Rational{2469, 20'000'000'000'000}));
}

TEST(Rational, RefusesEverythingElseByName) {
  for (const char* text : {"", "fast", "1e", "e3", "1e1.5", "1e99", "1e-16", "999e13", "1e3/7", "1/7e3",
                           "1/0", "1.5/2", "1/2/3", "--1", "1.2.3", ".", "-", "12345678901234567890"}) {
    expect_error<UsageError>([&] { return Rational::parse(text, "frame rate"); },
                             {"frame rate '" + std::string(text) + "'"});
  }
}

TEST(Rational, SaysThatThereAreTooManyDigits) {
  for (const char* text : {"1e-300", "-0.1234567890123456", "12345678901234567890"})
    expect_error<UsageError>([&] { return Rational::parse(text, "gain"); }, {"needs more than 15 digits"});
  for (const char* text : {"1/0", "1.2.3", "1e", ".", "1e1.5"})
    expect_error<UsageError>([&] { return Rational::parse(text, "gain"); }, {"is not a number"});
}

TEST(Rational, WritesTheShortestExactForm) {
  EXPECT_EQ((Rational{120, 1}).text(), "120");
  EXPECT_EQ((Rational{2997, 100}).text(), "29.97");
  EXPECT_EQ((Rational{30000, 1001}).text(), "30000/1001");
  EXPECT_EQ((Rational{-1, 4}).text(), "-0.25");
  EXPECT_EQ((Rational{179, 6}).text(), "179/6");
}

TEST(Rational, RoundsHalvesUpward) {
  EXPECT_EQ(round_half_up(1, 2), 1);
  EXPECT_EQ(round_half_up(-1, 2), 0);
  EXPECT_EQ(round_half_up(3, 2), 2);
  EXPECT_EQ(round_half_up(-3, 2), -1);
  EXPECT_EQ(round_half_up(-5, 3), -2);
  EXPECT_EQ(round_half_up(1, 3), 0);
}

}  // namespace
}  // namespace nutik::test
