#include "media/colour_profile.hpp"

#include <lcms2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <new>
#include <string>

namespace nutik {
namespace {

struct FreeProfile {
  void operator()(void* profile) const { cmsCloseProfile(profile); }
};
struct FreeCurve {
  void operator()(cmsToneCurve* curve) const { cmsFreeToneCurve(curve); }
};
struct FreeText {
  void operator()(cmsMLU* text) const { cmsMLUfree(text); }
};
using Profile = std::unique_ptr<void, FreeProfile>;
using Curve = std::unique_ptr<cmsToneCurve, FreeCurve>;

// From codes to light, as shares of white.
Curve curve_of(const Transfer& transfer) {
  constexpr cmsInt32Number kPower = 1, kToeAndPower = 4;  // of ICC's parametric curves, as lcms numbers them
  if (const auto toe = transfer.toe()) {
    // Above the toe light is (a c + b)^g: told from its values at 1 and at the toe's end.
    const bool is_srgb = transfer.kind() == Transfer::Kind::srgb;
    const double g = is_srgb ? 2.4 : 1 / 0.45;
    const double root = std::pow(transfer.light_of(0.5), 1 / g);
    const double a = 2 * (1 - root);
    const std::array<double, 5> parameters{g, a, 1 - a, toe->slope, toe->end};
    return Curve(cmsBuildParametricToneCurve(nullptr, kToeAndPower, parameters.data()));
  }
  if (transfer.is_linear()) return Curve(cmsBuildGamma(nullptr, 1.0));
  if (transfer.kind() == Transfer::Kind::gamma) {
    const double exponent = std::stod(transfer.text().substr(transfer.text().find(':') + 1));
    return Curve(cmsBuildParametricToneCurve(nullptr, kPower, &exponent));
  }
  constexpr std::uint32_t kEntries = 4096;
  std::array<cmsUInt16Number, kEntries> table;
  for (std::uint32_t i = 0; i < kEntries; ++i) {
    const double light = transfer.light_of(static_cast<double>(i) / (kEntries - 1));
    table[i] = static_cast<cmsUInt16Number>(std::lround(65'535 * std::min(light, 1.0)));
  }
  return Curve(cmsBuildTabulatedToneCurve16(nullptr, kEntries, table.data()));
}

Profile profile_of(const Picture& picture, cmsToneCurve* curve) {
  const auto& xy = chromaticities(picture.primaries);
  const auto point = [&](std::size_t i) { return cmsCIExyY{xy[i][0], xy[i][1], 1.0}; };
  const cmsCIExyY white = point(3);
  if (picture.shape.channels == 1) return Profile(cmsCreateGrayProfile(&white, curve));
  const cmsCIExyYTRIPLE primaries{point(0), point(1), point(2)};
  cmsToneCurve* const curves[]{curve, curve, curve};
  return Profile(cmsCreateRGBProfile(&white, &primaries, curves));
}

void describe(cmsHPROFILE profile, const std::string& words) {
  const std::unique_ptr<cmsMLU, FreeText> text(cmsMLUalloc(nullptr, 1));
  if (!text || !cmsMLUsetASCII(text.get(), "en", "US", words.c_str()) ||
      !cmsWriteTag(profile, cmsSigProfileDescriptionTag, text.get())) {
    throw std::bad_alloc();
  }
}

}  // namespace

std::vector<std::byte> colour_profile(const Picture& picture) {
  const bool is_light = !holds_codes(picture.type);
  if (!is_light && !picture.transfer) return {};
  const Transfer transfer = is_light ? Transfer::linear() : *picture.transfer;
  const Curve curve = curve_of(transfer);
  const Profile profile = curve ? profile_of(picture, curve.get()) : nullptr;
  if (!profile) throw std::bad_alloc();
  describe(profile.get(), std::string(to_text(picture.primaries)) + ", " + transfer.text());
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile.get(), nullptr, &size);
  std::vector<std::byte> bytes(size);
  if (size == 0 || !cmsSaveProfileToMem(profile.get(), bytes.data(), &size)) throw std::bad_alloc();
  // When it was made, which would make every file another.
  constexpr std::size_t kDate = 24, kDateBytes = 12;
  std::fill_n(bytes.begin() + kDate, kDateBytes, std::byte{0});
  return bytes;
}

}  // namespace nutik
