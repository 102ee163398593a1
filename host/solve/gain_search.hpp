// The gains that come nearest to wishes about light, for gain functions whose times are known.
//
//   in:      functions with names in place of gains, courses of light of regions, wishes
//   out:     the gains within bounds with the least Σ weight · miss²; a gain that no wish depends on keeps its first
//            value
//   always:  where the divisor does not depend on the gains, light is linear in them: one bounded least squares.
//            Another divisor (∫g) is followed step by step (Gauss and Newton)
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <variant>
#include <vector>

#include "exposure/function_template.hpp"
#include "exposure/normalization.hpp"
#include "solve/bounded_least_squares.hpp"
#include "solve/region_light.hpp"

namespace nutik {

struct LightWish {
  enum class Kind {
    equal,     // brightness
    at_most,   // brightness
    at_least,  // brightness
    like,      // every channel
    gone  // every channel: what moves adds nothing, so it is like the still light under the same functions
  };
  // A brightness; light that rests; or another region, by its number.
  using Target = std::variant<double, ChannelLight, std::size_t>;

  std::size_t region = 0;
  Kind kind = Kind::equal;
  double factor = 1.0;  // of the target
  Target target = 1.0;
  // For `gone`: the still light, by the mask value of the function that exposes it.
  std::map<std::uint8_t, ChannelLight> still = {};
  double weight = 1.0;
};

struct WishedExposure {
  std::int64_t duration_ns = 0;
  std::map<std::uint8_t, std::vector<TemplatePoint>> functions;  // that regions are exposed with
  Normalization normalization;
  double gain = 1.0;  // that light is multiplied with
  std::vector<RegionLight> regions;
  std::vector<LightWish> wishes;
  std::vector<Bounds> bounds;  // of gains
  ChannelLight luminance{};    // how much of brightness each channel is; adds up to 1
  std::uint32_t channels = 1;
};

// What a gain next to 0 is given, whose time in the support is better counted than left out.
inline constexpr double kLeastGain = 1e-12;

struct FoundGains {
  std::vector<double> gains;
  double cost = 0.0;  // Σ weight · missed²
};

// The light that a wish wants and the light that its region has; wishes about brightness use the first channel alone.
struct WishedLight {
  ChannelLight wanted{}, reached{};
};

class GainSearch {
 public:
  explicit GainSearch(WishedExposure exposure);

  // Nothing if a function's times are out of order. Throws InputError if a function cannot be normalized from any
  // beginning within the bounds.
  [[nodiscard]] std::optional<FoundGains> find(const std::vector<std::int64_t>& times_ns);

  // The gains of the last find() that no wish depends on, and how many of the others the wishes leave open, because
  // there are fewer wishes than gains. None, either, where a function can hardly be normalized with them.
  [[nodiscard]] std::vector<std::size_t> untold() const;
  [[nodiscard]] std::size_t open_count() const;

  // What each wish asks for and gets with them, where regions have such light.
  [[nodiscard]] std::vector<WishedLight> wished(const std::vector<ChannelLight>& region_light) const;
  // The light of regions as find() computes it.
  [[nodiscard]] std::vector<ChannelLight> region_light() const { return light_of(gains_).regions; }

  [[nodiscard]] const WishedExposure& exposure() const { return exposure_; }
  // By how much a wish is missed, by channel or in brightness, signed; 0 if it is kept.
  [[nodiscard]] std::vector<double> missed(const LightWish& wish, const WishedLight& light) const;

 private:
  // Integrals of a function's parts: of its known gains, then of each named gain as if it were 1.
  struct Parts {
    std::vector<TemplatePoint> points;  // with their times
    bool is_timeless = false;           // none of them is named
    std::vector<double> still_ns;
    std::map<std::size_t, std::vector<ChannelLight>> light_ns;  // by region
  };

  [[nodiscard]] std::optional<Parts> parts_of(const std::vector<TemplatePoint>& function, std::uint8_t tag,
                                              const std::vector<std::int64_t>& times_ns) const;
  // What gains come to, or how that changes with one of them.
  struct Light {
    std::vector<ChannelLight> regions;
    std::map<std::uint8_t, double> still;  // what each function makes of light that rests
  };

  // What a function's integrals are multiplied with: gain / X.
  [[nodiscard]] double scale_of(std::uint8_t tag, const std::vector<double>& gains) const;
  [[nodiscard]] Light light_of(const std::vector<double>& gains) const;
  [[nodiscard]] Light change_of(const std::vector<double>& gains, std::size_t gain) const;
  // What wishes want and have in this light; for a change of light, how both change.
  [[nodiscard]] std::vector<WishedLight> wished(const Light& light, bool is_change) const;
  // The misses of all wishes, kept ones included, row by row, times the roots of their weights.
  [[nodiscard]] std::vector<double> differences(const std::vector<WishedLight>& wished) const;
  [[nodiscard]] std::vector<double> differences(const std::vector<double>& gains) const;
  [[nodiscard]] double cost_of(const std::vector<double>& differences) const;
  // Infinite where a function cannot be normalized with such gains.
  [[nodiscard]] double cost_at(const std::vector<double>& gains) const;
  // How differences change with the gains.
  [[nodiscard]] std::vector<LeastSquaresRow> changes(const std::vector<double>& gains) const;
  // The same for the gains that were found; none if a function cannot be normalized right beside them.
  [[nodiscard]] std::vector<LeastSquaresRow> changes_of_found() const;
  void descend_from_several();
  void descend();
  void drop_rests();
  void choose_zeros();
  [[nodiscard]] std::vector<double> stepped() const;

  WishedExposure exposure_;
  std::vector<LightWish::Kind> row_kinds_;  // of differences
  std::map<std::uint8_t, Parts> parts_;
  std::vector<Bounds> bounds_;
  std::vector<bool> is_zero_;  // gains that stay at 0, and so count in no support
  std::vector<double> gains_;
};

}  // namespace nutik
