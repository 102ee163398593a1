// The plan of an exposure: what will be touched, with which weights, decided before anything is read.
//
//   in:      a capture, gain functions by mask value, a mask
//   out:     the functions that the mask uses, with their tables and live samples, and the blocks those lie in
//   always:  only what a function that the mask uses needs is planned. Tables and the mask's map are shared: copying a
//            plan copies none of them, and whoever makes plans one after another keeps what they have in common
//            (plan_cache.hpp)
//
// Renderer and reference follow the same plan; the reference reads the functions, not the tables.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "capture/timeline.hpp"
#include "exposure/gain_function.hpp"
#include "exposure/mask.hpp"
#include "imev/capture_source.hpp"
#include "render/gain_table.hpp"
#include "render/mask_map.hpp"

namespace nutik {

using FunctionSet = std::map<std::uint8_t, GainFunction>;  // by mask value

// What becomes of a pixel's light while its function is not 0: its integral, or of its samples, each times its largest
// gain, the lightest, the darkest or the middle one (render/combining_renderer.hpp).
enum class Combine { integral, lighten, darken, median };

struct PlanOptions {
  bool unmapped_is_zero = false;  // mask values without a function expose to 0 instead of being an error
  bool live_all = false;          // visit every sample, also where all gains are 0
  std::optional<Transfer> transfer = std::nullopt;  // instead of the capture's own
  std::string function_name = {};                   // in warnings, where it is not a mask value's; empty: M0, M1, …

  Combine combine = Combine::integral;

  // By how much each pixel's function comes later; null: by nothing (docs/explanation/model.md, "Time maps").
  std::shared_ptr<const DelayMap> delays = nullptr;

  friend bool operator==(const PlanOptions&, const PlanOptions&) = default;
};

struct PlannedFunction {
  std::uint8_t tag;
  GainFunction function;
  GainSummary summary;
  SampleRange live;           // samples whose reach meets the live interval
  std::uint64_t pixel_count;  // of the mask, that it has a share of
  std::shared_ptr<const GainTable> table;

  // With a delay map: by how much this region is exposed later. `function` is not shifted; `summary` and `table` are. D
  // is that of the whole function, also where the capture's end cuts it (exposure/gain_function.hpp).
  bool is_delayed = false;
  std::int64_t delay_ns = 0;
};

// S, the most light that a function makes of white: ∫|g| / D; where samples are combined the largest of its gains.
[[nodiscard]] double error_scale(const PlannedFunction& function, Combine combine);

struct PlannedBlock {
  std::uint64_t block;  // in the capture
  BlockExtent extent;
  std::uint64_t table_row;  // of its first sample, in tables of the planned blocks

  // Rows of the tables: one for each sample and one more (exposure/weight_integrator.hpp).
  [[nodiscard]] std::uint64_t row_count() const { return std::uint64_t{extent.sample_count} + 1; }
};

struct RenderPlan {
  CaptureFormat capture;
  std::int64_t duration_ns = 0;
  std::shared_ptr<const CaptureLayout> layout;
  std::vector<PlannedFunction> functions;  // one for each of the map's regions, by the same index
  std::shared_ptr<const MaskMap> map;
  std::vector<PlannedBlock> blocks;   // in time order
  std::vector<std::string> warnings;  // whole sentences

  Combine combine = Combine::integral;

  // Kernels add up light · ns of this much of its blocks, all steady: what exposures of other gains have in common.
  std::optional<Halves> sums_light;

  [[nodiscard]] std::uint64_t function_count() const { return functions.size(); }
  // Index into functions, which is its region's; of a mixed pixel the one with the largest share.
  [[nodiscard]] std::uint16_t function_of(std::uint64_t pixel) const { return map->region_at(pixel); }
  // The functions of a mixed pixel with their shares; none where it has one function alone.
  [[nodiscard]] std::span<const Share> shares_of(std::uint64_t pixel) const { return map->mixed.of(pixel); }
  // S of a pixel's function; of a mixed pixel its shares of those of its functions.
  [[nodiscard]] double error_scale(std::uint64_t pixel) const;
  // Rows of the tables of all functions for the planned blocks.
  [[nodiscard]] std::uint64_t row_count() const;
  // Whether some function's gain is steady over a bundle of blocks.
  [[nodiscard]] bool has_bundles() const;
  // Whether some function corrects samples of a block that counts as steady; whether any does of any block.
  [[nodiscard]] bool is_corrected(const PlannedBlock& planned) const;
  [[nodiscard]] bool has_corrected() const;
  // The samples that some function exposes.
  [[nodiscard]] std::uint64_t exposed_sample_count() const;
};

// The samples that a function exposes for longer than by a step of 1 ns at an end of it (meant_interval()): of those
// that it needs all but one or two.
[[nodiscard]] SampleRange exposed_samples(const PlannedFunction& planned, const Timeline& timeline);

// Measures the tables of all functions (GainTable::course), several at a time. Throws Cancelled at a stop.
void measure_tables(const RenderPlan& plan, const std::stop_token& stop = {});

// The samples that an exposure of these functions through this mask needs, as one range: what has to be
// read of a capture that can only be read from its start.
[[nodiscard]] SampleRange needed_samples(const Timeline& timeline, const FunctionSet& functions,
                                         const Mask& mask, const PlanOptions& options);

// What an empty PlanCache makes. Throws InputError where the mask has another size than the capture, or mask values
// have no function (listing the values and how many pixels each has).
[[nodiscard]] RenderPlan make_plan(const CaptureSource& source, const FunctionSet& functions,
                                   const Mask& mask, const PlanOptions& options);

}  // namespace nutik
