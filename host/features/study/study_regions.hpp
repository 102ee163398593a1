// What the regions of a study are made of: steps of its mask.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "features/masks/mask_request.hpp"
#include "imev/capture_source.hpp"
#include "scene/subject.hpp"

namespace nutik {

// Whether one of the cells, which increase, lies at the place or beside it.
[[nodiscard]] bool touches(const SubjectPlace& place, const std::vector<std::size_t>& cells, std::size_t columns);

// In pixels, with a cell around them.
[[nodiscard]] select::Rectangle box_round(const std::vector<std::size_t>& cells, const SubjectTrack& track);

// The largest part within a box, without specks, holes and narrow bays: so many pixels larger, then smaller. To shrink
// it comes last.
[[nodiscard]] std::vector<RegionChange> whole_within(const select::Rectangle& box, double larger, double smaller);

// What a subject puts down or takes away on its way.
struct Exchange {
  struct Thing {
    std::vector<std::size_t> cells;  // increasing
    MaskStep step;                   // its region, of no tag yet
  };
  std::vector<Thing> things;
  std::size_t cell_columns = 0;
};

// Things whose cells differ from the plate at a few looks before the subject's way and at none of a few behind, or
// the other way round, and whose regions end within these cells: what goes on beyond is light, or the scene's. None
// where the subject goes on its way from the first on, or to the last. Throws InputError where the capture is damaged.
[[nodiscard]] Exchange exchanged_by(const SubjectTrack& track, CaptureSource& capture, const std::string& name,
                                    std::uint32_t by_codes);

// Regions of those that touch the subject at its place, and are no larger than it, with a border of so many pixels. A
// trail shows them for a share of the time, and the plate has them for good, or never: they belong to that moment.
[[nodiscard]] std::vector<MaskStep> exchange_steps(const Exchange& exchange, const SubjectPlace& place,
                                                   std::uint8_t tag, std::uint32_t border);

}  // namespace nutik
