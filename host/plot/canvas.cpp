#include "plot/canvas.hpp"

#include <algorithm>
#include <cairo.h>
#include <new>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/source_text.hpp"

namespace nutik::plot {
namespace {

constexpr const char* kFont = "DejaVu Sans";

struct DestroySurface {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
struct DestroyContext {
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};
using Surface = std::unique_ptr<cairo_surface_t, DestroySurface>;
using Context = std::unique_ptr<cairo_t, DestroyContext>;

void check(cairo_status_t status) {
  if (status == CAIRO_STATUS_SUCCESS) return;
  if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
  throw OutputError(format("the picture cannot be drawn: {}", cairo_status_to_string(status)));
}

void set_colour(cairo_t* context, const Colour& colour) {
  cairo_set_source_rgba(context, colour.red, colour.green, colour.blue, colour.opacity);
}

void set_font(cairo_t* context, const TextStyle& style) {
  cairo_select_font_face(context, kFont, CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context, style.size);
}

void set_path(cairo_t* context, std::span<const Point> points) {
  cairo_new_path(context);
  for (const Point& point : points) cairo_line_to(context, point.x, point.y);
}

// A pixel of Cairo's RGB24: 0x00rrggbb in native byte order.
std::uint32_t pixel_of(const Picture& picture, std::uint64_t pixel) {
  const auto codes = picture.values<std::uint8_t>();
  const std::uint32_t channels = picture.shape.channels;
  const std::uint64_t first = pixel * channels;
  const auto code = [&](std::uint32_t channel) -> std::uint32_t {
    return codes[first + std::min(channel, channels - 1)];
  };
  return code(0) << 16 | code(1) << 8 | code(2);
}

}  // namespace

struct Canvas::Sheet {
  Surface surface;
  Context context;
};

Canvas::Canvas(std::uint32_t width, std::uint32_t height, Colour background)
    : width_(width), height_(height), sheet_(std::make_unique<Sheet>()) {
  if (width == 0 || height == 0 || std::max(width, height) > kLargestSide) {
    throw UsageError(format("a drawing of {} x {} pixels is not possible: each side has 1 … {}; draw less",
                            width, height, kLargestSide));
  }
  sheet_->surface.reset(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(width), static_cast<int>(height)));
  sheet_->context.reset(cairo_create(sheet_->surface.get()));
  check(cairo_status(sheet_->context.get()));
  cairo_set_line_join(sheet_->context.get(), CAIRO_LINE_JOIN_BEVEL);
  fill(Box{0, 0, static_cast<double>(width), static_cast<double>(height)}, background);
}

Canvas::~Canvas() = default;

void Canvas::line(std::span<const Point> points, const LineStyle& style) {
  cairo_t* context = sheet_->context.get();
  set_path(context, points);
  set_colour(context, style.colour);
  cairo_set_line_width(context, style.width);
  const double dashes[2] = {4 * style.width, 2.5 * style.width};
  cairo_set_dash(context, dashes, style.dashed ? 2 : 0, 0);
  cairo_stroke(context);
}

void Canvas::fill(std::span<const Point> polygon, Colour colour) {
  cairo_t* context = sheet_->context.get();
  set_path(context, polygon);
  cairo_close_path(context);
  set_colour(context, colour);
  cairo_fill(context);
}

void Canvas::fill(const Box& box, Colour colour) {
  const Point corners[] = {
      {box.x, box.y}, {box.right(), box.y}, {box.right(), box.bottom()}, {box.x, box.bottom()}};
  fill(corners, colour);
}

void Canvas::frame(const Box& box, const LineStyle& style) {
  const double in = style.width / 2;
  const Point corners[] = {{box.x + in, box.y + in},
                           {box.right() - in, box.y + in},
                           {box.right() - in, box.bottom() - in},
                           {box.x + in, box.bottom() - in},
                           {box.x + in, box.y}};
  line(corners, style);
}

double Canvas::text_width(std::string_view text, const TextStyle& style) const {
  cairo_t* context = sheet_->context.get();
  set_font(context, style);
  cairo_text_extents_t extents;
  cairo_text_extents(context, printable(text).c_str(), &extents);
  return extents.x_advance;
}

void Canvas::text(Point at, std::string_view text, const TextStyle& style) {
  cairo_t* context = sheet_->context.get();
  set_font(context, style);
  cairo_font_extents_t font;
  cairo_font_extents(context, &font);
  const double width = text_width(text, style);
  const double left = style.align == Align::left ? 0.0 : style.align == Align::centre ? -width / 2 : -width;
  // Half of a capital's height, and of no descender, so that numbers stand level with their ticks.
  constexpr double kHalfCapital = 0.365;
  double down = 0.0;
  switch (style.rise) {
    case Rise::top: down = font.ascent; break;
    case Rise::middle: down = kHalfCapital * style.size; break;
    case Rise::baseline: break;
    case Rise::bottom: down = -font.descent; break;
  }
  cairo_save(context);
  cairo_translate(context, at.x, at.y);
  constexpr double kQuarterTurn = 1.5707963267948966;
  if (style.upwards) cairo_rotate(context, -kQuarterTurn);
  cairo_move_to(context, left, down);
  set_colour(context, style.colour);
  cairo_show_text(context, printable(text).c_str());
  cairo_restore(context);
}

void Canvas::picture(const Box& box, const Picture& picture) {
  const auto width = static_cast<int>(picture.shape.width);
  const auto height = static_cast<int>(picture.shape.height);
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height));
  check(cairo_surface_status(surface.get()));
  cairo_surface_flush(surface.get());
  const std::uint64_t row_pixels =
      static_cast<std::uint64_t>(cairo_image_surface_get_stride(surface.get())) / 4;
  auto* pixels = reinterpret_cast<std::uint32_t*>(cairo_image_surface_get_data(surface.get()));
  for (std::uint64_t y = 0; y < picture.shape.height; ++y) {
    for (std::uint64_t x = 0; x < picture.shape.width; ++x) {
      pixels[y * row_pixels + x] = pixel_of(picture, y * picture.shape.width + x);
    }
  }
  cairo_surface_mark_dirty(surface.get());
  cairo_t* context = sheet_->context.get();
  cairo_save(context);
  cairo_rectangle(context, box.x, box.y, box.width, box.height);
  cairo_clip(context);
  cairo_translate(context, box.x, box.y);
  cairo_scale(context, box.width / width, box.height / height);
  cairo_set_source_surface(context, surface.get(), 0, 0);
  // Without this the picture's edge fades into nothing.
  cairo_pattern_set_extend(cairo_get_source(context), CAIRO_EXTEND_PAD);
  cairo_pattern_set_filter(cairo_get_source(context), CAIRO_FILTER_GOOD);
  cairo_paint(context);
  cairo_restore(context);
}

Canvas::Clip::Clip(Canvas& canvas, const Box& box) : canvas_(canvas) {
  cairo_t* context = canvas_.sheet_->context.get();
  cairo_save(context);
  cairo_rectangle(context, box.x, box.y, box.width, box.height);
  cairo_clip(context);
}

Canvas::Clip::~Clip() { cairo_restore(canvas_.sheet_->context.get()); }

Picture Canvas::finished() const {
  // After its first error Cairo leaves out all that follows, and says so only when asked.
  check(cairo_status(sheet_->context.get()));
  Picture picture({width_, height_, 3}, ValueType::code8, 255);
  picture.transfer = Transfer::srgb();
  cairo_surface_t* surface = sheet_->surface.get();
  cairo_surface_flush(surface);
  check(cairo_surface_status(surface));
  const std::uint64_t row_pixels = static_cast<std::uint64_t>(cairo_image_surface_get_stride(surface)) / 4;
  const auto* pixels = reinterpret_cast<const std::uint32_t*>(cairo_image_surface_get_data(surface));
  const auto codes = picture.values<std::uint8_t>();
  for (std::uint64_t y = 0, i = 0; y < height_; ++y) {
    for (std::uint64_t x = 0; x < width_; ++x) {
      const std::uint32_t pixel = pixels[y * row_pixels + x];
      for (const int shift : {16, 8, 0}) codes[i++] = static_cast<std::uint8_t>(pixel >> shift);
    }
  }
  return picture;
}

std::string fitted(const Canvas& canvas, std::string_view text, double width, const TextStyle& style) {
  std::string shown(text);
  while (!text.empty() && canvas.text_width(shown, style) > width) {
    // A whole character of UTF-8: the bytes that continue it, and its first.
    while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xC0) == 0x80) text.remove_suffix(1);
    if (!text.empty()) text.remove_suffix(1);
    shown = std::string(text) + "…";
  }
  return shown;
}

}  // namespace nutik::plot
