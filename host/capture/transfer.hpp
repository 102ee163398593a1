// The transfer function: how a stored code stands for light.
//
// Both sides are fractions in [0, 1]: a code divided by its white code, and light relative to the most that a code
// stands for. Integration is always done in light.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "capture/log_curve.hpp"

namespace nutik {

class Transfer {
 public:
  enum class Kind { srgb, bt709, linear, gamma, hlg, pq, log };

  static Transfer srgb() { return Transfer(Kind::srgb, 1.0); }      // IEC 61966-2-1
  static Transfer bt709() { return Transfer(Kind::bt709, 1.0); }    // ITU-R BT.709, BT.2020's constants
  static Transfer linear() { return Transfer(Kind::linear, 1.0); }  // light = code / white code
  static Transfer gamma(double exponent);                           // light = fraction ^ exponent
  // ITU-R BT.2100: the scene's light of hybrid log-gamma, by its OETF; the display's light of the perceptual
  // quantizer, by its EOTF, where light 1 is 10 000 cd/m².
  static Transfer hlg() { return Transfer(Kind::hlg, 1.0); }
  static Transfer pq() { return Transfer(Kind::pq, 1.0); }

  // A camera's curve by its name (capture/log_curve.hpp). Light is a share of what its largest code stands for. Codes
  // up to black have next to no light (at most 2^-30), each more than the one below, so that all codes can be told
  // apart.
  static Transfer log(std::string_view name);

  // What codes stand for that were taken for `held` and are said to be `stated`: of the same curve they keep their
  // scale.
  static Transfer restated(const Transfer& held, const Transfer& stated) {
    return held == stated.scaled_from_video() ? held : stated;
  }

  // `srgb`, `bt709`, `linear`, `gamma:2.2` (0.1 … 10), `hlg`, `pq` or a camera's curve, `slog3`; `slog3:video` is of
  // codes between black and white of video of limited range. Throws UsageError listing these.
  static Transfer parse(std::string_view text);
  [[nodiscard]] std::string text() const;

  [[nodiscard]] Kind kind() const { return kind_; }
  [[nodiscard]] bool is_linear() const { return kind_ == Kind::linear; }
  [[nodiscard]] double exponent() const { return exponent_; }  // of gamma
  // That a camera's curve is stored with; none for other functions.
  [[nodiscard]] std::optional<Primaries> usual_primaries() const;
  // The function of codes that were scaled from video of limited range: a curve that counts whole codes becomes
  // `…:video`.
  [[nodiscard]] Transfer scaled_from_video() const;

  // Light of a code fraction, and back. Inverse of each other to a few ulp; increasing.
  [[nodiscard]] double light_of(double fraction) const;
  [[nodiscard]] double fraction_of(double light) const;

  // The light that a screen shows as white: 1, or below it where codes also stand for what is brighter than white
  // (ITU-R BT.2408: 75 % of HLG, 203 cd/m² of PQ; reflectance 1 of cameras' curves).
  [[nodiscard]] double reference_white() const;

  // Light of every code 0 … white_code.
  [[nodiscard]] std::vector<double> light_of_codes(std::uint32_t white_code) const;
  // The same for every code that `code_bytes` bytes can hold, those above white as light 1: for codes out of
  // files, which may be damaged and must not lead past a table.
  [[nodiscard]] std::vector<double> light_of_all_codes(std::uint32_t white_code,
                                                       std::uint32_t code_bytes) const;

  // Element c is the least light that rounds to code c, half up in code: light_of((c - 1/2) / white).
  // Element 0 is 0.
  [[nodiscard]] std::vector<double> code_thresholds(std::uint32_t white_code) const;

  // The straight part at the dark end, for functions that have one: light = slope · fraction up to `end`.
  struct Toe {
    double end;
    double slope;
  };
  [[nodiscard]] std::optional<Toe> toe() const;

  // Curves by their names: each module has a table of its own.
  friend bool operator==(const Transfer& a, const Transfer& b) {
    return a.kind_ == b.kind_ && a.exponent_ == b.exponent_ && a.is_of_video_ == b.is_of_video_ &&
           (a.curve_ == b.curve_ || (a.curve_ != nullptr && b.curve_ != nullptr && a.curve_->name == b.curve_->name));
  }

 private:
  constexpr Transfer(Kind kind, double exponent) : kind_(kind), exponent_(exponent) {}

  [[nodiscard]] double log_light(double fraction) const;
  [[nodiscard]] double log_fraction(double light) const;
  // What a curve's formula has for a code.
  [[nodiscard]] double signal_of(double fraction) const;
  [[nodiscard]] double fraction_of_signal(double signal) const;

  Kind kind_;
  double exponent_;
  const LogCurve* curve_ = nullptr;
  bool is_of_video_ = false;
};

}  // namespace nutik
