// Makes a video: its frames are exposed one after another, and each is written while the next is exposed.
//
//   always:  equal frame periods. A signal after the first frame leaves a whole, shorter video
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "features/film/film_request.hpp"
#include "features/recipe/picture_recipe.hpp"
#include "media/writers/video_writer.hpp"
#include "session/output_check.hpp"
#include "session/requests/output_request.hpp"
#include "session/session.hpp"
#include "system/interruption.hpp"

namespace nutik {

// Where a video goes, told from its name: a container, or a numbered still for each frame.
class VideoOutput {
 public:
  // `rate` in frames a second; no codec: the one that is usual. Throws UsageError where the name is that of neither,
  // codec and container do not fit, or the container cannot tell so many frames a second apart.
  VideoOutput(std::filesystem::path path, Rational rate, const std::optional<std::string>& codec,
              const OutputRequest& request);

  // What values the frames have. Throws UsageError where the depth that was asked for and the file do not fit.
  [[nodiscard]] OutputFormat frame_format(const CaptureFormat& capture) const;

  // Throws UsageError where one of the files to write is an input, of another kind, or may not be replaced.
  void check(std::span<const std::uint64_t> frames, std::span<const std::string> inputs,
             Replacing replacing) const;
  // The still of a frame. Of stills alone.
  [[nodiscard]] std::filesystem::path still(std::uint64_t frame) const;

  // The size of its frames: in square pixels where people look at them.
  [[nodiscard]] Shape shape(const CaptureFormat& capture) const;
  [[nodiscard]] FileWishes wishes() const { return file_wishes(request_); }
  // The writer of a video in one file. `video` has what comes of the clip: its sound, chroma and screen.
  [[nodiscard]] std::unique_ptr<VideoWriter> open(const CaptureFormat& capture, const OutputFormat& format,
                                                  VideoFormat video) const;

  // That the encoder keeps.
  [[nodiscard]] std::uint32_t encoder_frames() const { return codec_ == nullptr ? 1 : codec_->held_frames; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] bool writes_stills() const { return codec_ == nullptr; }
  [[nodiscard]] bool loses() const { return codec_ != nullptr && !codec_->is_lossless; }
  [[nodiscard]] bool holds_sound() const;
  // `h264`, or `stills`.
  [[nodiscard]] std::string kind() const;

 private:
  std::filesystem::path path_;
  Rational rate_;
  OutputRequest request_;
  const VideoCodec* codec_ = nullptr;  // null: stills
  int codec_setting_ = 0;
};

struct MadeVideo {
  std::uint64_t frames = 0;                 // that were written
  std::optional<Interrupted> interruption;  // what ended the video before its last frame
  std::vector<std::string> notes;           // of the writer, and on sound: whole sentences
  std::optional<FilmSound> sound;           // that it has
};

// Which samples are made between a clip's pictures so that frames do not show what moves two or three times; for a
// film of which nobody stated that. None of a .tik, of events and of a stream, nor of frames that hold single samples.
[[nodiscard]] std::optional<BetweenRequest> joining_samples(const FramesRequest& request, const Frames& frames,
                                                            const Session& session);

// What the recipe of a frame's still states for itself: when it was exposed, and with keys what its functions (as a
// text with that name) and its mask were.
[[nodiscard]] OwnRecipe frame_recipe(const FramesRequest& request, const Frames& frames, std::uint64_t frame,
                                     const std::string& functions_name);

// `frames` are those of the request on the session's timeline; stills have the frames' numbers. `add`, which may be
// empty, is told each frame as it was exposed, and returns the text that goes into it where frames are stills. No
// `precision`: that of the session's devices. Throws what Session::render() does, and OutputError.
[[nodiscard]] MadeVideo make_video(
    Session& session, const FramesRequest& request, const Frames& frames, const VideoOutput& output,
    const ReportedProgress& progress,
    const std::function<std::string(std::uint64_t frame, const Exposure& exposure,
                                    const ExposedPicture& exposed)>& add,
    FilmSoundWish sound = FilmSoundWish::as_it_is, std::optional<Precision> precision = {});

}  // namespace nutik
