#include "studio/curves/curve_editor.hpp"

#include <QAccessible>
#include <QPaintEvent>
#include <algorithm>

#include "studio/curves/number_editor.hpp"
#include "studio/time/times.hpp"

namespace nutik::studio {
namespace {

constexpr int kHeader = 24, kFoot = 5;

Points points_of(const GainFunction& function) {
  return {function.points().begin(), function.points().end()};
}

}  // namespace

CurveEditor::CurveEditor(Document& document, TimeAxis& axis, QWidget* parent)
    : TimeView(document, axis, parent),
      numbers_(new NumberEditor(this, [this](const ControlPoint& typed) { return set_current(typed); })) {
  setAccessibleName(tr("Gain curve"));
  setObjectName("curves");
  connect(&document_, &Document::capture_changed, this, [this] {
    cancel_press();
    current_.reset();
    gains_.make_automatic({});
    activity_ = {};
    follow_document();
  });
  connect(&document_, &Document::changed, this, [this](Change what) {
    if (what != Change::mask || !document_.is_dragging()) follow_document();
  });
  connect(&document_, &Document::selection_changed, this, &CurveEditor::follow_selection);
  connect(&document_, &Document::released, this, &CurveEditor::follow_document);
  connect(&document_, &Document::probe_changed, this, [this] {
    waveform_ = document_.waveform() ? Series(document_.waveform()->light) : Series();
    refresh_backdrop();
  });
  follow_document();
}

CurveEditor::~CurveEditor() = default;

QString CurveEditor::set_current(const ControlPoint& typed) {
  if (!current_ || *current_ >= points_.size()) return {};
  const auto set = with_point_set(points_, *current_, typed);
  if (set) {
    use(*set, tr("Set point"));
    return {};
  }
  const QString before = *current_ == 0 ? QString() : exact_time_text(points_[*current_ - 1].time_ns);
  const QString after = *current_ + 1 == points_.size() ? QString() : exact_time_text(points_[*current_ + 1].time_ns);
  return before.isEmpty()  ? tr("Points keep their order: the time must be before %1").arg(after)
         : after.isEmpty() ? tr("Points keep their order: the time must be after %1").arg(before)
                           : tr("Points keep their order: the time must be after %1 and before %2").arg(before, after);
}

QRectF CurveEditor::plot_area() const {
  return QRectF(rect()).adjusted(TimeAxis::kLeft, kHeader, -TimeAxis::kRight, -(kLanePixels + kFoot));
}

double CurveEditor::lane_top() const { return plot_area().bottom() + 2; }

PlotFrame CurveEditor::frame() const { return {axis_, width(), plot_area(), gains_.range()}; }

QString CurveEditor::function_name() const {
  const std::uint8_t tag = document_.selected_tag();
  const auto look = document_.state().looks.find(tag);
  const QString name = look == document_.state().looks.end() ? QString() : look->second.name;
  return name.isEmpty() ? QString("M%1").arg(tag) : tr("%1 (M%2)").arg(name, QString::number(tag));
}

void CurveEditor::follow_document() {
  if (press_ && press_->kind == Press::Kind::drag && press_->tag != document_.selected_tag()) drop_press();
  points_ = document_.points(document_.selected_tag());
  boxcars_ = boxcars_of(points_);
  if (current_ && *current_ >= points_.size()) current_.reset();
  const bool is_steady = document_.is_dragging();
  if (!is_steady) {
    const GainRange before = gains_.range();
    gains_.follow(points_);
    refresh_findings();
    if (!(before == gains_.range())) refresh_backdrop();
  }
  // What is drawn behind changes when another function does.
  const auto is_own = [&](std::uint8_t tag) { return tag == document_.selected_tag(); };
  bool others_changed = drawn_functions_.size() != document_.functions().size();
  auto now = document_.functions().begin();
  for (auto drawn = drawn_functions_.begin(); !others_changed && drawn != drawn_functions_.end();
       ++drawn, ++now)
    others_changed = drawn->first != now->first || (!is_own(drawn->first) && !(drawn->second == now->second));
  if (others_changed || !is_steady) refresh_backdrop();
  describe();
  update();
}

void CurveEditor::follow_selection() {
  if (press_ && press_->drag && press_->tag == document_.selected_tag()) return update();
  const auto& chosen = document_.selected_points();
  if (current_ && !chosen.contains(*current_)) current_.reset();
  if (!current_ && chosen.size() == 1) current_ = *chosen.begin();
  numbers_->close_editor();
  follow_document();
}

void CurveEditor::refresh_findings() {
  findings_.clear();
  const auto found = document_.functions().find(document_.selected_tag());
  if (found == document_.functions().end() || document_.facts() == nullptr) return;
  const std::int64_t duration_ns = document_.duration_ns();
  GainSummary summary = summarize(found->second, duration_ns);
  try {
    summary = exposed_summary(document_.state(), found->first, duration_ns);
  } catch (const InputError& error) {
    findings_.push_back({FunctionFinding::Kind::still_gain_not_positive, error.what(), {}});
  }
  std::ranges::move(check_function(found->second, summary, {duration_ns, true}),
                    std::back_inserter(findings_));
}

void CurveEditor::describe() {
  QString text = tr("%1, %2 control points").arg(function_name(), QString::number(points_.size()));
  if (current_) text += tr("; point %1: %2").arg(*current_ + 1).arg(point_text(points_[*current_]));
  if (document_.selected_points().size() > 1)
    text += tr("; %1 selected").arg(document_.selected_points().size());
  for (const FunctionFinding& finding : findings_) text += "; " + QString::fromStdString(finding.message);
  if (text != accessibleDescription()) setAccessibleDescription(text);
}

void CurveEditor::use(const Points& points, const QString& name) {
  message_.clear();
  document_.set_points(document_.selected_tag(), points, name);
}

PointIndices CurveEditor::selected() const {
  return {document_.selected_points().begin(), document_.selected_points().end()};
}

void CurveEditor::select(const PointIndices& points, std::optional<std::size_t> current) {
  current_ = current && *current < points_.size() ? current : std::nullopt;
  document_.select_points({points.begin(), points.end()});
  describe();
  update();
}

Snapper CurveEditor::snapper(const PointIndices& moved) const {
  const CaptureFacts* facts = document_.facts();
  Snapper made(facts == nullptr ? nullptr : &facts->timeline, document_.functions(),
               document_.selected_tag());
  if (document_.mark_in()) made.add_time(*document_.mark_in(), tr("in mark"));
  if (document_.mark_out()) made.add_time(*document_.mark_out(), tr("out mark"));
  // Whoever moves in one direction need not hold the hand still in the other.
  for (const std::size_t i : moved) {
    made.add_time(points_[i].time_ns, tr("where it was"));
    made.add_gain(points_[i].gain, tr("as it was"));
  }
  return made;
}

std::optional<TransformBox> CurveEditor::box() const {
  return TransformBox::round(frame(), points_, selected());
}

void CurveEditor::resizeEvent(QResizeEvent* event) {
  numbers_->close_editor();
  TimeView::resizeEvent(event);
}

void CurveEditor::paint_backdrop(QPainter& painter, const TimeColours& colours) {
  const CaptureFacts* facts = document_.facts();
  Backdrop made;
  made.axis = &axis_;
  made.timeline = facts == nullptr ? nullptr : &facts->timeline;
  made.activity = &activity_;
  made.waveform = &waveform_;
  for (const auto& [tag, function] : document_.functions()) {
    const auto look = document_.state().looks.find(tag);
    const bool is_shown = look == document_.state().looks.end() || look->second.is_visible;
    if (tag != document_.selected_tag() && is_shown)
      made.others.push_back({points_of(function), colours.line(document_.colour(tag))});
  }
  drawn_functions_ = document_.functions();
  studio::paint_backdrop(painter, frame(), colours, made, width());
}

void CurveEditor::paintEvent(QPaintEvent*) {
  const TimeColours colours = TimeColours::of(palette());
  const PlotFrame frame = this->frame();
  const CaptureFacts* facts = document_.facts();
  QPainter painter(this);
  if (!isEnabled()) return;  // the picture is another capture's
  draw_backdrop(painter, colours);
  paint_header(painter, colours);
  if (facts != nullptr && document_.mode() == ExposureMode::boxcar) {
    const Boxcar& boxcar = document_.boxcar();
    const QRectF band(QPointF(frame.x_of(boxcar.start_ns), frame.box().top()),
                      QPointF(frame.x_of(boxcar.start_ns + boxcar.length_ns), frame.box().bottom()));
    painter.fillRect(band.intersected(frame.box()), with_opacity(colours.boxcar, 0.16));
  }
  const QColor colour = colours.line(document_.colour(document_.selected_tag()));
  paint_curve(painter, frame, colours, points_, colour);
  paint_boxcars(painter, frame, colours, boxcars_, lane_top(), colour);
  if (const auto box = this->box()) paint_box(painter, *box, colours);
  paint_points(painter, frame, colours, points_, selected(), hasFocus() ? current_ : std::nullopt, colour);
  for (const FunctionFinding& finding : findings_) {
    if (!finding.point || *finding.point >= points_.size()) continue;
    const QPointF at = frame.place(points_[*finding.point]) - QPointF(0, 8);
    if (frame.box().adjusted(-1, -1, 1, 1).contains(at)) paint_warning(painter, at, colours);
  }
  paint_drag(painter, frame, colours);
  painter.setPen(QPen(hasFocus() ? colours.boxcar : colours.grid, 1));
  painter.setBrush(Qt::NoBrush);
  painter.drawRect(frame.box().adjusted(-0.5, -0.5, 0.5, 0.5));
}

void CurveEditor::paint_header(QPainter& painter, const TimeColours& colours) const {
  const QFontMetricsF metrics(font());
  QRectF line(TimeAxis::kLeft, 0, plot_area().width(), kHeader - 2);
  if (document_.facts() == nullptr) return;
  constexpr double kDot = 8;
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(Qt::NoPen);
  painter.setBrush(colours.line(document_.colour(document_.selected_tag())));
  painter.drawEllipse(QRectF(line.left() + 1, line.center().y() - kDot / 2, kDot, kDot));
  line.setLeft(line.left() + kDot + 8);
  painter.setPen(colours.label);
  painter.drawText(QRectF(0, 0, TimeAxis::kLeft - 7, kHeader - 2), Qt::AlignRight | Qt::AlignVCenter, tr("gain"));
  painter.setPen(palette().color(QPalette::WindowText));
  const QString name = metrics.elidedText(function_name(), Qt::ElideRight, line.width() / 3);
  painter.drawText(line, Qt::AlignVCenter, name);
  line.setLeft(line.left() + metrics.horizontalAdvance(name) + 20);
  QString aside = pointer_text();
  if (aside.isEmpty() && !waveform_.empty()) {
    const QPoint pixel = document_.waveform()->pixel;
    const Series::Range light = waveform_.over(0, waveform_.values().size());
    aside =
        tr("light of pixel %1, %2, up to %3").arg(pixel.x()).arg(pixel.y()).arg(light.high, 0, 'g', 3);
  }
  if (!aside.isEmpty()) {
    const double wide = std::min(metrics.horizontalAdvance(aside), line.width() / 2);
    painter.setPen(hovered_ ? colours.label : colours.waveform);
    painter.drawText(QRectF(line.right() - wide, 0, wide, line.height()), Qt::AlignVCenter,
                     metrics.elidedText(aside, Qt::ElideRight, wide));
    line.setRight(line.right() - wide - 16);
  }
  QString said = message_;
  bool is_warning = !message_.isEmpty();
  if (said.isEmpty() && !findings_.empty()) {
    said = QString::fromStdString(findings_.front().message);
    if (findings_.size() > 1) said = tr("(1 of %1) ").arg(findings_.size()) + said;
    is_warning = true;
  }
  if (points_.empty()) said = tr("This region has no function yet: press Insert for a first point");
  if (is_warning) {
    paint_warning(painter, {line.left() + 6, line.center().y() + 6}, colours);
    line.setLeft(line.left() + 18);
  }
  painter.setPen(is_warning ? colours.warning : colours.label);
  painter.drawText(line, Qt::AlignVCenter, metrics.elidedText(said, Qt::ElideRight, line.width()));
  painter.restore();
}

void CurveEditor::paint_drag(QPainter& painter, const PlotFrame& frame, const TimeColours& colours) const {
  const QRectF& box = frame.box();
  if (press_ && press_->kind == Press::Kind::rubber_band && press_->has_moved) {
    painter.setPen(QPen(colours.boxcar, 1));
    painter.setBrush(with_opacity(colours.boxcar, 0.15));
    painter.drawRect(QRectF(press_->at, press_->last).normalized().intersected(box));
    return;
  }
  if (dragged_) {
    painter.setPen(QPen(colours.guide, 1, Qt::DashLine));
    if (dragged_->time_snap) {
      const double x = frame.x_of(dragged_->time_snap->time_ns);
      if (x >= box.left() && x <= box.right())
        painter.drawLine(QPointF(x, box.top()), QPointF(x, box.bottom()));
    }
    if (dragged_->gain_snap) {
      const double y = frame.y_of(dragged_->gain_snap->gain);
      if (y >= box.top() && y <= box.bottom())
        painter.drawLine(QPointF(box.left(), y), QPointF(box.right(), y));
    }
    QString text = dragged_->text;
    if (dragged_->time_snap) text += "  ·  " + dragged_->time_snap->what;
    paint_tip(painter, rect(), press_ ? press_->last : QPointF(), text, colours);
  }
}

QString CurveEditor::pointer_text() const {
  const PlotFrame frame = this->frame();
  if (!hovered_ || press_ || !frame.box().contains(*hovered_) || numbers_->isVisible()) return {};
  if (const auto under = point_under(frame, points_, selected(), *hovered_))
    return point_text(points_[*under]);
  return studio::pointer_text({frame.time_at(hovered_->x()), frame.gain_at(hovered_->y())},
                              frame.ns_per_pixel());
}

}  // namespace nutik::studio
