#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <string>
#include <utility>

#include "app/output/progress.hpp"
#include "app/output/report.hpp"
#include "app/run.hpp"
#include "app/words/stated_requests.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/picture.hpp"
#include "capture/source_text.hpp"
#include "exposure/function_check.hpp"
#include "exposure/function_diagnostics.hpp"
#include "exposure/mask.hpp"
#include "features/check/input_check.hpp"
#include "features/schema/option.hpp"
#include "features/schema/options.hpp"
#include "imev/each_block.hpp"
#include "mask/feather.hpp"
#include "session/clips/clip_source.hpp"
#include "session/requests/named_inputs.hpp"
#include "session/text/number_text.hpp"
#include "session/text/text_table.hpp"
#include "system/input_bytes.hpp"
#include "system/interruption.hpp"
#include "tik/reader.hpp"

namespace nutik::app {
namespace {

// What a check found, mistakes and warnings, for people or for a script.

using Severity = Finding::Severity;

constexpr std::size_t kMaxOfAKind = 20;

std::string message_of(const Finding& finding) {
  return finding.message + in_words(finding.advice, Dialect::command_line) +
         written(finding.settings, Dialect::command_line);
}

std::string text_of(const Finding& finding) {
  if (finding.place) {
    return Diagnostic{finding.severity, *finding.place, finding.message, finding.excerpt}.text(finding.file);
  }
  return format("{}: {}{}", finding.file, finding.severity == Severity::warning ? "warning: " : "",
                message_of(finding));
}

Json details_json(const std::vector<BlendedValue>& blended) {
  Json values = Json::array();
  for (const BlendedValue& value : blended) {
    values.push_back(
        {{"mask_value", value.value}, {"pixels", value.pixel_count}, {"x", value.x}, {"y", value.y}});
  }
  return Json{{"values", values}};
}

Json details_json(const std::vector<MaskSpeck>& specks) {
  Json places = Json::array();
  for (const MaskSpeck& speck : specks) {
    places.push_back({{"x", speck.x}, {"y", speck.y}, {"pixels", speck.pixel_count}});
  }
  return Json{{"mask_value", specks.front().tag}, {"specks", places}};
}

Json details_json(std::uint8_t tag) { return Json{{"mask_value", tag}}; }
Json details_json(std::monostate) { return Json::object(); }

Json json_of(const Finding& finding) {
  Json json{{"severity", finding.severity == Severity::warning ? "warning" : "error"},
            {"kind", finding.kind},
            {"file", finding.file},
            {"message", message_of(finding)}};
  if (finding.place) {
    json["line"] = finding.place->line;
    json["column"] = finding.place->column;
  }
  json.update(std::visit([](const auto& details) { return details_json(details); }, finding.details));
  return json;
}

std::size_t count_of(const std::vector<Finding>& findings, Severity severity) {
  return static_cast<std::size_t>(std::ranges::count(findings, severity, &Finding::severity));
}

// All of them, one below the other; of each kind at most 20 in each file, then how many more there are.
std::string findings_text(const std::vector<Finding>& findings) {
  std::string text;
  std::map<std::pair<std::string, std::string>, std::size_t> counts;
  for (const Finding& finding : findings) {
    if (++counts[{finding.file, finding.kind}] > kMaxOfAKind) continue;
    text += (text.empty() ? "" : "\n") + text_of(finding);
  }
  for (const auto& [of, count] : counts) {
    if (count <= kMaxOfAKind) continue;
    text += format("\n{}: and {} more like these ({}); --json lists all", of.first, count - kMaxOfAKind,
                   of.second);
  }
  return text;
}

Json findings_json(const std::vector<Finding>& findings) {
  Json json = Json::array();
  for (const Finding& finding : findings) json.push_back(json_of(finding));
  return json;
}

// `1 mistake, 2 warnings`, `nothing wrong`.
std::string verdict(const std::vector<Finding>& findings) {
  const std::size_t mistakes = count_of(findings, Severity::error);
  const std::size_t warnings = count_of(findings, Severity::warning);
  if (mistakes == 0 && warnings == 0) return "nothing wrong";
  if (mistakes == 0) return counted(warnings, "warning");
  if (warnings == 0) return counted(mistakes, "mistake");
  return counted(mistakes, "mistake") + ", " + counted(warnings, "warning");
}

// What a check looked at and what it came to, as text and as JSON.

std::string stops_text(const GainSummary& summary) {
  const auto stops = still_stops(summary);
  if (!stops) return "-";
  const double shown = std::round(*stops * 100) / 100;
  return shown == 0.0 ? "0" : format("{:+.2f}", shown);
}

// A line on what was looked at.
std::string heading_text(const InputCheck& check) {
  std::string text;
  const auto append = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  if (check.functions) {
    const std::size_t count =
        check.functions->file.functions.size() + check.functions->file.broken.size();
    append(format("{}: {}", check.functions->name, counted(count, "function")));
  }
  if (check.mask)
    append(format("{}: {} x {}", check.mask->name, check.mask->mask.width, check.mask->mask.height));
  if (check.capture && check.capture->timeline) {
    append(format("{}: {}, {}, {}", check.capture->name, shape_text(check.capture->format.shape),
                  counted(check.capture->timeline->sample_count(), "sample"),
                  duration_text(check.domain.duration_ns)));
  } else if (check.capture) {
    append(format("{}: {}, its length is not known", check.capture->name, shape_text(check.capture->format.shape)));
  }
  if (check.functions && !check.domain.is_capture) {
    append(format("figures are for 0 … {}, not for a capture",
                  integral_text(static_cast<double>(check.domain.duration_ns))));
  }
  if (check.functions && check.delay) append("figures are without the delay");
  return text.empty() ? "nothing could be read" : text;
}

// A row for each function, without columns of what is not known. For at least one function.
std::string figures_text(const InputCheck& check) {
  const auto is_known = [&](auto member) {
    return std::ranges::any_of(check.figures,
                               [&](const auto& figures) { return (figures.*member).has_value(); });
  };
  const bool has_pixels = is_known(&FunctionFigures::pixels);
  const bool has_samples = is_known(&FunctionFigures::samples);
  const auto count = [](const std::optional<std::uint64_t>& number) {
    return number ? format("{}", *number) : std::string("-");
  };
  const auto time = [](std::int64_t ns) { return integral_text(static_cast<double>(ns)); };
  std::vector<std::vector<std::string>> rows;
  const auto add_row = [&](const std::string& function, const std::string& pixels,
                           std::vector<std::string> figures, const std::string& samples) {
    std::vector<std::string> row{function};
    if (has_pixels) row.push_back(pixels);
    std::ranges::move(figures, std::back_inserter(row));
    if (has_samples) row.push_back(samples);
    rows.push_back(std::move(row));
  };
  add_row("function", "pixels", {"live", "D", "∫g", "still gain", "stops"}, "samples");
  for (const FunctionFigures& figures : check.figures) {
    const GainSummary& summary = figures.summary;
    const Interval& live = summary.live;
    add_row(format("M{}", figures.tag), count(figures.pixels),
            {live.empty() ? "never" : time(live.begin_ns) + " … " + time(live.end_ns),
             time(summary.support_ns), integral_text(figures.integral_ns),
             format("{:.6g}", summary.still_gain()), stops_text(summary)},
            count(figures.samples));
  }
  return table_text(rows, std::string("l") + (has_pixels ? "r" : "") + "lrrrr" + (has_samples ? "r" : ""));
}

Json check_json(const InputCheck& check) {
  Json functions = Json::array();
  for (const FunctionFigures& figures : check.figures) {
    const GainSummary& summary = figures.summary;
    const auto stops = still_stops(summary);
    Json function{{"mask_value", figures.tag},
                  {"pixels", figures.pixels ? Json(*figures.pixels) : Json()},
                  {"live_start_ns", summary.live.begin_ns},
                  {"live_end_ns", summary.live.end_ns},
                  {"nonzero_ns", summary.support_ns},
                  {"integral_ns", figures.integral_ns},
                  {"still_gain", summary.still_gain()},
                  {"stops", stops ? Json(*stops) : Json()},
                  {"samples", figures.samples ? Json(*figures.samples) : Json()}};
    functions.push_back(std::move(function));
  }
  return Json{{"mistakes", count_of(check.findings, Severity::error)},
              {"findings", findings_json(check.findings)},
              {"domain_end_ns", check.domain.duration_ns},
              {"domain_is_capture", check.domain.is_capture},
              {"functions", functions}};
}

// Adds to a check what can be read of an input: one that cannot is a finding like others, and the rest is checked all
// the same.
template <typename Read>
void attempt(InputCheck& check, const std::string& name, const std::string& kind, Read read,
             Finding::Severity severity = Finding::Severity::error) {
  try {
    read();
  } catch (const InputError& error) {
    std::string message = message_text(error, Dialect::command_line);
    // Findings start with the file's name anyway.
    for (const char* behind : {": ", " "}) {
      if (message.starts_with(name + behind)) message.erase(0, message.find(' ', name.size()) + 1);
    }
    check.findings.push_back({severity, kind, name, message});
  }
}

// Decodes all of it. A picture that cannot be read is its end.
void read_clip(InputCheck& check, const std::string& name, const SourceRequest& request, const Options& options) {
  const TwofoldProgress progress(request, progress_bar("reading", options.quiet, progress_lines(options)));
  const MemoryBudget memory = memory_budget(options);
  ClipSource source = open_clip_source(request, memory, progress.finding);
  check.capture = {name, source.capture, std::nullopt, source.clip->info().facts, source.notes};
  const MemoryNeeds needs{{"pictures within the decoder", source.clip->info().decoder_bytes},
                          {"a picture of the clip", source.capture.sample_bytes()}};
  needs.rest_of(memory.bytes);
  const std::uint64_t announced = source.announced_samples();
  std::uint64_t count = announced;
  attempt(check, name, "clip_picture", [&] {
    std::vector<std::byte> raster(source.capture.sample_bytes());
    std::uint64_t read = 0;
    const bool tells_changes = source.clip->tells_changes();
    while (tells_changes && read > 0 ? source.clip->read_changes().has_value() : source.clip->read(raster)) {
      check_interruption();
      progress.reading(++read, announced);
    }
    count = read;
    if (count == 0) throw InputError("has no picture");
    auto reason = source.clip->ended_early();
    if (!reason) reason = lost_pictures_text(source.name(), announced, read);
    if (reason) check.findings.push_back({Finding::Severity::warning, "clip_end", name, *reason});
  });
  std::ranges::move(source.clip->remarks(), std::back_inserter(source.notes));
  check.capture->notes = source.notes;
  if (count > 0) {
    check.capture->timeline = source.timeline(count);
    check.capture->facts = source.facts(count);
    check.capture->notes = source.all_notes(count);
  }
  for (const Note& note : check.capture->notes) {
    if (!note.is_warning) continue;
    check.findings.push_back({.severity = Finding::Severity::warning,
                              .kind = "clip_picture",
                              .file = name,
                              .message = note.text,
                              .settings = note.settings});
  }
  std::erase_if(check.capture->notes, [](const Note& note) { return note.is_warning; });
}

void read_capture(InputCheck& check, const std::string& name, const Options& options) {
  const SourceRequest request = source_request(options, name);
  if (!is_tik(name)) return read_clip(check, name, request, options);
  tik::Reader reader(name);
  check.capture = {name, reader.format(), reader.timeline()};
  MemoryNeeds needs = camera_check_needs(reader.format());
  needs.add("a block", largest_block(reader));
  needs.rest_of(memory_budget(options).bytes);
  {
    BlockCursor blocks(reader);
    for (std::uint64_t block = 0; block < reader.block_count(); ++block) {
      attempt(check, name, "capture_block", [&] { static_cast<void>(blocks.at(block)); });
    }
  }
  if (count_of(check.findings, Severity::error) > 0) return;
  const auto look = [&] {
    if (const auto moved = moved_camera(reader))
      check.findings.push_back({Finding::Severity::warning, "camera_moved", name,
                                moved->text() + "; encode the clip again with --align rigid"});
  };
  attempt(check, name, "camera_unknown", look, Finding::Severity::warning);
}

InputCheck checked_inputs(const Options& options) {
  refuse_without_mask(options);
  InputCheck check;
  check.normalization = options.asked.normalization;
  check.gain = brightening(options);
  if (options.functions) {
    const std::string name = input_title(*options.functions);
    attempt(check, name, "function_file",
            [&] { check.add_functions(name, InputBytes(*options.functions).text()); });
  }
  if (options.mask) {
    const std::string name = input_title(*options.mask);
    const auto& functions = check.functions;
    const std::uint8_t first = functions && !functions->file.functions.empty()
                                   ? functions->file.functions.begin()->first
                                   : std::uint8_t{0};
    attempt(check, name, "mask_file", [&] {
      Mask mask =
          options.mask_to ? exposure_mask(options, first) : read_layered_mask_input(*options.mask, first);
      if (options.feather && !options.mask_to) static_cast<void>(feathered(mask, *options.feather));
      check.add_mask(exposure_mask_name(options), std::move(mask));
    });
  }
  if (!options.operands.empty()) {
    const std::string& name = options.operands.front();
    attempt(check, input_title(name), "capture", [&] { read_capture(check, name, options); });
  }
  if (options.asked.delay) {
    DelayRequest delay = *options.asked.delay;
    attempt(check, delay.file.empty() ? "delays" : delay.file, "delay_map", [&] {
      delay.read();
      check.delay = std::move(delay);
    });
  }
  check.finish(options.asked.plan.unmapped_is_zero);
  return check;
}

void print_check(const InputCheck& check, bool quiet) {
  const std::string text = findings_text(check.findings);
  if (!quiet) print_line(heading_text(check));
  if (!text.empty()) print_line(text);
  if (quiet) return;
  if (!check.figures.empty()) print_line(figures_text(check));
  print_line(verdict(check.findings));
}

// The control points of a function file as a table, for programs that draw or change them.
void print_points(const Options& options) {
  if (!options.functions) throw UsageError("--points prints those of a function file; add -k functions.fn");
  if (!options.operands.empty() || options.mask || options.json) {
    throw UsageError("--points prints nothing else; leave the capture, -m and --json away");
  }
  const FunctionInput input = read_function_input(*options.functions);
  if (!input.warnings.empty()) print_note(input.warnings);
  std::string table = "mask_value,time_ns,gain\n";
  for (const auto& [tag, function] : *input.functions) {
    for (const ControlPoint& point : function.points()) {
      table += format("{},{},{}\n", tag, point.time_ns, point.gain);
    }
  }
  print_text(table);
}

}  // namespace

int run_check(const Options& options) {
  if (options.points) {
    print_points(options);
    return 0;
  }
  if (options.operands.size() > 1) {
    throw UsageError(format("'{}' is one file too many: check looks at one capture", options.operands[1]));
  }
  if (options.operands.empty() && !options.functions && !options.mask) {
    throw UsageError(
        "what should be checked? nutik-cl check -m mask.pgm -k functions.fn clip.tik, each optional");
  }
  const InputCheck check = checked_inputs(options);
  Answer answer{check_json(check)};
  if (check.capture) answer.tell_source(check.capture->facts, check.capture->notes);
  if (check.capture && !is_tik(check.capture->name)) {
    answer.notes.emplace_back("whether the camera moved was not looked at: check the .tik that encode makes of it");
  }
  if (!options.json) print_check(check, options.quiet);
  tell(options, {}, answer, true);
  return count_of(check.findings, Severity::error) > 0 ? ExitStatus::input : ExitStatus::ok;
}

}  // namespace nutik::app
