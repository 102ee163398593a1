#include "align/light_tables.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "system/simd_clones.hpp"

namespace nutik {
namespace {

// Singles that differ only in their last bits, this many of them or fewer, share a cell.
constexpr std::int32_t kMaxCellBits = 15;
// Behind the place in a cell where the next code begins, and more than any place.
constexpr std::int32_t kPlaceBits = 16;
constexpr std::uint32_t kNoPlace = 0xFFFF;

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
void look_up(const std::vector<float>& light, const Code* codes, std::size_t stride, std::span<float> lights) {
  if (light.size() <= std::numeric_limits<Code>::max()) {
    const std::uint32_t most = highest(codes, (lights.size() - 1) * stride + 1);
    if (most >= light.size()) throw CodeAboveWhite(most);
  }
  const float* const table = light.data();
  float* const to = lights.data();
  for (std::size_t i = 0; i < lights.size(); ++i) to[i] = table[codes[i * stride]];
}

// Positive singles are in the order of their bits.
constexpr std::int32_t bits_of(float light) { return std::bit_cast<std::int32_t>(light); }
constexpr std::int32_t kWhiteBits = bits_of(LightTables::kWhite);

constexpr std::uint32_t kLightsAtOnce = 128;

// Up to so many. Compilers make vectors of the first and last loop, and nothing good of all three in one.
NUTIK_SIMD_CLONES void find_codes(const float* __restrict lights, std::uint32_t count,
                                  const std::uint32_t* __restrict cells, std::int32_t first_cell,
                                  std::int32_t cell_bits, std::uint32_t* __restrict codes) {
  std::int32_t numbers[kLightsAtOnce];
  const std::int32_t last_cell = kWhiteBits >> cell_bits;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::int32_t cell = __builtin_bit_cast(std::int32_t, lights[i]) >> cell_bits;
    const std::int32_t known = cell > first_cell ? cell : first_cell;
    numbers[i] = (known < last_cell ? known : last_cell) - first_cell;
  }
  for (std::uint32_t i = 0; i < count; ++i) codes[i] = cells[numbers[i]];
  const std::int32_t places = (1 << cell_bits) - 1;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::int32_t place = __builtin_bit_cast(std::int32_t, lights[i]) & places;
    const auto next = static_cast<std::int32_t>(codes[i] & kNoPlace);
    codes[i] = (codes[i] >> kPlaceBits) + (place >= next ? 1 : 0);
  }
}

}  // namespace

LightTables::LightTables(const Transfer& transfer, std::uint32_t white_code) {
  for (const double light : transfer.light_of_codes(white_code)) light_.push_back(static_cast<float>(kWhite * light));
  std::vector<std::int32_t> begins;
  for (const double light : transfer.code_thresholds(white_code)) begins.push_back(bits_of(next_float(kWhite * light)));
  cell_bits_ = kMaxCellBits;
  for (std::uint32_t code = 2; code <= white_code; ++code) {
    while (cell_bits_ > 0 && begins[code - 1] >> cell_bits_ == begins[code] >> cell_bits_) --cell_bits_;
  }
  first_cell_ = (begins[1] >> cell_bits_) - 1;  // is black
  std::uint32_t code = 0;
  for (std::int32_t cell = first_cell_; cell <= kWhiteBits >> cell_bits_; ++cell) {
    const std::int32_t start = cell << cell_bits_;
    while (code < white_code && begins[code + 1] <= start) ++code;
    const std::int64_t place = code < white_code ? std::int64_t{begins[code + 1]} - start : kNoPlace;
    cells_.push_back(code << kPlaceBits | static_cast<std::uint32_t>(std::min<std::int64_t>(place, kNoPlace)));
  }
}

void LightTables::lights_of(const std::uint8_t* codes, std::size_t stride, std::span<float> lights) const {
  look_up(light_, codes, stride, lights);
}

void LightTables::lights_of(const std::uint16_t* codes, std::size_t stride, std::span<float> lights) const {
  look_up(light_, codes, stride, lights);
}

void LightTables::codes_of(std::span<const float> lights, std::uint32_t* codes) const {
  for (std::size_t i = 0; i < lights.size(); i += kLightsAtOnce) {
    const auto count = static_cast<std::uint32_t>(std::min<std::size_t>(kLightsAtOnce, lights.size() - i));
    find_codes(lights.data() + i, count, cells_.data(), first_cell_, cell_bits_, codes + i);
  }
}

}  // namespace nutik
