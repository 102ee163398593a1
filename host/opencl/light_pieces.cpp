#include "opencl/light_pieces.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace nutik {
namespace {

using Cubic = std::array<double, 4>;

// The cubic through f at the four Chebyshev nodes of [first, last]: at most 1.3 times as far from f as the
// best one.
template <typename Function>
Cubic interpolated(double first, double last, Function f) {
  std::array<double, 4> nodes{}, differences{};
  for (int i = 0; i < 4; ++i) {
    nodes[i] = (first + last) / 2 + (last - first) / 2 * std::cos(std::numbers::pi * (2 * i + 1) / 8);
    differences[i] = f(nodes[i]);
  }
  for (int order = 1; order < 4; ++order) {  // Newton's divided differences
    for (int i = 3; i >= order; --i) {
      differences[i] = (differences[i] - differences[i - 1]) / (nodes[i] - nodes[i - order]);
    }
  }
  Cubic cubic{};
  for (int i = 3; i >= 0; --i) {  // multiplied out, from the innermost bracket
    for (int j = 3; j > 0; --j) cubic[j] = cubic[j - 1] - nodes[i] * cubic[j];
    cubic[0] = differences[i] - nodes[i] * cubic[0];
  }
  return cubic;
}

}  // namespace

std::optional<std::vector<double>> light_pieces(const Transfer& transfer, std::uint32_t white_code) {
  const std::optional<Transfer::Toe> toe = transfer.toe();
  if (!toe || white_code < 255) return std::nullopt;
  const double white = white_code;
  const double toe_end = std::floor(toe->end * white);  // its last code
  const double scale = (kLightPieces - 1) / (white - toe_end);
  std::vector<double> pieces(2 + 4 * kLightPieces);
  pieces[0] = scale;
  pieces[1] = 1.0 - (toe_end + 0.5) * scale;
  for (std::uint32_t p = 0; p < kLightPieces; ++p) {
    Cubic cubic{0.0, toe->slope / white, 0.0, 0.0};
    if (p > 0) {
      const double first = std::ceil(toe_end + 0.5 + (p - 1) / scale);
      const double last = std::floor(toe_end + 0.5 + p / scale);
      cubic = interpolated(first, last, [&](double code) { return transfer.light_of(code / white); });
    }
    for (std::uint32_t j = 0; j < 4; ++j) pieces[2 + j * kLightPieces + p] = cubic[j];
  }
  return pieces;
}

}  // namespace nutik
