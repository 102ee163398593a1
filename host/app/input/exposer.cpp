#include "app/input/exposer.hpp"

#include "app/input/renderer_choice.hpp"
#include "app/requests/source_words.hpp"
#include "capture/format.hpp"
#include "render/rendering_report.hpp"

namespace nutik::app {

std::vector<std::string> exposure_warnings(const Exposed& exposed) {
  std::vector<std::string> warnings = exposed.plan.warnings;
  if (!holds_codes(exposed.picture.type) || exposed.negative != NegativeLight::saturate) return warnings;
  // Light below 0 is black in a picture of codes: a still scene under a negative still gain disappears.
  for (const PlannedFunction& function : exposed.plan.functions) {
    const double still_gain = function.summary.still_gain();
    if (still_gain >= 0.0) continue;
    warnings.push_back(
        format("M{}: the still gain is {:.6g}: whatever does not move comes out black; --negative "
               "offset shows light below 0, a .pfm or a .tif with --depth float keeps it",
               function.tag, still_gain));
  }
  return warnings;
}

Exposer::Exposer(const Options& options)
    : starting_(std::async(std::launch::async, [&options] { return choose_renderer(options); })),
      plans_(memory_budget(options).table_bytes()) {}

void Exposer::keep_resident(const CaptureSource& source) {
  resident_ = &source;
  if (renderer_) renderer_->keep_resident(resident_);
}

Exposed Exposer::expose(CaptureSource& source, const FunctionSet& functions, const Mask& mask,
                        const PlanOptions& plan_options, const OutputFormat& format) {
  RenderPlan plan = plans_.plan(source, functions, mask, plan_options);
  if (!renderer_) {
    // Kernels are loaded beside the first block. Where that fails the device is there for the next exposure.
    auto ready = std::async(std::launch::async, [&] {
      renderer_ = starting_.get();
      renderer_->keep_resident(resident_);
      renderer_->prepare(plan, format);
    });
    if (!plan.blocks.empty()) source.preload(plan.blocks.front().block);
    ready.get();
  }
  Rendered rendered = renderer_->render(plan, source, format);
  plan.warnings.insert(plan.warnings.end(), rendered.warnings.begin(), rendered.warnings.end());
  precision_ = to_text(rendered.precision);
  report_ = rendering_report(rendered, format);
  return {std::move(plan), std::move(rendered.picture), format.negative, rendered.saturation};
}

}  // namespace nutik::app
