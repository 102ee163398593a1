// The plan of an exposure: what will be touched, with which weights, decided before anything is read.
//
//   in:      a capture, gain functions by mask value, a mask
//   out:     the functions that the mask uses, their live samples, the blocks those lie in, and per block
//            the packed boundary tables
//   always:  only what a function that the mask uses needs is planned
//
// Renderer and reference follow the same plan; the reference reads the functions, not the tables.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "capture/timeline.hpp"
#include "exposure/gain_function.hpp"
#include "exposure/mask.hpp"
#include "imev/capture_source.hpp"

namespace nutik {

using FunctionSet = std::map<std::uint8_t, GainFunction>;  // by mask value

struct PlanOptions {
  bool unmapped_is_zero = false;     // mask values without a function expose to 0 instead of being an error
  bool live_all = false;             // visit every sample, also where all gains are 0
  std::optional<Transfer> transfer;  // instead of the capture's own
  std::string function_name;         // in warnings, where it is not a mask value's; empty: M0, M1, …
};

struct PlannedFunction {
  std::uint8_t tag;
  GainFunction function;
  GainSummary summary;
  SampleRange live;           // samples whose reach meets the live interval
  std::uint64_t pixel_count;  // of the mask
};

// Samples of a block, from its first on: [first, last).
struct SampleSpan {
  std::uint16_t first = 0;
  std::uint16_t last = 0;
};
static_assert(sizeof(SampleSpan) == 4);

struct PlannedBlock {
  std::uint64_t block;  // in the capture
  BlockExtent extent;
  std::uint64_t table_row;  // of its first sample in the tables

  // Of the tables.
  [[nodiscard]] std::uint64_t row_count() const { return std::uint64_t{extent.sample_count} + 1; }
};

struct RenderPlan {
  CaptureFormat capture;
  std::int64_t duration_ns = 0;
  std::vector<PlannedFunction> functions;       // by increasing tag; at most 256
  std::vector<std::uint8_t> function_of_pixel;  // index into functions, row by row
  std::vector<PlannedBlock> blocks;             // in time order

  // [row][function]: a block has a row for each of its samples and one more. See boundary_table.hpp.
  std::vector<double> weights;
  std::vector<double> boundaries;
  // [planned block][function]: which of the block's samples have a weight that may not be 0.
  std::vector<SampleSpan> spans;

  std::vector<std::string> warnings;  // whole sentences

  [[nodiscard]] std::uint64_t function_count() const { return functions.size(); }
  // The samples that some function needs.
  [[nodiscard]] std::uint64_t live_sample_count() const;
};

// The samples that an exposure of these functions through this mask needs, as one range: what has to be
// read of a capture that can only be read from its start.
[[nodiscard]] SampleRange needed_samples(const Timeline& timeline, const FunctionSet& functions,
                                         const Mask& mask, const PlanOptions& options);

// Throws InputError where the mask has another size than the capture, or mask values have no function
// (listing the values and how many pixels each has).
[[nodiscard]] RenderPlan make_plan(const CaptureSource& source, const FunctionSet& functions,
                                   const Mask& mask, const PlanOptions& options);

}  // namespace nutik
