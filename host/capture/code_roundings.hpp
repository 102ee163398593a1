// What codes of a capture were rounded by where they were made here, and not by a camera.
#pragma once

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik {

// Among what has no bound: YUV whose pixels share chroma became RGB.
inline constexpr std::string_view kSharedChroma = "chroma";
// Captures of earlier programs do not tell all that was rounded.
inline constexpr std::string_view kUnknown = "unknown";

struct CodeRoundings {
  double codes = 0.0;  // no code is further off by all of them that have a bound, one after another
  // What has none, by names that scripts know (docs/explanation/uncertainty.md).
  std::vector<std::string> unbounded = {};

  // Codes were made of others: differences became up to `steeper` times as large, and codes were rounded.
  void add(double rounded = 0.5, double steeper = 1.0, std::string_view without_bound = {}) {
    codes = codes * steeper + rounded;
    if (!without_bound.empty() && std::ranges::count(unbounded, without_bound) == 0)
      unbounded.emplace_back(without_bound);
  }

  // Some codes were made by these, some by others.
  void take_worst(const CodeRoundings& others) {
    codes = std::max(codes, others.codes);
    for (const std::string& name : others.unbounded) add(0.0, 1.0, name);
  }

  [[nodiscard]] bool are_none() const { return codes == 0.0; }
  [[nodiscard]] bool are_known() const { return std::ranges::count(unbounded, kUnknown) == 0; }

  // `0.525000 interpolation deflicker`, rounded up.
  [[nodiscard]] std::string text() const {
    std::string text = format("{:.6f}", codes + 5e-7);
    for (const std::string& name : unbounded) text += " " + name;
    return text;
  }
  // Captures had `1` before: light that was rounded once, and perhaps more. Throws UsageError.
  [[nodiscard]] static CodeRoundings parse(std::string_view text) {
    constexpr std::size_t kLongest = 256;
    CodeRoundings roundings;
    if (text == "1") return {0.5, {std::string(kUnknown)}};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), roundings.codes);
    const bool is_whole = error == std::errc() && (end == text.data() + text.size() || *end == ' ');
    if (!is_whole || text.size() > kLongest || !(roundings.codes >= 0.0 && roundings.codes <= 65'535.0))
      throw UsageError("what it says of its roundings is damaged");
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    while (!text.empty()) {
      const std::string_view word = text.substr(0, text.find(' '));
      roundings.add(0.0, 1.0, word);
      text.remove_prefix(std::min(word.size() + 1, text.size()));
    }
    return roundings;
  }

  friend bool operator==(const CodeRoundings&, const CodeRoundings&) = default;
};

}  // namespace nutik
