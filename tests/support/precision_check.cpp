#include "support/precision_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "render/reference_renderer.hpp"
#include "support/bound_share.hpp"
#include "support/rendering.hpp"
#include "support/stills.hpp"

namespace nutik::test {
namespace {

// What NUTIK_TEST_RENDER leaves to be rendered.
bool is_wanted(const std::string& name) {
  const char* wanted = std::getenv("NUTIK_TEST_RENDER");
  return wanted == nullptr || ("," + std::string(wanted) + ",").find("," + name + ",") != std::string::npos;
}

void keep(const Picture& picture, const std::string& name) {
  const char* folder = std::getenv("NUTIK_TEST_PICTURES");
  if (folder == nullptr) return;
  std::ofstream file(std::filesystem::path(folder) / name, std::ios::binary);
  file.write(reinterpret_cast<const char*>(picture.bytes.data()),
             static_cast<std::streamsize>(picture.bytes.size()));
  ASSERT_TRUE(file.good()) << name << " cannot be written to " << folder;
}

}  // namespace

OutputFormat codes_like(const CaptureFormat& capture) {
  return {capture.code_bytes == 1 ? ValueType::code8 : ValueType::code16, capture.white_code};
}

PrecisionCheck::PrecisionCheck(bool use_fma) {
  for (const Precision precision : first_precisions()) {
    if (!is_wanted(to_text(precision))) continue;
    OpenClOptions options = renderer_options(precision);
    options.use_fma = use_fma;
    seen_[precision].renderer = std::make_unique<OpenClRenderer>(options);
  }
}

std::vector<Precision> PrecisionCheck::precisions() const {
  std::vector<Precision> precisions;
  for (const auto& [precision, seen] : seen_) precisions.push_back(precision);
  return precisions;
}

void PrecisionCheck::check(const RenderPlan& plan, const Render& render, const std::string& name,
                           const std::string& rerun) {
  ReferenceRenderer reference;
  const Picture expected = render(reference, {ValueType::light64, 0});
  for (auto& [precision, seen] : seen_) {
    SCOPED_TRACE(name + " in " + to_text(precision) + "; rerun: " + rerun);
    if (is_wanted("light")) {
      const Picture light = render(*seen.renderer, {ValueType::light64, 0});
      const Difference share = share_of_bound(plan, precision, light, expected);
      EXPECT_LE(share.worst, 1.0) << "of the bound, at value " << share.value << ": "
                                  << light.values<double>()[share.value] << " and "
                                  << expected.values<double>()[share.value];
      const Difference difference = difference_of(plan, light, expected);
      // Beside gains that are not normal numbers the last place is more than that.
      const bool is_normal = scale_of(plan, difference.value) > 0x1p-900;
      if (precision == Precision::double_ && is_normal) {
        EXPECT_LE(difference.worst, kDoubleAgainstReference);
      }
      seen.worst = std::max(seen.worst, difference.worst);
      seen.shares.push_back(share.worst);
      if (precision == Precision::fixed) keep(light, name + ".light");
    }
    if (is_wanted("codes")) {
      const OutputFormat output = codes_like(plan.capture);
      const Picture codes = render(*seen.renderer, output);
      const Difference steps =
          share_of_bound(plan, error_bound(plan, precision, output), output, codes, expected);
      EXPECT_LE(steps.worst, 1.0) << "of the bound, at value " << steps.value << ": code "
                                  << code_of(codes, steps.value) << " for light "
                                  << expected.values<double>()[steps.value];
      if (precision == Precision::fixed) keep(codes, name + ".codes");
    }
  }
}

void PrecisionCheck::print() const {
  for (const auto& [precision, seen] : seen_) {
    if (seen.shares.empty()) continue;  // a test that looked in its own way
    print_shares(to_text(precision).c_str(), seen.shares);
    std::printf("%-32s worst difference %.3g of ∫|g|/D\n", "", seen.worst);
  }
}

}  // namespace nutik::test
