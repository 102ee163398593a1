// What the sums of one function can come to over a capture: what error bounds and the scales of whole numbers are
// made of. It depends on the function's table alone.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exposure/compensated_sum.hpp"
#include "render/gain_table.hpp"
#include "render/precision.hpp"

namespace nutik {

inline constexpr double kRoundoff32 = 0x1p-24;

// An error that grows with the light: at most constant + slope · light.
struct LightLine {
  double constant = 0.0;
  double slope = 0.0;
};

// Sums are of light · weight, over all light in [0, 1].
struct FunctionCourse {
  double magnitude = 0.0;              // Σ|w|
  double extent = 0.0;                 // the largest that the whole sum can be
  double partial_sums = 0.0;           // Σ over samples but a block's first: the same of its sum up to them
  double block_sums = 0.0;             // Σ over blocks but the first: the same of all up to their ends
  double boundaries = 0.0;             // Σ|B|
  double longest_block = 0.0;          // in live samples
  double block_count = 0.0;            // with live samples
  double sample_count = 0.0;           // live
  std::uint64_t weight_count = 0;      // that are not 0
  double compensated_magnitude = 0.0;  // Σ|w|, without the error of a running sum
  double steady_magnitude = 0.0;       // Σ|w| of steady blocks
  double corrected_magnitude = 0.0;    // Σ|w| of steady blocks with corrected samples, and of corrections

  // Σ of what the kernel's table misses of each boundary.
  [[nodiscard]] double boundary_errors(Precision precision) const;

  double single_boundary_errors = 0.0;
  double pair_boundary_errors = 0.0;

  // What partial sums within blocks and boundaries cost in single, by the light that the function makes of them. Each
  // line holds by itself. None where some weight is below 0.
  std::vector<LightLine> single_lines;
  double overshoot = 0.0;  // Σ|w| of what corrections take away again, and of these
};

// Goes through a table, block by block in time order.
class CourseMeter {
 public:
  void add(const BlockTable& table, const SteadyGain& steady) { add(table, steady, table.weights); }
  // A block with corrected samples: what its steady gain makes of all samples, and after that the correction.
  void add_corrected(const BlockTable& table, const SteadyGain& steady, const HatNumbers& hats);
  [[nodiscard]] FunctionCourse course() const;

 private:
  // Between what a sum can lie for light in [0, 1]: -below … above.
  struct Extent {
    double above = 0.0;
    double below = 0.0;

    void add(double weight);
    [[nodiscard]] double largest() const;
  };

  // Samples that err by like multiples of their own share of the light.
  struct LikeSamples {
    double slope = 0.0;  // the largest of these multiples
    double error = 0.0;
    double weight = 0.0;
  };

  // `own` is what the samples' light adds to the function's.
  void add(const BlockTable& table, const SteadyGain& steady, std::span<const double> own);
  void add_single(double error, double own_weight);
  [[nodiscard]] std::vector<LightLine> single_lines() const;

  std::array<LikeSamples, 64> like_samples_ = {};
  bool has_negative_ = false;
  FunctionCourse course_;
  Extent capture_;
  CompensatedSum magnitude_;
};

}  // namespace nutik
