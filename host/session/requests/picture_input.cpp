#include "session/requests/picture_input.hpp"

#include <filesystem>

#include "capture/format.hpp"
#include "media/clip.hpp"
#include "media/stills/still_sequence.hpp"
#include "system/is_absent.hpp"

namespace nutik {

Picture read_picture(const std::string& name) {
  if (is_absent(name)) {
    throw InputError(format("{} cannot be read: no such file", name));
  }
  const auto stills = list_stills(name);
  if (!stills || stills->size() != 1) {
    throw UsageError(format("{} is {}; a picture is needed (PNG, TIFF, PGM, PPM, JPEG)", name,
                                 stills ? format("a sequence of {}", stills->size()) : "no picture"),
                          Advice{", or a time of the capture: 0.3s, 12f"});
  }
  const auto clip = open_clip(name, {});
  const CaptureFormat& kind = clip->info().format;
  Picture picture(kind.shape, code_type(kind), kind.white_code);
  if (!clip->read(picture.bytes)) throw InputError(format("{} has no picture", name));
  const std::uint32_t largest = largest_code(picture.bytes, kind.code_bytes);
  if (largest > picture.white_code) {
    throw InputError(
        format("{} cannot be read: it has a code of {}, above the {} that it states as its largest; write it "
               "again with the right one",
               name, largest, picture.white_code));
  }
  return picture;
}

}  // namespace nutik
