#include "features/solve/wish.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/source_text.hpp"
#include "capture/text.hpp"
#include "exposure/function_numbers.hpp"
#include "session/text/number_text.hpp"

namespace nutik {
namespace {

using Kind = LightWish::Kind;

// Words between blanks; =, <=, >= and * are words without them, too.
std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  bool goes_on = false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const bool is_sign = text[at] == '<' || text[at] == '>' || text[at] == '=' || text[at] == '*';
    if (text[at] == ' ' || text[at] == '\t') {
      goes_on = false;
    } else if (is_sign) {
      words.emplace_back(1, text[at]);
      if (text[at] != '=' && text[at] != '*' && at + 1 < text.size() && text[at + 1] == '=')
        words.back() += text[++at];
      goes_on = false;
    } else {
      if (!goes_on) words.emplace_back();
      words.back() += text[at];
      goes_on = true;
    }
  }
  return words;
}

std::optional<double> number_of(const std::string& word) {
  const ReadNumber<double> read = read_gain(word);
  return read.mistake.empty() ? std::optional(read.value) : std::nullopt;
}

// `M64`, `R1`: the number behind the letter.
std::optional<std::uint8_t> tag_of(const std::string& word, char letter) {
  if (word.size() < 2 || word[0] != letter || word.find_first_not_of("0123456789", 1) != std::string::npos)
    return std::nullopt;
  const ReadNumber<std::uint8_t> read = read_mask_value(std::string_view(word).substr(1));
  if (!read.mistake.empty()) throw UsageError(format("{}: {}", word, read.mistake));
  return read.value;
}

std::optional<Rectangle> rectangle_of(const std::string& word) {
  if (std::ranges::count(word, ',') != 3) return std::nullopt;
  std::array<std::uint32_t, 4> numbers{};
  std::string_view rest = word;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!take_number(rest, numbers[i]) || !(i < 3 ? rest.starts_with(',') : rest.empty())) {
      throw UsageError(
          format("{} is no rectangle; write X,Y,WIDTH,HEIGHT in whole pixels: 500,120,80,60", word));
    }
    rest.remove_prefix(std::min<std::size_t>(1, rest.size()));
  }
  if (numbers[2] == 0 || numbers[3] == 0) throw UsageError(format("the rectangle {} holds no pixel", word));
  return Rectangle{numbers[0], numbers[1], numbers[2], numbers[3]};
}

class WishParser {
 public:
  explicit WishParser(std::string_view text) : words_(words_of(text)) { wish_.text = text; }

  StatedWish parse() {
    const auto region = take_region();
    if (!region) {
      fail_at(
          "where a region should stand: all, M64 for a mask value, R1 for one of a second mask, or "
          "X,Y,WIDTH,HEIGHT");
    }
    wish_.region = *region;
    take_relation();
    if (take("weight")) {
      const auto weight = at_end() ? std::nullopt : number_of(words_[at_]);
      if (!weight || !(*weight > 0.0)) fail_at("where a weight should stand, a number above 0");
      wish_.weight = *weight;
      ++at_;
    }
    if (!at_end()) fail_at("behind the wish; only weight and a number may follow");
    return std::move(wish_);
  }

 private:
  [[nodiscard]] bool at_end() const { return at_ == words_.size(); }
  bool take(std::string_view word) {
    if (at_end() || words_[at_] != word) return false;
    ++at_;
    return true;
  }

  std::optional<LightRegion> take_region() {
    if (at_end()) return std::nullopt;
    LightRegion region;
    if (take("all")) return region;
    const std::string& word = words_[at_];
    region.tag = tag_of(word, 'M');
    if (!region.tag) region.mark = tag_of(word, 'R');
    if (!region.tag && !region.mark) {
      region.within = rectangle_of(word);
      if (!region.within) return std::nullopt;
      ++at_;
      return region;
    }
    ++at_;
    if (take("within")) {
      if (!at_end()) region.within = rectangle_of(words_[at_]);
      if (!region.within) fail_at("where a rectangle should stand: X,Y,WIDTH,HEIGHT");
      ++at_;
    }
    return region;
  }

  void take_relation() {
    if (take("gone")) {
      wish_.kind = Kind::gone;
      wish_.target = StatedWish::Plate{};
      if (!take("at")) return;
      const auto moment = take_moment();
      if (!moment) fail_at("where a time should stand at which nothing is there: 0.1s, 12f, or 0s..0.1s");
      wish_.target = *moment;
      return;
    }
    if (take("=")) {
      wish_.kind = Kind::equal;
    } else if (take("<=")) {
      wish_.kind = Kind::at_most;
    } else if (take(">=")) {
      wish_.kind = Kind::at_least;
    } else if (take("like")) {
      wish_.kind = Kind::like;
    } else {
      fail_at("where =, <=, >=, like or gone should stand");
    }
    take_target();
  }

  void take_target() {
    std::optional<double> number = at_end() ? std::nullopt : number_of(words_[at_]);
    if (number) {
      ++at_;
      if (!take("*")) {
        if (wish_.kind == Kind::like) {
          --at_;
          fail_at("behind like, which compares colours: a number says how bright it is, with =");
        }
        wish_.target = *number;
        return;
      }
      wish_.factor = *number;
    }
    if (take("background") || take("plate")) {
      wish_.target = StatedWish::Plate{};
    } else if (const auto moment = take_moment()) {
      wish_.target = *moment;
    } else if (const auto region = take_region()) {
      wish_.target = *region;
    } else {
      fail_at("where light should stand: a number, background, a time (0.8s, 12f, 0s..0.1s) or another region");
    }
  }

  // A time, or two of them: `0.8s`, `0s..10ms`.
  std::optional<StatedWish::Moment> take_moment() {
    if (at_end()) return std::nullopt;
    const std::string& word = words_[at_];
    const bool begins_like_one = word.find_first_of("0123456789") == 0 && word.find(',') == std::string::npos;
    if (!begins_like_one) return std::nullopt;
    const auto dots = word.find("..");
    StatedWish::Moment moment{StatedTime::parse(word.substr(0, dots), "the time"), std::nullopt};
    if (dots != std::string::npos) moment.to = StatedTime::parse(word.substr(dots + 2), "the time");
    ++at_;
    return moment;
  }

  [[noreturn]] void fail_at(std::string_view why) const {
    throw UsageError(format("{} {}", at_end() ? "its end" : nutik::quoted(words_[at_]), why));
  }

  std::vector<std::string> words_;
  std::size_t at_ = 0;
  StatedWish wish_;
};

}  // namespace

bool StatedWish::has_tag() const {
  const auto* other = std::get_if<LightRegion>(&target);
  return region.tag || (other != nullptr && other->tag);
}

bool StatedWish::has_mark() const {
  const auto* other = std::get_if<LightRegion>(&target);
  return region.mark || (other != nullptr && other->mark);
}

StatedWish StatedWish::parse(std::string_view text) {
  try {
    return WishParser(text).parse();
  } catch (const UsageError& error) {
    throw UsageError(format("the wish {}: {}", nutik::quoted(text), error.what()));
  }
}

StatedFreedom StatedFreedom::parse(std::string_view text, const FunctionTemplate& functions) {
  const auto fail = [&](const std::string& why) {
    throw UsageError(format("the range {}: {}", nutik::quoted(text), why));
  };
  const auto equals = text.find('='), dots = text.find("..", equals == std::string_view::npos ? 0 : equals);
  if (equals == std::string_view::npos || dots == std::string_view::npos) {
    fail("write NAME=FROM..TO, as rest=-100..0 for a gain and when=0.6s..0.8s for a time");
  }
  StatedFreedom freedom;
  freedom.name = text.substr(0, equals);
  const std::string from(text.substr(equals + 1, dots - equals - 1));
  std::string to(text.substr(dots + 2));
  if (std::ranges::count(functions.times, freedom.name) > 0) {
    // The last slash behind a unit: times may be written as fractions, 1/50s.
    const auto unit = to.find_first_not_of("0123456789./-"),
               slash = to.find('/', unit == std::string::npos ? 0 : unit);
    TimeFreedom times;
    if (slash != std::string::npos) {
      times.step = StatedTime::parse(to.substr(slash + 1), format("the step of {}", freedom.name));
      if (times.step->number.numerator <= 0) fail("its step is not above 0");
      if (times.step->counts_samples() && times.step->number.denominator != 1)
        fail("its step is no whole number of pictures");
      to.resize(slash);
    }
    times.from = StatedTime::parse(from, freedom.name);
    times.to = StatedTime::parse(to, freedom.name);
    freedom.range = times;
    return freedom;
  }
  if (std::ranges::count(functions.gains, freedom.name) == 0) {
    std::string known;
    for (const auto* names : {&functions.gains, &functions.times}) {
      for (const std::string& name : *names) known += (known.empty() ? "" : ", ") + name;
    }
    fail(format("no function has the name '{}'; there are {}", printable(freedom.name), known));
  }
  Bounds bounds;
  for (const auto& [word, bound] :
       {std::pair(&from, &bounds.low), std::pair(static_cast<const std::string*>(&to), &bounds.high)}) {
    if (word->empty()) continue;  // none on this side
    const auto number = number_of(*word);
    if (!number)
      fail(format("{} is no gain; bounds are numbers, or nothing: -100..0, 0..", nutik::quoted(*word)));
    *bound = *number;
  }
  if (!(bounds.low <= bounds.high)) fail("FROM must not be above TO");
  freedom.range = bounds;
  return freedom;
}

namespace {

constexpr std::uint64_t kMaxCombinations = 1'000'000;
// Candidates where no step is stated: a picture's time apart, further where that is more than so many of all times
// together.
constexpr std::uint64_t kDefaultCombinations = 20'000;

// From when to when a named time may be.
struct FreeRange {
  std::int64_t from_ns = 0, to_ns = 0;
};

std::uint64_t multiplied(std::uint64_t combinations, std::uint64_t by) {
  if (combinations * by > kMaxCombinations) {
    throw UsageError(
        format("there are more than {} combinations of times to try; take larger steps or narrower ranges",
               kMaxCombinations));
  }
  return combinations * by;
}

const TimeFreedom& freedom_of(const std::string& name, const std::vector<StatedFreedom>& free) {
  const auto found = std::ranges::find(free, name, &StatedFreedom::name);
  if (found == free.end()) {
    throw UsageError(format("{} stands for a time: state from when to when it is to be looked for", name));
  }
  return std::get<TimeFreedom>(found->range);
}

FreeRange range_of(const TimeFreedom& free, const std::string& name, const Timeline& timeline) {
  const FreeRange range{moment_ns(free.from, timeline), moment_ns(free.to, timeline)};
  if (range.from_ns > range.to_ns)
    throw UsageError(format("{}: {} is behind {}", name, free.from.text(), free.to.text()));
  if (range.from_ns < 0 || range.to_ns > timeline.duration_ns()) {
    throw UsageError(format("{}: {} to {} does not lie in the capture, which lasts {}", name,
                            free.from.text(), free.to.text(), duration_text(timeline.duration_ns())));
  }
  return range;
}

std::vector<std::int64_t> stepped(const TimeFreedom& free, const FreeRange& range, const Timeline& timeline) {
  std::vector<std::int64_t> times_ns;
  if (free.step->counts_samples()) {
    const Timeline& pictures = timeline.pictures();
    std::uint64_t picture = sample_at(range.from_ns, pictures);
    if (pictures.start_ns(picture) < range.from_ns) ++picture;
    for (; picture < pictures.sample_count() && pictures.start_ns(picture) <= range.to_ns;
         picture += static_cast<std::uint64_t>(free.step->number.numerator)) {
      times_ns.push_back(pictures.start_ns(picture));
    }
    return times_ns;
  }
  const std::int64_t step_ns = std::max<std::int64_t>(free.step->nanoseconds(), 1);
  static_cast<void>(multiplied(1, static_cast<std::uint64_t>((range.to_ns - range.from_ns) / step_ns)));
  const ExactTime from = exact_time(free.from, "the range", timeline),
                  step = free.step->nanoseconds() > 0 ? exact_time(*free.step, "the step", timeline)
                                                      : ExactTime{1, 1};
  for (int128 k = 0;; ++k) {
    const std::int64_t time_ns = rounded_sum(from, {k * step.numerator, step.denominator});
    if (time_ns > range.to_ns) return times_ns;
    if (times_ns.empty() || time_ns > times_ns.back()) times_ns.push_back(time_ns);
  }
}

}  // namespace

std::vector<CandidateTimes> candidate_times(const FunctionTemplate& functions,
                                            const std::vector<StatedFreedom>& free,
                                            const Timeline& timeline) {
  std::vector<CandidateTimes> candidates;
  std::uint64_t combinations = 1;
  std::vector<std::size_t> unstepped;
  for (const std::string& name : functions.times) {
    const TimeFreedom& its = freedom_of(name, free);
    const FreeRange range = range_of(its, name, timeline);
    CandidateTimes& each = candidates.emplace_back();
    if (its.step) {
      each.times_ns = stepped(its, range, timeline);
      if (each.times_ns.empty()) {
        throw UsageError(format("{} has no time from {} to {} in steps of {}", name, its.from.text(), its.to.text(),
                                its.step->text()));
      }
      combinations = multiplied(combinations, each.times_ns.size());
    } else {
      unstepped.push_back(candidates.size() - 1);
      each.times_ns = {range.from_ns, range.to_ns};
    }
  }
  // Evenly many of each, a picture's time apart at the closest.
  const auto share = static_cast<double>(std::max<std::uint64_t>(kDefaultCombinations / combinations, 2));
  for (const std::size_t at : unstepped) {
    CandidateTimes& each = candidates[at];
    const std::int64_t from_ns = each.times_ns.front(), span_ns = each.times_ns.back() - from_ns;
    const auto most = static_cast<std::int64_t>(std::pow(share, 1.0 / static_cast<double>(unstepped.size())));
    const std::int64_t period_ns = std::max<std::int64_t>(
        timeline.duration_ns() / static_cast<std::int64_t>(timeline.sample_count()), 1);
    const std::int64_t steps =
        std::clamp<std::int64_t>(span_ns / period_ns, 1, std::max<std::int64_t>(most - 1, 1));
    each.times_ns.clear();
    for (std::int64_t i = 0; i <= steps; ++i)
      each.times_ns.push_back(from_ns + static_cast<std::int64_t>(static_cast<int128>(span_ns) * i / steps));
    each.times_ns.erase(std::unique(each.times_ns.begin(), each.times_ns.end()), each.times_ns.end());
    each.step_ns = std::max<std::int64_t>(span_ns / steps, 1);
    combinations = multiplied(combinations, each.times_ns.size());
  }
  return candidates;
}

}  // namespace nutik
