// The open capture with fewer pixels, and what previews ask of it.
#pragma once

#include <QRect>
#include <memory>

#include "session/live/live_pictures.hpp"
#include "studio/live/changed_pixels.hpp"

namespace nutik::studio {

class ReducedCapture {
 public:
  // Of a session with one pixel for so many of the capture's to a side.
  ReducedCapture(std::shared_ptr<Session> session, int divisor);

  [[nodiscard]] int divisor() const { return divisor_; }
  // Whether a screen that shows a pixel of the capture with so many of its own to a side shows no more than this has.
  // Never with soft masks, whose edges are blended of the capture's pixels.
  [[nodiscard]] bool can_show(const ExposureRequest& exposure, double screen_pixels) const;
  // The same exposure; of the squares that these pixels of the capture lie in.
  [[nodiscard]] LivePart part(ExposureRequest exposure, const QRect& pixels);

 private:
  std::shared_ptr<Session> session_;
  int divisor_;
  SharedMask whole_, mask_;  // the last that was asked for, and as it is here
};

}  // namespace nutik::studio
