#include "opencl/light_curve.hpp"

#include <array>
#include <cmath>

namespace nutik {
namespace {

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

}  // namespace

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

}  // namespace nutik
