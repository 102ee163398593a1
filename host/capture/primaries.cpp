#include "capture/primaries.hpp"

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik {
namespace {

struct Known {
  std::string_view text;
  std::array<std::array<double, 2>, 4> chromaticities;
  ColourMatrix to_bt709;  // from the chromaticities in exact fractions, each entry rounded once
};

constexpr std::array<double, 2> kD65{0.3127, 0.3290};

// In the order of Primaries.
constexpr std::array<Known, 3> kKnown{{
    {"bt709", {{{0.640, 0.330}, {0.300, 0.600}, {0.150, 0.060}, kD65}}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}},
    {"bt2020",
     {{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, kD65}},
     {{{1.6604910021084345, -0.5876411387885495, -0.07284986331988488},
       {-0.12455047452159074, 1.1328998971259603, -0.008349422604369477},
       {-0.018150763354905303, -0.10057889800800739, 1.1187296613629127}}}},
    {"p3",
     {{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, kD65}},
     {{{1.2249401762805598, -0.22494017628055996, 0.0},
       {-0.04205695470968816, 1.042056954709688, 0.0},
       {-0.019637554590334432, -0.07863604555063189, 1.0982736001409663}}}},
}};

const Known& known(Primaries primaries) { return kKnown[static_cast<std::size_t>(primaries)]; }

}  // namespace

std::string_view to_text(Primaries primaries) { return known(primaries).text; }

Primaries parse_primaries(std::string_view text) {
  for (std::size_t i = 0; i < kKnown.size(); ++i) {
    if (text == kKnown[i].text) return static_cast<Primaries>(i);
  }
  throw UsageError(format("primaries '{}' are not known; choose bt709, bt2020 or p3", text));
}

const std::array<std::array<double, 2>, 4>& chromaticities(Primaries primaries) {
  return known(primaries).chromaticities;
}

const ColourMatrix& to_bt709(Primaries primaries) { return known(primaries).to_bt709; }

}  // namespace nutik
