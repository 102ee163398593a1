#include "plot/canvas.hpp"

#include <gtest/gtest.h>

namespace nutik::plot {
namespace {

TEST(FittedText, KeepsWhatFitsAndCutsWholeCharacters) {
  const Canvas canvas(10, 10);
  const std::string text = "gain × 0.5, später";
  EXPECT_EQ(fitted(canvas, text, canvas.text_width(text)), text);
  for (double width = canvas.text_width(text) - 1; width > canvas.text_width("…"); width -= 3) {
    const std::string shown = fitted(canvas, text, width);
    EXPECT_LE(canvas.text_width(shown), width);
    ASSERT_TRUE(shown.ends_with("…")) << shown;
    const std::string front = shown.substr(0, shown.size() - std::string("…").size());
    EXPECT_EQ(text.substr(0, front.size()), front);
    const auto next = static_cast<unsigned char>(text[front.size()]);
    EXPECT_NE(next & 0xC0, 0x80) << "cut within a character: " << shown;
  }
  EXPECT_EQ(fitted(canvas, "", 5), "");
}

}  // namespace
}  // namespace nutik::plot
