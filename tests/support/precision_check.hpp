// Holds every arithmetic that the device has to its computed bound.
//
// For tools/check_kernels, which runs tests under a simulator:
//
//   NUTIK_TEST_RENDER=fixed,codes     only this arithmetic, and only codes or light: one render in a process
//   NUTIK_TEST_PICTURES=folder        keeps the pictures of `fixed`, to be compared with another device's
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "opencl/opencl_renderer.hpp"

namespace nutik::test {

// Renders a plan's capture, as often as it is called.
using Render = std::function<Picture(Renderer& renderer, const OutputFormat& output)>;

// 8 or 16 bits with the capture's own white code.
[[nodiscard]] OutputFormat codes_like(const CaptureFormat& capture);

class PrecisionCheck {
 public:
  // Checks the first device. A device without fused products rounds twice where others round once.
  explicit PrecisionCheck(bool use_fma = true);

  [[nodiscard]] std::vector<Precision> precisions() const;
  [[nodiscard]] OpenClRenderer& of(Precision precision) { return *seen_.at(precision).renderer; }

  // The current test fails where light is further from the reference's than the bound, in double further than the
  // program promises, or where codes are further from where the reference's light lies on their scale than half a
  // code and the bound in codes. `name` is that of the pictures that are kept; `rerun` says how to do it again.
  void check(const RenderPlan& plan, const Render& render, const std::string& name, const std::string& rerun);

  // The same of the capture itself.
  void check(const RenderPlan& plan, CaptureSource& capture, const std::string& name, const std::string& rerun) {
    const auto render = [&](Renderer& renderer, const OutputFormat& output) {
      return renderer.render(plan, capture, output).picture;
    };
    check(plan, render, name, rerun);
  }

  // How much of its bound each arithmetic used, of light, and the worst difference.
  void print() const;

 private:
  struct Seen {
    std::unique_ptr<OpenClRenderer> renderer;
    double worst = 0.0;          // in S
    std::vector<double> shares;  // of the bound, each check's largest
  };

  std::map<Precision, Seen> seen_;
};

}  // namespace nutik::test
