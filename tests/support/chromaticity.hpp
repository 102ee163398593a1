// What light in some primaries is, from where these lie and nothing else.
#pragma once

#include <array>
#include <cstddef>

namespace nutik::test {

using Matrix = std::array<std::array<double, 3>, 3>;

inline double determinant(const Matrix& m) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

// Cramer's rule.
inline std::array<double, 3> solved(const Matrix& m, const std::array<double, 3>& right) {
  std::array<double, 3> result{};
  for (std::size_t column = 0; column < 3; ++column) {
    Matrix replaced = m;
    for (std::size_t row = 0; row < 3; ++row) replaced[row][column] = right[row];
    result[column] = determinant(replaced) / determinant(m);
  }
  return result;
}

// Light of red, green and blue to CIE XYZ: as much of each as makes white of equal parts. `xy` is of red, green, blue
// and white.
inline Matrix to_xyz(const std::array<std::array<double, 2>, 4>& xy) {
  const auto of = [&](std::size_t i) {
    return std::array{xy[i][0] / xy[i][1], 1.0, (1.0 - xy[i][0] - xy[i][1]) / xy[i][1]};
  };
  Matrix matrix;
  for (std::size_t row = 0; row < 3; ++row) matrix[row] = {of(0)[row], of(1)[row], of(2)[row]};
  const std::array<double, 3> amounts = solved(matrix, of(3));
  for (auto& row : matrix) {
    for (std::size_t column = 0; column < 3; ++column) row[column] *= amounts[column];
  }
  return matrix;
}

}  // namespace nutik::test
