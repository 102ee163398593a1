#include "studio/regions/mask_tools.hpp"

#include <QPainter>
#include <QPainterPath>
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "studio/regions/region_edits.hpp"

namespace nutik::studio {
namespace {

constexpr double kMinSide = 0.5;  // of a shape, in pixels: less is a click

Point point_of(QPointF at) { return {at.x(), at.y()}; }

// Which region a stroke is for.
struct Target {
  std::uint8_t tag = kBackground;
  bool loses = false;  // the pixels, with Alt; else it gets them

  static Target of(const Document& document, Qt::KeyboardModifiers keys) {
    return {document.selected_tag(), (keys & Qt::AltModifier) != 0};
  }
  // Where there is no region yet the stroke makes one, in the same step of undo.
  void stroke(Document& document, const Region& region, const QString& what) {
    if (loses && tag != kBackground) return erase_region(document, region, tag, what);
    const bool makes_region = !loses && document.state().order.empty();
    const bool is_step = makes_region && !document.is_dragging();
    if (is_step) document.begin_drag();
    if (makes_region) {
      add_region(document);
      tag = document.selected_tag();
    }
    paint_region(document, region, tag, what);
    if (is_step) document.end_drag();
  }
};

// Bright over dark, on any picture.
template <typename Draw>
void draw_line(QPainter& painter, const Draw& draw) {
  for (const bool is_beneath : {true, false}) {
    QPen pen(is_beneath ? QColor(0, 0, 0, 180) : QColor(255, 255, 255),
             (is_beneath ? 3 : 1) * painter.device()->devicePixelRatioF());
    pen.setCosmetic(true);
    painter.setPen(pen);
    painter.setBrush(Qt::NoBrush);
    draw();
  }
}

class Brush : public CanvasTool {
 public:
  Brush(Document& document, const ToolSettings& settings) : document_(document), settings_(settings) {}

  void press(QPointF at, Qt::KeyboardModifiers keys) override {
    target_ = Target::of(document_, keys);
    document_.begin_drag();
    last_ = at;
    stroke(at);
  }
  void drag(QPointF to, Qt::KeyboardModifiers) override { stroke(to); }
  void release(QPointF at, Qt::KeyboardModifiers) override {
    stroke(at);
    document_.end_drag();
  }
  void give_up() override {
    if (!document_.is_dragging()) return;
    document_.end_drag();
    document_.undo_stack().undo();
  }
  void paint(QPainter& painter, QPointF pointer) const override {
    draw_line(painter, [&] { painter.drawEllipse(pointer, settings_.brush_radius, settings_.brush_radius); });
  }
  [[nodiscard]] std::optional<double> reach() const override { return settings_.brush_radius; }

 private:
  // A disc at each place of the way, no further apart than a quarter of it.
  void stroke(QPointF to) {
    const Shape& shape = document_.facts()->format.shape;
    const double radius = settings_.brush_radius, length = std::hypot(to.x() - last_.x(), to.y() - last_.y());
    const int steps = std::max(1, static_cast<int>(std::ceil(length / std::max(radius / 4, 0.25))));
    Region region = Region::none(shape.width, shape.height);
    for (int step = 0; step <= steps; ++step) stamp(region, last_ + (to - last_) * step / steps);
    last_ = to;
    target_.stroke(document_, region, Document::tr("Brush"));
  }

  void stamp(Region& region, QPointF at) const {
    const double radius = settings_.brush_radius;
    const auto first = [](double from) { return static_cast<int>(std::max(std::floor(from), 0.0)); };
    const auto last = [](double to, std::uint32_t side) {
      return static_cast<int>(std::min(std::ceil(to), 1.0 * side));
    };
    const int x_end = last(at.x() + radius, region.width), y_end = last(at.y() + radius, region.height);
    for (int y = first(at.y() - radius); y < y_end; ++y) {
      for (int x = first(at.x() - radius); x < x_end; ++x) {
        const double dx = x + 0.5 - at.x(), dy = y + 0.5 - at.y();
        if (dx * dx + dy * dy > radius * radius) continue;
        region.inside[static_cast<std::size_t>(y) * region.width + static_cast<std::size_t>(x)] = 1;
      }
    }
  }

  Document& document_;
  const ToolSettings& settings_;
  QPointF last_;
  Target target_;
};

// A rectangle or an ellipse between two corners.
class BoxTool : public CanvasTool {
 public:
  BoxTool(Document& document, bool is_ellipse) : document_(document), is_ellipse_(is_ellipse) {}

  void press(QPointF at, Qt::KeyboardModifiers) override {
    from_ = to_ = at;
    is_drawn_ = true;
  }
  void drag(QPointF to, Qt::KeyboardModifiers keys) override {
    if ((keys & Qt::ShiftModifier) != 0) {
      const double side = std::max(std::abs(to.x() - from_.x()), std::abs(to.y() - from_.y()));
      to = from_ + QPointF(std::copysign(side, to.x() - from_.x()), std::copysign(side, to.y() - from_.y()));
    }
    to_ = to;
  }
  void release(QPointF at, Qt::KeyboardModifiers keys) override {
    if (!is_drawn_) return;
    drag(at, keys);
    is_drawn_ = false;
    const QRectF box = QRectF(from_, to_).normalized();
    if (box.width() < kMinSide || box.height() < kMinSide) return;
    const Shape& shape = document_.facts()->format.shape;
    const Region region =
        is_ellipse_
            ? ellipse(shape.width, shape.height, point_of(box.center()), box.width() / 2, box.height() / 2)
            : rectangle(shape.width, shape.height, point_of(box.topLeft()), box.width(), box.height());
    Target::of(document_, keys)
        .stroke(document_, region, is_ellipse_ ? Document::tr("Ellipse") : Document::tr("Rectangle"));
  }
  void give_up() override { is_drawn_ = false; }
  void paint(QPainter& painter, QPointF) const override {
    if (!is_drawn_) return;
    const QRectF box = QRectF(from_, to_).normalized();
    draw_line(painter, [&] { is_ellipse_ ? painter.drawEllipse(box) : painter.drawRect(box); });
  }

 private:
  Document& document_;
  bool is_ellipse_;
  QPointF from_, to_;
  bool is_drawn_ = false;
};

// Corners by clicks; a double click, Enter or a click on the first corner closes it.
class PolygonTool : public CanvasTool {
 public:
  explicit PolygonTool(Document& document) : document_(document) {}

  void press(QPointF at, Qt::KeyboardModifiers keys) override {
    keys_ = keys;
    corners_.push_back(at);
  }
  void drag(QPointF to, Qt::KeyboardModifiers) override { corners_.back() = to; }
  void release(QPointF, Qt::KeyboardModifiers) override {}
  void finish() override {
    if (corners_.size() < 3) return;
    std::vector<Point> corners;
    std::ranges::transform(corners_, std::back_inserter(corners), point_of);
    corners_.clear();
    const Shape& shape = document_.facts()->format.shape;
    Target::of(document_, keys_)
        .stroke(document_, polygon(shape.width, shape.height, corners), Document::tr("Polygon"));
  }
  void give_up() override { corners_.clear(); }
  void paint(QPainter& painter, QPointF pointer) const override {
    if (corners_.empty()) return;
    QPolygonF line(QList<QPointF>(corners_.begin(), corners_.end()));
    line << pointer;
    draw_line(painter, [&] { painter.drawPolyline(line); });
  }

 private:
  Document& document_;
  std::vector<QPointF> corners_;
  Qt::KeyboardModifiers keys_;
};

class Wand : public CanvasTool {
 public:
  Wand(Document& document, const ToolSettings& settings, std::function<const QImage&()> image)
      : document_(document), settings_(settings), image_(std::move(image)) {}

  void press(QPointF at, Qt::KeyboardModifiers keys) override {
    const QPoint pixel(static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y())));
    const QImage& image = image_();
    const Shape& shape = document_.facts()->format.shape;
    const QSize size(static_cast<int>(shape.width), static_cast<int>(shape.height));
    if (image.size() != size || !image.rect().contains(pixel)) return;
    Target::of(document_, keys)
        .stroke(document_, similar_pixels(image, pixel, settings_.wand_codes), Document::tr("Magic wand"));
  }
  void drag(QPointF, Qt::KeyboardModifiers) override {}
  void release(QPointF, Qt::KeyboardModifiers) override {}
  void paint(QPainter&, QPointF) const override {}

 private:
  Document& document_;
  const ToolSettings& settings_;
  std::function<const QImage&()> image_;
};

}  // namespace

Region similar_pixels(const QImage& image, QPoint from, int codes) {
  const int width = image.width(), height = image.height();
  Region region = Region::none(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height));
  const QRgb wanted = image.pixel(from);
  const auto is_similar = [&](int x, int y) {
    const QRgb is = reinterpret_cast<const QRgb*>(image.constScanLine(y))[x];
    return std::abs(qRed(is) - qRed(wanted)) <= codes && std::abs(qGreen(is) - qGreen(wanted)) <= codes &&
           std::abs(qBlue(is) - qBlue(wanted)) <= codes;
  };
  std::vector<QPoint> open;
  const auto take = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= width || y >= height) return;
    std::uint8_t& inside =
        region.inside[static_cast<std::size_t>(y) * region.width + static_cast<std::size_t>(x)];
    if (inside != 0 || !is_similar(x, y)) return;
    inside = 1;
    open.emplace_back(x, y);
  };
  take(from.x(), from.y());
  while (!open.empty()) {
    const QPoint at = open.back();
    open.pop_back();
    take(at.x() - 1, at.y());
    take(at.x() + 1, at.y());
    take(at.x(), at.y() - 1);
    take(at.x(), at.y() + 1);
  }
  return region;
}

std::unique_ptr<CanvasTool> make_tool(ToolKind kind, Document& document, const ToolSettings& settings,
                                      std::function<const QImage&()> image) {
  switch (kind) {
    case ToolKind::look: return nullptr;
    case ToolKind::brush: return std::make_unique<Brush>(document, settings);
    case ToolKind::rectangle: return std::make_unique<BoxTool>(document, false);
    case ToolKind::ellipse: return std::make_unique<BoxTool>(document, true);
    case ToolKind::polygon: return std::make_unique<PolygonTool>(document);
    case ToolKind::wand: return std::make_unique<Wand>(document, settings, std::move(image));
  }
  return nullptr;
}

}  // namespace nutik::studio
