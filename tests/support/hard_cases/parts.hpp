// What hard cases are put together from.
#pragma once

#include <cstdint>
#include <functional>
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

// Samples whose value i has the code `code_of(i, k)` at sample k.
[[nodiscard]] DrawSample drawn_by(const CaptureFormat& capture,
                                  std::function<std::uint64_t(std::uint64_t i, std::uint64_t k)> code_of);

// Every pixel gets a new code without pattern at every sample.
[[nodiscard]] DrawSample noise(const CaptureFormat& capture);

// The same raster at every sample, every pixel another code.
[[nodiscard]] DrawSample still(const CaptureFormat& capture);

// A capture of functions with the mask values 0, 1, … in order. Neighbouring pixels have different ones, as far as
// there are several: 0, 1, …, 0, 1, …
[[nodiscard]] HardCase taking_turns(const CaptureFormat& capture, Timeline timeline, DrawSample sample,
                                    std::vector<GainFunction> functions);

// A capture of noise, its pixels taking turns.
[[nodiscard]] HardCase noisy_case(const CaptureFormat& capture, Timeline timeline,
                                  std::vector<GainFunction> functions);

// Two straight lines from 0 at time_ns - 1 to `gain` at time_ns to 0 at time_ns + 1: the shortest there is.
[[nodiscard]] GainFunction pulse(std::int64_t time_ns, double gain = 1.0);

}  // namespace nutik::test
