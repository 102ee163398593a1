// Time maps: how much later each pixel is exposed than its function says, g_p(t) = g_m(t − δ(p)).
//
//   in:      a range of delays, and a direction or a picture that says where in it each pixel lies
//   out:     the delays that occur, and which of them each pixel has
//   units:   whole nanoseconds, each rounded half up once, from its own exact value; below 0: earlier
//   always:  delays increase, and some pixel has each; there are at most 65,536
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "capture/frame_times.hpp"
#include "capture/picture.hpp"

namespace nutik {

// From one end of a direction to the other, or from black to white.
struct DelayRange {
  ExactTime from, to;
  DelayRange(const ExactTime& first, const ExactTime& last) : from(first), to(last) {}
  DelayRange(std::int64_t from_ns, std::int64_t to_ns) : from{from_ns}, to{to_ns} {}
};

struct DelayMap {
  // Kernels count pairs of a function and a delay in 16 bits.
  static constexpr std::size_t kMaxDelays = 1u << 16;
  // Distances from the centre are whole steps of the range, so that some functions of a mask fit, too.
  static constexpr std::uint32_t kRadialSteps = (1u << 14) - 1;

  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::int64_t> delays_ns;
  std::vector<std::uint16_t> delay_of_pixel;  // index into delays_ns, row by row

  // From the first row to the last, from the first column to the last, from the picture's centre to its corners. Throws
  // UsageError where the picture has more rows or columns than there can be delays.
  static DelayMap by_rows(const Shape& shape, const DelayRange& range);
  static DelayMap by_columns(const Shape& shape, const DelayRange& range);
  static DelayMap by_radius(const Shape& shape, const DelayRange& range);
  // From black to white of a grey picture. Codes are taken as they stand; light in floating point is rounded to
  // 65535ths. Throws InputError that calls the picture `name`.
  static DelayMap by_picture(const Picture& picture, const DelayRange& range, const std::string& name);

  [[nodiscard]] std::int64_t delay_ns(std::uint64_t pixel) const { return delays_ns[delay_of_pixel[pixel]]; }

  friend bool operator==(const DelayMap&, const DelayMap&) = default;
};

}  // namespace nutik
