// Edits of regions: which there are, how they look, which pixels they have. Each is one undo step of the document, but
// for those during a drag.
//
//   always:  every pixel has one region; what a region loses falls to the background, tag 0, which stays
#pragma once

#include <QString>
#include <cstdint>
#include <vector>

#include "session/below/regions.hpp"
#include "studio/document/document.hpp"

namespace nutik::studio {

inline constexpr std::uint8_t kBackground = 0;

// A region of no pixel yet, exposed over the interval that is scrubbed; selected. Nothing if all 256 tags are taken.
void add_region(Document& document);
void remove_region(Document& document, std::uint8_t tag);
void set_look(Document& document, std::uint8_t tag, const RegionLook& look, const QString& what);
// The interval that is scrubbed becomes the region's function.
void expose_over_boxcar(Document& document, std::uint8_t tag);

// Gives pixels a tag.
void paint_region(Document& document, const Region& region, std::uint8_t tag, const QString& what);
// The pixels that have it.
[[nodiscard]] Region region_of(const Document& document, std::uint8_t tag);
// By so many pixels; less than 0: it shrinks.
void grow_region(Document& document, std::uint8_t tag, double radius);
void smooth_region(Document& document, std::uint8_t tag, double radius);
// Of all edges, in hundredths of a pixel.
void set_feather(Document& document, int feather);

}  // namespace nutik::studio
