#include "media/formats/colour_profile.hpp"

#include <lcms2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <new>
#include <string>
#include <string_view>

#include "capture/format.hpp"

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
    const double exponent = transfer.exponent();
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
  const cmsCIExyYTRIPLE primaries{point(0), point(1), point(2)};
  cmsToneCurve* const curves[]{curve, curve, curve};
  Profile colour(cmsCreateRGBProfile(&white, &primaries, curves));
  if (picture.shape.channels != 1 || !colour) return colour;
  // Grey is that of the profile's own space, D50, and says what it was, too.
  Profile grey(cmsCreateGrayProfile(cmsD50_xyY(), curve));
  const auto adapted = cmsSigChromaticAdaptationTag;
  if (!grey || !cmsWriteTag(grey.get(), adapted, cmsReadTag(colour.get(), adapted))) return nullptr;
  return grey;
}

void describe(cmsHPROFILE profile, const std::string& words) {
  const std::unique_ptr<cmsMLU, FreeText> text(cmsMLUalloc(nullptr, 1));
  if (!text || !cmsMLUsetASCII(text.get(), "en", "US", words.c_str()) ||
      !cmsWriteTag(profile, cmsSigProfileDescriptionTag, text.get())) {
    throw std::bad_alloc();
  }
}

std::string name_of(cmsHPROFILE profile) {
  constexpr std::size_t kMax = 60;
  std::array<char, kMax + 1> text{};
  cmsGetProfileInfoASCII(profile, cmsInfoDescription, "en", "US", text.data(), text.size());
  std::string name;
  for (const char c : std::string_view(text.data())) {
    if (c >= ' ' && c <= '~') name += c;
  }
  return name;
}

bool is_curve_of(const cmsToneCurve* curve, const Transfer& transfer) {
  constexpr int kCodes = 255;
  constexpr double kRounded = 1.0 / 65'535;  // where tables end
  for (int code = 0; code <= kCodes; ++code) {
    const double light = cmsEvalToneCurveFloat(curve, static_cast<float>(code) / kCodes);
    const double least = transfer.light_of(std::max(code - 0.5, 0.0) / kCodes);
    const double most = transfer.light_of(std::min((code + 0.5) / kCodes, 1.0));
    if (!(light >= least - kRounded && light <= most + kRounded)) return false;
  }
  return true;
}

// The power that a curve would be, in as few decimals as the format's rounding leaves.
std::optional<Transfer> power_of(const cmsToneCurve* curve) {
  const double power = std::log(cmsEvalToneCurveFloat(curve, 0.5F)) / std::log(0.5);
  if (!(power >= 0.1 && power <= 10.0)) return std::nullopt;
  constexpr double kRounding = 1e-5;  // parameters are whole 65536ths
  for (double parts = 10;; parts *= 10) {
    const double decimal = std::round(power * parts) / parts;
    if (std::abs(power - decimal) <= kRounding) return Transfer::gamma(decimal);
  }
}

// The curves are alike, as those of channels have to be.
std::optional<Transfer> transfer_of(const std::vector<const cmsToneCurve*>& curves) {
  std::vector known{Transfer::srgb(), Transfer::linear(), Transfer::bt709(), Transfer::hlg(), Transfer::pq()};
  if (const auto power = power_of(curves.front())) known.push_back(*power);
  for (const Transfer& transfer : known) {
    if (std::ranges::all_of(curves, [&](const auto* curve) { return is_curve_of(curve, transfer); }))
      return transfer;
  }
  return std::nullopt;
}

constexpr std::array kColorants{cmsSigRedColorantTag, cmsSigGreenColorantTag, cmsSigBlueColorantTag};

std::optional<Primaries> primaries_of(cmsHPROFILE profile) {
  // White of a channel that is off by that much is off by 0.45 of a code of 8 bits in sRGB.
  constexpr double kAlike = 0.002;
  for (const Primaries primaries : all_primaries()) {
    Picture sample;
    sample.shape.channels = 3;
    sample.primaries = primaries;
    const Curve curve = curve_of(Transfer::linear());
    const Profile known = curve ? profile_of(sample, curve.get()) : nullptr;
    if (!known) throw std::bad_alloc();
    const bool are_alike = std::ranges::all_of(kColorants, [&](cmsTagSignature tag) {
      const auto* a = static_cast<const cmsCIEXYZ*>(cmsReadTag(profile, tag));
      const auto* b = static_cast<const cmsCIEXYZ*>(cmsReadTag(known.get(), tag));
      return a != nullptr && b != nullptr && std::abs(a->X - b->X) < kAlike &&
             std::abs(a->Y - b->Y) < kAlike && std::abs(a->Z - b->Z) < kAlike;
    });
    if (are_alike) return primaries;
  }
  return std::nullopt;
}

}  // namespace

ProfiledColours read_colour_profile(std::span<const std::byte> bytes) {
  const Profile profile(cmsOpenProfileFromMem(bytes.data(), static_cast<cmsUInt32Number>(bytes.size())));
  if (!profile) return {"a damaged ICC profile", std::nullopt, std::nullopt};
  const std::string name = name_of(profile.get());
  ProfiledColours colours{
      name.empty() ? "an ICC profile without a name" : format("the ICC profile '{}'", name), std::nullopt,
      std::nullopt};
  const bool is_grey = cmsGetColorSpace(profile.get()) == cmsSigGrayData;
  // Tables of colours go before curves and primaries.
  if (cmsIsTag(profile.get(), cmsSigAToB0Tag) || cmsIsTag(profile.get(), cmsSigAToB1Tag)) return colours;
  if (!is_grey && cmsGetColorSpace(profile.get()) != cmsSigRgbData) return colours;
  std::vector<const cmsToneCurve*> curves;
  for (const cmsTagSignature tag : is_grey
                                       ? std::vector{cmsSigGrayTRCTag}
                                       : std::vector{cmsSigRedTRCTag, cmsSigGreenTRCTag, cmsSigBlueTRCTag}) {
    const auto* curve = static_cast<const cmsToneCurve*>(cmsReadTag(profile.get(), tag));
    if (curve == nullptr) return colours;
    curves.push_back(curve);
  }
  colours.transfer = transfer_of(curves);
  if (!is_grey) colours.primaries = primaries_of(profile.get());
  return colours;
}

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
