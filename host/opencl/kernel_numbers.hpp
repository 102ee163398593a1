// What the kernels read and write beside the capture, in the arithmetic of a precision: the host's side of
// kernels/floating.clh, compensated.clh and fixed.clh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "opencl/kernel_layout.hpp"
#include "opencl/light_source.hpp"
#include "render/code_scale.hpp"
#include "render/fixed_scale.hpp"
#include "render/output_format.hpp"
#include "render/precision.hpp"

namespace nutik {

using Bytes = std::vector<std::byte>;

// A pixel's sum in one channel, all its planes.
inline constexpr std::size_t sum_bytes(Precision precision) { return precision == Precision::single_ ? 4 : 8; }

// One weight or boundary: as wide as the sums that it goes into.
inline constexpr std::size_t weight_bytes(Precision precision) { return sum_bytes(precision); }

// A number as two floats, and numbers as an arithmetic in floating point holds them (doubles if it is of whole ones).
[[nodiscard]] FloatPair pair_of(double number);
[[nodiscard]] inline double value_of(const FloatPair& pair) { return static_cast<double>(pair.high) + pair.low; }
[[nodiscard]] Bytes numbers_of(std::span<const double> values, Precision precision);

// Light of every code, or a curve. `white_light` is FixedScale's, for whole numbers.
[[nodiscard]] Bytes light_values(const LightSource& light, Precision precision, std::uint64_t white_light);

// What brings sums onto the scale of the thresholds: LightScale [function].
[[nodiscard]] Bytes light_scales(const RenderPlan& plan, Precision precision);

// The same where lights are blended, and by how many bits to the left that scale is brought onto the thresholds'.
[[nodiscard]] Bytes blend_scales(const RenderPlan& plan, Precision precision);
[[nodiscard]] std::uint32_t blend_shift(const RenderPlan& plan, Precision precision);

// By function, how the host brings its sums to light: light = sum · factor · first · second.
struct LightFactors {
  double factor;
  LightScale<double> exponent;
};
[[nodiscard]] std::vector<LightFactors> light_factors(const RenderPlan& plan, Precision precision);

// Whether kernels make the codes of a picture. The host makes those that show light below 0, or that have other
// primaries than the capture.
[[nodiscard]] inline bool kernels_make_codes(const CaptureFormat& capture, const OutputFormat& output) {
  return holds_codes(output.type) && output.negative == NegativeLight::saturate &&
         !CodeMaking::of(capture, output).conversion;
}

// How light becomes codes. It depends on this much of a plan and a picture's format.
struct CodeKey {
  Transfer transfer = Transfer::linear();  // of the picture's codes
  std::uint32_t white_code = 255;
  double white_light = 1.0;  // the kernel's light that has the white code
  Precision precision = Precision::single_;

  [[nodiscard]] static CodeKey of(const RenderPlan& plan, Precision precision, const OutputFormat& output);
  friend bool operator==(const CodeKey&, const CodeKey&) = default;
};
struct CodeTables {
  Bytes thresholds;  // Threshold: what white is, the least light of code 1 … white code, then more than any light
  std::vector<std::uint32_t> guesses;
};
// None where the codes lie too close together (code_search() in kernel_numbers.cpp).
[[nodiscard]] std::optional<CodeTables> code_tables(const CodeKey& key);

// The two limits of light between which it has a code, on the scale on which kernels blend: Threshold [2].
[[nodiscard]] Bytes code_limits(const CodeKey& key, const CodeScale& scale, const RenderPlan& plan);

}  // namespace nutik
