#include "features/solve/solving.hpp"

#include <algorithm>

#include "app/output/console.hpp"
#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/report.hpp"
#include "app/words/stated_requests.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "features/schema/option.hpp"
#include "features/schema/options.hpp"
#include "session/requests/named_inputs.hpp"
#include "session/text/number_text.hpp"
#include "session/text/shell_text.hpp"
#include "session/text/text_table.hpp"
#include "system/output_file.hpp"

namespace nutik::app {
namespace {

// What gains and times are to be found for.
SolveRequest solve_request(const Options& options) {
  if (!options.functions) {
    throw UsageError("solve needs gain functions, with names in place of what is to be found: -k named.fn");
  }
  SolveRequest request;
  // Wishes first: they are read faster than files.
  for (const Said& said : options.said) {
    if (said.option == "wish") request.wishes.push_back(StatedWish::parse(said.words.front()));
  }
  if (request.wishes.empty()) {
    throw UsageError("what is wished? Add --wish 'M0 = background', or --wish '300,150,60,60 gone' for example");
  }
  for (const StatedWish& wish : request.wishes) {
    const auto fail = [&](std::string_view letter, std::string_view what) {
      throw UsageError(format("--wish '{}': {} and a number is a value of {}", wish.text, letter, what));
    };
    if (wish.has_tag() && !options.mask) fail("M", "the mask; add -m mask.pgm");
    if (wish.has_mark() && !options.regions) fail("R", "a second mask; add --regions mask.pgm");
  }
  TemplateInput input = read_template_input(*options.functions);
  if (!input.warnings.empty()) print_note(input.warnings);
  request.functions = std::move(input.functions);
  for (const Said& said : options.said) {
    if (said.option != "free") continue;
    StatedFreedom free = StatedFreedom::parse(said.words.front(), request.functions);
    for (const StatedFreedom& other : request.free) {
      if (other.name == free.name) throw UsageError(format("--free states {} twice", free.name));
    }
    request.free.push_back(std::move(free));
  }
  for (const std::string& time : request.functions.times) {
    const bool is_stated =
        std::ranges::any_of(request.free, [&](const StatedFreedom& free) { return free.name == time; });
    if (!is_stated) {
      throw UsageError(format("{} stands for a time; say when it may be: --free {}=0.6s..0.8s", time, time));
    }
  }
  request.exposure = exposure_request(options, Shared(tags_of(request.functions)));
  if (options.regions) request.marks = Shared(read_mask_input(*options.regions, options.operands.front()));
  return request;
}

// By channel, or of brightness alone.
std::vector<double> numbers_of(const SolvedWish& wish, const ChannelLight& light) {
  return {light.begin(), light.begin() + static_cast<std::ptrdiff_t>(wish.missed.size())};
}

std::string numbers_text(const std::vector<double>& numbers, std::string_view specification) {
  std::string text;
  for (const double number : numbers) {
    text += (text.empty() ? "" : " ") +
            (specification == "light" ? format("{:.6f}", number) : format("{:.2g}", number));
  }
  return text;
}

// `rest = -25.0113, when = 0.612500305 s`: to the nanosecond, as it is written.
std::string found_text(const FunctionTemplate& functions, const NamedNumbers& numbers) {
  std::vector<std::string> found;
  for (std::size_t i = 0; i < functions.gains.size(); ++i)
    found.push_back(format("{} = {:.9g}", functions.gains[i], numbers.gains[i]));
  for (std::size_t i = 0; i < functions.times.size(); ++i)
    found.push_back(
        format("{} = {:.15g} s", functions.times[i], static_cast<double>(numbers.times_ns[i]) * 1e-9));
  return joined(found);
}

// Nothing that the light's digits here would show.
bool misses_nothing(const SolvedWish& wish) {
  return std::ranges::all_of(wish.missed, [](double missed) { return missed > -5e-7 && missed < 5e-7; });
}

std::string wishes_table(const SolvedExposure& solved) {
  std::vector<std::vector<std::string>> rows{{"wish", "wanted", "reached", "missed by", "cost"}};
  for (const SolvedWish& wish : solved.wishes) {
    rows.push_back({wish.text, numbers_text(numbers_of(wish, wish.light.wanted), "light"),
                    numbers_text(numbers_of(wish, wish.light.reached), "light"),
                    misses_nothing(wish) ? "-" : numbers_text(wish.missed, "missed"),
                    misses_nothing(wish) ? "-" : format("{:.2g}", wish.cost)});
  }
  return table_text(rows, "lllll");
}

Json json_of(const std::filesystem::path& output, const SolveRequest& request, const SolvedExposure& solved) {
  Json json{{"functions", output.string()}, {"gains", Json::object()}, {"times_ns", Json::object()}};
  for (std::size_t i = 0; i < request.functions.gains.size(); ++i)
    json["gains"][request.functions.gains[i]] = solved.numbers.gains[i];
  for (std::size_t i = 0; i < request.functions.times.size(); ++i)
    json["times_ns"][request.functions.times[i]] = solved.numbers.times_ns[i];
  json["wishes"] = Json::array();
  for (const SolvedWish& wish : solved.wishes) {
    json["wishes"].push_back({{"wish", wish.text},
                              {"wanted", numbers_of(wish, wish.light.wanted)},
                              {"reached", numbers_of(wish, wish.light.reached)},
                              {"missed", wish.missed},
                              {"cost", wish.cost},
                              {"kept", wish.is_kept()}});
  }
  json["at_ends"] = solved.at_ends;
  json["untold"] = Json::array();
  for (const std::size_t gain : solved.untold) json["untold"].push_back(request.functions.gains[gain]);
  json.update({{"kept", solved.is_kept()},
               {"cost", solved.cost()},
               {"open_gains", solved.open_count},
               {"tried_exposures", solved.tried},
               {"saturated_below_pixels", solved.saturation.below},
               {"saturated_above_pixels", solved.saturation.above}});
  return json;
}

// The command that exposes with what was found.
std::string next_command(const Options& options, const std::filesystem::path& output) {
  std::string words;
  for (const Option& option : schema()) {
    if (!option.is_of(CommandId::expose) || !option.makes_picture() || option.long_name == "functions") continue;
    if (option.is_in(options)) words += " " + option.display_name();
    if (const std::string* const value = option.stated(options)) words += " " + shell_word(*value);
  }
  return format("nutik-cl{} -k {} {} picture.png", words, shell_word(output.string()),
                shell_word(options.operands.front()));
}

// What may have kept a wish from being kept.
std::string stopped_text(const SolvedExposure& solved) {
  if (solved.at_ends.empty()) return "";
  return format("; {} came to {} (--free): what lies beyond may come nearer", joined(solved.at_ends),
                solved.at_ends.size() == 1 ? "an end of its range" : "ends of their ranges");
}

// What a person should know of it.
std::vector<std::string> notes_of(const SolveRequest& request, const SolvedExposure& solved) {
  std::vector<std::string> notes;
  for (const std::size_t gain : solved.untold) {
    notes.push_back(format("no wish depends on {}; it stays where it began, at {:.9g}",
                           request.functions.gains[gain], solved.numbers.gains[gain]));
  }
  if (solved.open_count > 0) {
    notes.push_back(
        format("the wishes are kept in more than one way: gains could still change together, in {}. What is "
               "nearest to where they began was taken; another wish, or bounds, would tell",
               counted(solved.open_count, "way")));
  }
  return notes;
}

}  // namespace

int run_solve(const Options& options) {
  const Stopwatch stopwatch;
  const std::filesystem::path output =
      stated_output(options, "solve").value_or(exposure_label(options) + "-solved.fn");
  check_output(output, OutputKind::functions, input_files(options), replacing(options));
  const SolveRequest request = solve_request(options);

  Session session = open_session(options, {.besides = solve_needs(request)});
  const SolvedExposure solved =
      solve(session, options.operands.front(), request, progress_bar("reading", options.quiet),
            progress_bar("looking for times", options.quiet));
  std::vector<std::string> warnings = solved.warnings;
  if (!solved.is_kept()) {
    warnings.push_back(
        format("not all wishes could be kept: the numbers are those with the least cost that was found, {:.2g}{}",
               solved.cost(), stopped_text(solved)));
  }
  print_warnings(warnings);
  write_text(output, solved.text);

  Answer answer{json_of(output, request, solved)};
  answer.json["seconds"] = stopwatch.seconds();
  answer.line =
      format("{}: {}; {} tried, {:.2f} s", output.string(), found_text(request.functions, solved.numbers),
             counted(solved.tried, "exposure"), stopwatch.seconds());
  answer.details.push_back(wishes_table(solved));
  answer.details.push_back("the picture: " + saturated_text(solved.saturation));
  answer.details.push_back("try: " + next_command(options, output));
  answer.notes = camera_notes(solved.moved);
  answer.tell_source(session);
  for (std::string& note : notes_of(request, solved)) answer.notes.push_back(std::move(note));
  return tell(options, output, answer);
}

}  // namespace nutik::app
