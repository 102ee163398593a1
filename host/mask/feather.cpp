#include "mask/feather.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <mutex>
#include <set>
#include <utility>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/source_text.hpp"
#include "capture/text.hpp"
#include "mask/whole_shares.hpp"
#include "system/interruption.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

// The kernel of an edge that reaches r pixels is a tent along rows times one along columns: r + 1 − |i| at distance i.
class Tent {
 public:
  explicit Tent(std::int32_t reach) : reach_(reach) {
    for (std::int32_t weight = reach + 100; weight > 0; weight -= 100) weights_.push_back(weight);
  }
  // Whole pixels that it reaches to either side.
  [[nodiscard]] std::int64_t pixels() const { return static_cast<std::int64_t>(weights_.size()) - 1; }
  [[nodiscard]] std::int64_t weight(std::int64_t distance) const {
    return weights_[static_cast<std::size_t>(std::abs(distance))];
  }
  [[nodiscard]] std::int32_t reach() const { return reach_; }

 private:
  std::int32_t reach_;
  std::vector<std::int64_t> weights_;
};

// How much of a column, or of all round a pixel, has each tag.
using TagWeights = std::vector<std::pair<std::uint8_t, std::int64_t>>;

// Adds them up.
class WeightSums {
 public:
  void add(std::uint8_t tag, std::int64_t weight) {
    if (sums_[tag] == 0) seen_.emplace_back(tag, 0);
    sums_[tag] += weight;
  }
  // The sums, and begins anew.
  TagWeights take() {
    for (auto& [tag, weight] : seen_) weight = std::exchange(sums_[tag], 0);
    return std::exchange(seen_, {});
  }

 private:
  std::array<std::int64_t, kMaskValues> sums_{};
  TagWeights seen_;  // whose sums are not 0
};

// A row of pixels under one kernel.
class RowUnderTent {
 public:
  RowUnderTent(const Mask& mask, const Tent& tent, std::int64_t y) : tent_(tent), columns_(mask.width) {
    const std::int64_t first = std::max<std::int64_t>(0, y - tent.pixels());
    const std::int64_t last = std::min<std::int64_t>(mask.height - 1, y + tent.pixels());
    WeightSums sums;
    for (std::size_t x = 0; x < columns_.size(); ++x) {
      const std::uint8_t* tags = mask.tags.data() + x;
      for (std::int64_t row = first; row <= last; ++row) sums.add(tags[row * mask.width], tent.weight(row - y));
      columns_[x] = sums.take();
    }
    // How many columns up to each, itself included, have nothing but its tag.
    for (std::size_t x = 0; x < columns_.size(); ++x) {
      const bool goes_on = x > 0 && columns_[x].size() == 1 && columns_[x - 1].size() == 1 &&
                           columns_[x][0].first == columns_[x - 1][0].first;
      uniform_.push_back(columns_[x].size() > 1 ? 0 : goes_on ? uniform_[x - 1] + 1 : 1);
    }
  }

  [[nodiscard]] bool is_uniform(std::int64_t x) const {
    const auto [first, last] = window(x);
    return uniform_[static_cast<std::size_t>(last)] >= last - first + 1;
  }

  // 1_m ∗ K for every tag m.
  [[nodiscard]] TagWeights at(std::int64_t x) const {
    WeightSums sums;
    const auto [first, last] = window(x);
    for (std::int64_t column = first; column <= last; ++column) {
      for (const auto& [tag, weight] : columns_[static_cast<std::size_t>(column)]) {
        sums.add(tag, weight * tent_.weight(column - x));
      }
    }
    return sums.take();
  }

 private:
  [[nodiscard]] std::pair<std::int64_t, std::int64_t> window(std::int64_t x) const {
    return {std::max<std::int64_t>(0, x - tent_.pixels()),
            std::min(static_cast<std::int64_t>(columns_.size()) - 1, x + tent_.pixels())};
  }

  const Tent& tent_;
  std::vector<TagWeights> columns_;
  std::vector<std::int64_t> uniform_;
};

// Shares out among the tags of an edge what they have together so far, in proportion to `weights`.
void share_out(const TagWeights& weights, const std::function<bool(std::uint8_t)>& takes_part,
               std::array<double, kMaskValues>& shares) {
  double together = 0.0, all = 0.0;
  for (std::size_t tag = 0; tag < kMaskValues; ++tag) {
    if (takes_part(static_cast<std::uint8_t>(tag))) together += shares[tag];
  }
  for (const auto& [tag, weight] : weights) {
    if (takes_part(tag)) all += static_cast<double>(weight);
  }
  if (all == 0.0) return;  // none of them is near: they keep what a wider edge gave them
  for (std::size_t tag = 0; tag < kMaskValues; ++tag) {
    if (takes_part(static_cast<std::uint8_t>(tag))) shares[tag] = 0.0;
  }
  for (const auto& [tag, weight] : weights) {
    if (takes_part(tag)) shares[tag] = together * static_cast<double>(weight) / all;
  }
}

// The pixels of a row that are mixed.
using MixedRow = std::vector<std::pair<std::uint64_t, std::vector<Share>>>;

MixedRow feathered_row(const Mask& mask, const Feather& feather, const std::vector<Tent>& tents,
                       std::int64_t y, const std::function<void()>& ask) {
  std::vector<RowUnderTent> rows;
  rows.reserve(tents.size());
  for (const Tent& tent : tents) rows.emplace_back(mask, tent, y);
  MixedRow mixed;
  for (std::int64_t x = 0; x < mask.width; ++x) {
    if (x % 64 == 0) ask();
    if (rows.front().is_uniform(x)) continue;  // of the widest kernel
    std::array<double, kMaskValues> shares{};
    shares[mask.tags[static_cast<std::size_t>(y * mask.width + x)]] = 1.0;
    for (std::size_t i = 0; i < tents.size(); ++i) {
      const TagWeights weights = rows[i].at(x);
      share_out(
          weights, [&](std::uint8_t tag) { return feather.of(tag) <= tents[i].reach(); }, shares);
    }
    mixed.emplace_back(static_cast<std::uint64_t>(y * mask.width + x), whole_shares(shares));
  }
  return mixed;
}

std::int32_t parse_reach(std::string_view text, const std::string& all) {
  const std::string_view number = text.ends_with("px") ? text.substr(0, text.size() - 2) : std::string_view();
  const std::size_t point = number.find('.');
  const std::string_view decimals = point == number.npos ? "0" : number.substr(point + 1);
  const auto whole = parsed<std::uint64_t>(number.substr(0, point));
  const auto part = parsed<std::uint32_t>(decimals);
  if (!whole || !part || decimals.size() > 2) {
    throw UsageError(
        format("the feather {} is no width of an edge; write how far edges reach in pixels, with two "
               "decimals at most: "
               "6px, 2.5px; of one mask value M255=6px, of several 2px,M255=6px",
               quoted(all)));
  }
  const std::uint64_t most = Feather::kMaxCentipixels;
  const std::uint64_t hundredths = 100 * std::min(*whole, most) + (decimals.size() == 1 ? 10 * *part : *part);
  if (hundredths > most) {
    throw UsageError(
        format("the feather {} reaches too far; at most {} pixels", quoted(all), Feather::kMaxCentipixels / 100));
  }
  return static_cast<std::int32_t>(hundredths);
}

}  // namespace

Feather Feather::parse(const std::string& text) {
  Feather feather;
  bool has_all = false;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    const std::string part = text.substr(from, comma - from);
    from = comma + 1;
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos) {
      if (has_all)
        throw UsageError(format("the feather {} says twice how far all edges reach", quoted(text)));
      has_all = true;
      feather.everywhere_centipixels = parse_reach(part, text);
      continue;
    }
    std::string_view tag = std::string_view(part).substr(0, equals);
    if (tag.starts_with('M') || tag.starts_with('m')) tag.remove_prefix(1);
    const auto value = parsed<std::uint8_t>(tag);
    if (!value || tag.size() > 3)
      throw UsageError(format("the feather {} names no mask value: M0=6px … M255=6px", quoted(text)));
    const std::int32_t reach = parse_reach(std::string_view(part).substr(equals + 1), text);
    if (!feather.of_tag.emplace(*value, reach).second)
      throw UsageError(format("the feather {} names M{} twice", quoted(text), *value));
  }
  return feather;
}

// From the widest edge to the narrowest: those that reach as far, or less, share out anew what they have together. So
// an edge between two tags is as wide as the wider of theirs.
Mask feathered(const Mask& mask, const Feather& feather, const ReportedProgress& progress) {
  std::set<std::int32_t, std::greater<>> reaches;
  const auto counts = mask.pixels_per_tag();
  for (const auto& [tag, reach] : feather.of_tag) {
    if (counts[tag] == 0)
      throw UsageError(format("no pixel of the mask has the value {}, which has a feather", tag));
  }
  for (std::size_t tag = 0; tag < kMaskValues; ++tag) {
    if (counts[tag] > 0) reaches.insert(feather.of(static_cast<std::uint8_t>(tag)));
  }
  std::vector<Tent> tents;
  tents.reserve(reaches.size());
  for (const std::int32_t reach : reaches) tents.emplace_back(reach);
  std::vector<MixedRow> rows(mask.height);
  std::mutex telling;
  std::uint64_t done = 0;
  const auto tell = [&](std::uint64_t rows_more) {
    check_interruption();
    const std::lock_guard lock(telling);
    if (progress) progress(std::exchange(done, done + rows_more), 2 * std::uint64_t{mask.height});
  };
  parallel_for(mask.height, [&](std::uint64_t y) {
    tell(1);
    rows[y] = feathered_row(mask, feather, tents, static_cast<std::int64_t>(y), [&] { tell(0); });
  });
  Mask soft{mask.width, mask.height, mask.tags, {}};
  for (const MixedRow& row : rows) {
    tell(1);
    for (const auto& [pixel, shares] : row) put_shares(soft, pixel, shares);
  }
  return soft;
}

}  // namespace nutik
