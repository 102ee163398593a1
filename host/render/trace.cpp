#include "render/trace.hpp"

#include <algorithm>
#include <functional>
#include <optional>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "imev/each_block.hpp"
#include "render/value_walk.hpp"

namespace nutik {
namespace {

using Light = std::array<double, 3>;  // by channel

// Light that holds from a sample of a block on.
struct LightRecord {
  std::uint32_t sample = 0;
  Light light{};
};

// Walks along one pixel's light, or a mean of them, which a function of the blocks gives.
using ReadLight = std::function<std::vector<LightRecord>(const BlockView& block)>;

Trace trace(const RenderPlan& plan, CaptureSource& source, std::size_t function, const WantsTiles& wants,
            const ReadLight& read_light) {
  Trace trace;
  trace.channels = plan.capture.shape.channels;
  trace.function = function;
  const GainWalk gain = walk_along(plan.functions[function], plan.duration_ns);
  const auto unscaled = [&](double value) { return std::scalbn(value, gain.exponent()); };
  std::array<ValueWalk, 3> walks;
  BlockCursor cursor(source);
  std::optional<std::uint64_t> block_before;
  for (const PlannedBlock& planned : plan.blocks) {
    // The reference also walks through what other functions need: there it adds zeros, which change no bit.
    if (plan.functions[function].table->span_in(planned.extent).empty()) continue;
    const auto records = read_light(cursor.at(planned.block, wants));
    const std::vector<SampleTimes> times = source.timeline().times(planned.extent.range());
    const bool follows = block_before && *block_before + 1 == planned.block;
    block_before = planned.block;
    const WalkedBlock block{times, follows, times.back().after_ns == plan.duration_ns};
    const std::size_t first_step = trace.steps.size();
    for (std::uint32_t channel = 0; channel < trace.channels; ++channel) {
      ValueWalk& walk = walks[channel];
      std::size_t at = first_step;  // all channels have the same edges
      walk_block(
          walk, gain, gain.piece_at(times.front().before_ns), block, records.size(),
          [&](std::size_t r) { return records[r].sample; },
          [&](std::size_t r) { return records[r].light[channel]; },
          [&](const WalkStep& step) {
            if (at == trace.steps.size()) {
              trace.steps.push_back(
                  {step.begin_ns, step.end_ns, unscaled(step.begin_gain), unscaled(step.end_gain), {}});
            }
            trace.steps[at++].values[channel] = {step.begin_light, step.end_light, unscaled(step.integral),
                                                 unscaled(walk.sum.value())};
          });
    }
  }
  for (std::uint32_t channel = 0; channel < trace.channels; ++channel) {
    trace.light[channel] = exposed_light(walks[channel].sum, gain);
  }
  return trace;
}

// The sum of many pixels' light, each by its weight, sample by sample: where it starts in a block, and by how much it
// changes.
class LightSum {
 public:
  explicit LightSum(const BlockExtent& extent)
      : changes_(extent.sample_count), is_edge_(extent.sample_count) {}

  void add(std::uint32_t sample, std::uint32_t channel, double change) {
    changes_[sample][channel].add(change);
    is_edge_[sample] = true;
  }

  [[nodiscard]] std::vector<LightRecord> mean(double weight) const {
    std::vector<LightRecord> records;
    std::array<CompensatedSum, 3> sums;
    for (std::uint32_t sample = 0; sample < changes_.size(); ++sample) {
      if (!is_edge_[sample]) continue;
      LightRecord record{sample, {}};
      for (std::uint32_t channel = 0; channel < 3; ++channel) {
        sums[channel].add(changes_[sample][channel].value());
        record.light[channel] = sums[channel].value() / weight;
      }
      records.push_back(record);
    }
    return records;
  }

 private:
  std::vector<std::array<CompensatedSum, 3>> changes_;  // at sample 0 all of the light
  std::vector<bool> is_edge_;
};

}  // namespace

std::vector<Trace> trace_pixel(const RenderPlan& plan, CaptureSource& source, std::uint32_t x,
                               std::uint32_t y, const ReportedProgress& progress) {
  const Shape& shape = plan.capture.shape;
  if (x >= shape.width || y >= shape.height) {
    throw UsageError(format("there is no pixel {},{}: the picture has 0,0 … {},{}", x, y, shape.width - 1,
                            shape.height - 1));
  }
  const TileGrid grid(shape);
  const std::uint64_t pixel = std::uint64_t{y} * shape.width + x;
  const std::uint64_t tile = grid.tile_of(x, y);
  const auto wants = [&](std::uint64_t first, std::uint64_t last) { return first <= tile && tile < last; };
  const Share whole{plan.function_of(pixel), kWholeShare};
  const std::span<const Share> several = plan.shares_of(pixel);
  const std::span<const Share> shares = several.empty() ? std::span(&whole, 1) : several;
  std::uint64_t blocks_read = 0;
  std::vector<ChangeRecord> history;
  const auto read = [&](const BlockView& block) {
    if (progress) progress(blocks_read++, plan.blocks.size() * shares.size());
    block.read_history(tile, TileGrid::lane_of(x, y), history);
    std::vector<LightRecord> records;
    for (const ChangeRecord& change : history) {
      LightRecord record{change.sample, {}};
      for (std::uint32_t channel = 0; channel < shape.channels; ++channel) {
        record.light[channel] = light_of_code(plan.capture, change.codes[channel]);
      }
      records.push_back(record);
    }
    return records;
  };
  std::vector<Trace> traces;
  for (const Share& share : shares) {
    traces.push_back(trace(plan, source, share.of, wants, read));
    traces.back().pixel_count = 1;
    traces.back().share = share.size;
  }
  return traces;
}

std::array<double, 3> light_of(std::span<const Trace> traces) {
  if (traces.size() == 1) return traces[0].light;
  std::vector<Share> shares;
  for (const Trace& trace : traces) shares.push_back({0, static_cast<std::uint16_t>(trace.share)});
  std::array<double, 3> light{};
  for (std::size_t channel = 0; channel < light.size(); ++channel) {
    light[channel] = mixed_light(shares, [&](std::size_t i) { return traces[i].light[channel]; });
  }
  return light;
}

Trace trace_region(const RenderPlan& plan, CaptureSource& source, std::uint8_t tag, const ReportedProgress& progress) {
  if (plan.map->has_delays()) {
    throw UsageError(
        "the pixels of a mask value have delays of their own, and no common function; follow one pixel");
  }
  const auto planned = std::ranges::find(plan.functions, tag, &PlannedFunction::tag);
  if (planned == plan.functions.end()) throw UsageError(format("no pixel of the mask has the value {}", tag));
  const auto function = static_cast<std::size_t>(planned - plan.functions.begin());
  const Shape& shape = plan.capture.shape;
  const TileGrid grid(shape);
  const std::vector<double> light_of =
      plan.capture.transfer.light_of_all_codes(plan.capture.white_code, plan.capture.code_bytes);
  // What of a pixel the function exposes.
  const auto weight_of = [&](std::uint64_t pixel) {
    const std::span<const Share> shares = plan.shares_of(pixel);
    if (shares.empty()) return plan.function_of(pixel) == function ? 1.0 : 0.0;
    const auto found = std::ranges::find(shares, function, &Share::of);
    return found == shares.end() ? 0.0 : static_cast<double>(found->size) / kWholeShare;
  };
  CompensatedSum weights;
  std::vector<bool> has_weight(grid.tile_count());
  for (std::uint64_t pixel = 0; pixel < shape.pixel_count(); ++pixel) {
    const double weight = weight_of(pixel);
    weights.add(weight);
    if (weight == 0.0) continue;
    has_weight[grid.tile_of(static_cast<std::uint32_t>(pixel % shape.width),
                            static_cast<std::uint32_t>(pixel / shape.width))] = true;
  }
  const auto wants = [&](std::uint64_t first, std::uint64_t last) {
    while (first < last && !has_weight[first]) ++first;
    return first < last;
  };
  std::uint64_t rows_read = 0;
  std::vector<ChangeRecord> history;
  Trace result = trace(plan, source, function, wants, [&](const BlockView& block) {
    LightSum sum(block.extent());
    for (std::uint64_t pixel = 0; pixel < shape.pixel_count(); ++pixel) {
      if (progress && pixel % shape.width == 0) progress(rows_read++, plan.blocks.size() * shape.height);
      const double weight = weight_of(pixel);
      if (weight == 0.0) continue;
      const auto x = static_cast<std::uint32_t>(pixel % shape.width);
      const auto y = static_cast<std::uint32_t>(pixel / shape.width);
      block.read_history(grid.tile_of(x, y), TileGrid::lane_of(x, y), history);
      for (std::uint32_t channel = 0; channel < shape.channels; ++channel) {
        double before = 0.0;
        for (const ChangeRecord& change : history) {
          const double light = weight * light_of[change.codes[channel]];
          sum.add(change.sample, channel, light - before);
          before = light;
        }
      }
    }
    return sum.mean(weights.value());
  });
  result.pixel_count = planned->pixel_count;
  return result;
}

}  // namespace nutik
