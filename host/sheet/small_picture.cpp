#include "sheet/drawings.hpp"

#include <algorithm>
#include <cmath>

#include "capture/light_means.hpp"

namespace nutik::sheet {

Picture thumbnail(const Picture& picture, std::uint32_t width, std::uint32_t height) {
  const auto code_bytes = static_cast<std::uint32_t>(value_bytes(picture.type));
  Picture small({width, height, picture.shape.channels}, ValueType::code8, 255);
  small.transfer = Transfer::srgb();
  LightMeans(picture.shape, Rectangle::whole(picture.shape), small.shape,
             picture.transfer.value_or(Transfer::srgb()).light_of_all_codes(picture.white_code, code_bytes),
             LightCodes(*small.transfer, small.white_code))
      .take(picture.bytes, code_bytes, small.bytes, 1, 0, height);
  return small;
}

Picture fitted_thumbnail(const Picture& picture, const Shape& shown, std::uint32_t side) {
  const double scale = std::min(1.0, static_cast<double>(side) / std::max(shown.width, shown.height));
  const auto pixels = [&](std::uint32_t length) {
    return static_cast<std::uint32_t>(std::max(1L, std::lround(scale * length)));
  };
  return thumbnail(picture, pixels(shown.width), pixels(shown.height));
}

}  // namespace nutik::sheet
