// What a video's codes are taken for: as stated, else as the file says, else as most such files are.
#pragma once

#include <vector>

#include "capture/fact.hpp"
#include "media/clip.hpp"
#include "media/videos/pixels.hpp"
#include "media/videos/probe.hpp"

namespace nutik::videos {

// Of pictures of 720 lines and more that name no matrix it is BT.709's, as most programs have it, else BT.601's;
// where no range is named it is the limited one. Throws InputError naming the file where the matrix that it names is none
// that is known here.
[[nodiscard]] YuvCoding yuv_coding(const Probe& probe, const ClipOptions& options, const std::string& name);

// Transfer function, primaries and pixel aspect of the capture; facts on these, and on matrix and range of YUV.
void describe(CaptureFormat& capture, std::vector<Fact>& facts, const Probe& probe,
              const ClipOptions& options);

}  // namespace nutik::videos
