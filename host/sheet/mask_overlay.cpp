#include "sheet/drawings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "capture/format.hpp"
#include "mask/distance.hpp"
#include "mask/region.hpp"
#include "plot/canvas.hpp"

namespace nutik::sheet {
namespace {

constexpr std::uint32_t kNarrowest = 480;  // in which a legend can be read
constexpr double kTint = 0.5;
constexpr std::size_t kColours = plot::kPalette.size() - 1;  // without black, which shadows have
constexpr double kLegendMargin = 10.0;
constexpr double kLegendLine = 22.0;
constexpr double kSwatch = 14.0;
constexpr std::size_t kMaxInLegend = 60;

struct Tag {
  std::uint8_t tag = 0;
  std::uint64_t pixel_count = 0;
  plot::Colour colour;
};

std::vector<Tag> tags_of(const Mask& mask) {
  const auto counts = mask.pixels_per_tag();
  std::vector<Tag> tags;
  std::size_t colour = 0;
  for (std::uint32_t tag = 0; tag < kMaskValues; ++tag) {
    if (counts[tag] == 0) continue;
    tags.push_back({static_cast<std::uint8_t>(tag), counts[tag],
                    tag == 0 ? plot::kWhite : plot::kPalette[colour++ % kColours]});
  }
  return tags;
}

// The picture in its own colours where the tag is 0, else in grey with the tag's colour over it, which covers all at
// the border of a region. Where tags share a pixel it is a mixture of these.
Picture tinted(const Mask& mask, const std::vector<Tag>& tags, const Picture& enlarged) {
  std::array<plot::Colour, kMaskValues> colours{};
  for (const Tag& tag : tags) colours[tag.tag] = tag.colour;
  Picture result({enlarged.shape.width, enlarged.shape.height, 3}, ValueType::code8, 255);
  const auto codes = result.values<std::uint8_t>();
  const auto source = enlarged.values<std::uint8_t>();
  const std::uint32_t width = result.shape.width, height = result.shape.height;
  const std::uint32_t channels = enlarged.shape.channels;
  const auto below = [&](std::uint64_t x, std::uint64_t y) {  // the mask's pixel
    return y * mask.height / height * mask.width + x * mask.width / width;
  };
  const auto tag_at = [&](std::uint32_t x, std::uint32_t y) { return mask.tags[below(x, y)]; };
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const std::size_t pixel = std::size_t{y} * width + x;
      const std::uint8_t tag = tag_at(x, y);
      const std::span<const Share> shares = mask.mixed.of(below(x, y));
      const bool is_border =
          shares.empty() &&
          ((x > 0 && tag_at(x - 1, y) != tag) || (x + 1 < width && tag_at(x + 1, y) != tag) ||
           (y > 0 && tag_at(x, y - 1) != tag) || (y + 1 < height && tag_at(x, y + 1) != tag));
      const auto code = [&](std::uint32_t channel) {
        return static_cast<double>(source[pixel * channels + std::min(channel, channels - 1)]);
      };
      const double grey = kLuma[0] * code(0) + kLuma[1] * code(1) + kLuma[2] * code(2);
      const auto shown = [&](std::size_t of, std::uint32_t channel) {
        const std::array<double, 3> colour{colours[of].red, colours[of].green, colours[of].blue};
        const double tint = is_border ? 1.0 : kTint;
        return of == 0 ? code(channel) : (1.0 - tint) * grey + tint * 255 * colour[channel];
      };
      for (std::uint32_t channel = 0; channel < 3; ++channel) {
        double value = shares.empty() ? shown(tag, channel) : 0.0;
        for (const Share& share : shares) value += shown(share.of, channel) * share.size / kWholeShare;
        codes[pixel * 3 + channel] = static_cast<std::uint8_t>(std::lround(value));
      }
    }
  }
  return result;
}

// The tag's number at the pixel of its region that lies furthest from all others, if there is room.
void number_region(plot::Canvas& canvas, const Mask& mask, const Tag& tag, double width, double height) {
  const double zoom_x = width / mask.width, zoom_y = height / mask.height;
  Region outside = Region::none(mask.width, mask.height);
  std::transform(mask.tags.begin(), mask.tags.end(), outside.inside.begin(),
                 [&](std::uint8_t other) { return static_cast<std::uint8_t>(other != tag.tag); });
  const std::vector<std::uint64_t> distances = squared_distances(outside);
  const auto widest =
      static_cast<std::size_t>(std::max_element(distances.begin(), distances.end()) - distances.begin());
  const plot::TextStyle style{
      .size = 13.0, .align = plot::Align::centre, .rise = plot::Rise::middle, .bold = true};
  const std::string text = format("M{}", tag.tag);
  const plot::Box plate{0, 0, canvas.text_width(text, style) + 8, 18};
  if (distances[widest] != kFarAway &&
      std::sqrt(static_cast<double>(distances[widest])) * std::min(zoom_x, zoom_y) < plate.height)
    return;
  const double x = std::clamp((static_cast<double>(widest % mask.width) + 0.5) * zoom_x, plate.width / 2,
                              width - plate.width / 2);
  const double y = std::clamp((static_cast<double>(widest / mask.width) + 0.5) * zoom_y, plate.height / 2,
                              height - plate.height / 2);
  canvas.fill(plot::Box{x - plate.width / 2, y - plate.height / 2, plate.width, plate.height}, plot::kWhite);
  canvas.text({x, y}, text, style);
}

std::vector<std::string> legend_of(const std::vector<Tag>& tags, std::uint64_t pixel_count) {
  std::vector<std::string> legend;
  for (const Tag& tag : tags) {
    if (legend.size() == kMaxInLegend) {
      legend.push_back(format("and {} more tags", tags.size() - kMaxInLegend));
      break;
    }
    legend.push_back(format("M{}  {} pixels, {:.3g} %", tag.tag, tag.pixel_count,
                            100.0 * static_cast<double>(tag.pixel_count) / static_cast<double>(pixel_count)));
  }
  return legend;
}

}  // namespace

Picture mask_overlay(const Mask& mask, const Picture& picture) {
  CaptureFormat format;
  format.shape = picture.shape;
  format.pixel_aspect = picture.pixel_aspect;
  const Shape shown = format.shown_shape();
  const std::uint32_t zoom = std::max(1u, (kNarrowest + shown.width - 1) / shown.width);
  const std::uint32_t width = shown.width * zoom, height = shown.height * zoom;
  const std::vector<Tag> tags = tags_of(mask);
  const std::vector<std::string> legend = legend_of(tags, picture.shape.pixel_count());

  double widest = 0.0;
  const plot::Canvas ruler(1, 1);
  for (const std::string& line : legend) widest = std::max(widest, ruler.text_width(line));
  const double column = kSwatch + 6 + widest + 24;
  const auto columns =
      std::max<std::size_t>(1, static_cast<std::size_t>((width - 2 * kLegendMargin + 24) / column));
  const std::size_t lines = (legend.size() + columns - 1) / columns;
  const auto legend_height =
      static_cast<std::uint32_t>(2 * kLegendMargin + static_cast<double>(lines) * kLegendLine);

  plot::Canvas canvas(width, height + legend_height);
  canvas.picture(plot::Box{0, 0, double(width), double(height)},
                 tinted(mask, tags, thumbnail(picture, width, height)));
  for (const Tag& tag : tags) {
    if (tag.tag != 0) number_region(canvas, mask, tag, width, height);
  }
  for (std::size_t i = 0; i < legend.size(); ++i) {
    const double x = kLegendMargin + static_cast<double>(i % columns) * column;
    const double y = height + kLegendMargin + (static_cast<double>(i / columns) + 0.5) * kLegendLine;
    if (i < tags.size() && i < kMaxInLegend) {
      const plot::Box swatch{x, y - kSwatch / 2, kSwatch, kSwatch};
      canvas.fill(swatch, tags[i].colour);
      canvas.frame(swatch, {.colour = plot::kNote});
    }
    canvas.text({x + kSwatch + 6, y}, legend[i], {.rise = plot::Rise::middle});
  }
  return canvas.finished();
}

}  // namespace nutik::sheet
