// A number for each sample, seen from far: the least and the most of many samples at once, however many there are.
#pragma once

#include <QPolygonF>
#include <QRectF>
#include <cstddef>
#include <span>
#include <vector>

#include "capture/timeline.hpp"
#include "studio/time/time_axis.hpp"

namespace nutik::studio {

class Series {
 public:
  struct Range {
    double low = 0.0, high = 0.0;
  };

  Series() = default;
  explicit Series(std::vector<double> values);

  [[nodiscard]] std::span<const double> values() const { return values_; }
  [[nodiscard]] bool empty() const { return values_.empty(); }
  // The range of values [first, last), at least one.
  [[nodiscard]] Range over(std::size_t first, std::size_t last) const;

 private:
  static constexpr std::size_t kTogether = 256;

  std::vector<double> values_;
  std::vector<Range> coarse_;  // of kTogether values each
};

// For each pixel column of a widget what the series has there: from its highest value to its lowest. Columns without
// a sample are left out.
struct SeriesColumn {
  int x = 0;
  Series::Range range;
};
[[nodiscard]] std::vector<SeriesColumn> columns_of(const Series& series, const Timeline& timeline,
                                                   const TimeAxis& axis, int width);

// The series as an area from the bottom of `box`, whose top is `most`.
[[nodiscard]] QPolygonF area_of(const std::vector<SeriesColumn>& columns, const QRectF& box, double most);

}  // namespace nutik::studio
