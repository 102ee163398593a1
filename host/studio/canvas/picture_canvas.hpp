// The picture: zoomed, panned, with the outlines of regions, and the mouse on it.
//
//   in:      pictures as they are exposed; the mouse and the keyboard
//   out:     which pixels are visible, the pixel under the pointer; clicks and strokes, to whoever is its tool
//   always:  the middle button pans, the wheel zooms to the pointer, whatever the tool; what the mouse does keys do,
//            too
#pragma once

#include <QImage>
#include <QLine>
#include <QPointF>
#include <QRect>
#include <QRectF>
#include <QSize>
#include <QVector>
#include <QWidget>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>

#include "capture/source_text.hpp"
#include "exposure/mask.hpp"
#include "exposure/shutter_shape.hpp"
#include "studio/document/document.hpp"
#include "studio/live/live_view.hpp"

namespace nutik::studio {

// The borders between a mask's regions.

// By tag: straight lines between pixels of the tag and pixels of smaller tags, as long as they go; in the picture's
// pixels. Each border is drawn once, by the larger tag, so that the background needs no colour.
using Outlines = std::map<std::uint8_t, QVector<QLine>>;
[[nodiscard]] Outlines outlines_of(const Mask& mask);

// Which part of a picture a widget shows, and how large.
//
//   units:   picture: pixels from its top left; widget: device-independent pixels from the widget's
//   always:  some of the picture is visible

class View {
 public:
  static constexpr double kMinZoom = 1.0 / 32, kMaxZoom = 64;

  void set_sizes(QSize picture, QSize widget);  // fits anew where it did
  [[nodiscard]] QSize picture() const { return picture_; }

  [[nodiscard]] double zoom() const { return zoom_; }

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

// What the left button does, in the picture's coordinates.
class CanvasTool {
 public:
  virtual ~CanvasTool() = default;
  virtual void press(QPointF at, Qt::KeyboardModifiers keys) = 0;
  virtual void drag(QPointF to, Qt::KeyboardModifiers keys) = 0;
  virtual void release(QPointF at, Qt::KeyboardModifiers keys) = 0;
  virtual void finish() {}   // Enter, or a double click
  virtual void give_up() {}  // Escape
  // How far from the pointer paint() draws, in pixels of the picture; nothing: anywhere.
  [[nodiscard]] virtual std::optional<double> reach() const { return {}; }
  // What is being drawn, `picture` painted already with lines one screen pixel wide; `pointer` is where the mouse is.
  virtual void paint(QPainter& painter, QPointF pointer) const = 0;
};

// How the picture is looked at for a while.
struct Glance {
  bool without_outlines = false, is_magnified = false;
  QImage held = {};     // while a key is; null: what follows
  QImage instead = {};  // until it is looked away from; null: the picture itself
  QString title = {};   // of `instead`
  QImage marks = {};    // over the picture; null: none
};

class Canvas : public QWidget {
  Q_OBJECT

 public:
  explicit Canvas(Document& document, QWidget* parent = nullptr);
  ~Canvas() override;

  void show_picture(const ShownPicture& picture);
  // Shows a clip that is being opened, until there is a picture of the document. No tool works on it.
  void show_first_look(const QImage& image);
  [[nodiscard]] bool shows_first_look() const { return is_first_look_; }
  void clear();
  // The document is another capture's: what is shown of a clip that was being opened stays until its first picture.
  void await_picture();

  void look(Glance glance);
  [[nodiscard]] const Glance& glance() const { return glance_; }

  // Null: the left button looks (a click takes the pixel, a drag pans). The tool is not owned.
  void set_tool(CanvasTool* tool);

  [[nodiscard]] const QImage& image() const { return image_; }
  [[nodiscard]] View& view() { return view_; }
  void zoom_by(double factor);  // about the middle
  void show_actual_size();
  void fit();

 Q_SIGNALS:
  void visible_changed(QRect pixels, double screen_pixels);  // of each of the capture's
  void pointed(std::optional<QPoint> pixel);  // none: it left the picture

 protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void leaveEvent(QEvent* event) override;
  void focusInEvent(QFocusEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;
  QSize sizeHint() const override { return {640, 400}; }

 private:
  void view_moved();
  void show_reduced(const ShownPicture& picture);
  void update_pixels(const QRectF& pixels);  // of the picture
  void update_tool(QPointF before);          // of the pointer
  void follow_mask(Change what);
  void paint(QPainter& painter, const QRegion& region);
  void paint_regions(QPainter& painter);
  void paint_cross(QPainter& painter, QPointF at) const;
  void paint_solo(QPainter& painter);
  void paint_magnifier(QPainter& painter);

  // canvas_input.cpp
  [[nodiscard]] bool is_workable() const;
  void follow_arrow(QPoint way);
  void press_key(Qt::KeyboardModifiers keys);
  void end_key_stroke();
  [[nodiscard]] QPointF key_pointer() const;
  void move_pointer(QPointF picture);
  void keep_in_sight(QPointF picture);
  [[nodiscard]] std::optional<QPoint> pixel_at(QPointF widget) const;

  Document& document_;
  QImage image_;
  QImage reduced_;      // with fewer pixels; shown in its place until the next of all pixels
  QSize reduced_size_;  // in pixels of the picture
  Glance glance_;
  View view_;
  CanvasTool* tool_ = nullptr;
  std::optional<Shared<MaskWithRegions>> outlined_;
  Outlines outlines_;
  QImage solo_;  // what it leaves in the dark
  QPointF pointer_, pressed_;
  bool is_inside_ = false;  // the pointer
  bool is_first_look_ = false, is_awaiting_ = false;
  bool is_panning_ = false, is_stroking_ = false, has_moved_ = false;
  bool is_by_keys_ = false;     // the pointer was moved by them last
  bool is_framed_ = false;      // keys led the focus here, which is seen then
  bool is_key_stroke_ = false;  // begun by a key, which also ends it
  Qt::KeyboardModifiers stroke_keys_;
};

}  // namespace nutik::studio
