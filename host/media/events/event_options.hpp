// What can be stated of recordings whose pixels keep their own time (media/events/event_clip.hpp).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <variant>

namespace nutik {

// By how much the natural logarithm of light changes with an event: up, and down.
struct Contrast {
  double up = 0, down = 0;
  friend bool operator==(const Contrast&, const Contrast&) = default;
};

// Light before the first event: everywhere the same, or a picture's.
using StartLight = std::variant<double, std::filesystem::path>;

struct EventOptions {
  std::optional<Contrast> contrast = std::nullopt;
  std::optional<StartLight> start = std::nullopt;
  std::optional<std::int64_t> tick_ns = std::nullopt;  // changes count at the start of the tick that they are in
  friend bool operator==(const EventOptions&, const EventOptions&) = default;
};

// `0.2`, or `0.3:0.17`: up, and down; each from 0.001 to 10. Throws UsageError.
[[nodiscard]] Contrast parse_contrast(std::string_view text);
// `0.18`, from 0.0001 to 1, else the name of a picture. Throws UsageError.
[[nodiscard]] StartLight parse_start_light(std::string_view text);

}  // namespace nutik
