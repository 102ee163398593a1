// Edits of regions: which there are, how they look, which pixels they have. Each is one undo step of the document, but
// for those during a drag.
//
//   always:  every pixel shows one region, the first that has it (covering.hpp); what none has is the background's, tag
//            0, which stays
#pragma once

#include <QString>
#include <cstdint>
#include <optional>
#include <vector>

#include "mask/region.hpp"
#include "studio/document/document.hpp"

namespace nutik::studio {

inline constexpr std::uint8_t kBackground = 0;

// A region of no pixel yet, before all others, exposed over the interval that is scrubbed; selected. Nothing if all 256
// tags are taken.
void add_region(Document& document);
void remove_region(Document& document, std::uint8_t tag);
// Before or behind its neighbour. Nothing at the ends, and of the background.
enum class Move { up, down };
void move_region(Document& document, std::uint8_t tag, Move move);
void set_look(Document& document, std::uint8_t tag, const RegionLook& look, const QString& what);
// The interval that is scrubbed becomes the region's function.
void expose_over_boxcar(Document& document, std::uint8_t tag);

// A region gets pixels: those of a region before it beneath that one. The background gets them from all regions.
void paint_region(Document& document, const Region& region, std::uint8_t tag, const QString& what);
// It loses pixels, and what it covered appears.
void erase_region(Document& document, const Region& region, std::uint8_t tag, const QString& what);
// The pixels that it has, covered or not.
[[nodiscard]] Region region_of(const Document& document, std::uint8_t tag);
// By so many pixels; less than 0: it shrinks.
void grow_region(Document& document, std::uint8_t tag, double radius);
void smooth_region(Document& document, std::uint8_t tag, double radius);
// Softens all edges, in hundredths of a pixel; or a region's own, where none means as all.
void set_feather(Document& document, int feather);
void set_feather_of(Document& document, std::uint8_t tag, std::optional<int> feather);

}  // namespace nutik::studio
