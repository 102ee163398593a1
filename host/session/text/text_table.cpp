#include "session/text/text_table.hpp"

#include <algorithm>
#include <numeric>

#include "capture/format.hpp"

namespace nutik {
namespace {

// Letters to insert, delete, change or swap with their neighbour (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), now(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = a[i - 1] == b[j - 1] ? 0 : 1;
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        now[j] = std::min(now[j], before_last[j - 2] + 1);
      }
    }
    std::swap(before_last, last);
    std::swap(last, now);
  }
  return last[b.size()];
}

// What the word is the beginning of, where that says something: not too little, not too many.
std::vector<std::string> starting_with(std::string_view word, std::span<const std::string> known) {
  constexpr std::size_t kFewest = 2;  // letters
  constexpr std::size_t kMax = 4;
  std::vector<std::string> found;
  if (word.size() - std::min(word.find_first_not_of('-'), word.size()) < kFewest) return found;
  for (const std::string& candidate : known) {
    if (candidate.starts_with(word) && std::ranges::find(found, candidate) == found.end())
      found.push_back(candidate);
  }
  if (found.size() > kMax) found.clear();
  return found;
}

// `--fps-out` and `--out-fps`.
bool has_same_parts(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  std::vector<std::string> of_a = parts_of(a, '-'), of_b = parts_of(b, '-');
  std::ranges::sort(of_a);
  std::ranges::sort(of_b);
  return of_a == of_b;
}

}  // namespace

std::size_t columns(std::string_view text) {
  std::size_t count = 0;
  for (const char c : text) count += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  return count;
}

std::string did_you_mean(std::string_view word, std::span<const std::string> known) {
  constexpr std::size_t kLongest = 100;  // characters; what is longer was not mistyped
  if (word.size() > kLongest) return {};
  std::vector<std::string> meant = starting_with(word, known);
  if (meant.empty()) {
    const std::string* nearest = nullptr;
    std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
    for (const std::string& candidate : known) {
      std::size_t distance = has_same_parts(word, candidate) ? 0 : edit_distance(word, candidate);
      if (word.starts_with(candidate + "-")) distance = std::min<std::size_t>(distance, 2);  // `prores-hq` for `prores`
      if (distance >= least) continue;
      least = distance;
      nearest = &candidate;
    }
    if (nearest == nullptr) return {};
    meant.push_back(*nearest);
  }
  return format("; did you mean {}?", alternatives(meant));
}

std::string table_text(const std::vector<std::vector<std::string>>& rows, std::string_view alignment) {
  constexpr std::string_view kBetween = "  ";
  std::vector<std::size_t> widths(alignment.size());
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < widths.size(); ++i) widths[i] = std::max(widths[i], columns(row[i]));
  }
  std::vector<std::string> lines;
  for (const auto& row : rows) {
    std::string& line = lines.emplace_back();
    for (std::size_t i = 0; i < widths.size(); ++i) {
      const std::string blanks(widths[i] - columns(row[i]), ' ');
      line += (i == 0 ? "" : kBetween);
      line += alignment[i] == 'r' ? blanks + row[i] : row[i] + blanks;
    }
    line.erase(line.find_last_not_of(' ') + 1);
  }
  return joined(lines, "\n");
}

}  // namespace nutik
