#include "studio/live/reduced_capture.hpp"

#include <utility>

#include "studio/live/picture_image.hpp"

namespace nutik::studio {
namespace {

// Of each square the tag in its middle.
Mask reduced(const Mask& mask, const Shape& shape, std::uint32_t divisor) {
  Mask tags = Mask::uniform(shape.width, shape.height, 0);
  auto tag = tags.tags.begin();
  for (std::uint32_t y = 0; y < shape.height; ++y) {
    const std::size_t middle = std::size_t{y * divisor + divisor / 2} * mask.width + divisor / 2;
    for (std::uint32_t x = 0; x < shape.width; ++x) *tag++ = mask.tags[middle + x * divisor];
  }
  return tags;
}

}  // namespace

ReducedCapture::ReducedCapture(std::shared_ptr<Session> session, int divisor)
    : session_(std::move(session)), divisor_(divisor) {}

bool ReducedCapture::can_show(const ExposureRequest& exposure, double screen_pixels) const {
  return screen_pixels * divisor_ <= 1 && !(exposure.mask && (*exposure.mask)->mask.is_soft());
}

LivePart ReducedCapture::part(ExposureRequest exposure, const QRect& pixels) {
  const Shape& shape = session_->format().shape;
  if (exposure.mask) {
    if (!whole_ || &**whole_ != &**exposure.mask) {
      whole_ = exposure.mask;
      mask_ = Shared(MaskWithRegions(reduced((*whole_)->mask, shape, static_cast<std::uint32_t>(divisor_))));
    }
    exposure.mask = mask_;
  }
  const QRect all = rectangle_of(Rectangle::whole(shape));
  const auto square = [this](QPoint pixel) { return QPoint(pixel.x() / divisor_, pixel.y() / divisor_); };
  const QRect squares = QRect(square(pixels.topLeft()), square(pixels.bottomRight())) & all;
  return {session_.get(), std::move(exposure), screen_format(),
          rectangle_of(squares.isEmpty() ? QRect(all.bottomRight(), QSize(1, 1)) : squares, shape)};
}

}  // namespace nutik::studio
