// What hard cases are put together from.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "support/hard_cases.hpp"
#include "support/random_case.hpp"

namespace nutik::test {

// By what is hard about them.
[[nodiscard]] std::span<const NamedHardCase> hard_times();
[[nodiscard]] std::span<const NamedHardCase> hard_gains();
[[nodiscard]] std::span<const NamedHardCase> hard_captures();

inline constexpr std::int64_t kSecondNs = 1'000'000'000;
inline constexpr Rational kHalfShutter{180, 1};

// Codes of 8 bits up to a white of 255, else of 16.
[[nodiscard]] CaptureFormat format_of(Shape shape, Transfer transfer, std::uint32_t white_code = 255);

// Functions with the mask values 0, 1, … in order.
[[nodiscard]] FunctionSet number(std::vector<GainFunction> functions);

// Neighbouring pixels have different functions, as far as there are several: 0, 1, …, 0, 1, …
[[nodiscard]] Mask take_turns(const Shape& shape, const FunctionSet& functions);

// Every pixel gets a new code without pattern at every sample.
[[nodiscard]] DrawSample noise(const CaptureFormat& capture);

// The same raster at every sample, every pixel another code.
[[nodiscard]] DrawSample still(const CaptureFormat& capture);

// A capture of noise, its pixels taking turns.
[[nodiscard]] HardCase noisy_case(const CaptureFormat& capture, Timeline timeline,
                                  std::vector<GainFunction> functions);

// Two straight lines from 0 at time_ns - 1 to `gain` at time_ns to 0 at time_ns + 1: the shortest there is.
[[nodiscard]] GainFunction pulse(std::int64_t time_ns, double gain = 1.0);

}  // namespace nutik::test
