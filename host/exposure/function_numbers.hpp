// The numbers of a function file: each reads a whole word and says what is wrong with it, if
// anything.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "capture/stated_time.hpp"

namespace nutik {

template <typename Number>
struct ReadNumber {
  Number value{};
  std::string mistake;  // what is wrong and what would be right; empty where `value` holds
};

// The digits behind an `M`: 0 … 255.
[[nodiscard]] ReadNumber<std::uint8_t> read_mask_value(std::string_view word);

// Nanoseconds as [+-] digits; or a stated time (capture/stated_time.hpp), rounded half up once. At most kLargestTimeNs
// from 0. `37f` is 37 times as long as a picture, where the file says how long that is.
[[nodiscard]] ReadNumber<std::int64_t> read_time(std::string_view word, const std::optional<StatedTime>& picture = {});
// How long a picture is: longer than nothing, in seconds or parts of it.
[[nodiscard]] ReadNumber<StatedTime> read_picture_length(std::string_view word);

// The double nearest to a decimal number: 0 where it is too small, a mistake where it is too large.
[[nodiscard]] ReadNumber<double> read_gain(std::string_view word);

}  // namespace nutik
