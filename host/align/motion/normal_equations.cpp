#include "align/motion/normal_equations.hpp"

#include <algorithm>
#include <opencv2/core.hpp>
#include <tuple>

#include "system/simd_clones.hpp"

namespace nutik::motion {
namespace {

using Row = NormalEquations::Row;

NUTIK_SIMD_CLONES void add_squares(const Row& slopes, double weight, double value, std::size_t numbers,
                                   Row* __restrict squares, Row& __restrict values) {
  for (std::size_t i = 0; i < numbers; ++i) {
    double* const row = squares[i].data();
    const double weighed = weight * slopes.data()[i];
    for (std::size_t k = 0; k < std::tuple_size_v<Row>; ++k) row[k] += weighed * slopes.data()[k];
    values.data()[i] += weighed * value;
  }
}

}  // namespace

void NormalEquations::add(const Row& slopes, double weight, double value) {
  add_squares(slopes, weight, value, numbers_, squares_.data(), values_);
}

bool NormalEquations::solve(std::span<double> numbers) const {
  const auto count = static_cast<int>(numbers_);
  cv::Mat squares(count, count, CV_64F), values(count, 1, CV_64F), solved;
  for (std::size_t i = 0; i < numbers_; ++i) {
    std::copy_n(squares_[i].data(), numbers_, squares.ptr<double>(static_cast<int>(i)));
  }
  std::copy_n(values_.data(), numbers_, values.ptr<double>());
  if (!cv::solve(squares, values, solved, cv::DECOMP_CHOLESKY)) return false;
  std::copy_n(solved.ptr<double>(), numbers_, numbers.data());
  return true;
}

}  // namespace nutik::motion
