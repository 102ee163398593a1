// Exposes pictures, one after another, with one renderer.
#pragma once

#include <future>
#include <memory>
#include <string>
#include <vector>

#include "app/command_line/options.hpp"
#include "imev/capture_source.hpp"
#include "render/plan_cache.hpp"
#include "render/renderer.hpp"

namespace nutik::app {

struct Exposed {
  RenderPlan plan;
  Picture picture;
  NegativeLight negative = NegativeLight::saturate;  // in codes
  Saturation saturation;
};

// What to tell about an exposure, whole sentences: the plan's warnings, and what codes cannot hold.
[[nodiscard]] std::vector<std::string> exposure_warnings(const Exposed& exposed);

class Exposer {
 public:
  // A device takes a while to start: it does so beside whatever the caller does next. Errors of that are
  // thrown by the first exposure.
  explicit Exposer(const Options& options);

  // Several pictures of this capture will be exposed: its blocks stay ready (Renderer::keep_resident).
  void keep_resident(const CaptureSource& source);

  // Throws InputError where mask, functions and capture do not fit or a block is damaged, DeviceError
  // where the device fails.
  [[nodiscard]] Exposed expose(CaptureSource& source, const FunctionSet& functions, const Mask& mask,
                               const PlanOptions& plan_options, const OutputFormat& format);

  // What makes the pictures, and what the last one took. After the first exposure.
  [[nodiscard]] std::string renderer_name() const { return renderer_->name(); }
  [[nodiscard]] const std::string& precision() const { return precision_; }
  [[nodiscard]] const std::string& report() const { return report_; }

 private:
  std::future<std::unique_ptr<Renderer>> starting_;
  std::unique_ptr<Renderer> renderer_;
  PlanCache plans_;
  const CaptureSource* resident_ = nullptr;
  std::string precision_, report_;
};

}  // namespace nutik::app
