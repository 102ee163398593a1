#include "plot/fitted_text.hpp"

namespace nutik::plot {

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
