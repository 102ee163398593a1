// A capture beside the clip that it was made from.
#pragma once

#include <cstdint>

#include "imev/source_comparison.hpp"
#include "session/memory_budget.hpp"
#include "session/requests/source_request.hpp"
#include "system/interruption.hpp"
#include "tik/reader.hpp"

namespace nutik {

struct SourceCheck {
  SourceComparison comparison;
  std::uint64_t file_bytes = 0;    // of the capture
  std::uint64_t source_bytes = 0;  // of the samples, unpacked
  bool clip_goes_on = false;       // after the capture's last sample
  std::uint64_t made_samples = 0;  // between pictures, which are not compared
};

// Reads both to the capture's end; the clip of a capture that was aligned is aligned alike. The white code of 16-bit
// clips is taken from the capture unless it is stated, and so are its pictures and how it was cropped; the noise
// whatever is stated. Throws InputError where the clip's pictures are not those of the capture, or too few.
[[nodiscard]] SourceCheck compare_with_source(tik::Reader& capture, SourceRequest clip,
                                              const MemoryBudget& memory,
                                              const ReportedProgress& progress = {});

// Throws UsageError where codes of a capture `name` are means of light by its own transfer function and another is
// stated, by which the same light has another mean: they were scaled, aligned or held within a camera's noise.
void check_stated_transfer(const tik::Header& header, const std::string& name,
                           const std::optional<Transfer>& stated);

}  // namespace nutik
