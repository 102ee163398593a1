#include "session/requests/frame_ranges.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik {
namespace {

constexpr std::size_t kMaxDigits = 12;

// Digits at the start of a text, which loses them.
std::optional<std::uint64_t> take_number(std::string_view& text) {
  const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
  if (digits == 0 || digits > kMaxDigits) return std::nullopt;
  std::uint64_t number = 0;
  for (const char c : text.substr(0, digits)) number = number * 10 + static_cast<std::uint64_t>(c - '0');
  text.remove_prefix(digits);
  return number;
}

}  // namespace

FrameRanges FrameRanges::parse(std::string_view text, std::string_view what) {
  const auto fail = [&] [[noreturn]] (std::string_view part) {
    throw UsageError(format("{} '{}': '{}' is no range of frames; write numbers from 0 on: 7, 1-100, 1-100x2 for "
                            "every second, several with commas between",
                            what, text, part));
  };
  FrameRanges ranges;
  ranges.text_ = text;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find_first_of(", ", begin), text.size());
    const std::string_view part = text.substr(begin, end - begin);
    begin = end + 1;
    if (part.empty()) continue;
    std::string_view rest = part;
    const auto first = take_number(rest);
    if (!first) fail(part);
    Range range{*first, *first, *first, 1, false};
    if (rest.starts_with('-')) {
      rest.remove_prefix(1);
      const auto last = take_number(rest);
      if (!last) fail(part);
      range.least = std::min(*first, *last);
      range.most = std::max(*first, *last);
      if (!rest.empty()) {
        const char kind = rest.front();
        rest.remove_prefix(1);
        const auto step = take_number(rest);
        if (!step || *step == 0 || (kind != 'x' && kind != 'y' && kind != ':')) fail(part);
        if (kind != ':') range.step = *step;
        range.leaves_out = kind == 'y';
      }
    }
    if (!rest.empty()) fail(part);
    ranges.ranges_.push_back(range);
  }
  if (ranges.ranges_.empty()) fail(text);
  return ranges;
}

std::vector<std::uint64_t> FrameRanges::below(std::uint64_t count) const {
  std::vector<std::uint64_t> numbers;
  for (const Range& range : ranges_) {
    for (std::uint64_t k = range.least; k <= range.most && k < count; ++k) {
      const std::uint64_t apart = k < range.from ? range.from - k : k - range.from;
      if ((apart % range.step == 0) != range.leaves_out) numbers.push_back(k);
    }
  }
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

std::vector<std::uint64_t> chosen_numbers(const std::optional<FrameRanges>& ranges, std::uint64_t count,
                                          std::string_view what, std::string_view whole) {
  if (!ranges) {
    std::vector<std::uint64_t> all(count);
    std::iota(all.begin(), all.end(), std::uint64_t{0});
    return all;
  }
  std::vector<std::uint64_t> numbers = ranges->below(count);
  if (!numbers.empty()) return numbers;
  throw UsageError(format("none of the {} {} is there: the {} has {}, numbered from 0 to {}", what, ranges->text(),
                          whole, count, count - 1));
}

std::string ranges_text(std::span<const std::uint64_t> numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    text += format("{}{}", text.empty() ? "" : ", ", numbers[i]);
    if (last > i) text += format("-{}", numbers[last]);
    i = last + 1;
  }
  return text;
}

}  // namespace nutik
