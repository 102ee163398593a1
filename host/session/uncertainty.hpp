// What a picture's light may be off by, term by term (docs/explanation/uncertainty.md).
//
//   in:      an exposure: its bound, its format, what its capture is known to be
//   out:     a list, from which text, JSON and Python's dictionaries are written
//   always:  of the pixel that may be off furthest. Bounds hold for every pixel and may be added up; what is no bound is told
//            beside them
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "capture/made_samples.hpp"
#include "render/error_bound.hpp"

namespace nutik {

struct ExposedPicture;

// What a capture is known to be off by before anything is exposed.
struct CaptureErrors {
  double rounded_light = 0.0;  // between light and the code that it was rounded to: scaled or floating-point pictures
  double held_light = 0.0;   // between what a sample had and what is held of it: its tolerance, its noise's sigmas
  double noise_light = 0.0;  // a sample's standard deviation where it is largest; 0: not known
  std::optional<double> alignment_pixels = std::nullopt;
  std::optional<MadeSamples> made = std::nullopt;

  // `is_rounded`: its codes are light that was rounded.
  [[nodiscard]] static CaptureErrors of(const CaptureFormat& capture, bool is_rounded);
};

struct UncertaintyTerm {
  enum class Is { bound, deviation, count };

  std::string_view name;  // as scripts know it
  Is is = Is::bound;
  std::optional<PictureError> error = std::nullopt;
  std::vector<std::pair<std::string_view, double>> figures = {};  // what is no light, with the unit in the name
  std::string text = {};

  // By the names that JSON and Python have: `term`, `is`, `light`, and `codes` or `float_steps`, figures.
  using Field = std::pair<std::string_view, std::variant<std::string_view, double>>;
  [[nodiscard]] std::vector<Field> fields(const OutputFormat& output) const;
};

struct Uncertainty {
  double scale = 0.0;  // S: the largest ∫|g| / D of a function; of light that is combined the largest gain
  std::vector<UncertaintyTerm> terms;
  UncertaintyTerm bounds;  // all of them, added up

  [[nodiscard]] static Uncertainty of(const ExposedPicture& exposed, const CaptureErrors& capture);
  // A line for each term.
  [[nodiscard]] std::vector<std::string> lines(const OutputFormat& output) const;
};

}  // namespace nutik
