#include "solve/gain_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/compensated_sum.hpp"
#include "system/interruption.hpp"

namespace nutik {
namespace {

using Kind = LightWish::Kind;

constexpr int kMaxSteps = 60;
// Other places to begin at, where the first led to more cost than that.
constexpr int kOtherBegins = 15;
constexpr double kMinCost = 1e-12;
// A step that changes no gain by more than this share of it is none.
constexpr double kMinStep = 1e-15;
// Nor is one that lessens the cost by a smaller share.
constexpr double kMinGain = 1e-12;
// How far gains are changed to see what that changes in a divisor, as a share.
constexpr double kProbe = 1e-4;
// A gain this much smaller than the largest is what rounding left of 0.
constexpr double kNoGain = 1e-12;
// In place of a gain that is 0 on its way, whose time counts as if it were not.
constexpr double kNearlyZero = 1e-30;

bool is_inequality(Kind kind) { return kind == Kind::at_most || kind == Kind::at_least; }
bool compares_channels(Kind kind) { return kind == Kind::like || kind == Kind::gone; }

// The middle of the bounds; where one is missing 1, or -1, or what is nearest to that.
double begin_within(const Bounds& bounds) {
  if (std::isfinite(bounds.low) && std::isfinite(bounds.high)) return std::midpoint(bounds.low, bounds.high);
  return bounds.high <= 0.0 ? std::min(-1.0, bounds.high) : std::clamp(1.0, bounds.low, bounds.high);
}

// Another place within the bounds, for each share from 0 to 1; where a bound is missing about where it begins.
double place_within(const Bounds& bounds, double share) {
  const double begin = begin_within(bounds), reach = std::max(1.0, std::fabs(begin));
  return std::lerp(std::isfinite(bounds.low) ? bounds.low : begin - reach,
                   std::isfinite(bounds.high) ? bounds.high : begin + reach, share);
}

std::vector<ControlPoint> with_gains(const std::vector<TemplatePoint>& points, const auto& gain_of) {
  std::vector<ControlPoint> control;
  control.reserve(points.size());
  for (const TemplatePoint& point : points)
    control.push_back({point.time_ns, point.gain_name ? gain_of(*point.gain_name) : point.gain});
  return control;
}

}  // namespace

GainSearch::GainSearch(WishedExposure exposure) : exposure_(std::move(exposure)) {
  for (const LightWish& wish : exposure_.wishes)
    row_kinds_.insert(row_kinds_.end(), compares_channels(wish.kind) ? exposure_.channels : 1, wish.kind);
}

std::optional<GainSearch::Parts> GainSearch::parts_of(const std::vector<TemplatePoint>& function,
                                                      std::uint8_t tag,
                                                      const std::vector<std::int64_t>& times_ns) const {
  const auto timed = FunctionTemplate::points(function, times_ns);
  if (!timed) return std::nullopt;
  Parts parts;
  parts.points = function;
  parts.is_timeless = true;
  for (std::size_t i = 0; i < function.size(); ++i) {
    parts.is_timeless &= !function[i].time_name;
    parts.points[i].time_ns = (*timed)[i].time_ns;
  }
  for (std::size_t part = 0; part <= exposure_.bounds.size(); ++part) {
    std::vector<ControlPoint> points = *timed;
    for (std::size_t i = 0; part > 0 && i < points.size(); ++i)
      points[i].gain = function[i].gain_name == part - 1 ? 1.0 : 0.0;
    const std::vector<GainPiece> pieces = GainFunction(std::move(points)).pieces(exposure_.duration_ns);
    CompensatedSum still;
    for (const GainPiece& piece : pieces)
      still.add(static_cast<double>(piece.end_ns - piece.begin_ns) * (piece.begin_gain + piece.end_gain) / 2);
    parts.still_ns.push_back(still.value());
    for (std::size_t region = 0; region < exposure_.regions.size(); ++region) {
      const auto& courses = exposure_.regions[region].courses;
      if (const auto course = courses.find(tag); course != courses.end())
        parts.light_ns[region].push_back(course->second.integral_ns(pieces));
    }
  }
  return parts;
}

double GainSearch::scale_of(std::uint8_t tag, const std::vector<double>& gains) const {
  const auto gain_of = [&](std::size_t name) {
    return gains[name] == 0.0 && !is_zero_[name] ? kNearlyZero : gains[name];
  };
  const GainSummary summary =
      summarize(GainFunction(with_gains(parts_.at(tag).points, gain_of)), exposure_.duration_ns);
  if (summary.support_ns == 0) return 0.0;
  const std::string name = format("M{}", tag);
  return exposure_.gain * exposure_.normalization.factor_of(summary, name) / static_cast<double>(summary.support_ns);
}

GainSearch::Light GainSearch::light_of(const std::vector<double>& gains) const {
  Light light;
  std::vector<std::array<CompensatedSum, 3>> sums(exposure_.regions.size());
  for (const auto& [tag, parts] : parts_) {
    const double scale = scale_of(tag, gains);
    double still_ns = parts.still_ns[0];
    for (std::size_t i = 0; i < gains.size(); ++i) still_ns += gains[i] * parts.still_ns[i + 1];
    light.still[tag] = scale * still_ns;
    for (const auto& [region, light_ns] : parts.light_ns) {
      for (std::size_t channel = 0; channel < 3; ++channel) {
        sums[region][channel].add(scale * light_ns[0][channel]);
        for (std::size_t i = 0; i < gains.size(); ++i)
          sums[region][channel].add(scale * gains[i] * light_ns[i + 1][channel]);
      }
    }
  }
  for (const auto& sum : sums) light.regions.push_back({sum[0].value(), sum[1].value(), sum[2].value()});
  return light;
}

// By the rule for products: of integrals, and of what they are multiplied with. X is a straight function of a gain, but
// where the gain's sign counts, so that its difference is its derivative.
GainSearch::Light GainSearch::change_of(const std::vector<double>& gains, std::size_t gain) const {
  Light change;
  change.regions.resize(exposure_.regions.size());
  const double by = kProbe * std::max(1.0, std::fabs(gains[gain]));
  std::vector<double> more = gains, less = gains;
  more[gain] += by;
  less[gain] -= by;
  for (const auto& [tag, parts] : parts_) {
    const double scale = scale_of(tag, gains), above = scale_of(tag, more), below = scale_of(tag, less);
    const bool is_scaled = scale != 0.0 && above != 0.0 && below != 0.0 && above != below;
    const double scale_change =
        is_scaled ? -scale * scale * (1 / above - 1 / below) / (more[gain] - less[gain]) : 0.0;
    const auto changed = [&](const auto& part) {
      double whole = part(0);
      for (std::size_t i = 0; i < gains.size(); ++i) whole += gains[i] * part(i + 1);
      return scale * part(gain + 1) + scale_change * whole;
    };
    const Parts& of = parts;
    change.still[tag] = changed([&](std::size_t part) { return of.still_ns[part]; });
    for (const auto& [region, light_ns] : parts.light_ns) {
      const std::vector<ChannelLight>& integrals = light_ns;
      for (std::size_t channel = 0; channel < 3; ++channel)
        change.regions[region][channel] +=
            changed([&](std::size_t part) { return integrals[part][channel]; });
    }
  }
  return change;
}

std::vector<WishedLight> GainSearch::wished(const Light& light, bool is_change) const {
  const auto brightness = [&](const ChannelLight& of) {
    return of[0] * exposure_.luminance[0] + of[1] * exposure_.luminance[1] + of[2] * exposure_.luminance[2];
  };
  std::vector<WishedLight> wished;
  for (const LightWish& wish : exposure_.wishes) {
    ChannelLight wanted{};
    const auto* number = std::get_if<double>(&wish.target);
    if (wish.kind == Kind::gone) {
      for (const auto& [tag, still] : wish.still) {
        for (std::size_t channel = 0; channel < 3; ++channel)
          wanted[channel] += light.still.at(tag) * still[channel];
      }
    } else if (const auto* region = std::get_if<std::size_t>(&wish.target)) {
      wanted = light.regions[*region];
    } else if (!is_change && number == nullptr) {
      wanted = std::get<ChannelLight>(wish.target);
    }
    ChannelLight reached = light.regions[wish.region];
    if (!compares_channels(wish.kind)) {
      wanted = {number == nullptr ? brightness(wanted) : is_change ? 0.0 : *number};
      reached = {brightness(reached)};
    }
    for (double& each : wanted) each *= wish.factor;
    wished.push_back({wanted, reached});
  }
  return wished;
}

std::vector<WishedLight> GainSearch::wished(const std::vector<ChannelLight>& region_light) const {
  return wished({region_light, light_of(gains_).still}, false);
}

std::vector<double> GainSearch::missed(const LightWish& wish, const WishedLight& light) const {
  std::vector<double> missed;
  for (std::size_t channel = 0; channel < (compares_channels(wish.kind) ? exposure_.channels : 1);
       ++channel) {
    const double difference = light.reached[channel] - light.wanted[channel];
    if (wish.kind == Kind::at_most) {
      missed.push_back(std::max(difference, 0.0));
    } else {
      missed.push_back(wish.kind == Kind::at_least ? std::min(difference, 0.0) : difference);
    }
  }
  return missed;
}

std::vector<double> GainSearch::differences(const std::vector<WishedLight>& wished) const {
  std::vector<double> differences;
  for (std::size_t i = 0; i < wished.size(); ++i) {
    const LightWish& wish = exposure_.wishes[i];
    for (std::size_t channel = 0; channel < (compares_channels(wish.kind) ? exposure_.channels : 1);
         ++channel)
      differences.push_back(std::sqrt(wish.weight) *
                            (wished[i].reached[channel] - wished[i].wanted[channel]));
  }
  return differences;
}

std::vector<double> GainSearch::differences(const std::vector<double>& gains) const {
  return differences(wished(light_of(gains), false));
}

double GainSearch::cost_of(const std::vector<double>& differences) const {
  CompensatedSum cost;
  for (std::size_t row = 0; row < differences.size(); ++row) {
    const bool is_kept = (row_kinds_[row] == Kind::at_most && differences[row] < 0) ||
                         (row_kinds_[row] == Kind::at_least && differences[row] > 0);
    if (!is_kept) cost.add(differences[row] * differences[row]);
  }
  return cost.value();
}

double GainSearch::cost_at(const std::vector<double>& gains) const {
  try {
    return cost_of(differences(gains));
  } catch (const InputError&) {
    return std::numeric_limits<double>::infinity();
  }
}

std::vector<LeastSquaresRow> GainSearch::changes(const std::vector<double>& gains) const {
  std::vector<LeastSquaresRow> rows;
  for (const double difference : differences(gains)) rows.push_back({{}, difference});
  for (std::size_t i = 0; i < gains.size(); ++i) {
    const std::vector<double> changes = differences(wished(change_of(gains, i), true));
    for (std::size_t row = 0; row < rows.size(); ++row) rows[row].factors.push_back(changes[row]);
  }
  return rows;
}

// The gains that would be best if light were a straight function of them as it is here. What a wish of "at most" and
// "at least" leaves is one more number that may be anything from 0 on.
std::vector<double> GainSearch::stepped() const {
  std::vector<LeastSquaresRow> rows = changes(gains_);
  std::vector<Bounds> bounds = bounds_;
  std::vector<double> begin = gains_;
  std::vector<std::size_t> rests(rows.size(), 0);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (!is_inequality(row_kinds_[row])) continue;
    rests[row] = bounds.size();
    const double rest = row_kinds_[row] == Kind::at_most ? -rows[row].wanted : rows[row].wanted;
    bounds.push_back({0.0, std::numeric_limits<double>::infinity()});
    begin.push_back(std::max(rest, 0.0));
  }
  for (std::size_t row = 0; row < rows.size(); ++row) {
    LeastSquaresRow& each = rows[row];
    double wanted = -each.wanted;
    for (std::size_t i = 0; i < gains_.size(); ++i) wanted += each.factors[i] * gains_[i];
    each.wanted = wanted;
    each.factors.resize(bounds.size(), 0.0);
    if (rests[row] > 0) each.factors[rests[row]] = row_kinds_[row] == Kind::at_most ? 1.0 : -1.0;
  }
  std::vector<double> found = least_squares(rows, bounds, std::move(begin));
  found.resize(gains_.size());
  return found;
}

void GainSearch::descend() {
  if (gains_.empty()) return;
  double cost = cost_at(gains_);
  for (int step = 0; step < kMaxSteps && cost > 0.0; ++step) {
    check_interruption();
    std::vector<double> towards;
    try {
      towards = stepped();
    } catch (const InputError&) {  // a function whose parts cancel right beside it
      return;
    }
    bool is_better = false, is_far = false;
    for (double share = 1.0; share > 1e-6 && !is_better; share /= 2) {
      std::vector<double> next = gains_;
      for (std::size_t i = 0; i < next.size(); ++i) {
        next[i] = share == 1.0 ? towards[i] : next[i] + share * (towards[i] - next[i]);
        is_far |= std::fabs(next[i] - gains_[i]) > kMinStep * std::fabs(next[i]);
      }
      if (!is_far) break;
      const double reached = cost_at(next);
      if (reached >= cost) continue;
      is_better = reached < cost * (1 - kMinGain);
      cost = reached;
      gains_ = std::move(next);
      if (!is_better) return;
    }
    if (!is_better) return;
  }
}

// A divisor that depends on gains bends light, so that a descent may end in a hollow that is not the lowest: others
// begin at places unlike the first, each gain's spread evenly over its bounds, every other time between -1 and 1, where
// most are found however wide their bounds are.
void GainSearch::descend_from_several() {
  descend();
  double least = cost_at(gains_);
  std::vector<double> best = gains_;
  for (int begin = 1; begin <= kOtherBegins && least > kMinCost; ++begin) {
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
      const double turn = begin * std::sqrt(static_cast<double>((i + 1) * (i + 2)));  // irrational
      const auto& [low, high] = bounds_[i];
      const Bounds usual{std::clamp(-1.0, low, high), std::clamp(1.0, low, high)};
      gains_[i] = place_within(begin % 2 == 0 ? usual : bounds_[i], turn - std::floor(turn));
    }
    if (!std::isfinite(cost_at(gains_))) continue;
    descend();
    const double cost = cost_at(gains_);
    if (cost >= least) continue;
    least = cost;
    best = gains_;
  }
  gains_ = std::move(best);
}

// What rounding left of 0 becomes 0.
void GainSearch::drop_rests() {
  double largest = 0.0;
  for (const double gain : gains_) largest = std::max(largest, std::fabs(gain));
  for (std::size_t i = 0; i < gains_.size(); ++i) {
    const bool may_be_zero = bounds_[i].low <= 0.0 && bounds_[i].high >= 0.0;
    if (may_be_zero && std::fabs(gains_[i]) <= kNoGain * largest) gains_[i] = 0.0;
  }
}

// Up to here the time of every gain counts. At 0 it leaves the support, and all light jumps: one gain after another
// stays at 0, the one with which the others find the least cost, as long as that lessens it; a gain that came to 0
// does where it costs no more.
void GainSearch::choose_zeros() {
  double least = cost_at(gains_);
  for (bool is_better = true; is_better;) {
    is_better = false;
    auto best = std::tuple(gains_, bounds_, is_zero_);
    const auto from = best;
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
      std::tie(gains_, bounds_, is_zero_) = from;
      const bool came_to_zero = gains_[i] == 0.0;
      if (is_zero_[i] || bounds_[i].low > 0.0 || bounds_[i].high < 0.0) continue;
      if (!came_to_zero && least <= kMinCost) continue;
      gains_[i] = 0.0;
      bounds_[i] = {0.0, 0.0};
      is_zero_[i] = true;
      descend();
      drop_rests();
      const double cost = cost_at(gains_);
      if (came_to_zero ? cost > least + kMinCost : cost >= least - kMinCost) continue;
      is_better = true;
      least = cost;
      best = std::tuple(gains_, bounds_, is_zero_);
    }
    std::tie(gains_, bounds_, is_zero_) = std::move(best);
  }
}

std::optional<FoundGains> GainSearch::find(const std::vector<std::int64_t>& times_ns) {
  for (const auto& [tag, function] : exposure_.functions) {
    const auto known = parts_.find(tag);
    if (known != parts_.end() && known->second.is_timeless) continue;
    auto parts = parts_of(function, tag, times_ns);
    if (!parts) return std::nullopt;
    parts_.insert_or_assign(tag, std::move(*parts));
  }
  bounds_ = exposure_.bounds;
  is_zero_.clear();
  gains_.clear();
  for (const Bounds& bounds : bounds_) {
    is_zero_.push_back(bounds.low == 0.0 && bounds.high == 0.0);
    gains_.push_back(begin_within(bounds));
  }
  const bool is_support = exposure_.normalization == Normalization();
  exposure_.normalization.depends_on_gains() ? descend_from_several() : descend();
  drop_rests();
  if (is_support) choose_zeros();
  FoundGains found{gains_, cost_of(differences(gains_))};
  for (std::size_t i = 0; i < gains_.size() && is_support; ++i) {
    const Bounds& bounds = exposure_.bounds[i];
    if (gains_[i] == 0.0 && !is_zero_[i])
      found.gains[i] = bounds.high > 0.0 ? std::min(kLeastGain, bounds.high) : std::max(-kLeastGain, bounds.low);
  }
  return found;
}

}  // namespace nutik
