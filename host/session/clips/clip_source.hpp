// Clips as a session reads them.
//
//   in:      a request, what may be held in memory
//   out:     the clip, the format of its samples with the noise model
//   always:  nothing of the clip has been read but what its noise was measured on, and all of it where its camera's
//            path had to be found
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "align/alignment.hpp"
#include "capture/error.hpp"
#include "media/clip.hpp"
#include "session/clips/clip_memory.hpp"
#include "session/requests/source_request.hpp"
#include "system/input_bytes.hpp"

namespace nutik {

// A clip's format, with what was stated in place of what its files say, without noise. Throws UsageError if the stated
// white code does not fit its codes.
[[nodiscard]] CaptureFormat clip_format(const Clip& clip, const ClipOptions& options);

// Throws InputError where a path names what can be read only once.
void refuse_streams(const std::filesystem::path& path);

// A clip and how it is to be encoded.
struct ClipSource {
  SourceRequest request;
  std::unique_ptr<Clip> clip;
  CaptureFormat capture;    // of its samples; what is held of them has held_format()
  std::vector<Note> notes;  // on the clip and its noise: what a person should know
  std::optional<Shared<CameraPath>> camera = std::nullopt;  // whose pictures are moved along it
  std::optional<Shared<MadeSamples>> made = std::nullopt;   // between its pictures

  // Everything that was read, stated or assumed of the clip, its times included, each with its origin.
  [[nodiscard]] std::vector<Fact> facts(std::uint64_t sample_count) const;

  // None where it has none, or all pictures are at one time.
  [[nodiscard]] std::optional<ClipSound> sound() const;

  // `notes`, and that the rate may be one of playing: slow-motion files state that.
  [[nodiscard]] std::vector<Note> all_notes(std::uint64_t sample_count) const;

  // Throws UsageError where there is no clip, InputError where it has what no capture has.
  void check() const;

  // For messages.
  [[nodiscard]] std::string name() const { return input_title(request.path.string()); }
  // As the files announce it; 0: they do not.
  [[nodiscard]] std::uint64_t announced_samples() const { return clip->info().sample_count; }
  // The clip has so many samples. Throws InputError if its rate is unknown.
  [[nodiscard]] Timeline timeline(std::uint64_t sample_count) const;
  // The same of its own pictures, without those made between them.
  [[nodiscard]] Timeline filmed(std::uint64_t sample_count) const;
  // What its memory is shared out by.
  [[nodiscard]] ClipToRead clip_to_read() const;
};

// Throws InputError where the clip cannot be read, UsageError where the request does not fit it;
// MemoryTooLittle where its own noise cannot be measured in the memory; what find_camera_path() throws. `progress`
// counts pictures while that reads the clip; the source's own request knows the path then.
//
// `open` is of a clip that its owner makes: it does so from the start, as often as the clip is read. The request's path
// is its name in messages then; UsageError where the request states what only files have, a part for example.
[[nodiscard]] ClipSource open_clip_source(const SourceRequest& request, const MemoryBudget& memory,
                                          const ReportedProgress& progress = {}, const std::stop_token& stop = {},
                                          OpenClip open = {});

// The progress of a clip that is read twice, once for its camera's path: both times in one.
struct TwofoldProgress {
  TwofoldProgress(const SourceRequest& source, const ReportedProgress& progress);
  ReportedProgress finding, reading;
};

// When the pictures of a .tik or a clip were exposed, as far as that is known before one is decoded. Throws InputError
// where nothing tells how many there are or how fast they were taken, and what open_clip_source() throws.
[[nodiscard]] Timeline known_timeline(const SourceRequest& request, const MemoryBudget& memory);

}  // namespace nutik
