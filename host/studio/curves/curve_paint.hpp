// Draws the curve editor, part by part. Knows nothing of documents and events.
#pragma once

#include <QPainter>
#include <QPolygonF>
#include <vector>

#include "studio/curves/handles.hpp"
#include "studio/time/time_view.hpp"

namespace nutik::studio {

// The curve from the box's left to its right, with held ends, no finer than pixels: as quick of a million points.
[[nodiscard]] QPolygonF visible_curve(const PlotFrame& frame, const Points& points);

struct PaintedFunction {
  Points points;
  QColor colour;
};

// What stays while points are dragged.
struct Backdrop {
  const TimeAxis* axis = nullptr;
  const Timeline* timeline = nullptr;  // none: no capture is open
  const Series* activity = nullptr;
  const Series* waveform = nullptr;
  std::vector<PaintedFunction> others;
};
void paint_backdrop(QPainter& painter, const PlotFrame& frame, const TimeColours& colours,
                    const Backdrop& backdrop, int width);

void paint_curve(QPainter& painter, const PlotFrame& frame, const TimeColours& colours, const Points& points,
                 const QColor& colour);
// Where points are too many to be told apart only selected ones are drawn.
void paint_points(QPainter& painter, const PlotFrame& frame, const TimeColours& colours, const Points& points,
                  const PointIndices& selected, std::optional<std::size_t> current, const QColor& colour);
void paint_boxcars(QPainter& painter, const PlotFrame& frame, const TimeColours& colours,
                   const std::vector<GainBoxcar>& boxcars, double lane_top, const QColor& colour);
void paint_box(QPainter& painter, const TransformBox& box, const TimeColours& colours);
// Text in a small box near a place, within `area`.
void paint_tip(QPainter& painter, const QRectF& area, QPointF at, const QString& text,
               const TimeColours& colours);
// A warning sign whose foot is at a place.
void paint_warning(QPainter& painter, QPointF at, const TimeColours& colours);

}  // namespace nutik::studio
