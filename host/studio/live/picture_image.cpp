#include "studio/live/picture_image.hpp"

namespace nutik::studio {

QImage image_of(const Picture& picture) {
  const auto codes = picture.values<std::uint8_t>();
  const auto width = static_cast<int>(picture.shape.width);
  const auto format = picture.shape.channels == 1 ? QImage::Format_Grayscale8 : QImage::Format_RGB888;
  const QImage borrowed(codes.data(), width, static_cast<int>(picture.shape.height),
                        static_cast<qsizetype>(picture.shape.width) * picture.shape.channels, format);
  return borrowed.convertToFormat(QImage::Format_RGB32);
}

OutputFormat screen_format() {
  OutputFormat format;
  format.transfer = Transfer::srgb();
  return format;
}

QRect rectangle_of(const Rectangle& rectangle) {
  return {static_cast<int>(rectangle.x), static_cast<int>(rectangle.y), static_cast<int>(rectangle.width),
          static_cast<int>(rectangle.height)};
}

Rectangle rectangle_of(const QRect& rectangle, const Shape& shape) {
  const QRect part = rectangle & rectangle_of(Rectangle::whole(shape));
  if (part.isEmpty()) return Rectangle::whole(shape);
  return {static_cast<std::uint32_t>(part.x()), static_cast<std::uint32_t>(part.y()),
          static_cast<std::uint32_t>(part.width()), static_cast<std::uint32_t>(part.height())};
}

}  // namespace nutik::studio
