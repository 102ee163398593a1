#include "sheet/contact_sheet.hpp"

#include <gtest/gtest.h>

#include "capture/error.hpp"
#include "support/messages.hpp"

namespace nutik::sheet {
namespace {

TEST(SheetLayout, FitsItsWidthAndEnlargesNothing) {
  for (const Shape shape : {Shape{640, 360, 3}, Shape{100, 800, 1}, Shape{3000, 20, 1}, Shape{8, 8, 1}}) {
    for (const std::uint32_t count : {1u, 2u, 7u, 24u, 97u}) {
      const SheetLayout layout = lay_out(shape, count, {});
      EXPECT_LE(layout.width(), kDefaultWidth);
      EXPECT_GE(layout.columns * layout.rows, count);
      EXPECT_LT(layout.columns * (layout.rows - 1), count) << "an empty row";
      EXPECT_LE(layout.cell_width, std::max(shape.width, 2 * kNarrowestCell));
      const double exact = layout.cell_width * static_cast<double>(shape.height) / shape.width;
      EXPECT_NEAR(layout.cell_height, std::max(1.0, exact), 0.5);
    }
  }
  EXPECT_EQ(lay_out({640, 360, 3}, 24, {}).columns, 6u);  // no row is short
  EXPECT_EQ(lay_out({1200, 300, 3}, 2, {}).columns, 1u) << "panoramas stand one above the other";
  EXPECT_EQ(lay_out({640, 200, 3}, 5, {}).columns, 2u) << "rather a short row than a column";
}

TEST(SheetLayout, DoesAsAsked) {
  const SheetLayout layout = lay_out({640, 360, 3}, 10, {.columns = 4, .width = 1000});
  EXPECT_EQ(layout.columns, 4u);
  EXPECT_EQ(layout.rows, 3u);
  EXPECT_LE(layout.width(), 1000u);
  EXPECT_GT(layout.width(), 1000u - 4);  // what does not divide by four
  EXPECT_EQ(lay_out({64, 36, 3}, 3, {.columns = 10, .width = {}}).columns, 3u);
}

std::string refusal(const Shape& shape, std::uint32_t count, const SheetWishes& wishes) {
  return test::message_of<UsageError>([&] { return lay_out(shape, count, wishes); });
}

TEST(SheetLayout, RefusesWhatCannotBeSeenOrDrawn) {
  EXPECT_NE(refusal({640, 360, 3}, 100, {.columns = 50, .width = 1000}).find("choose fewer columns"),
            std::string::npos);
  EXPECT_NE(refusal({100, 3000, 1}, 400, {.columns = 1, .width = {}}).find("make fewer pictures"),
            std::string::npos);
  EXPECT_EQ(refusal({600, 60'000, 1}, 1, {}).find("a row of pictures 60000 pixels high passes the 32767 that"), 0u);
}

TEST(ContactSheet, HasEachPictureInItsPlace) {
  const Shape shape{120, 60, 1};
  const SheetLayout layout = lay_out(shape, 3, {.columns = 2, .width = {}});
  ASSERT_EQ(layout.cell_width, 120u);
  ContactSheet sheet(layout, "heading");
  for (const int code : {10, 20, 30}) {
    Picture picture(shape, ValueType::code8, 255);
    std::fill(picture.bytes.begin(), picture.bytes.end(), std::byte(code));
    sheet.add("a label that is much too long for so narrow a picture", picture);
  }
  const Picture finished = sheet.finished();
  EXPECT_EQ(finished.shape, (Shape{layout.width(), layout.height(), 3}));
  std::array<std::uint64_t, 256> counts{};
  std::uint32_t left[256], top[256];
  std::fill_n(left, 256, ~0u);
  std::fill_n(top, 256, ~0u);
  for (std::uint32_t y = 0; y < finished.shape.height; ++y) {
    for (std::uint32_t x = 0; x < finished.shape.width; ++x) {
      const std::uint8_t code =
          finished.values<std::uint8_t>()[(std::size_t{y} * finished.shape.width + x) * 3];
      ++counts[code];
      left[code] = std::min(left[code], x);
      top[code] = std::min(top[code], y);
    }
  }
  // Dark letters may have these codes at their smooth edges, too; pictures have 7200 pixels.
  for (const int code : {10, 20, 30}) EXPECT_NEAR(double(counts[std::size_t(code)]), 7200.0, 60.0) << code;
  EXPECT_LT(left[10], left[20]);
  EXPECT_LT(top[20], top[30]);
}

}  // namespace
}  // namespace nutik::sheet
