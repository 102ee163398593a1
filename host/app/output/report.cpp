#include "app/output/report.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <variant>

#include "capture/format.hpp"
#include "capture/source_text.hpp"
#include "features/captures/retiming.hpp"
#include "features/schema/option.hpp"
#include "media/writers/picture_writer.hpp"
#include "render/render_plan.hpp"
#include "session/text/number_text.hpp"
#include "session/text/text_table.hpp"

namespace nutik::app {
namespace {

// What a summary says of the first functions, and how many it leaves out.
struct FunctionTexts {
  template <typename Text>
  FunctionTexts(const ExposureFigures& figures, Text text) {
    constexpr std::size_t kMax = 6;
    const std::size_t shown = std::min(figures.functions.size(), kMax);
    std::ranges::transform(std::span(figures.functions).first(shown), std::back_inserter(texts), text);
    left_out = figures.functions.size() - shown;
  }

  std::vector<std::string> texts;
  std::size_t left_out = 0;
};

enum class About { times, part, events, colour };

About subject_of(const Fact& fact) {
  switch (fact.setting) {
    case Setting::frame_rate:
    case Setting::shutter_angle: return About::times;
    case Setting::from:
    case Setting::to:
    case Setting::crop:
    case Setting::between:
    case Setting::deflicker:
    case Setting::scale: return About::part;
    case Setting::contrast:
    case Setting::start_picture:
    case Setting::tick: return About::events;
    case Setting::deinterlace: return fact.origin == Origin::assumed ? About::colour : About::part;
    default: return About::colour;
  }
}

// Each fact with who said it, those of one subject.
std::string facts_text(std::span<const Fact> facts, About subject) {
  std::string text;
  for (const Fact& fact : facts) {
    if (subject_of(fact) != subject) continue;
    const std::string who = fact.origin == Origin::file     ? format(" (from {}", fact.source)
                            : fact.origin == Origin::stated ? written(std::vector{fact.setting}, Dialect::command_line)
                                                            : std::string(" (assumed");
    text += format("{}{}{}", text.empty() ? "" : ", ", fact.text, who);
    if (fact.origin != Origin::stated) text += format("{}{})", fact.remark.empty() ? "" : ": ", fact.remark);
  }
  return text;
}

// A line each, where there are facts: source: (times), part:, events:, colour: with the options that change what is
// assumed.
std::vector<std::string> fact_lines(std::span<const Fact> facts) {
  std::vector<std::string> lines;
  if (const std::string times = facts_text(facts, About::times); !times.empty()) lines.push_back("source: " + times);
  if (const std::string part = facts_text(facts, About::part); !part.empty())
    lines.push_back("part: " + part);
  std::vector<Setting> assumed;
  for (const Fact& fact : facts) {
    if (fact.origin == Origin::assumed) assumed.push_back(fact.setting);
  }
  if (const std::string events = facts_text(facts, About::events); !events.empty())
    lines.push_back("events: " + events);
  if (const std::string colours = facts_text(facts, About::colour); !colours.empty()) {
    const std::string others = written(assumed, Dialect::command_line);
    lines.push_back(
        format("colour: {}{}", colours, others.empty() ? "" : "; what is assumed can be stated" + others));
  }
  return lines;
}

}  // namespace

std::string timing_text(std::span<const Fact> facts) { return facts_text(facts, About::times); }

void print_json(const Json& json) {
  constexpr auto kReplace = Json::error_handler_t::replace;
  const std::string text = json.dump(2, ' ', false, kReplace);
  // What a terminal would obey stands there as JSON's own escapes.
  print_text((printable_lines(text) == text ? text : json.dump(2, ' ', true, kReplace)) + "\n");
}

Json shape_json(const Shape& shape) {
  return {{"width", shape.width}, {"height", shape.height}, {"channels", shape.channels}};
}

Json facts_json(const std::vector<std::string>& lines) {
  Json facts = Json::array();
  for (const std::string& line : lines) {
    facts.push_back({{"fact", line}});
    if (const auto setting = correction_of(line)) facts.back()["option"] = written(*setting, Dialect::command_line);
  }
  return facts;
}

void Answer::tell_source(const std::vector<Fact>& facts, const std::vector<Note>& more) {
  source = fact_lines(facts);
  for (const Fact& fact : facts)
    json["facts"].push_back({{"fact", fact.line()}, {"option", written(fact.setting, Dialect::command_line)}});
  for (const Note& note : more) {
    std::string text = note_texts({note}, Dialect::command_line).front();
    if (note.is_warning) {
      print_warning(text);
    } else {
      notes.push_back(std::move(text));
    }
  }
}

void Answer::tell_source(const Session& session) {
  if (session.is_clip()) tell_source(session.facts(), session.notes());
}

void Answer::tell_source(const Session& session, const Options& stated) {
  if (!session.is_clip()) return;
  std::vector<Fact> facts = session.facts();
  for (Fact& fact : facts) {
    const auto is_of = [&](const Said& said) { return said.row->setting == fact.setting; };
    if (fact.origin == Origin::stated && std::ranges::none_of(stated.said, is_of)) fact.origin = Origin::assumed;
  }
  tell_source(facts, session.notes());
}

std::vector<std::string> square_notes(const CaptureFormat& capture, const Shape& written) {
  if (written == capture.shape) return {};
  const auto [wide, high] = capture.pixel_aspect;
  const Note note(format("pixels of {}:{} were made square: {} x {} became {} x {}", wide, high, capture.shape.width,
                         capture.shape.height, written.width, written.height),
                  {Setting::keep_pixels});
  return note_texts({note}, Dialect::command_line);
}

int tell(const Options& options, const std::filesystem::path& output, const Answer& answer) {
  return tell(options, output, answer, options.output.has_value() || options.operands.size() > 1);
}

int tell(const Options& options, const std::filesystem::path& output, const Answer& answer, bool was_named) {
  if (options.json) {
    Json json = answer.json;
    json["notes"] = answer.notes;
    json["warnings"] = printed_warnings();
    print_json(json);
  } else if (!options.quiet) {
    if (!answer.line.empty()) print_line(answer.line);
    for (const std::string& detail : answer.details) print_line(detail);
    for (const std::string& line : answer.source) print_note(line);
    print_notes(answer.notes);
  } else if (!was_named) {
    print_text(output.string() + "\n");  // for a script, byte by byte
  }
  return 0;
}

namespace {

// What a reader has to be told, because it would take something else for granted; empty: nothing.
std::string unnamed_note(const std::filesystem::path& picture, const CaptureFormat& capture,
                         const OutputFormat& output) {
  if (!is_silent_name(picture)) return {};
  CodeMaking making = CodeMaking::of(capture, output);
  if (!holds_codes(output.type)) making.transfer = Transfer::linear();
  std::string left;
  if (making.transfer != (output.type == ValueType::code8 ? Transfer::srgb() : Transfer::linear()))
    left = "the transfer function " + making.transfer.text();
  if (capture.shape.channels > 1 && making.primaries != making.transfer.usual_primaries().value_or(Primaries::bt709))
    left += format("{}the primaries {}", left.empty() ? "" : " and ", to_text(making.primaries));
  if (left.empty()) return {};
  return format("{} does not name {}: state that when it is read", picture.string(), left);
}

}  // namespace

void ExposureTally::add(const ExposedPicture& exposed) {
  output_ = exposed.output;
  saturation_ += exposed.saturation;
  has_codes_ |= holds_codes(exposed.output.type);
  const Transfer& held = exposed.figures.capture.transfer;
  const bool is_cut_off = exposed.saturation.above > 0 && exposed.output.transfer;
  if (held.reference_white() < 1 && (is_cut_off || !has_codes_)) brighter_than_white_ = held;
  precision_ = to_text(exposed.precision);
  renderer_ = exposed.renderer;
  report_ = rendering_report(exposed, exposed.output);
  error_bound_ = exposed.error_bound();
  if (!worst_.bounds.error || exposed.uncertainty.bounds.error->light > worst_.bounds.error->light) {
    worst_ = exposed.uncertainty;
    worst_output_ = exposed.output;
  }
}

void ExposureTally::wrote(const CaptureFormat& capture, const Shape& written, const std::filesystem::path& picture) {
  if (unnamed_.empty()) unnamed_ = unnamed_note(picture, capture, output_);
  squared_ = square_notes(capture, written);
  if (squared_.empty() || !worst_output_.maps_bounds) return;
  squared_.push_back(format("maps of bounds have the capture's {} x {} pixels, for which alone they hold",
                            capture.shape.width, capture.shape.height));
}

std::string ExposureTally::saturation_text() const {
  return has_codes_ ? ", " + saturated_text(saturation_) : std::string();
}

Json ExposureTally::saturation_json() const {
  if (!has_codes_) return Json::object();
  return {{"saturated_below_pixels", saturation_.below}, {"saturated_above_pixels", saturation_.above}};
}

Json uncertainty_json(const Uncertainty& uncertainty, const OutputFormat& output) {
  if (!uncertainty.bounds.error) return Json::object();  // nothing was exposed
  const auto json_of = [&](const UncertaintyTerm& term) {
    Json json;
    for (const UncertaintyTerm::Field& field : term.fields(output))
      std::visit([&](const auto& each) { json[std::string(field.first)] = each; }, field.second);
    return json;
  };
  Json terms = Json::array();
  for (const UncertaintyTerm& term : uncertainty.terms) terms.push_back(json_of(term));
  return {{"uncertainty", {{"scale", uncertainty.scale}, {"terms", terms}, {"bounds", json_of(uncertainty.bounds)}}}};
}

std::vector<std::string> ExposureTally::notes() const {
  std::vector<std::string> notes = squared_;
  if (!unnamed_.empty()) notes.push_back(unnamed_);
  if (!brighter_than_white_) return notes;
  const double white = brighter_than_white_->reference_white();
  const std::string share = format("white is {:.3g} % of the light that {} reaches", 100 * white,
                                   brighter_than_white_->text());
  notes.push_back(
      has_codes_ ? format("{}, and {} brighter come out white; nutik-cl expose --ev {:.1f} shows all that a still "
                          "scene holds, and an .exr, or a .tif with --depth float, keeps it",
                          share, counted(saturation_.above, "pixel"), std::floor(10 * std::log2(white)) / 10)
                 : format("{}, which is 1 here; --gain {:.6g} makes white 1", share, 1 / white));
  return notes;
}

void ExposureTally::end(Answer& answer, Session& session, bool verbose, const std::string& rate) const {
  const std::string renderer = renderer_.empty() ? session.devices().renderer().name() : renderer_;
  answer.json.update(saturation_json());
  answer.json.update(uncertainty_json());
  answer.json.update({{"precision", precision_}, {"renderer", renderer}, {"seconds", seconds()}});
  answer.line += format("{}{}, {:.2f} s on {}", saturation_text(), rate, seconds(), renderer);
  std::ranges::move(notes(), std::back_inserter(answer.notes));
  if (verbose && !report_.empty()) answer.details.push_back(report_);
  if (verbose && worst_.bounds.error)
    std::ranges::move(worst_.lines(worst_output_), std::back_inserter(answer.details));
}

std::vector<std::string> exposure_warnings(const ExposedPicture& exposed) {
  std::vector<std::string> warnings = exposed.warnings;
  const std::uint64_t pixels = exposed.picture.shape.pixel_count();
  if (holds_codes(exposed.output.type) && exposed.saturation.above == pixels) {
    warnings.push_back(
        "every pixel comes out white: all light is above 1; --normalize integral, --gain or --ev makes it "
        "less, an .exr or a .tif with --depth float keeps it");
  }
  if (!holds_codes(exposed.output.type) || exposed.output.negative != NegativeLight::saturate)
    return warnings;
  // Light below 0 is black in a picture of codes: a still scene under a negative still gain disappears.
  for (const PlannedFunction& function : exposed.figures.functions) {
    const double still_gain = function.summary.still_gain();
    if (still_gain >= 0.0) continue;
    warnings.push_back(
        format("M{}: the still gain is {:.6g}: whatever does not move comes out black; --negative "
               "offset shows light below 0, an .exr or a .tif with --depth float keeps it",
               function.tag, still_gain));
  }
  if (exposed.saturation.below == pixels && warnings.size() == exposed.warnings.size())
    warnings.push_back("every pixel comes out black: all light is below 0");
  return warnings;
}

std::string still_gains_text(const ExposureFigures& figures, bool plain) {
  if (figures.combine != Combine::integral) return {};
  const FunctionTexts gains(figures, [&](const PlannedFunction& function) {
    const double still_gain = function.summary.still_gain();
    return plain ? format(" {:.6g}", still_gain) : format(" M{} {:.6g}", function.tag, still_gain);
  });
  return ", still gain" + joined(gains.texts, ",") +
         (gains.left_out > 0 ? format(" and {} more", gains.left_out) : "") +
         (figures.has_delays ? " without delay" : "");
}

std::string plan_text(const ExposureFigures& figures) {
  std::string text = "plan: ";
  if (figures.blocks_read == 0) {
    text += "nothing is read: no gain within the capture differs from 0";
  } else {
    const auto [first, last] = figures.read;
    text += format("exposes {} of {} samples; ", figures.live_samples, figures.timeline.sample_count());
    text += format("read: {} (samples {} … {})", counted(figures.blocks_read, "block"), first, last - 1);
    if (figures.block_count) {
      text += format(", skipped: {}", counted(*figures.block_count - figures.blocks_read, "block"));
    } else if (last < figures.timeline.sample_count()) {
      text += format("; the clip is decoded up to there");
    }
  }
  const auto time = [](std::int64_t ns) { return integral_text(static_cast<double>(ns)); };
  const FunctionTexts lines(figures, [&](const PlannedFunction& function) {
    const Interval& live = function.summary.live;
    return format(
        "\n  M{}: {}, {}, {}", function.tag, counted(function.pixel_count, "pixel"),
        live.empty() ? "never live" : format("live {} … {}", time(live.begin_ns), time(live.end_ns)),
        counted(exposed_samples(function, figures.timeline).size(), "sample"));
  });
  text += joined(lines.texts, "");
  if (lines.left_out > 0) text += format("\n  and {} functions more", lines.left_out);
  return text + format("\n  tables of gains: {}; map of functions: {}", bytes_text(figures.table_bytes),
                       bytes_text(figures.map_bytes));
}

Json functions_json(const ExposureFigures& figures) {
  Json functions = Json::array();
  for (const PlannedFunction& function : figures.functions) {
    functions.push_back({{"mask_value", function.tag},
                         {"pixels", function.pixel_count},
                         {"live_start_ns", function.summary.live.begin_ns},
                         {"live_end_ns", function.summary.live.end_ns},
                         {"samples", exposed_samples(function, figures.timeline).size()}});
    if (figures.combine == Combine::integral) functions.back()["still_gain"] = function.summary.still_gain();
  }
  return functions;
}

}  // namespace nutik::app
