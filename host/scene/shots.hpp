// The shots of a capture: what was filmed without a cut.
//
//   always:  shots follow one another, from the first sample to the last. A flash is no cut, as the scene after it is the one
//            before it, nor a light that is switched on, nor a camera that turns fast, as all its pictures differ
#pragma once

#include <vector>

#include "imev/capture_source.hpp"

namespace nutik {

// Looks at every sample. Throws InputError where the capture is damaged.
[[nodiscard]] std::vector<SampleRange> shots_of(CaptureSource& capture);

}  // namespace nutik
