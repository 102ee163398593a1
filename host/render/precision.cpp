#include "render/precision.hpp"

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik {

std::string to_text(Precision precision) {
  switch (precision) {
    case Precision::single_: return "single";
    case Precision::compensated: return "compensated";
    case Precision::double_: return "double";
    case Precision::fixed: return "fixed";
  }
  return {};
}

Precision parse_precision(std::string_view text) {
  for (const Precision precision : kPrecisions) {
    if (text == to_text(precision)) return precision;
  }
  throw UsageError(
      format("precision '{}' is not known; choose auto, single, compensated, double or fixed", text));
}

}  // namespace nutik
