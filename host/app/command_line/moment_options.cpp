#include "app/command_line/option_groups.hpp"

namespace nutik::app {
namespace {

using Id = CommandId;

constexpr std::string_view kSheet = "The sheet";
constexpr std::string_view kSweep = "What is varied, FROM..TO/STEP: one, or two as rows and columns";
constexpr std::string_view kActivity = "Changes over time";

}  // namespace

std::vector<Option> moment_options() {
  return {
      valued(0, "shift", "TIMES", kSweep,
             "the functions later: 0..1s/0.1s, or -5f..5f/1f in pictures of the clip", bit(Id::sweep),
             &Options::shift),
      valued(0, "scale-gain", "FACTORS", kSweep, "every gain times a factor: 0.5..2/0.25", bit(Id::sweep),
             &Options::scale_gain),
      valued(0, "stretch", "FACTORS", kSweep,
             "the functions longer by a factor, from where the first of them begins to expose: 0.5..2/0.5",
             bit(Id::sweep), &Options::stretch),
      valued(0, "every", "TIME", kSheet,
             "from the start of one exposure to the next: 0.2s, 5f (default: so that 24 fit)",
             bit(Id::contact), &Options::every),
      valued(0, "columns", "N", kSheet, "pictures beside each other (default: as many as look well)",
             kMakesSheets, &Options::columns),
      valued(0, "width", "PIXELS", kSheet, "of the whole sheet (default: up to 1600, no picture enlarged)",
             kMakesSheets, &Options::width),
      valued(0, "each", "NAME%02d.png", kSheet, "also write every picture in full size, numbered from 0",
             bit(Id::sweep), &Options::each),
      valued(0, "tag", "N", kActivity, "count only pixels that have this value in the mask",
             bit(Id::activity), &Options::tag),
      valued(0, "by", "CODES", kActivity,
             "count codes that differ by more than this at a sample (default: 0)", bit(Id::activity),
             &Options::by),
      valued(0, "moment", "quietest|busiest", kActivity,
             "print nothing but that stretch, as options for another command: --start 12f --exposure 9f",
             bit(Id::activity), &Options::moment),
      valued(0, "csv", "FILE.csv", kActivity, "a line for each sample, - for standard output",
             bit(Id::activity), &Options::csv),
      valued(0, "map", "MAP.png", kActivity,
             "also write where it changes, as info --activity does: black never, white most often",
             bit(Id::activity), &Options::map),
  };
}

}  // namespace nutik::app
