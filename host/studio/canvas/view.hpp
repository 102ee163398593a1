// Which part of a picture a widget shows, and how large.
//
//   units:   picture: pixels from its top left; widget: device-independent pixels from the widget's
//   always:  some of the picture is visible
#pragma once

#include <QPointF>
#include <QRect>
#include <QRectF>
#include <QSize>

namespace nutik::studio {

class View {
 public:
  static constexpr double kMinZoom = 1.0 / 32, kMaxZoom = 64;

  void set_sizes(QSize picture, QSize widget);  // fits anew where it did
  [[nodiscard]] QSize picture() const { return picture_; }

  [[nodiscard]] double zoom() const { return zoom_; }
  [[nodiscard]] bool is_fitted() const { return is_fitted_; }

  void fit();
  // The picture's point under `at` stays there.
  void set_zoom(double zoom, QPointF at);
  void pan(QPointF by);

  [[nodiscard]] QPointF to_picture(QPointF widget) const;
  [[nodiscard]] QPointF to_widget(QPointF picture) const;
  [[nodiscard]] QRectF place() const;   // of the whole picture, on the widget
  [[nodiscard]] QRect visible() const;  // pixels of the picture

 private:
  void keep_in_sight();

  QSize picture_, widget_;
  double zoom_ = 1;
  QPointF origin_;  // of the picture, on the widget
  bool is_fitted_ = true;
};

}  // namespace nutik::studio
