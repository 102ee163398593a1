#include "opencl/validation.hpp"

#include <algorithm>
#include <array>
#include <chrono>

#include "capture/median.hpp"
#include "render/reference_renderer.hpp"

namespace nutik {
namespace {

constexpr OutputFormat kWholeLight{ValueType::light64, 0};

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

struct Times {
  std::vector<double> expose_ms, develop_ms, render_ms;
};

}  // namespace

double ValidatedVariant::gigabytes_per_second() const {
  return expose_ms > 0.0 ? static_cast<double>(payload_bytes) * 1e-6 / expose_ms : 0.0;
}

bool Validation::is_within_bounds() const {
  return std::ranges::all_of(variants,
                             [](const ValidatedVariant& variant) { return variant.is_within_bound(); });
}

Validation validate(const RenderPlan& plan, CaptureSource& capture, const OutputFormat& output,
                    OpenClRenderer& renderer, std::uint32_t runs,
                    const std::function<void(std::uint64_t done, std::uint64_t total)>& progress,
                    std::uint64_t memory_bytes) {
  static constexpr std::array kOfCombined{Precision::double_};
  const auto precisions =
      plan.combine == Combine::integral ? renderer.precisions() : std::span<const Precision>(kOfCombined);
  const std::uint64_t total = 1 + precisions.size() * (2 + std::uint64_t{runs});
  std::uint64_t done = 0;
  const auto step = [&] { progress(++done, total); };
  Validation validation;
  validation.output = output;

  const Clock::time_point start = Clock::now();
  RenderControl control;
  control.memory_bytes = memory_bytes;
  control.takes_wrong = true;
  const Picture expected = ReferenceRenderer().render(plan, capture, kWholeLight, control).picture;
  validation.reference_ms = milliseconds_since(start);
  step();

  const auto render = [&](Precision precision, const OutputFormat& format) {
    RenderControl with_precision = control;
    with_precision.precision = precision;
    return renderer.render(plan, capture, format, with_precision);
  };
  std::vector<Precision> trusted;
  for (const Precision precision : precisions) {
    ValidatedVariant& variant = validation.variants.emplace_back();
    variant.bound = error_bound(plan, precision, output);
    variant.light = light_errors(plan, variant.bound, expected, render(precision, kWholeLight).picture);
    step();
    const Rendered rendered = render(precision, output);
    variant.stored = stored_errors(plan, variant.bound, expected, rendered.picture);
    if (rendered.passed_self_test) trusted.push_back(precision);
    step();
  }
  const auto available = trusted.empty() ? precisions : std::span<const Precision>(trusted);
  const Precision chosen = choose_precision(plan, output, available).precision();
  validation.chosen = static_cast<std::size_t>(std::ranges::find(precisions, chosen) - precisions.begin());

  std::vector<Times> times(precisions.size());
  for (std::uint32_t run = 0; run < runs; ++run) {
    for (std::size_t i = 0; i < precisions.size(); ++i) {
      const Clock::time_point begin = Clock::now();
      const RenderStatistics took = render(precisions[i], output).statistics;
      times[i].render_ms.push_back(milliseconds_since(begin));
      times[i].expose_ms.push_back(took.expose_ms);
      times[i].develop_ms.push_back(took.develop_ms);
      validation.variants[i].payload_bytes = took.payload_bytes;
      validation.variants[i].is_timed &= took.is_timed;
      step();
    }
  }
  for (std::size_t i = 0; i < precisions.size(); ++i) {
    validation.variants[i].expose_ms = median(std::move(times[i].expose_ms));
    validation.variants[i].develop_ms = median(std::move(times[i].develop_ms));
    validation.variants[i].render_ms = median(std::move(times[i].render_ms));
  }
  return validation;
}

}  // namespace nutik
