// A sheet to draw on: text, lines, areas and pictures, smooth at their edges. Cairo's only user.
//
//   units:   pixels from the top left; y grows downwards; 0.5 is the middle of the first pixel
//   always:  what lies outside the sheet is left out; text is UTF-8, and what of it cannot be
//            shown (bytes that are no UTF-8, controls) stands as escapes: \xe9
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "capture/picture.hpp"

namespace nutik::plot {

// Colours of drawings, told apart by every kind of colour vision and in grey. tools/fnplot has the same.

// sRGB codes as fractions; opacity 1 covers what is behind.
struct Colour {
  double red = 0.0;
  double green = 0.0;
  double blue = 0.0;
  double opacity = 1.0;

  // 0x0060a8 is (0, 96, 168).
  [[nodiscard]] static constexpr Colour of(std::uint32_t rgb, double opacity = 1.0) {
    return {((rgb >> 16) & 0xFF) / 255.0, ((rgb >> 8) & 0xFF) / 255.0, (rgb & 0xFF) / 255.0, opacity};
  }
};

inline constexpr Colour kWhite = Colour::of(0xffffff);
inline constexpr Colour kText = Colour::of(0x202020);
inline constexpr Colour kNote = Colour::of(0x505050);
inline constexpr Colour kGrid = Colour::of(0xd4d4d4);
inline constexpr Colour kZeroLine = Colour::of(0xa0a0a0);

// What adds light and what takes it away.
inline constexpr Colour kPositive = Colour::of(0x0060a8);
inline constexpr Colour kPositiveArea = Colour::of(0x9ecae9);
inline constexpr Colour kNegativeArea = Colour::of(0xfdc086);

// Several things in one drawing: Okabe and Ito's colours, from the most to the least distinct on white.
inline constexpr std::array<Colour, 7> kPalette{
    Colour::of(0x0072b2), Colour::of(0xd55e00), Colour::of(0x009e73), Colour::of(0xcc79a7),
    Colour::of(0x56b4e9), Colour::of(0xe69f00), Colour::of(0x000000)};

inline constexpr std::uint32_t kLargestSide = 32'767;  // of a sheet, in pixels: Cairo's limit

struct Point {
  double x = 0.0;
  double y = 0.0;
};

struct Box {
  double x = 0.0;
  double y = 0.0;
  double width = 0.0;
  double height = 0.0;

  [[nodiscard]] double right() const { return x + width; }
  [[nodiscard]] double bottom() const { return y + height; }
};

// Which part of a text lies at its point.
enum class Align { left, centre, right };
enum class Rise { top, middle, baseline, bottom };

struct TextStyle {
  double size = 13.0;  // of the font, in pixels
  Colour colour = kText;
  Align align = Align::left;
  Rise rise = Rise::baseline;
  bool bold = false;
  bool upwards = false;  // turned by 90 degrees, read from below
};

struct LineStyle {
  Colour colour = kText;
  double width = 1.0;
  bool dashed = false;
};

class Canvas {
 public:
  // Throws UsageError where the sheet would pass kLargestSide or have no pixel.
  Canvas(std::uint32_t width, std::uint32_t height, Colour background = kWhite);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  [[nodiscard]] std::uint32_t width() const { return width_; }
  [[nodiscard]] std::uint32_t height() const { return height_; }

  void line(std::span<const Point> points, const LineStyle& style);
  void fill(std::span<const Point> polygon, Colour colour);
  void fill(const Box& box, Colour colour);
  void frame(const Box& box, const LineStyle& style);  // its outline, inside the box

  void text(Point at, std::string_view text, const TextStyle& style = {});
  // How wide a line of text is.
  [[nodiscard]] double text_width(std::string_view text, const TextStyle& style = {}) const;

  // A picture of 8-bit codes, grey or colour, scaled to the box. Its aspect is the caller's care.
  void picture(const Box& box, const Picture& picture);

  // Until the returned object goes, nothing is drawn outside the box.
  class Clip {
   public:
    explicit Clip(Canvas& canvas, const Box& box);
    ~Clip();
    Clip(const Clip&) = delete;
    Clip& operator=(const Clip&) = delete;

   private:
    Canvas& canvas_;
  };

  // What was drawn: 8-bit colour. Throws std::bad_alloc or OutputError where Cairo could not draw all of it.
  [[nodiscard]] Picture finished() const;

 private:
  struct Sheet;

  std::uint32_t width_;
  std::uint32_t height_;
  std::unique_ptr<Sheet> sheet_;
};

// As much of a line's front as is no wider than `width`, with an ellipsis where something is left out.
[[nodiscard]] std::string fitted(const Canvas& canvas, std::string_view text, double width,
                                 const TextStyle& style = {});

}  // namespace nutik::plot
