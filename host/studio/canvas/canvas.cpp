#include "studio/canvas/canvas.hpp"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>
#include <cmath>

namespace nutik::studio {
namespace {

constexpr double kClickPixels = 3;  // a press that moves no further is a click
constexpr double kPanByKey = 48;    // widget pixels
constexpr double kZoomByKey = 1.25;
constexpr double kZoomByNotch = 1.2;  // of a mouse wheel
const QColor kSurround(36, 36, 36);   // neutral, so that it does not tint what is seen
const QColor kDarkened(0, 0, 0, 170);

}  // namespace

Canvas::Canvas(Document& document, QWidget* parent) : QWidget(parent), document_(document) {
  setMouseTracking(true);
  setFocusPolicy(Qt::StrongFocus);
  setMinimumSize(240, 160);
  setAttribute(Qt::WA_OpaquePaintEvent);
  setAccessibleName(tr("Picture"));
  setAccessibleDescription(
      tr("The exposure. Plus and minus zoom, arrow keys pan, 1 shows pixel for pixel, 0 all of it."));
  connect(&document_, &Document::changed, this, &Canvas::follow_mask);
  connect(&document_, &Document::selection_changed, this, &Canvas::follow_mask);
  connect(&document_, &Document::capture_changed, this, &Canvas::follow_mask);
  connect(&document_, &Document::probe_changed, this, [this] { update(); });
}

Canvas::~Canvas() = default;

void Canvas::show_picture(const ShownPicture& picture) {
  const CaptureFacts* facts = document_.facts();
  if (facts == nullptr) return;
  const QSize size(static_cast<int>(facts->format.shape.width), static_cast<int>(facts->format.shape.height));
  is_first_look_ = false;
  if (picture.place == QRect({0, 0}, size)) {
    image_ = picture.image;
  } else {
    if (image_.size() != size) {
      image_ = QImage(size, QImage::Format_RGB32);
      image_.fill(Qt::black);
    }
    QPainter(&image_).drawImage(picture.place.topLeft(), picture.image);
  }
  if (view_.picture() != size) {
    view_.set_sizes(size, this->size());
    view_moved();
  }
  update();
}

void Canvas::show_first_look(const QImage& image) {
  image_ = image;
  is_first_look_ = true;
  view_.set_sizes(image.size(), size());
  view_moved();
}

void Canvas::clear() {
  image_ = {};
  is_first_look_ = false;
  update();
}

void Canvas::set_hint(const QString& hint) {
  hint_ = hint;
  update();
}

void Canvas::set_tool(CanvasTool* tool) {
  if (tool_ != nullptr) tool_->give_up();
  tool_ = tool;
  is_stroking_ = false;
  setCursor(tool_ != nullptr ? Qt::CrossCursor : Qt::ArrowCursor);
  update();
}

void Canvas::zoom_by(double factor) {
  view_.set_zoom(view_.zoom() * factor, QRectF(rect()).center());
  view_moved();
}

void Canvas::show_actual_size() {
  view_.set_zoom(1 / devicePixelRatioF(), QRectF(rect()).center());
  view_moved();
}

void Canvas::fit() {
  view_.fit();
  view_moved();
}

void Canvas::view_moved() {
  update();
  Q_EMIT visible_changed(view_.visible());
}

void Canvas::follow_mask() {
  const DocumentState& state = document_.state();
  const bool is_same =
      outlined_.has_value() == state.mask.has_value() && (!outlined_ || &**outlined_ == &**state.mask);
  if (!is_same) {
    outlined_ = state.mask;
    outlines_ = outlined_ ? outlines_of((*outlined_)->mask) : Outlines();
  }
  solo_ = {};
  update();
}

void Canvas::paintEvent(QPaintEvent* event) {
  QPainter painter(this);
  painter.fillRect(event->rect(), kSurround);
  if (image_.isNull()) {
    painter.setPen(QColor(190, 190, 190));
    painter.drawText(rect().adjusted(24, 24, -24, -24), Qt::AlignCenter | Qt::TextWordWrap, hint_);
    return;
  }
  painter.setRenderHint(QPainter::SmoothPixmapTransform, view_.zoom() < 1);
  painter.drawImage(view_.place(), image_);
  if (document_.facts() == nullptr || is_first_look_) return;
  painter.translate(view_.place().topLeft());
  painter.scale(view_.zoom(), view_.zoom());
  paint_solo(painter);
  paint_regions(painter);
  if (tool_ != nullptr && is_inside_) tool_->paint(painter, view_.to_picture(pointer_));
}

void Canvas::paint_regions(QPainter& painter) {
  if (document_.mode() == ExposureMode::functions || tool_ != nullptr) {
    for (const auto& [tag, lines] : outlines_) {
      const auto look = document_.state().looks.find(tag);
      if (look == document_.state().looks.end() || !look->second.is_visible) continue;
      // Dark beneath the colour, so that it is seen on any picture.
      const bool is_selected = tag == document_.selected_tag();
      for (const bool is_beneath : {true, false}) {
        QPen pen(is_beneath ? QColor(0, 0, 0, 150) : look->second.colour,
                 (is_selected ? 2.0 : 1.0) + (is_beneath ? 2.0 : 0.0));
        pen.setCosmetic(true);
        painter.setPen(pen);
        painter.drawLines(lines);
      }
    }
  }
  if (document_.probe()) {
    const QPointF at = QPointF(*document_.probe()) + QPointF(0.5, 0.5);
    const double arm = 6 / view_.zoom();
    for (const QColor& colour : {QColor(Qt::black), QColor(Qt::white)}) {
      QPen pen(colour, colour == QColor(Qt::black) ? 3 : 1);
      pen.setCosmetic(true);
      painter.setPen(pen);
      painter.drawLine(at - QPointF(arm, 0), at + QPointF(arm, 0));
      painter.drawLine(at - QPointF(0, arm), at + QPointF(0, arm));
    }
  }
}

void Canvas::paint_solo(QPainter& painter) {
  if (!document_.solo() || !outlined_) return;
  const Mask& mask = (*outlined_)->mask;
  if (solo_.isNull()) {
    solo_ = QImage(static_cast<int>(mask.width), static_cast<int>(mask.height),
                   QImage::Format_ARGB32_Premultiplied);
    for (int y = 0; y < solo_.height(); ++y) {
      auto* row = reinterpret_cast<QRgb*>(solo_.scanLine(y));
      const std::uint8_t* tags = mask.tags.data() + static_cast<std::size_t>(y) * mask.width;
      for (int x = 0; x < solo_.width(); ++x) row[x] = tags[x] == *document_.solo() ? 0 : kDarkened.rgba();
    }
  }
  painter.drawImage(0, 0, solo_);
}

std::optional<QPoint> Canvas::pixel_at(QPointF widget) const {
  const QPointF at = view_.to_picture(widget);
  const QPoint pixel(static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y())));
  return image_.rect().contains(pixel) ? std::optional(pixel) : std::nullopt;
}

void Canvas::resizeEvent(QResizeEvent*) {
  view_.set_sizes(view_.picture(), size());
  view_moved();
}

void Canvas::mousePressEvent(QMouseEvent* event) {
  pointer_ = pressed_ = event->position();
  is_inside_ = true;
  has_moved_ = false;
  if (image_.isNull() || document_.facts() == nullptr || is_first_look_) return;
  if (event->button() == Qt::MiddleButton || (event->button() == Qt::LeftButton && tool_ == nullptr)) {
    is_panning_ = true;
  } else if (event->button() == Qt::LeftButton) {
    is_stroking_ = true;
    tool_->press(view_.to_picture(pointer_), event->modifiers());
    update();
  }
}

void Canvas::mouseMoveEvent(QMouseEvent* event) {
  const QPointF before = pointer_;
  pointer_ = event->position();
  is_inside_ = true;
  if (is_panning_) {
    if (!has_moved_ && (pointer_ - pressed_).manhattanLength() <= kClickPixels) return;
    view_.pan(pointer_ - (has_moved_ ? before : pressed_));
    has_moved_ = true;
    view_moved();
  } else if (is_stroking_) {
    tool_->drag(view_.to_picture(pointer_), event->modifiers());
    update();
  } else if (tool_ != nullptr) {
    update();
  }
  Q_EMIT pointed(pixel_at(pointer_));
}

void Canvas::mouseReleaseEvent(QMouseEvent* event) {
  if (is_panning_) {
    is_panning_ = false;
    if (!has_moved_ && event->button() == Qt::LeftButton) document_.set_probe(pixel_at(event->position()));
  } else if (is_stroking_ && event->button() == Qt::LeftButton) {
    is_stroking_ = false;
    tool_->release(view_.to_picture(event->position()), event->modifiers());
    update();
  }
}

void Canvas::mouseDoubleClickEvent(QMouseEvent* event) {
  if (tool_ != nullptr && event->button() == Qt::LeftButton) {
    tool_->finish();
    update();
  } else {
    mousePressEvent(event);
  }
}

void Canvas::wheelEvent(QWheelEvent* event) {
  if (image_.isNull()) return;
  const double notches = event->angleDelta().y() / 120.0;
  view_.set_zoom(view_.zoom() * std::pow(kZoomByNotch, notches), event->position());
  view_moved();
}

void Canvas::keyPressEvent(QKeyEvent* event) {
  const auto pan = [&](double x, double y) {
    view_.pan(QPointF(x, y) * kPanByKey);
    view_moved();
  };
  switch (event->key()) {
    case Qt::Key_Left: return pan(1, 0);
    case Qt::Key_Right: return pan(-1, 0);
    case Qt::Key_Up: return pan(0, 1);
    case Qt::Key_Down: return pan(0, -1);
    case Qt::Key_Plus:
    case Qt::Key_Equal: return zoom_by(kZoomByKey);
    case Qt::Key_Minus: return zoom_by(1 / kZoomByKey);
    case Qt::Key_Return:
    case Qt::Key_Enter:
      if (tool_ != nullptr) tool_->finish();
      return update();
    case Qt::Key_Escape:
      if (tool_ != nullptr) tool_->give_up();
      is_stroking_ = false;
      return update();
    default: QWidget::keyPressEvent(event);
  }
}

void Canvas::leaveEvent(QEvent*) {
  is_inside_ = false;
  update();
  Q_EMIT pointed({});
}

}  // namespace nutik::studio
