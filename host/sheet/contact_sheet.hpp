// A contact sheet: many pictures in a grid, each small, with a label.
//
//   in:      pictures of one shape, with labels
//   out:     one of 8-bit colour
//   always:  every picture as large as the others, however long its label
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "plot/canvas.hpp"

namespace nutik::sheet {

// How many pictures lie beside each other, and how large.
struct SheetLayout {
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;
  std::uint32_t cell_width = 0;  // of the pictures, in pixels
  std::uint32_t cell_height = 0;

  [[nodiscard]] std::uint32_t width() const;  // of the whole sheet
  [[nodiscard]] std::uint32_t height() const;
};

// What was asked for, and what is chosen where nothing was.
struct SheetWishes {
  std::optional<std::uint32_t> columns;
  std::optional<std::uint32_t> width;  // of the whole sheet; default: up to kDefaultWidth
  friend bool operator==(const SheetWishes&, const SheetWishes&) = default;
};
inline constexpr std::uint32_t kDefaultWidth = 1600;
inline constexpr std::uint64_t kMaxPictures = 400;  // on a sheet
inline constexpr std::uint32_t kNarrowestCell = 48;  // in which a label can be read

// A layout for `count` pictures of this shape. Where no width was asked for, none is enlarged beyond twice
// kNarrowestCell. Throws UsageError where pictures would be narrower than kNarrowestCell, or the sheet higher than can
// be drawn.
[[nodiscard]] SheetLayout lay_out(const Shape& picture, std::uint32_t count, const SheetWishes& wishes);

class ContactSheet {
 public:
  ContactSheet(const SheetLayout& layout, const std::string& heading);

  // The next picture, of codes, row by row from the top left. `label` is shortened where it does not fit.
  void add(const std::string& label, const Picture& picture);

  [[nodiscard]] Picture finished() const { return canvas_.finished(); }

 private:
  SheetLayout layout_;
  plot::Canvas canvas_;
  std::uint32_t count_ = 0;
};

}  // namespace nutik::sheet
