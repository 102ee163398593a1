// The scene of a capture without what moves in it: what is asked, and what came of it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "capture/picture.hpp"
#include "features/masks/mask_request.hpp"
#include "imev/capture_source.hpp"
#include "mask/region.hpp"
#include "render/output_format.hpp"
#include "session/memory_budget.hpp"
#include "system/interruption.hpp"

namespace nutik {

struct PlateRequest {
  // Codes of the same light differ by no more, to either side. None: by three standard deviations of the noise that the
  // capture itself is measured to have, and at least by 1/32 of white.
  std::optional<std::uint32_t> by_codes;
  // Where the capture has more samples, so many are looked at, evenly in time.
  std::uint64_t max_samples = ~std::uint64_t{0};
};

struct MadePlate {
  Picture picture;
  Region uncertain;            // as the scene's Plate has it
  bool is_noise_known = true;  // false: nothing was stated, and the noise cannot be measured. 1/32 was taken
  Saturation saturation = {};  // of its codes
};

// Beside a block of the capture.
[[nodiscard]] MemoryNeeds plate_making_needs(const CaptureFormat& capture);

// Reads all of the capture, some of it twice to measure its noise. `capture_name` is for
// messages. Throws MemoryTooLittle, InputError where the capture is damaged or has a single sample.
[[nodiscard]] MadePlate make_plate(CaptureSource& capture, const std::string& capture_name,
                                   const PlateRequest& request, const OutputFormat& output,
                                   const MemoryBudget& memory, const ReportedProgress& progress = {});

// A plate to compare with, which need not be free of noise: of few samples, in codes of the capture, as a picture of it
// at a time has them. As above.
[[nodiscard]] MadePlate make_rough_plate(CaptureSource& capture, const std::string& capture_name,
                                         const MemoryBudget& memory, const ReportedProgress& progress = {});

// What making a mask takes, with the plate where a step needs it.
[[nodiscard]] NeedsOfFormat mask_needs_of(const MaskRequest& request);

}  // namespace nutik
