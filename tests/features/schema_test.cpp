// The schema: a row for each option, which the command line, Python and messages read.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "capture/error.hpp"
#include "features/schema/option.hpp"
#include "features/schema/requests.hpp"
#include "support/messages.hpp"

namespace nutik::test {
namespace {

constexpr int kCommands = static_cast<int>(CommandId::man) + 1;

TEST(Schema, HasNoTwoRowsOfOneNameForACommand) {
  for (int id = 0; id < kCommands; ++id) {
    std::set<std::string> names, arguments;
    for (const Option* const option : options_of(static_cast<CommandId>(id))) {
      if (!option->heading.empty()) continue;
      EXPECT_TRUE(names.insert(option->name()).second) << id << ": " << option->name();
      EXPECT_TRUE(arguments.insert(option->written(Dialect::python)).second) << id << ": " << option->name();
      EXPECT_FALSE(option->help.empty()) << option->name();
    }
  }
}

TEST(Schema, HasARowForEverySettingThatErrorsName) {
  for (int setting = 0; setting <= static_cast<int>(Setting::tick); ++setting) {
    EXPECT_NE(written(static_cast<Setting>(setting), Dialect::command_line).find("--"), std::string::npos) << setting;
    EXPECT_NE(written(static_cast<Setting>(setting), Dialect::python).find('='), std::string::npos) << setting;
  }
}

TEST(Schema, WritesAdviceAsTheClientStatesIt) {
  const UsageError error("no pixel is left", Advice{"; keep the size (`unseen hold`), or begin later with `from`"});
  EXPECT_EQ(message_text(error, Dialect::command_line),
            "no pixel is left; keep the size (--unseen hold), or begin later with --from");
  EXPECT_EQ(message_text(error, Dialect::python),
            "no pixel is left; keep the size (unseen='hold'), or begin later with begin=");
}

TEST(Schema, SaysWhatNumberIsNoneAsTheClientStatesIt) {
  Options options;
  option_of(CommandId::study, "region")->state(options, "region", {"1,x"});
  try {
    static_cast<void>(study_request(options));
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_TRUE(message_text(error, Dialect::python).starts_with("region=: 'x' is no number"));
    EXPECT_TRUE(message_text(error, Dialect::command_line).starts_with("--region: 'x' is no number"));
  }
}

TEST(Schema, LeavesBackquotesThatNameNoOption) {
  for (const std::string name : {"`", "a`b", "`none`", "``", "a`b`c`d"}) {
    EXPECT_EQ(message_text(InputError(name, Advice{" " + name + "; leave `from` out"}), Dialect::command_line),
              name + " " + name + "; leave --from out");
  }
}

// Fields that are not empty until their option is stated; what is empty has its default where it is used.
TEST(Schema, StatesTheDefaultsThatFieldsHave) {
  const auto expect = [](CommandId command, std::string_view name, auto field) {
    const Option& option = *option_of(command, name);
    constexpr std::string_view kBefore = "(default: ";
    const std::string_view text = option.help.substr(option.help.find(kBefore) + kBefore.size());
    const std::string word(text.substr(0, text.find_first_of(" ,;)")));
    Options options;
    option.state(options, option.name(), {word});
    EXPECT_TRUE(field(options) == field(Options())) << option.name() << ' ' << word;
  };
  expect(CommandId::encode, "tolerance", [](const Options& of) { return of.source.tolerance; });
  expect(CommandId::encode, "sigmas", [](const Options& of) { return of.source.sigmas; });
  expect(CommandId::encode, "tiles", [](const Options& of) { return of.source.tiles; });
  expect(CommandId::encode, "codec", [](const Options& of) { return of.codec; });
  expect(CommandId::expose, "normalize", [](const Options& of) { return of.asked.normalization; });
  expect(CommandId::expose, "combine", [](const Options& of) { return of.combining.how; });
  expect(CommandId::video, "out-fps", [](const Options& of) { return of.film.rate; });
  expect(CommandId::video, "out-angle", [](const Options& of) { return of.film.angle; });
  expect(CommandId::video, "speed", [](const Options& of) { return of.film.speed; });
  expect(CommandId::study, "style", [](const Options& of) { return of.study.style; });
  expect(CommandId::study, "spacing", [](const Options& of) { return of.study.spacing; });
  expect(CommandId::study, "slit-from", [](const Options& of) { return of.study.slit_from; });
  expect(CommandId::validate, "runs", [](const Options& of) { return of.runs; });
  // These have no word of their own until they are stated.
  expect(CommandId::expose, "gain", [](const Options& of) { return of.gain.value_or(ExposureRequest().gain); });
  expect(CommandId::expose, "shutter-error",
         [](const Options& of) { return of.shutter_error.value_or(ShutterShape::kDefaultError); });
}

// A row with more choices than values, or fewer, is a mistake of the table.
TEST(Schema, TakesEveryChoiceAndNoOther) {
  int rows = 0;
  for (const Option& option : schema()) {
    if (option.take == nullptr || option.choice_list.empty()) continue;
    ++rows;
    for (const std::string& choice : option.choices()) {
      Options options;
      if (choice.ends_with(':')) continue;
      EXPECT_NO_THROW(option.state(options, option.name(), {choice})) << option.name() << ' ' << choice;
    }
  }
  EXPECT_GE(rows, 25);
  Options options;
  const Option& depth = *option_of(CommandId::expose, "depth");
  depth.state(options, "--depth", {"double"});
  EXPECT_EQ(options.picture.depth, Depth::doubled);
  EXPECT_EQ(message_of<UsageError>([&] { depth.restate(options, {"12"}); }),
            "--depth '12' is not known; choose 8, 16, half, float or double");
}

TEST(Schema, CountsWhatTheRowOfAnotherCommandStated) {
  Options options;
  option_of(CommandId::study, "feather")->state(options, "--feather", {"6px"});
  const Option& exposing = *option_of(CommandId::expose, "feather");
  ASSERT_NE(&exposing, option_of(CommandId::study, "feather"));
  ASSERT_NE(exposing.stated(options), nullptr);
  EXPECT_EQ(*exposing.stated(options), "6px");
}

TEST(Schema, TakesAnOptionOnce) {
  Options options;
  const Option& rate = *option_of_argument(CommandId::encode, "rate");
  rate.state(options, "rate", {"240"});
  EXPECT_THROW(rate.state(options, "rate", {"120"}), UsageError);
  rate.restate(options, {"120"});
  ASSERT_TRUE(options.source.clip.rate);
  EXPECT_EQ(*options.source.clip.rate, (Rational{120, 1}));
}

}  // namespace
}  // namespace nutik::test
