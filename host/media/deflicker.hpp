// A clip whose camera corrected its exposure or its white balance while it filmed, as if it had not.
//
//   in:      a clip
//   out:     the same pictures, with codes as the same things have in the first one
//   always:  within a channel equal codes of a picture stay equal, and greater ones do not become smaller; a picture
//            that may have been exposed as the first one, but for noise, keeps its codes
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "media/clip.hpp"

namespace nutik {

// What it says of itself among a clip's facts.
inline constexpr std::string_view kDeflickered = "exposed as its first picture";

// How far codes of one picture lie from those of another for the same things: by codes, linear between knots.
class CodeShift {
 public:
  // Between pairs of codes of the same places. Of those that are neither black nor white in both less than half may
  // show other things: none where more do, and no shift where nearly all are black or white. Codes are shares of white.
  static std::optional<CodeShift> between(std::span<const double> codes, std::span<const double> wanted);

  [[nodiscard]] double at(double code) const;
  // The greatest difference of two that more than a fiftieth of `codes` has, which are not empty. Where no codes are, a
  // shift is only carried on from others, and may be anything.
  [[nodiscard]] double distance_to(const CodeShift& other, std::span<const double> codes) const;

 private:
  static constexpr std::size_t kKnots = 17;

  std::array<double, kKnots> shifts_{};
};

// Whether differences whose signs are chance may add up to so much, up or down, more often than once in so many trials:
// by Chernoff's bound, whatever sizes they have. Fewer than 1 + log2(trials) of them always may.
[[nodiscard]] bool may_be_chance(std::span<const double> differences, double trials);

// Its remarks say how many pictures were corrected, and how far.
[[nodiscard]] std::unique_ptr<Clip> deflicker(std::unique_ptr<Clip> clip);

}  // namespace nutik
