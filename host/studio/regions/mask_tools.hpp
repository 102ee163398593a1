// What paints regions on the canvas: brush, rectangle, ellipse, polygon, magic wand.
//
//   in:      strokes in the picture's coordinates
//   out:     edits of the document: the selected region gets the pixels; with Alt held it loses them
//   always:  a stroke is one undo step. Escape takes back what is not finished
#pragma once

#include <QImage>
#include <functional>
#include <memory>
#include <vector>

#include "mask/region.hpp"
#include "studio/canvas/picture_canvas.hpp"
#include "studio/document/document.hpp"

namespace nutik::studio {

enum class ToolKind { look, brush, rectangle, ellipse, polygon, wand };

struct ToolSettings {
  double brush_radius = 12;  // pixels of the picture
  int wand_codes = 24;       // codes of 255 that a channel may differ by from where it was clicked
};

// Null for ToolKind::look. `settings` are read at each stroke; `image` is what the wand looks at.
[[nodiscard]] std::unique_ptr<CanvasTool> make_tool(ToolKind kind, Document& document,
                                                    const ToolSettings& settings,
                                                    std::function<const QImage&()> image);

// The pixels that hang together with one, over their sides, and differ from it by at most so many codes in each
// channel.
[[nodiscard]] Region similar_pixels(const QImage& image, QPoint from, int codes);

}  // namespace nutik::studio
