#include "studio/curves/handles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nutik::studio {
namespace {

bool is_gain_step(const Points& points, std::size_t first) {
  return points[first + 1].time_ns - points[first].time_ns == 1 &&
         points[first + 1].gain != points[first].gain;
}

constexpr double kRoom = 0.12;       // of what is shown, above and below
constexpr double kSmallest = 1e-12;  // gains that can be told apart in pictures are far larger
constexpr double kLargest = 1e15;

constexpr double kBoxRoom = 10;  // between points and the box round them

// Points [first, second) whose times lie in a range.
std::pair<std::size_t, std::size_t> within_times(const Points& points, std::int64_t begin_ns,
                                                 std::int64_t end_ns) {
  const auto earlier = [](const ControlPoint& point, std::int64_t time) { return point.time_ns < time; };
  const auto first = std::lower_bound(points.begin(), points.end(), begin_ns, earlier);
  const auto last = std::lower_bound(first, points.end(), end_ns + 1, earlier);
  return {static_cast<std::size_t>(first - points.begin()), static_cast<std::size_t>(last - points.begin())};
}

double distance_to_segment(QPointF a, QPointF b, QPointF at) {
  const QPointF along = b - a;
  const double length = QPointF::dotProduct(along, along);
  const double share = length > 0 ? std::clamp(QPointF::dotProduct(at - a, along) / length, 0.0, 1.0) : 0.0;
  const QPointF apart = at - (a + share * along);
  return std::hypot(apart.x(), apart.y());
}

QRectF square_at(double x, double y) {
  return {x - kHandlePixels / 2, y - kHandlePixels / 2, kHandlePixels, kHandlePixels};
}

QRectF seizable(const QRectF& area, double more) { return area.adjusted(-more, -more, more, more); }

}  // namespace

std::vector<GainBoxcar> boxcars_of(const Points& points) {
  std::vector<GainBoxcar> boxcars;
  for (std::size_t i = 0; i + 2 < points.size(); ++i) {
    const ControlPoint &begin = points[i], &end = points[i + 1];
    if (begin.gain != end.gain || begin.gain == 0.0 || !is_gain_step(points, i + 1)) continue;
    const bool has_first_step = i > 0 && is_gain_step(points, i - 1);
    if (!has_first_step && (i > 0 || begin.time_ns > 0)) continue;
    boxcars.push_back({i, i + 1, begin.time_ns, end.time_ns, begin.gain, has_first_step});
  }
  return boxcars;
}

Points with_boxcar_moved(const Points& points, const GainBoxcar& boxcar, BoxcarPart part,
                         std::int64_t by_ns) {
  Points result = points;
  std::size_t first = boxcar.first, last = boxcar.last;
  if (!boxcar.has_first_step && part != BoxcarPart::end) {
    result.insert(result.begin(), {boxcar.begin_ns - 1, 0.0});
    ++first;
    ++last;
  }
  if (part == BoxcarPart::begin) return moved(result, {first}, {by_ns, 0.0});
  if (part == BoxcarPart::end) return moved(result, {last}, {by_ns, 0.0});
  return moved(result, {first, last}, {by_ns, 0.0});
}

GainRange range_with_room(std::span<const ControlPoint> points) {
  double low = 0.0, high = 0.0;
  for (const ControlPoint& point : points) {
    low = std::min(low, point.gain);
    high = std::max(high, point.gain);
  }
  // A gain of 1, which plain exposures have, is shown unless all gains are far from it.
  constexpr double kNear = 0.2;
  if (high > kNear || low == high) high = std::max(high, 1.0);
  low = std::max(low, -kLargest);
  high = std::min(high, kLargest);
  const double length = std::max(high - low, kSmallest);
  return {low - kRoom * length, high + kRoom * length};
}

void GainAxis::follow(std::span<const ControlPoint> points) {
  if (is_automatic_) range_ = range_with_room(points);
}

void GainAxis::zoom(double factor, double fixed) {
  const GainRange next{fixed + (range_.low - fixed) * factor, fixed + (range_.high - fixed) * factor};
  const double length = next.high - next.low;
  // So near to a large gain that doubles no longer tell the ends apart, nothing could be drawn.
  const double finest = std::max(kSmallest, 1e-9 * std::max(std::fabs(next.low), std::fabs(next.high)));
  if (!(length > finest) || length > kLargest) return;
  range_ = next;
  is_automatic_ = false;
}

void GainAxis::make_automatic(std::span<const ControlPoint> points) {
  is_automatic_ = true;
  follow(points);
}

std::optional<std::size_t> point_under(const PlotFrame& frame, const Points& points,
                                       const PointIndices& selected, QPointF at) {
  const auto [first, last] =
      within_times(points, frame.time_at(at.x() - kReachPixels), frame.time_at(at.x() + kReachPixels));
  std::optional<std::size_t> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = first; i < last; ++i) {
    const QPointF apart = frame.place(points[i]) - at;
    constexpr double kPreference = 0.5;  // pixels
    const bool is_selected = std::binary_search(selected.begin(), selected.end(), i);
    const double distance = std::hypot(apart.x(), apart.y());
    if (distance > kReachPixels || distance - (is_selected ? kPreference : 0.0) > least) continue;
    nearest = i;
    least = distance - (is_selected ? kPreference : 0.0);
  }
  return nearest;
}

bool is_on_curve(const PlotFrame& frame, const Points& points, QPointF at) {
  if (points.empty() || !frame.box().contains(at)) return false;
  auto [first, last] =
      within_times(points, frame.time_at(at.x() - kReachPixels), frame.time_at(at.x() + kReachPixels));
  const double left = frame.box().left() - kReachPixels, right = frame.box().right() + kReachPixels;
  // From the held gain before the first point to the one after the last.
  const auto place = [&](std::size_t i) {
    if (i == 0)
      return QPointF(std::min(left, frame.x_of(points.front().time_ns)), frame.y_of(points.front().gain));
    if (i == points.size() + 1)
      return QPointF(std::max(right, frame.x_of(points.back().time_ns)), frame.y_of(points.back().gain));
    return frame.place(points[i - 1]);
  };
  for (std::size_t i = first; i <= last; ++i) {
    const bool is_step = i > 0 && i < points.size() && points[i].time_ns - points[i - 1].time_ns == 1;
    if (!is_step && distance_to_segment(place(i), place(i + 1), at) <= kReachPixels) return true;
  }
  return false;
}

PointIndices points_within(const PlotFrame& frame, const Points& points, const QRectF& area) {
  const auto [first, last] = within_times(points, frame.time_at(area.left()), frame.time_at(area.right()));
  PointIndices found;
  for (std::size_t i = first; i < last; ++i) {
    const double y = frame.y_of(points[i].gain);
    if (y >= area.top() && y <= area.bottom()) found.push_back(i);
  }
  return found;
}

std::optional<TransformBox> TransformBox::round(const PlotFrame& frame, const Points& points,
                                                const PointIndices& selected) {
  if (selected.size() < 2) return std::nullopt;
  TransformBox made;
  made.low_ = made.high_ = points[selected.front()].gain;
  for (const std::size_t i : selected) {
    made.low_ = std::min(made.low_, points[i].gain);
    made.high_ = std::max(made.high_, points[i].gain);
  }
  made.is_long_ = points[step_anchor(points, selected.front())].time_ns <
                  points[step_anchor(points, selected.back())].time_ns;
  const QRectF tight(QPointF(frame.x_of(points[selected.front()].time_ns), frame.y_of(made.high_)),
                     QPointF(frame.x_of(points[selected.back()].time_ns), frame.y_of(made.low_)));
  made.box_ = tight.adjusted(-kBoxRoom, -kBoxRoom, kBoxRoom, kBoxRoom);
  return made;
}

std::vector<std::pair<BoxPart, QRectF>> TransformBox::handles() const {
  constexpr BoxPart kParts[] = {BoxPart::top_left,     BoxPart::top_right, BoxPart::bottom_left,
                                BoxPart::bottom_right, BoxPart::left,      BoxPart::right,
                                BoxPart::top,          BoxPart::bottom};
  std::vector<std::pair<BoxPart, QRectF>> handles;
  for (const BoxPart part : kParts) {
    const bool is_sideways = moves_left(part) || moves_right(part);
    if ((is_sideways && !is_long_) || (moves_top(part) && high_ == 0.0) ||
        (moves_bottom(part) && low_ == 0.0))
      continue;
    const double x = moves_left(part) ? box_.left() : moves_right(part) ? box_.right() : box_.center().x();
    const double y = moves_top(part) ? box_.top() : moves_bottom(part) ? box_.bottom() : box_.center().y();
    handles.emplace_back(part, square_at(x, y));
  }
  return handles;
}

std::optional<BoxPart> TransformBox::part_under(QPointF at) const {
  for (const auto& handle : handles())
    if (seizable(handle.second, 3).contains(at)) return handle.first;
  if (box_.contains(at)) return BoxPart::inside;
  return std::nullopt;
}

BoxcarHandles BoxcarHandles::of(const PlotFrame& frame, const GainBoxcar& boxcar, double lane_top) {
  const double begin = frame.x_of(boxcar.begin_ns), end = frame.x_of(boxcar.end_ns);
  const double middle = (begin + end) / 2, half = std::max(end - begin, kMinBarPixels) / 2;
  constexpr double kEndPixels = 7;
  BoxcarHandles handles;
  handles.bar = {middle - half, lane_top + 1, 2 * half, kLanePixels - 2};
  handles.begin = {handles.bar.left(), handles.bar.top(), kEndPixels, handles.bar.height()};
  handles.end = {handles.bar.right() - kEndPixels, handles.bar.top(), kEndPixels, handles.bar.height()};
  const QPointF level((std::max(begin, frame.box().left()) + std::min(end, frame.box().right())) / 2,
                      frame.y_of(boxcar.gain));
  handles.level = {level.x() - 9, level.y() - 3, 18, 6};
  return handles;
}

std::optional<BoxcarHit> boxcar_under(const PlotFrame& frame, const std::vector<GainBoxcar>& boxcars,
                                      double lane_top, QPointF at) {
  for (const GainBoxcar& boxcar : boxcars) {
    const BoxcarHandles handles = BoxcarHandles::of(frame, boxcar, lane_top);
    if (handles.bar.right() < frame.box().left() || handles.bar.left() > frame.box().right()) continue;
    if (seizable(handles.level, 3).contains(at)) return BoxcarHit{boxcar, BoxcarPart::gain};
    if (!seizable(handles.bar, 2).contains(at)) {
      // The steps themselves are edges, too.
      const auto is_on_step = [&](std::int64_t time_ns) {
        const double low = frame.y_of(std::min(0.0, boxcar.gain)),
                     high = frame.y_of(std::max(0.0, boxcar.gain));
        return std::fabs(frame.x_of(time_ns) - at.x()) <= kReachPixels / 2 && at.y() >= high && at.y() <= low;
      };
      if (boxcar.has_first_step && is_on_step(boxcar.begin_ns)) return BoxcarHit{boxcar, BoxcarPart::begin};
      if (is_on_step(boxcar.end_ns)) return BoxcarHit{boxcar, BoxcarPart::end};
      continue;
    }
    if (at.x() <= handles.begin.right()) return BoxcarHit{boxcar, BoxcarPart::begin};
    if (at.x() >= handles.end.left()) return BoxcarHit{boxcar, BoxcarPart::end};
    return BoxcarHit{boxcar, BoxcarPart::whole};
  }
  return std::nullopt;
}

}  // namespace nutik::studio
