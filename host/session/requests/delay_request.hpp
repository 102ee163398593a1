// Delays of pixels (exposure/delay_map.hpp), as they are asked for.
//
//   rows:15ms   columns:0s..0.5s   radial:-20ms..20ms   map.tif:0s..1s
//
// From the first row or column to the last, from the centre to the corners, from black to white; one time is where it
// ends, and it starts at 0. Or the delay of each pixel, not written in words.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "capture/picture.hpp"
#include "exposure/delay_map.hpp"
#include "session/requests/stated_moments.hpp"
#include "system/shared.hpp"

namespace nutik {

struct DelayRequest {
  enum class Course { picture, rows, columns, radial, times };

  Course course = Course::rows;
  StatedTime from, to;
  // Either a picture:
  std::string file;
  std::optional<Shared<Picture>> picture;  // read
  // Or times:
  std::shared_ptr<const DelayMap> map;

  // Throws UsageError naming `what` for anything else. Reads nothing.
  static DelayRequest parse(std::string_view text, std::string_view what);
  // Times are whole nanoseconds, row by row. Throws UsageError where they are not one for each pixel, or more than
  // there can be different delays.
  static DelayRequest of_times(std::uint32_t width, std::uint32_t height, std::span<const std::int64_t> times_ns);
  // `0s..15ms`
  [[nodiscard]] std::string range_text() const;
  // Reads the picture, if there is one. Throws as read_picture() does, UsageError if it is no single picture.
  void read();

  friend bool operator==(const DelayRequest&, const DelayRequest&) = default;
};

// The least delay that a pixel can have, and the largest.
[[nodiscard]] std::pair<std::int64_t, std::int64_t> delay_ends_ns(const std::optional<DelayRequest>& request);

// For pictures of this shape. Throws InputError if it has another size, UsageError if its picture was not read.
[[nodiscard]] std::shared_ptr<const DelayMap> delays_of(const DelayRequest& request, const Shape& shape);

}  // namespace nutik
