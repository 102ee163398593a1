#include "studio/canvas/picture_canvas.hpp"

#include <QPaintEvent>
#include <QPainter>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "studio/live/changed_pixels.hpp"

namespace nutik::studio {
namespace {

constexpr int kNone = -1;

// Whose outline lies between two pixels.
int tag_between(std::uint8_t a, std::uint8_t b) { return a == b ? kNone : std::max(a, b); }

// A line that grows while neighbours go on with the same tag.
struct Run {
  int tag = kNone, from = 0;

  // Where another one begins, or none: the line up to there.
  template <typename Line>
  void go_on(Outlines& outlines, int next, int at, const Line& line) {
    if (next == tag) return;
    if (tag != kNone) outlines[static_cast<std::uint8_t>(tag)] += line(from, at);
    tag = next;
    from = at;
  }
};

constexpr double kInSight = 40;  // widget pixels of the picture that stay visible

const QColor kSurround(36, 36, 36);  // neutral, so that it does not tint what is seen
const QColor kDarkened(0, 0, 0, 170);

}  // namespace

// Row by row, as the mask lies in memory: this is done anew at each move of a brush.
Outlines outlines_of(const Mask& mask) {
  Outlines outlines;
  const int width = static_cast<int>(mask.width), height = static_cast<int>(mask.height);
  const auto row_at = [&](int y) { return mask.tags.data() + static_cast<std::size_t>(y) * mask.width; };
  const auto are_same = [&](const std::uint8_t* a, const std::uint8_t* b) {
    return std::memcmp(a, b, mask.width) == 0;
  };
  std::vector<Run> downwards(mask.width);  // left of each pixel
  for (int y = 0; y <= height; ++y) {
    const std::uint8_t *row = y < height ? row_at(y) : nullptr, *above = y > 0 ? row_at(y - 1) : nullptr;
    if (row != nullptr && above != nullptr && are_same(above, row)) continue;
    for (int x = 1; x < width; ++x)
      downwards[static_cast<std::size_t>(x)].go_on(
          outlines, row == nullptr ? kNone : tag_between(row[x - 1], row[x]), y,
          [x](int from, int to) { return QLine(x, from, x, to); });
    if (row == nullptr || above == nullptr) continue;
    Run along;
    const auto line = [y](int from, int to) { return QLine(from, y, to, y); };
    for (int x = 0; x < width; ++x) along.go_on(outlines, tag_between(above[x], row[x]), x, line);
    along.go_on(outlines, kNone, width, line);
  }
  return outlines;
}

void View::set_sizes(QSize picture, QSize widget) {
  const bool is_new = picture != picture_;
  picture_ = picture;
  widget_ = widget;
  if (is_new || is_fitted_) {
    fit();
  } else {
    keep_in_sight();
  }
}

void View::fit() {
  is_fitted_ = true;
  if (picture_.isEmpty() || widget_.isEmpty()) return;
  const double wide = static_cast<double>(widget_.width()) / picture_.width();
  const double high = static_cast<double>(widget_.height()) / picture_.height();
  zoom_ = std::clamp(std::min(wide, high), kMinZoom, kMaxZoom);
  origin_ =
      QPointF(widget_.width() - zoom_ * picture_.width(), widget_.height() - zoom_ * picture_.height()) / 2;
}

void View::set_zoom(double zoom, QPointF at) {
  const QPointF fixed = to_picture(at);
  zoom_ = std::clamp(zoom, kMinZoom, kMaxZoom);
  origin_ = at - fixed * zoom_;
  is_fitted_ = false;
  keep_in_sight();
}

void View::pan(QPointF by) {
  origin_ += by;
  is_fitted_ = false;
  keep_in_sight();
}

void View::keep_in_sight() {
  const double width = zoom_ * picture_.width(), height = zoom_ * picture_.height();
  const double x_margin = std::min(kInSight, width), y_margin = std::min(kInSight, height);
  origin_.setX(
      std::clamp(origin_.x(), x_margin - width, std::max(widget_.width() - x_margin, x_margin - width)));
  origin_.setY(
      std::clamp(origin_.y(), y_margin - height, std::max(widget_.height() - y_margin, y_margin - height)));
}

QPointF View::to_picture(QPointF widget) const { return (widget - origin_) / zoom_; }

QPointF View::to_widget(QPointF picture) const { return picture * zoom_ + origin_; }

QRectF View::place() const { return {origin_, QSizeF(picture_) * zoom_}; }

QRect View::visible() const {
  const QPointF first = to_picture({0, 0}),
                last = to_picture({1.0 * widget_.width(), 1.0 * widget_.height()});
  const QPoint from(static_cast<int>(std::floor(first.x())), static_cast<int>(std::floor(first.y())));
  const QPoint to(static_cast<int>(std::ceil(last.x())) - 1, static_cast<int>(std::ceil(last.y())) - 1);
  return QRect(from, to) & QRect({0, 0}, picture_);
}

Canvas::Canvas(Document& document, QWidget* parent) : QWidget(parent), document_(document) {
  setMouseTracking(true);
  setFocusPolicy(Qt::StrongFocus);
  setMinimumSize(240, 160);
  setAttribute(Qt::WA_OpaquePaintEvent);
  setAccessibleName(tr("Picture"));
  setAccessibleDescription(
      tr("The exposure. Plus and minus zoom, Ctrl+1 shows pixel for pixel, Ctrl+0 all of it; arrow keys pan. "
         "Return takes a pixel, which arrow keys then move. With a tool arrow keys move the pointer, Space begins "
         "and ends a stroke, Backspace one that erases."));
  connect(&document_, &Document::changed, this, &Canvas::follow_mask);
  connect(&document_, &Document::selection_changed, this, [this] { follow_mask(Change::state); });
  connect(&document_, &Document::capture_changed, this, [this] { follow_mask(Change::state); });
  connect(&document_, &Document::probe_changed, this, [this] { update(); });
}

Canvas::~Canvas() = default;

void Canvas::show_picture(const ShownPicture& picture) {
  const CaptureFacts* facts = document_.facts();
  if (facts == nullptr || (is_first_look_ && !is_awaiting_)) return;  // of the clip before
  is_first_look_ = is_awaiting_ = false;
  const QSize size(static_cast<int>(facts->format.shape.width), static_cast<int>(facts->format.shape.height));
  const bool is_part = image_.size() == size && view_.picture() == size;
  if (picture.divisor > 1) return is_part ? show_reduced(picture) : void();
  const bool was_reduced = !std::exchange(reduced_, {}).isNull();
  if (picture.place == QRect({0, 0}, size)) {
    image_ = picture.image;
  } else {
    if (image_.size() != size) {
      image_ = QImage(size, QImage::Format_RGB32);
      image_.fill(Qt::black);
    }
    QPainter(&image_).drawImage(picture.place.topLeft(), picture.image);
  }
  if (is_part && !was_reduced) return update_pixels(picture.place);
  if (view_.picture() != size) {
    view_.set_sizes(size, this->size());
    view_moved();
  }
  update();
}

void Canvas::show_reduced(const ShownPicture& picture) {
  const int divisor = picture.divisor;
  // What is left over at the right and at the bottom no square of pixels shows.
  const QSize size(image_.width() / divisor, image_.height() / divisor);
  if (reduced_.size() != size) {
    reduced_ = image_.copy(QRect({0, 0}, size * divisor))
                   .scaled(size, Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
    update();
  }
  const QPoint at(picture.place.x() / divisor, picture.place.y() / divisor);
  QPainter(&reduced_).drawImage(at, picture.image);
  reduced_size_ = reduced_.size() * divisor;
  update_pixels(picture.place);
}

void Canvas::update_pixels(const QRectF& pixels) {
  constexpr int kAround = 4;  // the widest pen, and what smoothing mixes
  const QPointF first = view_.to_widget(pixels.topLeft()), last = view_.to_widget(pixels.bottomRight());
  update(QRectF(first, last).toAlignedRect().adjusted(-kAround, -kAround, kAround, kAround));
}

void Canvas::update_tool(QPointF before) {
  const auto reach = tool_->reach();
  if (!reach) return update();
  for (const QPointF pointer : {before, pointer_})
    update_pixels(QRectF(view_.to_picture(pointer), QSizeF(0, 0)).adjusted(-*reach, -*reach, *reach, *reach));
}

void Canvas::show_first_look(const QImage& image) {
  if (is_stroking_) tool_->give_up();
  is_stroking_ = is_key_stroke_ = is_panning_ = false;
  image_ = image;
  reduced_ = {};
  is_first_look_ = true;
  is_awaiting_ = false;
  view_.set_sizes(image.size(), size());
  view_moved();
}

void Canvas::clear() {
  image_ = reduced_ = {};
  is_first_look_ = is_awaiting_ = false;
  update();
}

void Canvas::await_picture() {
  if (!is_first_look_) return clear();
  is_awaiting_ = true;
}

void Canvas::look(Glance glance) {
  glance_ = std::move(glance);
  update();
}

void Canvas::set_tool(CanvasTool* tool) {
  if (tool_ != nullptr) tool_->give_up();
  tool_ = tool;
  is_stroking_ = is_key_stroke_ = false;
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
  Q_EMIT visible_changed(view_.visible(), view_.zoom() * devicePixelRatioF());
}

void Canvas::follow_mask(Change what) {
  const DocumentState& state = document_.state();
  const bool is_same =
      outlined_.has_value() == state.mask.has_value() && (!outlined_ || &**outlined_ == &**state.mask);
  if (!is_same) {
    const QRect changed = changed_pixels(outlined_, state.mask, image_.rect());
    outlined_ = state.mask;
    outlines_ = outlined_ ? outlines_of((*outlined_)->mask) : Outlines();
    if (what == Change::mask && !document_.solo()) return update_pixels(changed);
  }
  solo_ = {};
  update();
}

void Canvas::paintEvent(QPaintEvent* event) {
  QPainter painter(this);
  paint(painter, event->region());
  if (!is_framed_) return;
  painter.resetTransform();
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(palette().color(QPalette::Highlight), 2));
  painter.drawRect(rect().adjusted(1, 1, -1, -1));
}

void Canvas::paint(QPainter& painter, const QRegion& region) {
  QRectF place = view_.place();
  if (!reduced_.isNull()) place.setSize(QSizeF(reduced_size_) * view_.zoom());
  const QRect covered = place.toAlignedRect().adjusted(1, 1, -1, -1);
  for (const QRect& around : region - (image_.isNull() ? QRect() : covered))
    painter.fillRect(around, kSurround);
  if (image_.isNull()) return;  // it comes at once
  painter.setRenderHint(QPainter::SmoothPixmapTransform, view_.zoom() < 1);
  const bool is_held = !glance_.held.isNull();
  const QImage& other = is_held ? glance_.held : glance_.instead;
  const bool is_another = !other.isNull() && !is_first_look_;
  const QImage& exposed = reduced_.isNull() ? image_ : reduced_;
  painter.drawImage(is_another ? view_.place() : place, is_another ? other : exposed);
  if (document_.facts() == nullptr || is_first_look_) return;
  if (is_another) {
    painter.setPen(Qt::white);
    const QString title = is_held ? tr("A") : glance_.title;
    const QRect box = painter.boundingRect(rect().adjusted(12, 12, -12, -12), Qt::AlignLeft, title);
    painter.fillRect(box.adjusted(-6, -4, 6, 4), QColor(0, 0, 0, 170));
    return painter.drawText(box, title);
  }
  painter.save();
  painter.translate(view_.place().topLeft());
  painter.scale(view_.zoom(), view_.zoom());
  if (!glance_.marks.isNull()) painter.drawImage(0, 0, glance_.marks);
  paint_solo(painter);
  if (!glance_.without_outlines) paint_regions(painter);
  if (tool_ != nullptr && is_inside_) tool_->paint(painter, view_.to_picture(pointer_));
  if (tool_ != nullptr && is_by_keys_) paint_cross(painter, view_.to_picture(pointer_));
  painter.restore();
  if (glance_.is_magnified && is_inside_) paint_magnifier(painter);
}

// The pixels round the pointer, large, with the codes of the middle one.
void Canvas::paint_magnifier(QPainter& painter) {
  constexpr int kAround = 6, kSide = 12, kText = 20, kAway = 24;
  const auto pixel = pixel_at(pointer_);
  if (!pixel) return;
  const int side = (2 * kAround + 1) * kSide;
  QRect lens(pointer_.toPoint() + QPoint(kAway, kAway), QSize(side, side + kText));
  if (lens.right() > width()) lens.moveRight(pointer_.toPoint().x() - kAway);
  if (lens.bottom() > height()) lens.moveBottom(pointer_.toPoint().y() - kAway);
  painter.fillRect(lens, kSurround);
  painter.setRenderHint(QPainter::SmoothPixmapTransform, false);
  const QRect part(*pixel - QPoint(kAround, kAround), QSize(2 * kAround + 1, 2 * kAround + 1));
  painter.drawImage(QRect(lens.topLeft(), QSize(side, side)), image_.copy(part));
  painter.setPen(Qt::white);
  painter.drawRect(lens);
  painter.drawRect(QRect(lens.topLeft() + QPoint(kAround, kAround) * kSide, QSize(kSide, kSide)));
  const QRgb codes = image_.pixel(*pixel);
  painter.drawText(QRect(lens.left(), lens.top() + side, side, kText), Qt::AlignCenter,
                   QString("%1  %2  %3").arg(qRed(codes)).arg(qGreen(codes)).arg(qBlue(codes)));
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
                 ((is_selected ? 2.0 : 1.0) + (is_beneath ? 2.0 : 0.0)) * devicePixelRatioF());
        pen.setCosmetic(true);
        painter.setPen(pen);
        painter.drawLines(lines);
      }
    }
  }
  if (document_.probe()) paint_cross(painter, QPointF(*document_.probe()) + QPointF(0.5, 0.5));
}

void Canvas::paint_cross(QPainter& painter, QPointF at) const {
  const double arm = 6 / view_.zoom();
  for (const QColor& colour : {QColor(Qt::black), QColor(Qt::white)}) {
    QPen pen(colour, (colour == QColor(Qt::black) ? 3 : 1) * devicePixelRatioF());
    pen.setCosmetic(true);
    painter.setPen(pen);
    painter.drawLine(at - QPointF(arm, 0), at + QPointF(arm, 0));
    painter.drawLine(at - QPointF(0, arm), at + QPointF(0, arm));
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

}  // namespace nutik::studio
