#include "studio/curves/curve_paint.hpp"

#include <QFontMetricsF>
#include <algorithm>
#include <cmath>

#include "plot/graph.hpp"

namespace nutik::studio {
namespace {

constexpr double kFarPixels =
    20'000;  // what lies further up or down is cut: painters compute in short numbers
constexpr double kLinePixels = 1.8, kOtherLinePixels = 1.2;

// Adds a vertex, and where the line to it leaves what is painted, the place at which it does.
void add_vertex(QPolygonF& line, QPointF& previous, QPointF to) {
  const auto held = [](double y) { return std::clamp(y, -kFarPixels, kFarPixels); };
  const auto crossing = [&](double y) {
    const double share = (y - previous.y()) / (to.y() - previous.y());
    return QPointF(previous.x() + share * (to.x() - previous.x()), y);
  };
  if (!line.isEmpty()) {
    std::vector<QPointF> places;
    for (const double limit : {-kFarPixels, kFarPixels})
      if ((previous.y() < limit) != (to.y() < limit)) places.push_back(crossing(limit));
    std::sort(places.begin(), places.end(), [&](QPointF a, QPointF b) {
      return std::fabs(a.y() - previous.y()) < std::fabs(b.y() - previous.y());
    });
    for (const QPointF& place : places) line << place;
  }
  line << QPointF(to.x(), held(to.y()));
  previous = to;
}

// Painters compare all sides of a long line or area with each other, which takes seconds: they get short parts. Smooth
// lines take their time even so, and a drag has few milliseconds: of many parts they are drawn without.
constexpr qsizetype kSmooth = 160, kDense = 1'500, kTogether = 32;

void paint_line(QPainter& painter, const QPolygonF& line, const QColor& colour, double width) {
  painter.setBrush(Qt::NoBrush);
  if (line.size() > kSmooth) {
    painter.setRenderHint(QPainter::Antialiasing, false);
    painter.setPen(QPen(colour, 0));
    painter.drawPolyline(line);
    if (width > kOtherLinePixels) painter.drawPolyline(line.translated(0, 1));
    return;
  }
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(colour, width));
  for (qsizetype first = 0; first + 1 < line.size(); first += kTogether)
    painter.drawPolyline(line.constData() + first,
                         static_cast<int>(std::min(kTogether + 1, line.size() - first)));
}

// Between a line and a height.
void paint_area(QPainter& painter, const QPolygonF& line, double foot, const QBrush& brush) {
  painter.setRenderHint(QPainter::Antialiasing, false);
  painter.setPen(Qt::NoPen);
  painter.setBrush(brush);
  if (line.size() <= kDense) {
    for (qsizetype first = 0; first + 1 < line.size(); first += kTogether) {
      QPolygonF part = line.mid(first, kTogether + 1);
      part << QPointF(part.back().x(), foot) << QPointF(part.front().x(), foot);
      painter.drawPolygon(part);
    }
    return;
  }
  for (auto vertex = line.begin(); vertex != line.end();) {
    const int column = static_cast<int>(std::floor(vertex->x()));
    double low = foot, high = foot;
    for (; vertex != line.end() && static_cast<int>(std::floor(vertex->x())) == column; ++vertex) {
      low = std::max(low, vertex->y());
      high = std::min(high, vertex->y());
    }
    const int next = vertex == line.end() ? column + 1 : static_cast<int>(std::floor(vertex->x()));
    const int top = static_cast<int>(std::floor(high));
    painter.fillRect(column, top, next - column, static_cast<int>(std::ceil(low)) - top, brush);
  }
}

// A point's sign, drawn once for all points.
constexpr double kSignPixels = 12;
QPixmap round_sign(double radius, const QPen& pen, const QColor& inside, qreal ratio) {
  QPixmap sign((QSizeF(kSignPixels, kSignPixels) * ratio).toSize());
  sign.setDevicePixelRatio(ratio);
  sign.fill(Qt::transparent);
  QPainter painter(&sign);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(pen);
  painter.setBrush(inside);
  painter.drawEllipse(QPointF(kSignPixels / 2, kSignPixels / 2), radius, radius);
  return sign;
}

void paint_series(QPainter& painter, const PlotFrame& frame, const TimeColours& colours,
                  const Backdrop& backdrop, int width) {
  const QRectF& box = frame.box();
  painter.setPen(Qt::NoPen);
  if (backdrop.activity != nullptr && !backdrop.activity->empty()) {
    const auto columns = columns_of(*backdrop.activity, *backdrop.timeline, *backdrop.axis, width);
    const Series::Range all = backdrop.activity->over(0, backdrop.activity->values().size());
    painter.setBrush(with_opacity(colours.activity, 0.30));
    constexpr double kShare = 0.3;  // of the height: it lies behind
    painter.drawPolygon(area_of(columns, box.adjusted(0, box.height() * (1 - kShare), 0, 0), all.high));
  }
  if (backdrop.waveform != nullptr && !backdrop.waveform->empty()) {
    QPolygonF line;
    const Series::Range all = backdrop.waveform->over(0, backdrop.waveform->values().size());
    const double most = all.high > 0.0 ? all.high * 1.05 : 1.0;  // of dark pixels, too, the course is seen
    const auto y_of = [&](double light) { return box.bottom() - box.height() * std::max(light, 0.0) / most; };
    for (const SeriesColumn& column :
         columns_of(*backdrop.waveform, *backdrop.timeline, *backdrop.axis, width))
      line << QPointF(column.x, y_of(column.range.high)) << QPointF(column.x + 1, y_of(column.range.low));
    painter.setPen(QPen(colours.waveform, 1.0));
    painter.drawPolyline(line);
  }
}

void paint_gain_axis(QPainter& painter, const PlotFrame& frame, const TimeColours& colours) {
  const QRectF& box = frame.box();
  constexpr double kApart = 34;
  const int most = std::clamp(static_cast<int>(box.height() / kApart), 2, 12);
  const plot::Ticks ticks = plot::number_ticks(frame.gains().low, frame.gains().high, most);
  const QFontMetricsF metrics(painter.font());
  for (const plot::Tick& tick : ticks.ticks) {
    const double y = std::round(frame.y_of(tick.at)) + 0.5;
    painter.setPen(QPen(tick.at == 0.0 ? colours.axis : colours.grid, 1));
    painter.drawLine(QPointF(box.left(), y), QPointF(box.right(), y));
    painter.setPen(colours.label);
    const QString label =
        metrics.elidedText(QString::fromStdString(tick.label), Qt::ElideRight, box.left() - 12);
    painter.drawText(QRectF(0, y - metrics.height() / 2, box.left() - 7, metrics.height()),
                     Qt::AlignRight | Qt::AlignVCenter, label);
  }
}

void paint_time_grid(QPainter& painter, const PlotFrame& frame, const TimeColours& colours,
                     const TimeAxis& axis) {
  const QRectF& box = frame.box();
  constexpr double kApart = 90;
  const int most = std::max(static_cast<int>(box.width() / kApart), 2);
  const auto ticks = plot::time_ticks(std::llround(axis.begin_ns()), std::llround(axis.end_ns()), most);
  painter.setPen(QPen(colours.grid, 1));
  for (const plot::Tick& tick : ticks.ticks) {
    const double x = std::round(frame.x_of(std::llround(tick.at))) + 0.5;
    if (x >= box.left() && x <= box.right())
      painter.drawLine(QPointF(x, box.top()), QPointF(x, box.bottom()));
  }
}

}  // namespace

QPolygonF visible_curve(const PlotFrame& frame, const Points& points) {
  QPolygonF line;
  if (points.empty()) return line;
  const QRectF& box = frame.box();
  // Whole nanoseconds may be many pixels apart: the ends lie outside the box.
  const std::int64_t begin = frame.time_at(box.left() - 2) - 1, end = frame.time_at(box.right() + 2) + 1;
  const auto earlier = [](const ControlPoint& point, std::int64_t time) { return point.time_ns < time; };
  const auto first = std::lower_bound(points.begin(), points.end(), begin, earlier);
  const auto last = std::lower_bound(first, points.end(), end + 1, earlier);

  QPointF previous;
  const auto add = [&](std::int64_t time_ns, double gain) {
    add_vertex(line, previous, {frame.x_of(time_ns), frame.y_of(gain)});
  };
  add(begin, gain_at(points, begin));
  if (static_cast<double>(last - first) <= 4 * box.width()) {
    for (auto point = first; point != last; ++point) add(point->time_ns, point->gain);
  } else {
    // A pixel's first, lowest, highest and last points look like all of its points.
    for (auto point = first; point != last;) {
      const double column = std::floor(frame.x_of(point->time_ns));
      auto low = point, high = point, next = point;
      for (; next != last && std::floor(frame.x_of(next->time_ns)) == column; ++next) {
        if (next->gain < low->gain) low = next;
        if (next->gain > high->gain) high = next;
      }
      add(point->time_ns, point->gain);
      add(std::min(low, high)->time_ns, std::min(low, high)->gain);
      add(std::max(low, high)->time_ns, std::max(low, high)->gain);
      add((next - 1)->time_ns, (next - 1)->gain);
      point = next;
    }
  }
  add(end, gain_at(points, end));
  return line;
}

void paint_backdrop(QPainter& painter, const PlotFrame& frame, const TimeColours& colours,
                    const Backdrop& backdrop, int width) {
  const QRectF& box = frame.box();
  painter.fillRect(box, colours.ground);
  paint_gain_axis(painter, frame, colours);
  painter.save();
  painter.setClipRect(box);
  if (backdrop.timeline != nullptr) {
    const double start = frame.x_of(0), end = frame.x_of(backdrop.timeline->duration_ns());
    painter.fillRect(QRectF(box.topLeft(), QPointF(std::min(start, box.right()), box.bottom())),
                     colours.outside);
    painter.fillRect(QRectF(QPointF(std::max(end, box.left()), box.top()), box.bottomRight()),
                     colours.outside);
    paint_time_grid(painter, frame, colours, *backdrop.axis);
    paint_series(painter, frame, colours, backdrop, width);
  }
  for (const PaintedFunction& other : backdrop.others) {
    // Mixed, not seen through: parts of a line that meet are no darker.
    paint_line(painter, visible_curve(frame, other.points), mixed(colours.ground, other.colour, 0.5),
               kOtherLinePixels);
  }
  painter.restore();
}

void paint_curve(QPainter& painter, const PlotFrame& frame, const TimeColours& colours, const Points& points,
                 const QColor& colour) {
  const QPolygonF line = visible_curve(frame, points);
  if (line.isEmpty()) return;
  const QRectF& box = frame.box();
  const double zero = std::clamp(frame.y_of(0.0), box.top(), box.bottom());
  const double foot = std::clamp(frame.y_of(0.0), -kFarPixels, kFarPixels);
  painter.save();
  painter.setClipRect(QRectF(box.topLeft(), QPointF(box.right(), zero)));
  paint_area(painter, line, foot, with_opacity(colour, 0.20));
  const auto is_negative = [](const ControlPoint& point) { return point.gain < 0.0; };
  if (std::any_of(points.begin(), points.end(), is_negative)) {
    painter.setClipRect(QRectF(QPointF(box.left(), zero), box.bottomRight()));
    paint_area(painter, line, foot, with_opacity(colours.negative, 0.26));
    paint_area(painter, line, foot, QBrush(with_opacity(colours.negative, 0.55), Qt::BDiagPattern));
  }
  painter.setClipRect(box.adjusted(0, -1, 0, 1));
  paint_line(painter, line, colour, kLinePixels);
  painter.restore();
}

void paint_points(QPainter& painter, const PlotFrame& frame, const TimeColours& colours, const Points& points,
                  const PointIndices& selected, std::optional<std::size_t> current, const QColor& colour) {
  const QRectF reach = frame.box().adjusted(-kHandlePixels, -kHandlePixels, kHandlePixels, kHandlePixels);
  const PointIndices seen = points_within(frame, points, reach);
  constexpr double kApart = 3;
  const bool is_dense = static_cast<double>(seen.size()) * kApart > frame.box().width();
  const double plain = is_dense ? 2.0 : 4.0, chosen = is_dense ? 2.0 : 4.5;
  const qreal ratio = painter.device()->devicePixelRatioF();
  const QPixmap plain_sign = round_sign(plain, QPen(colour, 1.6), colours.ground, ratio);
  const QPixmap chosen_sign = round_sign(chosen, QPen(colours.text, 1.6), colour, ratio);
  for (const std::size_t i : seen) {
    const bool is_selected = std::binary_search(selected.begin(), selected.end(), i);
    if (is_dense && !is_selected) continue;
    const QPointF at = frame.place(points[i]);
    const double half = kSignPixels / 2;
    painter.drawPixmap(at - QPointF(half, half), is_selected ? chosen_sign : plain_sign);
    if (current != i) continue;
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(colours.text, 1.0, Qt::DotLine));
    painter.drawEllipse(at, chosen + 4, chosen + 4);
    painter.restore();
  }
}

void paint_boxcars(QPainter& painter, const PlotFrame& frame, const TimeColours& colours,
                   const std::vector<GainBoxcar>& boxcars, double lane_top, const QColor& colour) {
  const QRectF& box = frame.box();
  painter.save();
  painter.setClipRect(QRectF(box.left() - kHandlePixels, box.top(), box.width() + 2 * kHandlePixels,
                             lane_top + kLanePixels - box.top()));
  for (const GainBoxcar& boxcar : boxcars) {
    const BoxcarHandles handles = BoxcarHandles::of(frame, boxcar, lane_top);
    if (handles.bar.right() < box.left() || handles.bar.left() > box.right()) continue;
    const QColor tint = boxcar.gain < 0 ? colours.negative : colour;
    painter.setPen(Qt::NoPen);
    painter.setBrush(mixed(colours.ground, tint, 0.45));
    painter.drawRect(handles.bar);
    painter.setBrush(tint);
    painter.drawRect(handles.begin);
    painter.drawRect(handles.end);
    if (!box.contains(handles.level.center())) continue;
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(QPen(colours.ground, 1));
    painter.drawRoundedRect(handles.level, 3, 3);
    painter.setRenderHint(QPainter::Antialiasing, false);
  }
  painter.restore();
}

void paint_box(QPainter& painter, const TransformBox& box, const TimeColours& colours) {
  painter.save();
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(colours.axis, 1, Qt::DashLine));
  painter.drawRect(box.box());
  painter.setPen(QPen(colours.ground, 1));
  painter.setBrush(colours.text);
  for (const auto& handle : box.handles()) painter.drawRect(handle.second);
  painter.restore();
}

void paint_tip(QPainter& painter, const QRectF& area, QPointF at, const QString& text,
               const TimeColours& colours) {
  const QFontMetricsF metrics(painter.font());
  const double width = std::min(metrics.horizontalAdvance(text) + 16, area.width());
  QRectF tip(at.x() + 14, at.y() - 14 - metrics.height() - 8, width, metrics.height() + 8);
  tip.moveLeft(std::clamp(tip.left(), area.left(), std::max(area.left(), area.right() - tip.width())));
  if (tip.top() < area.top()) tip.moveTop(at.y() + 18);
  tip.moveTop(std::clamp(tip.top(), area.top(), std::max(area.top(), area.bottom() - tip.height())));
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(Qt::NoPen);
  painter.setBrush(with_opacity(colours.tip, 0.95));
  painter.drawRoundedRect(tip, 4, 4);
  painter.setPen(colours.tip_text);
  painter.drawText(tip, Qt::AlignCenter, metrics.elidedText(text, Qt::ElideRight, tip.width() - 8));
  painter.restore();
}

void paint_warning(QPainter& painter, QPointF at, const TimeColours& colours) {
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(colours.ground, 1));
  painter.setBrush(colours.warning);
  const QPolygonF sign{{at, at + QPointF(-6, -11), at + QPointF(6, -11)}};
  painter.drawPolygon(sign);
  painter.restore();
}

}  // namespace nutik::studio
