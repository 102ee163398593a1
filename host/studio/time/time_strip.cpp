#include "studio/time/time_strip.hpp"

#include <QPainter>
#include <algorithm>
#include <cmath>

#include "plot/graph.hpp"
#include "studio/time/times.hpp"

namespace nutik::studio {
namespace {

constexpr double kRuler = 30, kStripFoot = 4;
constexpr double kLabels = 18;            // the ruler's upper part; marks have the lower one
constexpr double kThumbnailShare = 0.58;  // of the track's height

}  // namespace

QString interval_text(const Boxcar& boxcar, const Timeline& timeline) {
  const std::int64_t end_ns = boxcar.start_ns + boxcar.length_ns;
  const auto first = picture_at(boxcar.start_ns, timeline), last = picture_at(end_ns - 1, timeline);
  const QString begin = sample_text(boxcar.start_ns, timeline), end = sample_text(end_ns - 1, timeline);
  const QString samples = begin == end    ? begin
                          : first && last ? TimeStrip::tr("pictures %1 to %2").arg(*first).arg(*last)
                                          : TimeStrip::tr("%1 to %2").arg(begin, end);
  return TimeStrip::tr("%1 to %2, %3").arg(exact_time_text(boxcar.start_ns), exact_time_text(end_ns), samples);
}

TimeStrip::TimeStrip(Document& document, TimeAxis& axis, QWidget* parent)
    : TimeView(document, axis, parent) {
  setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Fixed);
  setAccessibleName(tr("Time"));
  setObjectName("time");
  connect(&document_, &Document::capture_changed, this, [this] {
    cancel_press();
    activity_ = {};
    refresh_backdrop();
    follow_document();
  });
  connect(&document_, &Document::changed, this, [this](Change what) {
    if (what != Change::mask) follow_document();
  });
  connect(&document_, &Document::played_changed, this, [this] { update(); });
  follow_document();
}

QRectF TimeStrip::track() const {
  return QRectF(rect()).adjusted(TimeAxis::kLeft, kRuler, -TimeAxis::kRight, -kStripFoot);
}

QRectF TimeStrip::boxcar_area() const { return place_of(document_.boxcar()); }

QRectF TimeStrip::place_of(const Boxcar& boxcar) const {
  const double begin = axis_.to_pixel(static_cast<double>(boxcar.start_ns), width());
  const double end = axis_.to_pixel(static_cast<double>(boxcar.start_ns + boxcar.length_ns), width());
  return {begin, track().top(), end - begin, track().height()};
}

QPointF TimeStrip::mark_place(std::int64_t time_ns) const {
  return {axis_.to_pixel(static_cast<double>(time_ns), width()), (kLabels + kRuler) / 2};
}

void TimeStrip::follow_document() {
  if (const CaptureFacts* facts = document_.facts())
    setAccessibleDescription(tr("Exposed interval: %1").arg(interval_text(document_.boxcar(), facts->timeline)));
  update();
}

void TimeStrip::paintEvent(QPaintEvent*) {
  const TimeColours colours = TimeColours::of(palette());
  QPainter painter(this);
  if (!isEnabled()) return;  // the picture is another capture's
  draw_backdrop(painter, colours);
  if (document_.facts() == nullptr) return;
  paint_boxcar(painter, colours);
  paint_marks(painter, colours);
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(hasFocus() ? colours.boxcar : colours.grid, 1));
  painter.drawRect(track().adjusted(-0.5, -0.5, 0.5, 0.5));
}

void TimeStrip::paint_backdrop(QPainter& painter, const TimeColours& colours) {
  const QRectF track = this->track();
  painter.fillRect(track, colours.ground);
  const CaptureFacts* facts = document_.facts();
  if (facts == nullptr) return;
  const QFontMetricsF metrics(font());
  constexpr double kApart = 90;
  const int most = std::max(static_cast<int>(track.width() / kApart), 2);
  const auto ticks = plot::time_ticks(std::llround(axis_.begin_ns()), std::llround(axis_.end_ns()), most);
  painter.setPen(colours.label);
  painter.drawText(QRectF(0, 0, TimeAxis::kLeft - 7, kLabels), Qt::AlignRight | Qt::AlignVCenter,
                   QString::fromStdString(ticks.unit));
  for (const plot::Tick& tick : ticks.ticks) {
    const double x = std::round(axis_.to_pixel(tick.at, width())) + 0.5;
    const QString label = QString::fromStdString(tick.label);
    const double half = metrics.horizontalAdvance(label) / 2 + 1;
    painter.setPen(colours.axis);
    painter.drawLine(QPointF(x, kRuler - 4), QPointF(x, kRuler));
    if (x - half < TimeAxis::kLeft - 6 || x + half > width()) continue;  // beside the unit, or cut off
    painter.setPen(colours.label);
    painter.drawText(QRectF(x - half, 0, 2 * half, kLabels), Qt::AlignCenter, label);
  }

  painter.save();
  painter.setClipRect(track);
  const double start = axis_.to_pixel(0, width());
  const double end = axis_.to_pixel(static_cast<double>(facts->timeline.duration_ns()), width());
  const bool has_thumbnails = !document_.overview().thumbnails.empty();
  const double split = has_thumbnails ? track.top() + kThumbnailShare * track.height() : track.top();
  if (has_thumbnails) paint_thumbnails(painter, QRectF(track.topLeft(), QPointF(track.right(), split)));
  if (!activity_.empty()) {
    const QRectF row(QPointF(track.left(), split + 3), track.bottomRight());
    painter.setPen(Qt::NoPen);
    painter.setBrush(colours.activity);
    const double highest = activity_.over(0, activity_.values().size()).high;
    painter.drawPolygon(area_of(columns_of(activity_, facts->timeline, axis_, width()), row, highest));
  }
  painter.fillRect(QRectF(track.topLeft(), QPointF(std::min(start, track.right()), track.bottom())),
                   colours.outside);
  painter.fillRect(QRectF(QPointF(std::max(end, track.left()), track.top()), track.bottomRight()),
                   colours.outside);
  painter.restore();
  // What the rows are, beside them.
  painter.setPen(colours.label);
  const auto name_row = [&](double top, double bottom, const QString& name) {
    painter.drawText(QRectF(0, top, TimeAxis::kLeft - 7, bottom - top), Qt::AlignRight | Qt::AlignVCenter,
                     metrics.elidedText(name, Qt::ElideRight, TimeAxis::kLeft - 8));
  };
  if (!activity_.empty()) name_row(split, track.bottom(), tr("change"));
}

void TimeStrip::paint_thumbnails(QPainter& painter, const QRectF& row) const {
  const auto& thumbnails = document_.overview().thumbnails;
  const QSize size = thumbnails.front().image.size();
  if (size.isEmpty()) return;
  const double wide = std::max(row.height() * size.width() / size.height(), 8.0) + 1;
  // Pictures stay with their times when the axis is moved: places count from time 0 on.
  const double zero = axis_.to_pixel(0, width());
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  for (double x = zero + std::floor((row.left() - zero) / wide) * wide; x < row.right(); x += wide) {
    if (axis_.to_time(x, width()) >= document_.duration_ns()) break;
    if (axis_.to_time(x + wide, width()) <= 0) continue;
    // What the last one has beyond the capture is covered.
    const std::int64_t middle =
        std::clamp<std::int64_t>(axis_.to_time(x + wide / 2, width()), 0, document_.duration_ns());
    const auto after = std::lower_bound(thumbnails.begin(), thumbnails.end(), middle,
                                        [](const CaptureOverview::Thumbnail& thumbnail, std::int64_t time) {
                                          return thumbnail.time_ns < time;
                                        });
    auto nearest = after == thumbnails.end() ? after - 1 : after;
    if (after != thumbnails.begin() &&
        std::abs((after - 1)->time_ns - middle) < std::abs(nearest->time_ns - middle))
      nearest = after - 1;
    painter.drawImage(QRectF(x, row.top(), wide - 1, row.height()), nearest->image);
  }
}

void TimeStrip::paint_boxcar(QPainter& painter, const TimeColours& colours) const {
  const QRectF track = this->track();
  QRectF area = place_of(document_.played().value_or(document_.boxcar()));
  constexpr double kMin = 2;  // it can be seen however short it is
  if (area.width() < kMin) area.adjust(-(kMin - area.width()) / 2, 0, (kMin - area.width()) / 2, 0);
  if (area.right() < track.left() || area.left() > track.right()) return;
  const bool is_exposed = document_.mode() == ExposureMode::boxcar || document_.played();
  painter.save();
  painter.setClipRect(track);
  painter.fillRect(area, with_opacity(colours.boxcar, is_exposed ? 0.34 : 0.14));
  painter.setPen(QPen(with_opacity(colours.boxcar, is_exposed ? 1.0 : 0.5), 2));
  painter.drawLine(area.topLeft(), area.bottomLeft());
  painter.drawLine(area.topRight(), area.bottomRight());
  painter.restore();
}

void TimeStrip::paint_marks(QPainter& painter, const TimeColours& colours) const {
  const QRectF track = this->track();
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  const auto paint = [&](const std::optional<std::int64_t>& mark, double direction) {
    if (!mark) return;
    const QPointF at = mark_place(*mark);
    if (at.x() < track.left() - 1 || at.x() > track.right() + 1) return;
    const QRectF beyond = direction > 0 ? QRectF(track.topLeft(), QPointF(at.x(), track.bottom()))
                                        : QRectF(QPointF(at.x(), track.top()), track.bottomRight());
    painter.fillRect(beyond, with_opacity(colours.ground, 0.55));
    painter.setPen(QPen(colours.guide, 1.4));
    painter.drawLine(QPointF(at.x(), kLabels), QPointF(at.x(), track.bottom()));
    painter.setPen(Qt::NoPen);
    painter.setBrush(colours.guide);
    const QPointF top(at.x(), kLabels);
    painter.drawPolygon(QPolygonF({top, top + QPointF(9 * direction, 0), top + QPointF(0, 12)}));
  };
  paint(document_.mark_in(), 1);
  paint(document_.mark_out(), -1);
  painter.restore();
}

}  // namespace nutik::studio
