// What a video's codes are taken for: as stated, else as the file says, else as most such files are.
#pragma once

#include <string>

#include "media/clip.hpp"
#include "media/videos/pixels.hpp"
#include "media/videos/probe.hpp"

namespace nutik::videos {

// Where no matrix is named it is the usual one; where no range is named it is the limited one. Throws InputError naming the file where the matrix that it names is none
// that is known here.
[[nodiscard]] YuvCoding yuv_coding(const Probe& probe, const ClipOptions& options, const std::string& name);

// Transfer function, primaries and pixel aspect of the capture, whose white code is known; facts on all of these, and on
// matrix, range and chroma of YUV.
void describe(ClipInfo& info, const Probe& probe, const ClipOptions& options);

}  // namespace nutik::videos
