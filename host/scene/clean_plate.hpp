// The plate: what a scene looks like without what moves in it.
//
//   in:      a capture, and how far codes of the same light may lie apart
//   out:     for each pixel the light that it holds longest; and the uncertain pixels, which hold theirs for less than
//            half of the time
//   always:  each pixel follows from its own records. A thing that moves may rest, but nowhere for as long as the
//            background is seen there
//
// Channels are taken one after another, green first: among the times at which a pixel held its most frequent green,
// those at which it held its most frequent red, then blue. The light is the mean over the times that are left, which
// averages noise out.
#pragma once

#include <cstdint>

#include "capture/memory_needs.hpp"
#include "capture/picture.hpp"
#include "imev/capture_source.hpp"
#include "mask/region.hpp"
#include "scene/place_times.hpp"
#include "system/interruption.hpp"

namespace nutik {

struct Plate {
  Picture light;     // light64, in the capture's primaries
  Region uncertain;  // held for less than half of the time; small holes amid these that are told with them
};

// What a plate takes, beside blocks of the capture.
[[nodiscard]] MemoryNeeds plate_needs(const CaptureFormat& capture);

// Looks at every sample, or at so many evenly in time, on all cores; `progress` counts tiles, twice as many as
// there are, and is called by any of them, one after another. Packed blocks are
// unpacked strip by strip, so that they and the plate stay within `memory_bytes`. Throws MemoryTooLittle, InputError
// where the capture is damaged.
[[nodiscard]] Plate make_plate(CaptureSource& capture, const CodeBand& band, std::uint64_t memory_bytes,
                               std::uint64_t max_samples = ~std::uint64_t{0}, const ReportedProgress& progress = {});

// The share of the region's border along which the plate has an edge and the picture none: about 0 for a thing, 1 for a
// hole, and in between for a thing of which the plate shows a part. An edge differs by more than `by_codes`. The region
// reaches `margin` pixels over what differs. Both pictures hold codes of one type, and have the region's size. 0 for a
// region that is too small to tell.
[[nodiscard]] double plate_edge_share(const Picture& picture, const Picture& plate, const Region& region,
                                      std::uint32_t by_codes, std::uint32_t margin);

// What differs from the plate without what is a shadow: the ground, with less light on it. Both pictures hold codes of
// one type. A shadow begins softly: from where nothing differs, the light on the ground falls by little from pixel to
// pixel, by about as much in all colours, and never to nothing. A shadow with a hard edge stays.
[[nodiscard]] Region without_shadow(const Picture& picture, const Picture& plate, const Region& differing);

}  // namespace nutik
