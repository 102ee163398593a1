#include "studio/time/sample_series.hpp"

#include <algorithm>

#include "session/requests/moments.hpp"

namespace nutik::studio {

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

}  // namespace nutik::studio
