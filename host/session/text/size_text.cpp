#include "session/text/size_text.hpp"

#include "capture/format.hpp"

namespace nutik {

std::string counted(std::uint64_t count, std::string_view name) {
  return format("{} {}{}", count, name, count == 1 ? "" : "s");
}

std::string saturated_text(const Saturation& saturation) {
  const auto [below, above] = saturation;
  if (below == 0 && above == 0) return "no pixel saturated";
  if (above == 0) return format("{} saturated below 0", counted(below, "pixel"));
  if (below == 0) return format("{} saturated above 1", counted(above, "pixel"));
  return format("{} saturated below 0 and {} above 1", counted(below, "pixel"), above);
}

std::string bytes_text(std::uint64_t bytes) {
  const auto value = static_cast<double>(bytes);
  if (bytes < 1000) return format("{} bytes", bytes);
  if (value < 999.5e3) return format("{:.3g} kB", value * 1e-3);
  if (value < 999.5e6) return format("{:.3g} MB", value * 1e-6);
  return format("{:.3g} GB", value * 1e-9);
}

std::string shape_text(const Shape& shape) {
  return format("{} x {} {}", shape.width, shape.height, shape.channels == 1 ? "grey" : "colour");
}

std::string aspect_text(const Rational& aspect) {
  return format("{}:{}", aspect.numerator, aspect.denominator);
}

}  // namespace nutik
