#include "opencl/light_curve.hpp"

#include <array>
#include <cmath>

namespace nutik {
namespace {

using Polynomial = std::array<double, kCurveDegree + 1>;

// Minimax fits of degree 10 in x = c / white from the end of the toe to 1 (Remez' algorithm with 60
// digits; tools/fit_transfer.py makes them again). Largest error before rounding: 7.2e-8 and 8.4e-9.
constexpr Polynomial kSrgb{0.00083970082288569766797, 0.036004107837990895874, 0.47321679983777766077,
                           0.96609827155027350161,    -1.3644234570062845501, 2.4059220635965568642,
                           -3.4238329754194041927,    3.4792653411258808979,  -2.3247431976409470655,
                           0.90823063684303447884,    -0.15657736375068930824};
constexpr double kSrgbToeEnd = 0.04045;
constexpr double kSrgbToeSlope = 1.0 / 12.92;

constexpr Polynomial kBt709{0.0047870422614194067242, 0.10678905264339969044, 0.66304354431212352464,
                            0.44035009322603927779,   -0.55220288524403860993, 0.82928651423133046805,
                            -1.0359831587212744892,   0.94903534487198279861,  -0.58316358196749547634,
                            0.21267529002871870894,   -0.034617264045309982192};
constexpr double kBt709ToeEnd = 4.5 * 0.018053968510807;
constexpr double kBt709ToeSlope = 1.0 / 4.5;

// The same polynomial in x - centre.
Polynomial moved(const Polynomial& polynomial, double centre) {
  // Horner's scheme, once for each coefficient (Taylor shift).
  Polynomial shifted = polynomial;
  for (std::size_t done = 0; done < kCurveDegree; ++done) {
    for (std::size_t j = kCurveDegree; j-- > done;) shifted[j] += centre * shifted[j + 1];
  }
  return shifted;
}

}  // namespace

std::optional<std::vector<double>> light_curve(const Transfer& transfer, std::uint32_t white_code) {
  const bool is_srgb = transfer.kind() == Transfer::Kind::srgb;
  if (!is_srgb && transfer.kind() != Transfer::Kind::bt709) return std::nullopt;
  const double white = white_code;
  const double centre = std::floor(white / 2 + 0.5);
  const double step = std::scalbn(1.0, -(std::ilogb(white) + 1));
  const Polynomial polynomial = moved(is_srgb ? kSrgb : kBt709, centre / white);
  std::vector<double> curve{centre, step, std::floor((is_srgb ? kSrgbToeEnd : kBt709ToeEnd) * white),
                            (is_srgb ? kSrgbToeSlope : kBt709ToeSlope) / white};
  double scale = 1.0;  // (1 / (step · white))^j
  for (const double coefficient : polynomial) {
    curve.push_back(coefficient * scale);
    scale /= step * white;
  }
  return curve;
}

}  // namespace nutik
