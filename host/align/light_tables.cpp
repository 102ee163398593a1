#include "align/light_tables.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "system/simd_clones.hpp"

namespace nutik {
namespace {

// Of light, for each code: few steps have two that begin within them, of 8 bits. Tables for 16 bits stay small.
constexpr std::uint32_t kStepsPerCode = 16;
constexpr std::uint32_t kMaxSteps = 1 << 16;

// The least single that is no less than `light`: singles reach both at once.
float next_float(double light) {
  const auto near = static_cast<float>(light);
  return near < light ? std::nextafter(near, std::numeric_limits<float>::infinity()) : near;
}

template <typename Code>
std::uint32_t highest(const Code* codes, std::size_t count) {
  Code most = 0;
  for (std::size_t i = 0; i < count; ++i) most = most < codes[i] ? codes[i] : most;
  return most;
}

template <typename Code>
void look_up(const std::vector<float>& light, const Code* codes, std::size_t stride,
             std::span<float> lights) {
  const std::uint32_t most = highest(codes, (lights.size() - 1) * stride + 1);
  if (most >= light.size()) throw CodeAboveWhite(most);
  const float* const table = light.data();
  float* const to = lights.data();
  for (std::size_t i = 0; i < lights.size(); ++i) to[i] = table[codes[i * stride]];
}

// Steps are a power of 2, so that a light's is exact.
NUTIK_SIMD_CLONES void find_codes(const float* __restrict lights, std::size_t count, float steps,
                                  const std::uint32_t* __restrict first_code, std::uint32_t half,
                                  const float* __restrict begins, std::uint32_t* __restrict codes) {
  for (std::size_t i = 0; i < count; ++i) codes[i] = first_code[static_cast<std::int32_t>(lights[i] * steps)];
  for (; half > 0; half /= 2) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t next = codes[i] + half;
      codes[i] = lights[i] >= begins[next] ? next : codes[i];
    }
  }
}

}  // namespace

LightTables::LightTables(const Transfer& transfer, std::uint32_t white_code) {
  for (const double light : transfer.light_of_codes(white_code)) light_.push_back(static_cast<float>(light));
  for (const double light : transfer.code_thresholds(white_code)) begins_.push_back(next_float(light));
  const std::uint32_t steps = std::min(std::bit_ceil(white_code) * kStepsPerCode, kMaxSteps);
  std::uint32_t code = 0, most = 1;
  for (std::uint32_t step = 0; step <= steps; ++step) {
    const float light = static_cast<float>(step) / static_cast<float>(steps);
    const std::uint32_t before = code;
    while (code < white_code && begins_[code + 1] <= light) ++code;
    if (step > 0) most = std::max(most, code - before);
    first_code_.push_back(code);
  }
  half_ = std::bit_floor(most);
  begins_.resize(begins_.size() + 2 * std::size_t{half_}, std::numeric_limits<float>::infinity());
}

void LightTables::lights_of(const std::uint8_t* codes, std::size_t stride, std::span<float> lights) const {
  look_up(light_, codes, stride, lights);
}

void LightTables::lights_of(const std::uint16_t* codes, std::size_t stride, std::span<float> lights) const {
  look_up(light_, codes, stride, lights);
}

void LightTables::codes_of(std::span<const float> lights, std::uint32_t* codes) const {
  find_codes(lights.data(), lights.size(), static_cast<float>(first_code_.size() - 1), first_code_.data(),
             half_, begins_.data(), codes);
}

}  // namespace nutik
