// What libraries throw. A message says what is wrong, where, what the limit is and what to do about it. app/run.cpp
// prints what ends a command, and makes an exit status of its class.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace nutik {

// What a caller can state otherwise to get further. A library names none of an application's options: its message
// says what helps, its error holds the settings, and the application adds what it calls them (--fps, fps=).
enum class Setting {
  automatic_noise,  // measured on the clip itself
  between,
  block_samples,
  chroma_place,
  columns,
  contrast,  // of an event
  count_redrawn,
  crf,
  crop,
  deflicker,
  deinterlace,
  depth,
  end_at_damage,  // a clip is taken up to where it is damaged
  frame_rate,
  from,  // the part of a clip
  keep_pixels,
  matrix,
  normalization,
  out_transfer,
  pixel_aspect,
  precision,
  primaries,
  quality,
  range,
  raw_layout,
  renderer,
  scale,
  shutter_angle,
  sound,
  start_picture,
  tick,
  to,
  transfer,
  unmapped,
  video_codec,
  white_code,
  width
};

// What ends a message that says more than the names of settings: `; take a part of the clip (`from`, `to`)`. Options
// stand in it between backquotes, by their names in the schema (features/schema), each with its value if it has one.
struct Advice {
  std::string text;
};

class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message, std::vector<Setting> settings = {})
      : std::runtime_error(message), settings_(std::move(settings)) {}
  Error(const std::string& message, Advice advice)
      : std::runtime_error(message), advice_(std::move(advice.text)) {}
  // All of the message speaks of options.
  explicit Error(const Advice& advice) : std::runtime_error(advice.text), advice_(advice.text) {}

  [[nodiscard]] const std::vector<Setting>& settings() const { return settings_; }
  [[nodiscard]] const std::string& advice() const { return advice_; }

 private:
  std::vector<Setting> settings_;
  std::string advice_;
};

// What a person should know although nothing failed, whole sentences; and the settings that would change it.
struct Note {
  Note(std::string said, std::vector<Setting> that_change_it = {})
      : text(std::move(said)), settings(std::move(that_change_it)) {}

  std::string text;
  std::vector<Setting> settings;
  bool is_warning = false;  // something is lost: that is said also where nothing else is (--quiet)
};

[[nodiscard]] inline Note warning_of(std::string said) {
  Note note(std::move(said));
  note.is_warning = true;
  return note;
}

// The request itself makes no sense: options that contradict each other, an unknown name.
struct UsageError : Error {
  using Error::Error;
};

// Something that was read is wrong: a clip, a .tik, a mask, a function file.
struct InputError : Error {
  using Error::Error;
};

// The OpenCL device cannot do it: absent, too small, a failed build.
struct DeviceError : Error {
  using Error::Error;
};

// The result cannot be written.
struct OutputError : Error {
  using Error::Error;
};

// The result may err by more than was allowed.
struct ImpreciseError : Error {
  using Error::Error;
};

// Whoever asked does not want the result any more.
struct Cancelled : Error {
  Cancelled() : Error("it was cancelled") {}
};

// Whether a request that asks for less may be granted.
[[nodiscard]] inline bool is_refusal(const Error& error) {
  return dynamic_cast<const UsageError*>(&error) != nullptr || dynamic_cast<const InputError*>(&error) != nullptr ||
         dynamic_cast<const OutputError*>(&error) != nullptr;
}

}  // namespace nutik
