// Pictures of many functions in one pass over a capture, on the processor: for pictures so small that it takes a device
// longer to be asked for each than to compute it.
//
//   in:      plans of one capture, each of which suits_one_pass(), a rectangle
//   out:     of each plan the light of the rectangle (light64)
//   always:  a block's samples times their weights are added up in double, in time order, and blocks after one another:
//            as Precision::double_ adds up dense tiles, so that its error bound holds
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/renderer.hpp"

namespace nutik {

// Whether all pixels have one function, and there are few.
[[nodiscard]] bool suits_one_pass(const RenderPlan& plan);

// How many pictures of a rectangle are best made at once, with no more than so many bytes.
[[nodiscard]] std::size_t pictures_in_one_pass(const RenderPlan& plan, const Rectangle& rectangle,
                                               std::uint64_t most_bytes);

// Throws InputError for a damaged block, Cancelled.
[[nodiscard]] std::vector<Picture> expose_in_one_pass(std::span<const RenderPlan> plans, CaptureSource& source,
                                                      const Rectangle& rectangle, const RenderControl& control);

}  // namespace nutik
