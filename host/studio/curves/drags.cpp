#include "studio/curves/drags.hpp"

#include <algorithm>
#include <cmath>

#include "capture/format.hpp"
#include "studio/document/document.hpp"
#include "studio/time/times.hpp"

namespace nutik::studio {
namespace {

// A function with more points is snapped to at its first ones: nobody aligns with one of a million by eye.
constexpr std::size_t kMaxPoints = 10'000;

bool is_earlier(const TimeSnap& a, const TimeSnap& b) { return a.time_ns < b.time_ns; }

std::int64_t whole(double ns) {
  constexpr auto kMax = static_cast<double>(kLargestTimeNs);
  return std::llround(std::clamp(ns, -kMax, kMax));
}

// The nearest multiple of a power of ten: what is written with few digits.
double rounded(double value, double step) {
  if (step <= 0.0) return value;
  if (step >= 1.0) return std::round(value / step) * step;
  const double parts = std::round(1.0 / step);
  const double of_them = std::round(value * parts);
  return of_them / parts;
}

std::int64_t later(std::int64_t time_ns, const HandShift& shift) {
  if (whole(shift.time_ns) == 0) return time_ns;
  const auto step = std::max<std::int64_t>(1, whole(shift.time_step_ns));
  const std::int64_t at = time_ns + whole(shift.time_ns);
  const std::int64_t half = at < 0 ? -step / 2 : step / 2;
  return std::clamp((at + half) / step * step, -kLargestTimeNs, kLargestTimeNs);
}

double higher(double gain, const HandShift& shift) {
  return shift.gain == 0.0 ? gain : rounded(gain + shift.gain, shift.gain_step);
}

QString short_gain(double gain) { return QString::fromStdString(format("{:.4g}", gain)); }

// Selected points are spread by a side of the box round them.
Dragged spread_by(const HandShift& shift, const Points& points, const PointIndices& chosen, bool is_left,
                  const Snapper& snapper) {
  // Steps are aligned by the points that stand for their moments.
  const std::size_t begin = step_anchor(points, chosen.front()), end = step_anchor(points, chosen.back());
  const std::int64_t held = points[is_left ? begin : end].time_ns;
  const std::int64_t fixed = points[is_left ? end : begin].time_ns;
  Dragged dragged;
  std::int64_t at = later(held, shift);
  dragged.time_snap = snapper.time(at, shift.time_reach_ns);
  if (dragged.time_snap) at = dragged.time_snap->time_ns;
  // It does not turn over.
  constexpr double kMin = 1e-6;
  const double factor = std::max(static_cast<double>(at - fixed) / static_cast<double>(held - fixed), kMin);
  dragged.points = at == held ? points : spread(points, chosen, factor, fixed);
  const std::int64_t length = dragged.points[end].time_ns - dragged.points[begin].time_ns;
  const double times =
      static_cast<double>(length) / static_cast<double>(points[end].time_ns - points[begin].time_ns);
  dragged.text = Document::tr("%1 long, × %2").arg(exact_time_text(length), short_gain(times));
  return dragged;
}

// Whatever their times are already.
void amplify(Dragged& dragged, const HandShift& shift, const PointIndices& chosen, double held,
             const Snapper& snapper) {
  double to = higher(held, shift);
  dragged.gain_snap = snapper.gain(to, shift.gain_reach);
  if (dragged.gain_snap) to = dragged.gain_snap->gain;
  if (to != held) dragged.points = amplified(dragged.points, chosen, to / held);
  const QString text = Document::tr("gain %1, × %2").arg(short_gain(to), short_gain(to / held));
  dragged.text = dragged.text.isEmpty() ? text : dragged.text + "; " + text;
}

// A whole boxcar snaps with its nearer end. Changes the shift.
std::optional<TimeSnap> snap(const BoxcarHit& hit, const Snapper& snapper, std::int64_t& by_ns, double reach_ns) {
  std::optional<TimeSnap> begin, end;
  const std::int64_t begin_ns = hit.boxcar.begin_ns, end_ns = hit.boxcar.end_ns;
  if (hit.part != BoxcarPart::end) begin = snapper.time(begin_ns + by_ns, reach_ns);
  if (hit.part != BoxcarPart::begin) end = snapper.time(end_ns + by_ns, reach_ns);
  const std::int64_t asked_ns = by_ns;
  const auto distance = [&](const std::optional<TimeSnap>& to, std::int64_t from) {
    return std::abs(to->time_ns - from - asked_ns);
  };
  if (begin && (!end || distance(begin, begin_ns) <= distance(end, end_ns))) {
    by_ns = begin->time_ns - begin_ns;
    return begin;
  }
  if (end) by_ns = end->time_ns - end_ns;
  return end;
}

QString name_of(BoxcarPart part) {
  switch (part) {
    case BoxcarPart::whole: return Document::tr("Move boxcar");
    case BoxcarPart::begin: return Document::tr("Move boxcar's begin");
    case BoxcarPart::end: return Document::tr("Move boxcar's end");
    case BoxcarPart::gain: return Document::tr("Change boxcar's gain");
  }
  return {};
}

}  // namespace

Snapper::Snapper(const Timeline* timeline, const FunctionSet& functions, std::uint8_t moved_tag)
    : timeline_(timeline), gains_{{0.0, Document::tr("gain 0")}, {1.0, Document::tr("gain 1")}} {
  if (timeline != nullptr) {
    times_ = {{0, Document::tr("start of the capture")}, {timeline->duration_ns(), Document::tr("end of the capture")}};
  }
  for (const auto& [tag, function] : functions) {
    if (tag == moved_tag) continue;
    const QString what = Document::tr("point of M%1").arg(tag);
    const auto points = function.points();
    for (const ControlPoint& point : points.first(std::min(points.size(), kMaxPoints))) {
      times_.push_back({point.time_ns, what});
      gains_.push_back({point.gain, what});
    }
  }
  std::stable_sort(times_.begin(), times_.end(), is_earlier);
}

void Snapper::add_time(std::int64_t time_ns, const QString& what) {
  const TimeSnap added{time_ns, what};
  times_.insert(std::upper_bound(times_.begin(), times_.end(), added, is_earlier), added);
}

void Snapper::add_gain(double gain, const QString& what) { gains_.push_back({gain, what}); }

std::optional<TimeSnap> Snapper::time(std::int64_t time_ns, double reach_ns) const {
  const auto distance = [&](std::int64_t at) { return std::fabs(static_cast<double>(at - time_ns)); };
  const auto after = std::lower_bound(times_.begin(), times_.end(), TimeSnap{time_ns, {}}, is_earlier);
  std::optional<TimeSnap> nearest;
  if (after != times_.end()) nearest = *after;
  if (after != times_.begin() && (!nearest || distance((after - 1)->time_ns) < distance(nearest->time_ns)))
    nearest = *(after - 1);
  if (nearest && distance(nearest->time_ns) <= reach_ns) return nearest;
  if (timeline_ == nullptr) return std::nullopt;
  const std::int64_t edge = nearest_sample_edge(time_ns, *timeline_);
  if (distance(edge) > reach_ns) return std::nullopt;
  return TimeSnap{edge, edge_text(edge, *timeline_)};
}

std::optional<GainSnap> Snapper::gain(double gain, double reach) const {
  std::optional<GainSnap> nearest;
  for (const GainSnap& candidate : gains_) {
    const double distance = std::fabs(candidate.gain - gain);
    if (distance <= reach && (!nearest || distance < std::fabs(nearest->gain - gain))) nearest = candidate;
  }
  return nearest;
}

Drag drag_points(Points points, PointIndices chosen, std::size_t pressed_index, Snapper snapper) {
  const QString name =
      chosen.size() == 1 ? Document::tr("Move point") : Document::tr("Move %1 points").arg(chosen.size());
  return {name, [=](const HandShift& shift) {
            // A step is aligned by the point that stands for its moment.
            const ControlPoint& anchor = points[shift.alone ? pressed_index : step_anchor(points, pressed_index)];
            const ControlPoint& pressed = points[pressed_index];
            Dragged dragged;
            PointShift by{later(anchor.time_ns, shift) - anchor.time_ns, higher(pressed.gain, shift) - pressed.gain};
            dragged.time_snap = snapper.time(anchor.time_ns + by.time_ns, shift.time_reach_ns);
            if (dragged.time_snap) by.time_ns = dragged.time_snap->time_ns - anchor.time_ns;
            dragged.gain_snap = snapper.gain(pressed.gain + by.gain, shift.gain_reach);
            if (dragged.gain_snap) by.gain = dragged.gain_snap->gain - pressed.gain;
            dragged.points = moved(points, chosen, by, shift.alone ? Steps::ignored : Steps::kept);
            // A sum of differences would have other last digits.
            ControlPoint& to = dragged.points[pressed_index];
            to.gain = dragged.gain_snap ? dragged.gain_snap->gain : higher(pressed.gain, shift);
            dragged.text = point_text(to);
            return dragged;
          }};
}

Drag drag_box(Points points, PointIndices chosen, const TransformBox& box, BoxPart part, Snapper snapper) {
  if (part == BoxPart::inside)
    return drag_points(std::move(points), chosen, chosen.front(), std::move(snapper));
  const bool has_time = moves_left(part) || moves_right(part), has_gain = moves_top(part) || moves_bottom(part);
  const QString name = !has_gain   ? Document::tr("Stretch points in time")
                       : !has_time ? Document::tr("Multiply gains")
                                   : Document::tr("Stretch points in time and gain");
  const double held = moves_top(part) ? box.high() : box.low();
  return {name, [=](const HandShift& shift) {
            Dragged dragged{points, {}, {}, {}};
            if (has_time) dragged = spread_by(shift, points, chosen, moves_left(part), snapper);
            if (has_gain) amplify(dragged, shift, chosen, held, snapper);
            return dragged;
          }};
}

Drag drag_boxcar(Points points, const BoxcarHit& hit, Snapper snapper) {
  return {name_of(hit.part), [=](const HandShift& shift) {
            const GainBoxcar& boxcar = hit.boxcar;
            Dragged dragged;
            if (hit.part == BoxcarPart::gain) {
              double to = higher(boxcar.gain, shift);
              dragged.gain_snap = snapper.gain(to, shift.gain_reach);
              if (dragged.gain_snap) to = dragged.gain_snap->gain;
              dragged.text = Document::tr("gain %1").arg(short_gain(to));
              dragged.points = points;
              for (const std::size_t i : {boxcar.first, boxcar.last}) dragged.points[i].gain = to;
              return dragged;
            }
            const std::int64_t held = hit.part == BoxcarPart::end ? boxcar.end_ns : boxcar.begin_ns;
            std::int64_t by_ns = later(held, shift) - held;
            dragged.time_snap = snap(hit, snapper, by_ns, shift.time_reach_ns);
            // Nothing is added to a boxcar that stays where it is.
            dragged.points = by_ns == 0 ? points : with_boxcar_moved(points, boxcar, hit.part, by_ns);
            const std::size_t added = dragged.points.size() - points.size();
            const std::int64_t begin = dragged.points[boxcar.first + added].time_ns;
            const std::int64_t end = dragged.points[boxcar.last + added].time_ns;
            dragged.text = Document::tr("%1 to %2, %3 long")
                               .arg(exact_time_text(begin), exact_time_text(end), exact_time_text(end - begin));
            return dragged;
          }};
}

QString point_text(const ControlPoint& point) {
  return Document::tr("%1, gain %2").arg(exact_time_text(point.time_ns), short_gain(point.gain));
}

QString pointer_text(const ControlPoint& at, double ns_per_pixel) {
  const auto step = std::max<std::int64_t>(1, whole(std::pow(10.0, std::floor(std::log10(ns_per_pixel)))));
  const QString gain = QString::fromStdString(format("{:.3g}", at.gain));
  return Document::tr("%1, gain %2").arg(exact_time_text(at.time_ns / step * step), gain);
}

}  // namespace nutik::studio
