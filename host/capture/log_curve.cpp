#include "capture/log_curve.hpp"

#include <cmath>
#include <numbers>

namespace nutik {
namespace {

constexpr double kCodes = 1023;  // of 10 bits, in which makers print their values
constexpr double kLog10Of2 = std::numbers::ln2 / std::numbers::ln10;

// Signal of a share of video's white, which has the codes 64 … 940.
constexpr double of_video(double share) { return (64 + 876 * share) / kCodes; }

constexpr LogCurve kCurves[] = {
    // Sony, "S-Log2 Technical Paper" (2012): of light 155 / 219 / 0.9, whose unit is a white of 90 %.
    {"slog2", Primaries::sgamut3, true, 155 / (219 * 0.9), 0.037584, 0.432699 * 876 / kCodes,
     of_video(0.646596), of_video(0.030001222851889303), 5 * 155 / (219 * 0.9) * 876 / kCodes,
     of_video(0.030001222851889303)},
    // Sony, "Technical Summary for S-Gamut3.Cine/S-Log3 and S-Gamut3/S-Log3".
    {"slog3", Primaries::sgamut3_cine, true, 1 / 0.19, 0.01 / 0.19, 261.5 / kCodes, 420 / kCodes,
     171.2102946929 / kCodes, (171.2102946929 - 95) / 0.01125 / kCodes, 95 / kCodes},
    // Panasonic, "VARICAM V-Log/V-Gamut" (2014).
    {"vlog", Primaries::vgamut, true, 1, 0.00873, 0.241514, 0.598206, 0.181, 5.6, 0.125},
    // Canon, "Input Transform Version 202007" for Canon Log 2 and 3: of light / 0.9.
    {"clog2", Primaries::cinema_gamut, true, 87.099375 / 0.9, 1, 0.24136077, 0.092864125, 0.092864125,
     87.099375 / 0.9 * 0.24136077 / std::numbers::ln10, 0.092864125},
    {"clog3", Primaries::cinema_gamut, true, 14.98325 / 0.9, 1, 0.36726845, 0.12240537, 0.15277891,
     1.9754798 / 0.9, 0.12512219},
    // ARRI, "ALEXA Log C Curve: Usage in VFX" (2012): SUP 3.x, EI 800, of linear scene exposure.
    {"logc3", Primaries::arri_wg3, false, 5.555556, 0.052272, 0.247190, 0.385537, 0.149658, 5.367655,
     0.092809},
    // ARRI, "LogC4 Logarithmic Color Space Specification" (2022), which counts in powers of 2; its toe is below black.
    {"logc4", Primaries::arri_wg4, false, ((1 << 18) - 16) / 117.45 / 64, 1, 928 / kCodes / 14 / kLog10Of2,
     95 / kCodes, 95 / kCodes, ((1 << 18) - 16) / 117.45 / 64 * 928 / kCodes / 14 / std::numbers::ln2,
     95 / kCodes},
    // Fujifilm, "F-Log Data Sheet Ver. 1.1" and "F-Log2 Data Sheet Ver. 1.0" (2022).
    {"flog", Primaries::bt2020, true, 0.555556, 0.009468, 0.344676, 0.790453, 0.100537775223865, 8.735631,
     0.092864},
    {"flog2", Primaries::bt2020, true, 5.555556, 0.064829, 0.245281, 0.384316, 0.100686685370811, 8.799461,
     0.092864},
    // Nikon, "N-Log Specification Document 1.0.0" (2018). Its pieces overlap up to code 452 by a seventh of a code;
    // they are joined where they meet, so that light increases with codes.
    {"nlog", Primaries::bt2020, true, 1, 0, 150 * std::numbers::ln10 / kCodes, 619 / kCodes,
     446.54444744390275 / kCodes, 650 / kCodes, -0.0075, LogCurve::Toe::cube_root},
    // DJI, "White Paper on D-Log and D-Gamut of DJI Cinema Color System" (2017), of signals without codes.
    {"dlog", Primaries::dgamut, false, 0.9892, 0.0108, 0.256663, 0.584555, 0.14, 6.025, 0.0929},
    // Apple, "Apple Log Profile White Paper" (2023): 47.28711236 (light + 0.05641088)² up to light 0.01. Apple Log 2 is
    // the same curve with Apple Wide Gamut.
    {"applelog", Primaries::bt2020, false, 1, 0.00964052, 0.08550479 / kLog10Of2, 0.69336945,
     47.28711236 * 0.06641088 * 0.06641088, 47.28711236, -0.05641088, LogCurve::Toe::square_root},
    // Academy, S-2016-001 "ACEScct", which counts in powers of 2.
    {"acescct", Primaries::ap1, false, 1, 0, 1 / 17.52 / kLog10Of2, 9.72 / 17.52, 0.155251141552511,
     10.5402377416545, 0.0729055341958355},
};

}  // namespace

double LogCurve::light_of(double signal) const {
  if (signal >= toe_end) return (std::pow(10.0, (signal - base) / scale) - offset) / gain;
  switch (toe) {
    case Toe::straight: return (signal - toe_base) / toe_gain;
    case Toe::square_root: return std::sqrt(signal / toe_gain) + toe_base;
    case Toe::cube_root: return std::pow(signal / toe_gain, 3) + toe_base;
  }
  return signal;
}

double LogCurve::signal_of(double light) const {
  if (light >= light_of(toe_end)) return scale * std::log10(gain * light + offset) + base;
  switch (toe) {
    case Toe::straight: return toe_gain * light + toe_base;
    case Toe::square_root: return toe_gain * (light - toe_base) * (light - toe_base);
    case Toe::cube_root: return toe_gain * std::cbrt(light - toe_base);
  }
  return light;
}

std::span<const LogCurve> log_curves() { return kCurves; }

}  // namespace nutik
