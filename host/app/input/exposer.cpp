#include "app/input/exposer.hpp"

#include "app/input/renderer_choice.hpp"

namespace nutik::app {

Exposer::Exposer(const Options& options)
    : starting_(std::async(std::launch::async, [&options] { return choose_renderer(options); })) {}

Exposed Exposer::expose(CaptureSource& source, const FunctionSet& functions, const Mask& mask,
                        const PlanOptions& plan_options, const OutputFormat& format) {
  RenderPlan plan = make_plan(source, functions, mask, plan_options);
  if (!renderer_) {
    // Kernels are loaded beside the first block.
    auto ready = std::async(std::launch::async, [&] {
      auto renderer = starting_.get();
      renderer->prepare(plan, format);
      return renderer;
    });
    if (!plan.blocks.empty()) source.preload(plan.blocks.front().block);
    renderer_ = ready.get();
  }
  Picture picture = renderer_->render(plan, source, format);
  return {std::move(plan), std::move(picture)};
}

}  // namespace nutik::app
