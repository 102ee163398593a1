#include "support/kernel_builds.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "capture/format.hpp"
#include "support/rendering.hpp"

namespace nutik::test {
namespace {

constexpr LightKind kLights[] = {LightKind::linear, LightKind::curve, LightKind::pieces, LightKind::table,
                                LightKind::near_table};
constexpr std::uint32_t kLanes[] = {1, 4, 8, 16};
constexpr std::uint32_t kItemPixels[] = {1, 4, 8, 16, 64};
constexpr std::uint32_t kItemTiles[] = {1, 3, 16};
constexpr std::uint32_t kCodeBytes[] = {1, 2};
constexpr std::uint32_t kChannels[] = {1, 3};
constexpr bool kFuses[] = {true, false};
const OutputFormat kOutputs[] = {{ValueType::code8, 255},
                                 {ValueType::code16, 65'535},
                                 {ValueType::code8, 255, NegativeLight::saturate, Transfer::bt709()},
                                 {ValueType::code16, 65'535, NegativeLight::saturate, Transfer::linear()},
                                 {ValueType::light32, 0},
                                 {ValueType::light64, 0},
                                 {ValueType::code8, 255, NegativeLight::offset},
                                 {ValueType::code16, 4095, NegativeLight::absolute}};

constexpr Exclusion kExclusions[] = {
    {"an item's pixels are whole vectors",
     [](const KernelBuild& build) { return build.item_pixels % build.lanes != 0; }},
    {"an item of more than 8 vectors suits no device, and its unrolled loops take a compiler half a minute",
     [](const KernelBuild& build) { return build.item_pixels / build.lanes > 8; }},
    {"curves and pieces are made for floats: other arithmetics look light up",
     [](const KernelBuild& build) {
       return build.precision != Precision::single_ &&
              (build.light == LightKind::curve || build.light == LightKind::pieces);
     }},
    {"16 pieces are permuted in 16 lanes",
     [](const KernelBuild& build) { return build.light == LightKind::pieces && build.lanes != 16; }},
    {"tables beside a group have 256 codes", [](const KernelBuild& build) {
       return build.light == LightKind::near_table && build.code_bytes != 1;
     }},
    {"whole numbers have no fused product: the host always says that there is none",
     [](const KernelBuild& build) { return build.precision == Precision::fixed && build.fuses; }},
};

const char* name_of(LightKind light) {
  switch (light) {
    case LightKind::linear: return "linear";
    case LightKind::curve: return "curve";
    case LightKind::pieces: return "pieces";
    case LightKind::table: return "table";
    case LightKind::near_table: return "near";
  }
  return "";
}

const char* name_of(const OutputFormat& output) {
  if (output.negative == NegativeLight::offset) return "offset8";
  if (output.negative == NegativeLight::absolute) return "absolute12";
  if (output.transfer) return output.type == ValueType::code8 ? "shown8" : "shown16";
  switch (output.type) {
    case ValueType::code8: return "code8";
    case ValueType::code16: return "code16";
    case ValueType::light32: return "light32";
    case ValueType::light64: return "light64";
  }
  return "";
}

// Which value of each parameter a build has, numbered over all parameters.
class ValueNumbers {
 public:
  explicit ValueNumbers(const std::vector<KernelBuild>& builds) {
    std::set<std::string> seen;
    for (const KernelBuild& build : builds) {
      for (const std::string& value : values_of(build)) seen.insert(value);
    }
    names_.assign(seen.begin(), seen.end());
  }
  [[nodiscard]] std::size_t count() const { return names_.size(); }
  [[nodiscard]] std::vector<std::size_t> of(const KernelBuild& build) const {
    std::vector<std::size_t> numbers;
    for (const std::string& value : values_of(build)) {
      numbers.push_back(static_cast<std::size_t>(std::ranges::lower_bound(names_, value) - names_.begin()));
    }
    return numbers;
  }

 private:
  std::vector<std::string> names_;
};

// The shape of a device's own work (work_shape.hpp): a GPU's, and a CPU's in this precision.
bool has_own_shape(const KernelBuild& build, Precision precision, bool is_gpu) {
  const bool is_of_floats = precision == Precision::single_ || precision == Precision::compensated;
  const std::array wanted = is_gpu ? std::array{4u, 4u, 1u} : std::array{is_of_floats ? 16u : 8u, 64u, 16u};
  return build.precision == precision &&
         wanted == std::array{build.lanes, build.item_pixels, build.item_tiles};
}

}  // namespace

std::string KernelBuild::name() const {
  return format("{}-{}-{}x{}x{}-{}byte-{}channel-{}-{}", to_text(precision), name_of(light), lanes,
                item_pixels, item_tiles, code_bytes, channels, fuses ? "fused" : "unfused", name_of(output));
}

Transfer KernelBuild::transfer() const {
  switch (light) {
    case LightKind::linear: return Transfer::linear();
    case LightKind::curve: return Transfer::srgb();
    case LightKind::pieces: return Transfer::bt709();
    case LightKind::table:
    case LightKind::near_table: break;
  }
  return Transfer::gamma(2.2);
}

OpenClOptions KernelBuild::options() const {
  OpenClOptions options = renderer_options(precision);
  options.item_pixels = item_pixels;
  options.item_tiles = item_tiles;
  options.lanes = lanes;
  options.group_items = lanes <= 4 ? 64 : 1;
  options.rows_at_once = lanes == 4 ? 4 : 1;
  options.table_copies = light == LightKind::near_table ? 8 : 0;
  options.use_fma = fuses;
  options.permutes_pieces = light == LightKind::pieces;
  return options;
}

std::span<const Exclusion> kernel_build_exclusions() { return kExclusions; }

std::vector<KernelBuild> all_combinations() {
  std::vector<KernelBuild> builds;
  for (const Precision precision : kPrecisions) {
    for (const std::uint32_t lanes : kLanes) {
      for (const std::uint32_t item_pixels : kItemPixels) {
        for (const std::uint32_t item_tiles : kItemTiles) {
          for (const bool fuses : kFuses) {
            for (const LightKind light : kLights) {
              for (const std::uint32_t code_bytes : kCodeBytes) {
                for (const std::uint32_t channels : kChannels) {
                  for (const OutputFormat& output : kOutputs) {
                    builds.push_back({precision, light, lanes, item_pixels, item_tiles, code_bytes, channels,
                                      fuses, output});
                  }
                }
              }
            }
          }
        }
      }
    }
  }
  return builds;
}

std::vector<KernelBuild> possible_builds() {
  std::vector<KernelBuild> builds = all_combinations();
  std::erase_if(builds, [](const KernelBuild& build) {
    return std::ranges::any_of(kExclusions, [&](const Exclusion& each) { return each.applies(build); });
  });
  return builds;
}

// Greedy: the next one is always the build in which most pairs meet that have not met yet.
std::vector<KernelBuild> pairwise(const std::vector<KernelBuild>& builds) {
  const ValueNumbers numbers(builds);
  std::vector<bool> is_open(numbers.count() * numbers.count());
  std::vector<std::vector<std::size_t>> values;
  const auto for_each_pair = [&](std::size_t build, auto visit) {
    for (const std::size_t a : values[build]) {
      for (const std::size_t b : values[build]) {
        if (a < b) visit(a * numbers.count() + b);
      }
    }
  };
  for (std::size_t i = 0; i < builds.size(); ++i) {
    values.push_back(numbers.of(builds[i]));
    for_each_pair(i, [&](std::size_t pair) { is_open[pair] = true; });
  }

  std::vector<KernelBuild> few;
  // Takes the best of those that are wanted, if it is worth anything.
  const auto take = [&](auto is_wanted) {
    std::size_t best = 0, most = 0;
    for (std::size_t i = 0; i < builds.size(); ++i) {
      if (!is_wanted(builds[i])) continue;
      std::size_t open = 0;
      for_each_pair(i, [&](std::size_t pair) { open += is_open[pair]; });
      if (open > most) std::tie(best, most) = std::pair(i, open);
    }
    if (most == 0) return false;
    for_each_pair(best, [&](std::size_t pair) { is_open[pair] = false; });
    few.push_back(builds[best]);
    return true;
  };
  for (const Precision precision : kPrecisions) {
    for (const bool is_gpu : {true, false}) {
      take([&](const KernelBuild& build) { return has_own_shape(build, precision, is_gpu); });
    }
  }
  while (take([](const KernelBuild&) { return true; })) {
  }
  return few;
}

std::vector<std::string> values_of(const KernelBuild& build) {
  return {to_text(build.precision),
          format("light {}", name_of(build.light)),
          format("{} lanes", build.lanes),
          format("{} pixels", build.item_pixels),
          format("{} tiles", build.item_tiles),
          format("{} bytes", build.code_bytes),
          format("{} channels", build.channels),
          build.fuses ? "fused" : "unfused",
          format("output {}", name_of(build.output))};
}

}  // namespace nutik::test
