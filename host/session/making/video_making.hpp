// Makes a video: its frames are exposed one after another, and each is written while the next is exposed.
//
//   always:  frames have equal periods; what a signal ends after its first frame is a whole, shorter video
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "session/making/picture_recipe.hpp"
#include "session/making/video_output.hpp"
#include "session/requests/frames_request.hpp"
#include "session/session.hpp"
#include "system/interruption.hpp"

namespace nutik {

struct MadeVideo {
  std::uint64_t frames = 0;                 // that were written
  std::optional<Interrupted> interruption;  // what ended the video before its last frame
  std::vector<std::string> notes;           // of the writer: whole sentences
};

// What the recipe of a frame's still states for itself: when it was exposed, and with keys what its functions (as a text
// with that name) and its mask were.
[[nodiscard]] OwnRecipe frame_recipe(const FramesRequest& request, const Frames& frames, std::uint64_t frame,
                                     const std::string& functions_name);

// `frames` are those of the request on the session's timeline; stills have the frames' numbers. `add`, which may be
// empty, is told each frame as it was exposed, and returns the text that goes into it where frames are stills. Throws
// what Session::render() does, and OutputError.
[[nodiscard]] MadeVideo make_video(
    Session& session, const FramesRequest& request, const Frames& frames, const VideoOutput& output,
    const ReportedProgress& progress,
    const std::function<std::string(std::uint64_t frame, const Exposure& exposure,
                                    const ExposedPicture& exposed)>& add);

}  // namespace nutik
