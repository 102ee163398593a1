#include "app/text/timing_text.hpp"

#include <algorithm>

#include "app/text/message_text.hpp"
#include "session/format.hpp"

namespace nutik::app {
namespace {

// Rates from the one to the other are what players show; a clip filmed faster often says one of them.
constexpr double kLowestPlaybackRate = 1.0;
constexpr double kHighestPlaybackRate = 60.0;

enum class About { times, part, colour };

About subject_of(const Fact& fact) {
  switch (fact.setting) {
    case Setting::frame_rate:
    case Setting::shutter_angle: return About::times;
    case Setting::from:
    case Setting::to:
    case Setting::crop:
    case Setting::deflicker:
    case Setting::deinterlace:
    case Setting::scale: return About::part;
    default: return About::colour;
  }
}

// Each fact with who said it, those of one subject.
std::string facts_text(std::span<const Fact> facts, About subject) {
  std::string text;
  for (const Fact& fact : facts) {
    if (subject_of(fact) != subject) continue;
    const std::string who = fact.origin == Origin::file     ? format(" (from {}", fact.source)
                            : fact.origin == Origin::stated ? options_text({fact.setting})
                                                            : std::string(" (assumed");
    text += format("{}{}{}", text.empty() ? "" : ", ", fact.text, who);
    if (fact.origin != Origin::stated) text += format("{}{})", fact.remark.empty() ? "" : ": ", fact.remark);
  }
  return text;
}

}  // namespace

std::string timing_text(std::span<const Fact> facts) { return facts_text(facts, About::times); }

std::vector<std::string> fact_lines(std::span<const Fact> facts) {
  std::vector<std::string> lines{"source: " + timing_text(facts)};
  if (const std::string part = facts_text(facts, About::part); !part.empty())
    lines.push_back("part: " + part);
  std::vector<Setting> assumed;
  for (const Fact& fact : facts) {
    if (fact.origin == Origin::assumed) assumed.push_back(fact.setting);
  }
  if (const std::string colours = facts_text(facts, About::colour); !colours.empty()) {
    const std::string others = options_text(assumed);
    lines.push_back(
        format("colour: {}{}", colours, others.empty() ? "" : "; what is assumed can be stated" + others));
  }
  return lines;
}

std::vector<std::string> note_lines(std::span<const Note> notes, const Timeline& timeline,
                                    const SourceRequest& request) {
  std::vector<std::string> lines;
  for (const Note& note : notes) lines.push_back(note_text(note));
  const double rate = timeline.rate().value();
  const auto is_of_rate = [](const Note& note) {
    return std::ranges::find(note.settings, Setting::frame_rate) != note.settings.end();
  };
  if (!request.clip.rate && std::ranges::none_of(notes, is_of_rate) && rate >= kLowestPlaybackRate &&
      rate <= kHighestPlaybackRate) {
    lines.push_back(format(
        "note: the rate of {} a second comes from the file; slow-motion files state their playback rate: "
        "if it was filmed faster, say so with --fps",
        timeline.rate().text()));
  }
  return lines;
}

}  // namespace nutik::app
