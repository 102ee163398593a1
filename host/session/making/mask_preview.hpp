// What a mask's preview lies on.
#pragma once

#include <optional>

#include "exposure/mask.hpp"
#include "session/exposed_picture.hpp"
#include "session/requests/mask_request.hpp"
#include "session/session.hpp"

namespace nutik {

// An interval as a plain exposure's, the picture at a start alone, or neither: all of the capture.
struct BackdropTime {
  std::optional<StatedTime> start, length;
};

// An exposure of the capture.
[[nodiscard]] ExposedPicture backdrop_of(Session& session, const BackdropTime& time);

// Without a capture: the first picture that the mask was made from, else plain grey.
[[nodiscard]] Picture backdrop_of(const MaskRequest& request, const Mask& mask);

}  // namespace nutik
