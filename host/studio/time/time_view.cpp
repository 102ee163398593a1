#include "studio/time/time_view.hpp"

#include <QHelpEvent>
#include <QPainter>
#include <QToolTip>
#include <algorithm>
#include <cmath>

#include "session/requests/stated_moments.hpp"

namespace nutik::studio {

QColor mixed(const QColor& a, const QColor& b, double share) {
  const auto channel = [share](float from, float to) {
    return static_cast<float>(from + (to - from) * static_cast<float>(share));
  };
  return QColor::fromRgbF(channel(a.redF(), b.redF()), channel(a.greenF(), b.greenF()),
                          channel(a.blueF(), b.blueF()));
}

QColor with_opacity(QColor colour, double opacity) {
  colour.setAlphaF(static_cast<float>(opacity));
  return colour;
}

QColor TimeColours::line(const QColor& region) const {
  const double contrast = std::abs(region.lightnessF() - ground.lightnessF());
  constexpr double kEnough = 0.45;
  return contrast >= kEnough ? region : mixed(region, text, std::min((kEnough - contrast) * 1.6, 0.6));
}

TimeColours TimeColours::of(const QPalette& palette) {
  const QColor base = palette.color(QPalette::Base), text = palette.color(QPalette::Text);
  const bool is_dark = base.lightness() < text.lightness();
  TimeColours colours;
  colours.ground = base;
  colours.outside = mixed(base, is_dark ? QColor(Qt::black) : text, is_dark ? 0.35 : 0.07);
  colours.grid = mixed(base, text, 0.10);
  colours.axis = mixed(base, text, 0.34);
  colours.label = mixed(base, text, 0.68);
  colours.text = text;
  colours.activity = mixed(base, QColor(0x8f, 0x7a, 0xc0), is_dark ? 0.55 : 0.5);
  colours.waveform = mixed(base, is_dark ? QColor(0xe8, 0xe2, 0xc8) : QColor(0x50, 0x48, 0x30), 0.5);
  colours.negative = is_dark ? QColor(0xe6, 0x8a, 0x2e) : QColor(0xd5, 0x6a, 0x00);
  colours.boxcar = palette.color(QPalette::Highlight);
  colours.guide = is_dark ? QColor(0x6f, 0xd6, 0xc4) : QColor(0x00, 0x86, 0x70);
  colours.warning = is_dark ? QColor(0xf2, 0xc1, 0x4e) : QColor(0xa8, 0x6a, 0x00);
  colours.tip = is_dark ? mixed(base, text, 0.16) : mixed(base, text, 0.9);
  colours.tip_text = is_dark ? text : base;
  return colours;
}

Series::Series(std::vector<double> values) : values_(std::move(values)) {
  for (std::size_t first = 0; first < values_.size(); first += kTogether) {
    Range range{values_[first], values_[first]};
    for (std::size_t i = first; i < std::min(first + kTogether, values_.size()); ++i)
      range = {std::min(range.low, values_[i]), std::max(range.high, values_[i])};
    coarse_.push_back(range);
  }
}

Series::Range Series::over(std::size_t first, std::size_t last) const {
  Range range{values_[first], values_[first]};
  const auto add = [&range](const Range& more) {
    range = {std::min(range.low, more.low), std::max(range.high, more.high)};
  };
  while (first < last) {
    if (first % kTogether == 0 && first + kTogether <= last) {
      add(coarse_[first / kTogether]);
      first += kTogether;
    } else {
      add({values_[first], values_[first]});
      ++first;
    }
  }
  return range;
}

std::vector<SeriesColumn> columns_of(const Series& series, const Timeline& timeline, const TimeAxis& axis,
                                     int width) {
  std::vector<SeriesColumn> columns;
  if (series.values().size() != timeline.sample_count()) return columns;
  for (int x = TimeAxis::kLeft; x < width - TimeAxis::kRight; ++x) {
    const std::int64_t begin = axis.to_time(x, width);
    const std::int64_t end = std::max(axis.to_time(x + 1, width), begin + 1);
    if (end <= 0 || begin >= timeline.duration_ns()) continue;
    // A sample's value is drawn from its start to the next one's.
    const std::uint64_t first = sample_at(begin, timeline), last = sample_at(end - 1, timeline);
    columns.push_back({x, series.over(first, last + 1)});
  }
  return columns;
}

QPolygonF area_of(const std::vector<SeriesColumn>& columns, const QRectF& box, double most) {
  QPolygonF area;
  if (columns.empty() || most <= 0) return area;
  area << QPointF(columns.front().x, box.bottom());
  for (const SeriesColumn& column : columns) {
    const double y = box.bottom() - box.height() * std::clamp(column.range.high / most, 0.0, 1.0);
    area << QPointF(column.x, y) << QPointF(column.x + 1, y);
  }
  area << QPointF(columns.back().x + 1, box.bottom());
  return area;
}

TimeView::TimeView(Document& document, TimeAxis& axis, QWidget* parent)
    : QWidget(parent), document_(document), axis_(axis), activity_(document.overview().changed_share) {
  setFocusPolicy(Qt::StrongFocus);
  setMouseTracking(true);
  connect(&document_, &Document::overview_changed, this, [this] {
    activity_ = Series(document_.overview().changed_share);
    refresh_backdrop();
  });
  connect(&axis_, &TimeAxis::changed, this, &TimeView::refresh_backdrop);
  connect(&document_, &Document::marks_changed, this, qOverload<>(&QWidget::update));
}

void TimeView::refresh_backdrop() {
  is_backdrop_stale_ = true;
  update();
}

void TimeView::draw_backdrop(QPainter& painter, const TimeColours& colours) {
  const QSize device = size() * devicePixelRatioF();
  if (is_backdrop_stale_ || backdrop_.size() != device) {
    is_backdrop_stale_ = false;
    backdrop_ = QPixmap(device);
    backdrop_.setDevicePixelRatio(devicePixelRatioF());
    backdrop_.fill(palette().color(QPalette::Window));
    QPainter behind(&backdrop_);
    behind.setFont(font());
    paint_backdrop(behind, colours);
  }
  painter.drawPixmap(0, 0, backdrop_);
}

void TimeView::begin_key_edit(const QKeyEvent& event) {
  if (event.isAutoRepeat() || is_key_edit_) return;
  is_key_edit_ = true;
  document_.begin_drag();
}

void TimeView::end_key_edit() {
  if (!is_key_edit_) return;
  is_key_edit_ = false;
  document_.end_drag();
}

bool TimeView::event(QEvent* event) {
  if (event->type() == QEvent::ShortcutOverride && is_own_key(static_cast<QKeyEvent&>(*event))) {
    event->accept();
    return true;
  }
  if (event->type() != QEvent::ToolTip) return QWidget::event(event);
  const auto& help = static_cast<QHelpEvent&>(*event);
  const QString text = text_at(help.pos());
  if (text.isEmpty()) QToolTip::hideText();
  if (!text.isEmpty()) QToolTip::showText(help.globalPos(), text, this);
  return true;
}

void TimeView::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange || event->type() == QEvent::FontChange) refresh_backdrop();
  QWidget::changeEvent(event);
}

void TimeView::resizeEvent(QResizeEvent*) { refresh_backdrop(); }

void TimeView::keyReleaseEvent(QKeyEvent* event) {
  if (!event->isAutoRepeat()) end_key_edit();
  QWidget::keyReleaseEvent(event);
}

double TimeView::notches_of(const QWheelEvent& event) {
  constexpr double kNotch = 120.0;
  return (event.angleDelta().y() != 0 ? event.angleDelta().y() : event.angleDelta().x()) / kNotch;
}

void TimeView::wheelEvent(QWheelEvent* event) {
  constexpr double kPannedPixels = 60;
  const double turned = notches_of(*event);
  if (turned == 0) return event->ignore();
  if (event->modifiers() & Qt::ShiftModifier || event->angleDelta().y() == 0)
    axis_.pan(-turned * kPannedPixels, width());
  else
    axis_.zoom(std::pow(kPerNotch, turned), event->position().x(), width());
  event->accept();
}

void TimeView::focusOutEvent(QFocusEvent* event) {
  end_key_edit();
  QWidget::focusOutEvent(event);
}

}  // namespace nutik::studio
