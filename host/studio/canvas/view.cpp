#include "studio/canvas/view.hpp"

#include <algorithm>
#include <cmath>

namespace nutik::studio {
namespace {

constexpr double kInSight = 40;  // widget pixels of the picture that stay visible

}  // namespace

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

}  // namespace nutik::studio
