// The shots of a capture: what was filmed without a cut.
//
//   always:  shots follow one another, from the first sample to the last. A flash is no cut, as the scene after it is the one
//            before it, nor a light that is switched on, nor a camera that turns fast, as all its pictures differ.
//            The first picture or the last is a shot of its own also where it replaces a sixteenth of the scene and the
//            eight pictures next to it hardly differ
#pragma once

#include <vector>

#include "imev/capture_source.hpp"

namespace nutik {

// Looks at every sample. Throws InputError where the capture is damaged.
[[nodiscard]] std::vector<SampleRange> shots_of(CaptureSource& capture);

}  // namespace nutik
