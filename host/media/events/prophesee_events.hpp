// Files of Prophesee's cameras: RAW, as the sensor sent it (EVT 2.0, 2.1 and 3.0), and DAT.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "capture/error.hpp"
#include "media/clip.hpp"

namespace nutik {

// The light of a pixel rose or fell by one step.
struct CameraEvent {
  std::int64_t time_us;  // of the camera's clock
  std::uint16_t x, y;
  bool is_up;
};

// The events of a contrast-detecting camera, as its file tells them.
struct CameraEvents {
  std::string kind;  // of the file, for people: `EVT 2.0`
  std::uint32_t width = 0, height = 0;
  std::string size_from;  // what of the file tells the size; empty: it is assumed
  std::vector<CameraEvent> events;  // in the order of their times
  std::vector<Note> notes;
};

// Reads all of a file whose name is `name` and that begins with `% `: once to count its events, and again if there is
// memory for them. Throws InputError if it is of another kind, or holds no event; MemoryTooLittle.
[[nodiscard]] CameraEvents read_prophesee_events(std::span<const std::byte> file, const std::string& name,
                                                 const ClipOptions& options);

// The lines of text that files of Prophesee's cameras begin with: `% keyword value`, until a line that does not begin
// like this or says `% end`.
struct PropheseeHeader {
  std::map<std::string, std::string> values;  // by keyword in small letters; `format`'s own, `height=720`, too
  std::size_t bytes = 0;                      // where the events begin

  [[nodiscard]] const std::string& of(const std::string& keyword) const {
    static const std::string kNone;
    const auto at = values.find(keyword);
    return at == values.end() ? kNone : at->second;
  }
  // 0 if it is missing, or no number of pixels.
  [[nodiscard]] std::uint32_t pixels(const std::string& keyword) const;
};

[[nodiscard]] PropheseeHeader read_prophesee_header(std::span<const std::byte> file);

}  // namespace nutik
