#include "app/output/timing_text.hpp"

#include "capture/format.hpp"
#include "features/schema/option.hpp"

namespace nutik::app {
namespace {

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

}  // namespace

std::string timing_text(std::span<const Fact> facts) { return facts_text(facts, About::times); }

std::vector<std::string> fact_lines(std::span<const Fact> facts) {
  std::vector<std::string> lines;
  if (const std::string times = timing_text(facts); !times.empty()) lines.push_back("source: " + times);
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

}  // namespace nutik::app
