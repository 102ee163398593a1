#include "opencl/light_source.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

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

// Transfer functions as a straight toe and a polynomial: how kernels in single precision turn codes
// into light without a table (kernels/light.clh). Looking each code up costs a CPU twice as much.

// light(c) = c <= toe_end ? c · toe_slope : Σ a_j t^j, t = (c - centre) · step
//
// centre is whole and step a power of two, so that t is exact in single precision. Light then errs
// by less than 3.3e-7 for every white code up to 65535, and by less than 1.7e-7 where white has
// the form 2^b - 1, b = 8 … 16 (derivation and measurement: docs/explanation/accuracy.md).
inline constexpr std::uint32_t kCurveDegree = 10;

using Polynomial = std::array<double, kCurveDegree + 1>;

// Minimax fits of degree 10 in x = c / white from the end of the toe to 1 (Remez' algorithm with 60
// digits; tools/fit_transfer.py makes them again). They err by at most 7.2e-8 and 8.4e-9.
constexpr Polynomial kSrgb{0.00083970080532169184063, 0.036004108747578095881, 0.47321678551749025182,
                           0.96609837775844266078,    -1.3644238981174655601,  2.4059231732797312689,
                           -3.4238347155638276552,    3.4792670279961795842,   -2.3247441575788362265,
                           0.90823091802064095267,    -0.15657739306993932715};

constexpr Polynomial kBt709{0.004787042272076680537, 0.10678905227010020537,  0.66304354963742362726,
                            0.44035005235203389876,  -0.55220269652046736743, 0.82928595970930972498,
                            -1.0359820974193341046,  0.94903402756748175577,  -0.58316256063528465787,
                            0.21267484109144665375,  -0.034617178727986897332};

// The same polynomial in x - centre.
Polynomial moved(const Polynomial& polynomial, double centre) {
  // Horner's scheme, once for each coefficient (Taylor shift).
  Polynomial shifted = polynomial;
  for (std::size_t done = 0; done < kCurveDegree; ++done) {
    for (std::size_t j = kCurveDegree; j-- > done;) shifted[j] += centre * shifted[j + 1];
  }
  return shifted;
}

// The curve as the kernel reads it: centre, step, toe_end, toe_slope, a_0 … a_10. Nothing where the
// transfer function has no such form: pure powers have no toe, no polynomial follows them to 0.
std::optional<std::vector<double>> light_curve(const Transfer& transfer, std::uint32_t white_code) {
  const std::optional<Transfer::Toe> toe = transfer.toe();
  if (!toe) return std::nullopt;
  const double white = white_code;
  const double centre = std::floor(white / 2 + 0.5);
  const double step = std::scalbn(1.0, -(std::ilogb(white) + 1));
  const Polynomial polynomial =
      moved(transfer.kind() == Transfer::Kind::srgb ? kSrgb : kBt709, centre / white);
  std::vector<double> curve{centre, step, std::floor(toe->end * white), toe->slope / white};
  double scale = 1.0;  // (1 / (step · white))^j
  for (const double coefficient : polynomial) {
    curve.push_back(coefficient * scale);
    scale /= step * white;
  }
  return curve;
}

// light(c) = a_0[p] + a_1[p] c + a_2[p] c² + a_3[p] c³,   p = ⌊scale · c + offset⌋
//
// Piece 0 is the toe; the others cut the rest into equal parts, half way between codes. As the kernel reads
// it: scale, offset, then a_0[16], a_1[16], a_2[16], a_3[16]. Light errs by less than 2.7e-7, measured
// 1.3e-7 (docs/explanation/accuracy.md).
// Nothing where the function has no straight toe, or where the white code is below 255.
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

// Light of 256 codes by pieces, with the kernel's roundings where it fuses products: rows that look it up have the same
// floats as those that are computed, so that a picture does not depend on who can look up.
std::vector<double> light_of_bytes(const std::vector<double>& pieces) {
  std::vector<double> light(256);
  for (std::size_t code = 0; code < light.size(); ++code) {
    const auto c = static_cast<float>(code);
    const auto rounded = [&](std::size_t at) { return static_cast<float>(pieces[at]); };
    const auto piece = static_cast<std::size_t>(std::fma(c, rounded(0), rounded(1)));
    float value = rounded(2 + 3 * kLightPieces + piece);
    for (std::size_t j = 3; j-- > 0;) value = std::fma(value, c, rounded(2 + j * kLightPieces + piece));
    light[code] = value;
  }
  return light;
}

}  // namespace

LightSource light_source(const CaptureFormat& capture, Precision precision, const LightLookup& means) {
  if (capture.transfer.is_linear()) return {"NUTIK_LIGHT_LINEAR", {}};
  const bool is_near = means.has_near_table && capture.code_bytes == 1;
  const bool looks_up_bytes = means.looks_up_bytes && precision == Precision::single_ && capture.code_bytes == 1;
  if (precision == Precision::single_ && !is_near) {
    if (means.permutes_pieces) {
      if (auto pieces = light_pieces(capture.transfer, capture.white_code)) {
        std::vector<double> bytewise = looks_up_bytes ? light_of_bytes(*pieces) : std::vector<double>();
        return {"NUTIK_LIGHT_PIECES", std::move(*pieces), std::move(bytewise)};
      }
    }
    if (auto curve = light_curve(capture.transfer, capture.white_code)) {
      return {"NUTIK_LIGHT_CURVE", std::move(*curve)};
    }
  }
  std::vector<double> table = capture.transfer.light_of_all_codes(capture.white_code, capture.code_bytes);
  return {"NUTIK_LIGHT_TABLE", table, looks_up_bytes ? table : std::vector<double>()};
}

}  // namespace nutik
