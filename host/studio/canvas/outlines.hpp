// The borders between a mask's regions.
#pragma once

#include <QLine>
#include <QVector>
#include <cstdint>
#include <map>

#include "session/below/functions.hpp"

namespace nutik::studio {

// By tag: straight lines between pixels of the tag and pixels of smaller tags, as long as they go; in the picture's
// pixels. Each border is drawn once, by the larger tag, so that the background needs no colour.
using Outlines = std::map<std::uint8_t, QVector<QLine>>;
[[nodiscard]] Outlines outlines_of(const Mask& mask);

}  // namespace nutik::studio
