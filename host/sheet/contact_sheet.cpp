#include "sheet/contact_sheet.hpp"

#include <algorithm>
#include <cmath>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "plot/canvas.hpp"
#include "sheet/drawings.hpp"

namespace nutik::sheet {
namespace {

constexpr std::uint32_t kSheetMargin = 12;
constexpr std::uint32_t kGap = 8;
constexpr std::uint32_t kLabelHeight = 20;  // below each picture
constexpr std::uint32_t kHeadingHeight = 26;
constexpr double kDefaultCell = 240.0;
constexpr double kDefaultAspect = 1.5;  // of the whole sheet

// As many columns as give a sheet of the usual aspect, or nearly as many where these leave no row short; fewer
// where pictures would be too small to see.
std::uint32_t default_columns(const Shape& picture, std::uint32_t count, std::uint32_t width) {
  const double aspect = static_cast<double>(picture.width) / picture.height;
  const double wanted = std::ceil(std::sqrt(count * kDefaultAspect / aspect));
  const double most = std::max(1.0, std::floor(width / std::min<double>(kDefaultCell, picture.width + kGap)));
  const auto columns = static_cast<std::uint32_t>(std::clamp(wanted, 1.0, std::min<double>(most, count)));
  if (count % columns == 0) return columns;
  for (const std::uint32_t near : {columns + 1, columns - 1}) {
    if (near > 1 && near <= most && count % near == 0) return near;
  }
  return columns;
}

}  // namespace

std::uint32_t SheetLayout::width() const { return 2 * kSheetMargin + columns * cell_width + (columns - 1) * kGap; }
std::uint32_t SheetLayout::height() const {
  return 2 * kSheetMargin + kHeadingHeight + rows * (cell_height + kLabelHeight) + (rows - 1) * kGap;
}

SheetLayout lay_out(const Shape& picture, std::uint32_t count, const SheetWishes& wishes) {
  const std::uint32_t width = wishes.width.value_or(kDefaultWidth);
  SheetLayout layout;
  layout.columns = std::min(wishes.columns.value_or(default_columns(picture, count, width)), count);
  layout.rows = (count + layout.columns - 1) / layout.columns;
  const std::int64_t room = std::int64_t{width} - 2 * kSheetMargin - std::int64_t{layout.columns - 1} * kGap;
  const std::int64_t cell = room / layout.columns;
  if (cell < kNarrowestCell) {
    throw UsageError(format("{} pictures beside each other in {} pixels would be {} wide; at least {} are "
                            "needed: choose fewer "
                            "columns or a larger width",
                            layout.columns, width, std::max<std::int64_t>(cell, 0), kNarrowestCell),
                     {Setting::columns, Setting::width});
  }
  layout.cell_width = static_cast<std::uint32_t>(cell);
  if (!wishes.width) {
    layout.cell_width = std::min(layout.cell_width, std::max(picture.width, 2 * kNarrowestCell));
  }
  const double height = std::round(static_cast<double>(layout.cell_width) * picture.height / picture.width);
  layout.cell_height = static_cast<std::uint32_t>(std::clamp(height, 1.0, double{plot::kLargestSide}));
  const double total = static_cast<double>(layout.rows) * (layout.cell_height + kLabelHeight + kGap);
  if (total > plot::kLargestSide - 2 * kSheetMargin - kHeadingHeight) {
    throw UsageError(
        format(
            "{} {} pixels high {} the {} that a sheet can have; make fewer pictures, or smaller ones with more columns "
            "or a smaller width",
            layout.rows == 1 ? "a row of pictures" : format("{} rows of pictures", layout.rows), height,
            layout.rows == 1 ? "passes" : "pass", plot::kLargestSide),
        {Setting::columns, Setting::width});
  }
  return layout;
}

ContactSheet::ContactSheet(const SheetLayout& layout, const std::string& heading)
    : layout_(layout), canvas_(layout.width(), layout.height()) {
  const plot::TextStyle style{.size = 15.0, .rise = plot::Rise::top, .bold = true};
  canvas_.text({kSheetMargin, kSheetMargin - 3.0},
               plot::fitted(canvas_, heading, layout.width() - 2.0 * kSheetMargin, style), style);
}

void ContactSheet::add(const std::string& label, const Picture& picture) {
  const std::uint32_t column = count_ % layout_.columns, row = count_ / layout_.columns;
  ++count_;
  const plot::Box box{kSheetMargin + column * (layout_.cell_width + double{kGap}),
                      kSheetMargin + kHeadingHeight + row * (layout_.cell_height + kLabelHeight + double{kGap}),
                      double(layout_.cell_width), double(layout_.cell_height)};
  canvas_.picture(box, thumbnail(picture, layout_.cell_width, layout_.cell_height));
  const plot::TextStyle style{.size = 13.0, .rise = plot::Rise::top};
  canvas_.text({box.x, box.bottom() + 2.0}, plot::fitted(canvas_, label, box.width, style), style);
}

}  // namespace nutik::sheet
