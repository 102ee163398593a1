// Pictures from files beside those of a capture, in codes that can be compared.
//
//   in:      a picture of the capture, in its codes; one from a file, in codes of any transfer function, depth and
//            white code, or light
//   out:     both in codes of the capture's transfer function, depth and white code, after the same losses: the
//            capture's picture went through the codes of the file, made of light as the program makes them
//   always:  codes of the capture's own kind stay as they are. Those of which their file says nothing are of its
//            transfer function and primaries
#pragma once

#include <string>
#include <utility>

#include "capture/picture.hpp"
#include "features/masks/mask_request.hpp"

namespace nutik {

// `named` becomes the second. Both have as many channels. Throws InputError where nothing tells how its codes would be
// made of the capture's light.
[[nodiscard]] std::pair<Shared<Picture>, Shared<Picture>> comparable_codes(Shared<Picture> captured,
                                                                           const CaptureFormat& capture,
                                                                           const NamedPicture& named);

// That nothing says what a picture's codes stand for, where that may not be what they are taken for; else empty.
[[nodiscard]] std::string silence_note(const CaptureFormat& capture, const NamedPicture& named);

}  // namespace nutik
