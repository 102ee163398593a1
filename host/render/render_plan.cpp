#include "render/render_plan.hpp"

#include <algorithm>
#include <array>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/boundary_table.hpp"
#include "exposure/function_check.hpp"
#include "exposure/mask_check.hpp"

namespace nutik {
namespace {

void check_mask(const Shape& shape, const Mask& mask) {
  if (const std::string mistake = size_mistake(mask, shape); !mistake.empty()) throw InputError(mistake);
}

void check_mapped(const FunctionSet& functions, const std::array<std::uint64_t, kMaskValues>& pixels) {
  std::array<bool, kMaskValues> is_mapped{};
  for (const auto& [tag, function] : functions) is_mapped[tag] = true;
  if (const std::string mistake = unmapped_mistake(pixels, is_mapped); !mistake.empty()) {
    throw InputError(mistake);
  }
}

void warn(RenderPlan& plan, const PlannedFunction& function, bool was_unmapped,
          const std::string& function_name) {
  const std::string name = function_name.empty() ? format("M{}", function.tag) : function_name;
  for (const FunctionFinding& finding :
       check_domain(function.function, function.summary, {.duration_ns = plan.duration_ns})) {
    if (finding.kind == FunctionFinding::Kind::zero_everywhere && was_unmapped) continue;  // as it was asked
    plan.warnings.push_back(format("{}: {}", name, finding.message));
  }
}

SampleRange live_samples(const GainSummary& summary, const Timeline& timeline, const PlanOptions& options) {
  if (options.live_all) return {0, timeline.sample_count()};
  return timeline.samples_reaching(summary.live.begin_ns, summary.live.end_ns);
}

bool is_live(const RenderPlan& plan, const SampleRange& samples) {
  return std::any_of(plan.functions.begin(), plan.functions.end(), [&](const PlannedFunction& function) {
    return function.live.first < samples.last && samples.first < function.live.last;
  });
}

void plan_blocks(RenderPlan& plan, const CaptureSource& source) {
  std::uint64_t row = 0;
  for (std::uint64_t block = 0; block < source.block_count(); ++block) {
    const BlockExtent extent = source.block_extent(block);
    if (!is_live(plan, extent.range())) continue;
    plan.blocks.push_back({block, extent, row});
    row += plan.blocks.back().row_count();
  }
  plan.weights.assign(row * plan.function_count(), 0.0);
  plan.boundaries.assign(row * plan.function_count(), 0.0);
  plan.spans.assign(plan.blocks.size() * plan.function_count(), {});
}

void pack_tables(RenderPlan& plan, const Timeline& timeline) {
  const std::uint64_t count = plan.function_count();
  std::vector<WeightSweep> sweeps;
  sweeps.reserve(count);
  for (const PlannedFunction& function : plan.functions) {
    sweeps.emplace_back(function.function, function.summary, plan.duration_ns);
  }
  std::vector<double> weights, boundaries;
  for (std::size_t b = 0; b < plan.blocks.size(); ++b) {
    const PlannedBlock& block = plan.blocks[b];
    const SampleRange samples = block.extent.range();
    const std::vector<SampleTimes> times = timeline.times(samples);
    for (std::uint64_t f = 0; f < count; ++f) {
      const SampleRange& live = plan.functions[f].live;
      const std::uint64_t first = std::clamp(live.first, samples.first, samples.last);
      const std::uint64_t last = std::clamp(live.last, samples.first, samples.last);
      if (first >= last) continue;
      plan.spans[b * count + f] = {static_cast<std::uint16_t>(first - samples.first),
                                   static_cast<std::uint16_t>(last - samples.first)};
      weights.resize(last - first);
      boundaries.resize(last - first + 1);
      sweeps[f].pack(std::span(times).subspan(first - samples.first, last - first), weights, boundaries);
      // Outside the live samples weights are 0 and boundaries flat.
      for (std::uint64_t k = samples.first; k <= samples.last; ++k) {
        const std::uint64_t at = (block.table_row + k - samples.first) * count + f;
        plan.boundaries[at] = boundaries[std::clamp(k, first, last) - first];
        if (k >= first && k < last) plan.weights[at] = weights[k - first];
      }
    }
  }
}

}  // namespace

std::uint64_t RenderPlan::live_sample_count() const {
  std::uint64_t samples = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    for (std::uint32_t k = 0; k < blocks[b].extent.sample_count; ++k) {
      const auto first = spans.begin() + static_cast<std::ptrdiff_t>(b * function_count());
      samples += std::any_of(first, first + static_cast<std::ptrdiff_t>(function_count()),
                             [&](const SampleSpan& span) { return span.first <= k && k < span.last; });
    }
  }
  return samples;
}

SampleRange needed_samples(const Timeline& timeline, const FunctionSet& functions, const Mask& mask,
                           const PlanOptions& options) {
  const auto pixels = mask.pixels_per_tag();
  SampleRange needed;
  for (const auto& [tag, function] : functions) {
    if (pixels[tag] == 0) continue;
    const GainSummary summary = summarize(function, timeline.duration_ns());
    const SampleRange live = live_samples(summary, timeline, options);
    if (live.empty()) continue;
    needed.first = needed.empty() ? live.first : std::min(needed.first, live.first);
    needed.last = std::max(needed.last, live.last);
  }
  return needed;
}

RenderPlan make_plan(const CaptureSource& source, const FunctionSet& functions, const Mask& mask,
                     const PlanOptions& options) {
  RenderPlan plan;
  plan.capture = source.format();
  if (options.transfer) plan.capture.transfer = *options.transfer;
  const Timeline& timeline = source.timeline();
  plan.duration_ns = timeline.duration_ns();
  check_mask(plan.capture.shape, mask);
  const auto pixels = mask.pixels_per_tag();
  if (!options.unmapped_is_zero) check_mapped(functions, pixels);

  const GainFunction zero({{0, 0.0}});
  std::array<std::uint8_t, kMaskValues> index_of_tag{};
  for (std::uint32_t value = 0; value < kMaskValues; ++value) {
    if (pixels[value] == 0) continue;
    const auto tag = static_cast<std::uint8_t>(value);
    const auto found = functions.find(tag);
    const bool unmapped = found == functions.end();
    PlannedFunction function{tag, unmapped ? zero : found->second, {}, {}, pixels[value]};
    function.summary = summarize(function.function, plan.duration_ns);
    function.live = live_samples(function.summary, timeline, options);
    warn(plan, function, unmapped, options.function_name);
    index_of_tag[value] = static_cast<std::uint8_t>(plan.functions.size());
    plan.functions.push_back(std::move(function));
  }
  plan.function_of_pixel.resize(mask.tags.size());
  std::transform(mask.tags.begin(), mask.tags.end(), plan.function_of_pixel.begin(),
                 [&](std::uint8_t tag) { return index_of_tag[tag]; });
  plan_blocks(plan, source);
  pack_tables(plan, timeline);
  return plan;
}

}  // namespace nutik
