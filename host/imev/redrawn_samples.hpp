// Samples at which a codec drew its picture anew, as it does with its key frames: pixels that are still change there,
// all at once and a little. So they do where a camera changes its exposure by a step, which counts as the same.
#pragma once

#include <cstdint>
#include <vector>

#include "imev/activity.hpp"

namespace nutik {

// In increasing order. At such a sample at least a quarter of all pixels change, half as many again as at either sample
// beside it, and less than a quarter of those by more than a sixteenth of white: what moves does not come and go within
// one sample, and a cut or a flash changes more. Files need not say which pictures these are: a clip
// that was edited shows the key frames of its source, too.
[[nodiscard]] std::vector<std::uint64_t> redrawn_samples(const Activity& activity);

}  // namespace nutik
