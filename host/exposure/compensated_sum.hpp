// A running sum whose error does not grow with the number of terms (Neumaier's variant of Kahan's
// summation: the sum of the rounding errors is carried beside the sum).
#pragma once

#include <cmath>

namespace nutik {

class CompensatedSum {
 public:
  void add(double term) {
    const double sum = sum_ + term;
    correction_ += std::fabs(sum_) >= std::fabs(term) ? (sum_ - sum) + term : (term - sum) + sum_;
    sum_ = sum;
  }
  [[nodiscard]] double value() const { return sum_ + correction_; }

 private:
  double sum_ = 0.0;
  double correction_ = 0.0;
};

}  // namespace nutik
