// How fast a phone filmed what its file plays slower or faster.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "media/clip.hpp"
#include "media/videos/libav.hpp"

namespace nutik::videos {

struct CaptureRate {
  Rational rate;     // pictures a second
  std::string name;  // of what states it
  std::string from = "the file";  // that has it
};

// A camera's curve that a file's metadata name, which H.273 has no numbers for.
struct NamedCurve {
  Transfer transfer;
  std::optional<Primaries> primaries;
  std::string from = "the file";  // that names it
};

// What Sony's cameras write in their XML, which is a box of an MP4 or lies beside the clip (C0001.MXF: C0001M01.XML),
// or without it in an MXF's labels, DJI's and ARRI's as ColorGammaSxS, and Apple's as
// com.apple.proapps.customgamma or in a track's box `logs`. Says in `notes` which curve of theirs is not known here.
[[nodiscard]] std::optional<NamedCurve> named_curve(const AVFormatContext& format, const std::filesystem::path& path,
                                                    std::vector<Note>& notes);

// The file beside the clip that has Sony's XML; none where the clip has it itself, or there is none.
[[nodiscard]] std::filesystem::path story_beside(const std::filesystem::path& path);

// What Android's cameras write (com.android.capture.fps), Samsung's (moov/udta/smta), or Sony's (captureFps; see
// above). Says in `notes` where that is no rate.
[[nodiscard]] std::optional<CaptureRate> capture_rate(const AVFormatContext& format,
                                                      const std::filesystem::path& path,
                                                      std::vector<Note>& notes);

// Whether a video's edit list plays other than one part of it at its own speed: parts again, in another order, slower.
[[nodiscard]] bool has_edits(const std::filesystem::path& path);

// Whether Samsung's trailer names parts that were filmed faster than others.
[[nodiscard]] bool has_slow_parts(const std::filesystem::path& path);

// Times as they were filmed, where the rate is one that the file's own times were stretched or pressed from: a whole
// number of times as fast, or slow, as pictures follow each other where none was dropped. Where the times run at it
// already nothing changes. Says in `notes` what was done, or why not.
void apply_capture_rate(const CaptureRate& filmed, ClipTiming& timing, std::vector<Note>& notes);

}  // namespace nutik::videos
