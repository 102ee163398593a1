// Weighted least squares of a few numbers: what is added up for them, and their solution.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace nutik::motion {

class NormalEquations {
 public:
  static constexpr std::size_t kMaxNumbers = 10;
  // As many as fill vectors: those beyond the numbers are zero.
  using Row = std::array<double, 12>;

  explicit NormalEquations(std::size_t numbers) : numbers_(numbers) {}

  // That the numbers, each times the slope of the same place, add up to `value`.
  void add(const Row& slopes, double weight, double value);

  // False where nothing tells some of the numbers.
  [[nodiscard]] bool solve(std::span<double> numbers) const;

 private:
  std::size_t numbers_;
  std::array<Row, kMaxNumbers> squares_{};
  Row values_{};
};

}  // namespace nutik::motion
