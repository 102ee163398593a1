// Exposes the resident capture again and again: what exposures before have made is not made again.
//
//   in:      exposures of one capture, one after another, each as its plan
//   out:     each band's sums, handed over to be developed
//   always:  a picture is the same to the last bit whatever was exposed before (kept_sums.hpp, last_exposure.hpp)
#pragma once

#include <functional>
#include <map>
#include <span>
#include <vector>

#include "opencl/exposer.hpp"
#include "opencl/kept_sums.hpp"
#include "opencl/last_exposure.hpp"

namespace nutik {

class IncrementalExposer {
 public:
  // What one exposure is made with.
  struct Means {
    std::function<void(const ExposedPlan& what, std::span<ExposedBand> bands, const Exposer::Develop& done)>
        expose;
    std::function<std::vector<ExposedBand>(const RenderPlan& plan)> whole_picture;  // its bands
    const DeviceInfo& info;
    cl::CommandQueue& queue;
    DeviceMemory& memory;
    RenderStatistics& statistics;
  };

  // Another capture is resident.
  void clear();

  void expose(const Means& means, const RenderPlan& plan, const CaptureSource& source, Precision precision,
              const RenderMemory& shares, std::span<ExposedBand> bands, const Exposer::Develop& develop);

 private:
  SumsInUse sums_in_use(const Means& means, const RenderPlan& plan, const CaptureSource& source,
                        Precision precision, std::uint64_t max_bytes, std::span<const std::uint8_t> exposes,
                        std::span<const ExposedBand> bands);

  std::map<Precision, KeptSums> kept_;
  LastExposure last_;
};

// Of a plan: each is exposed.
[[nodiscard]] inline std::vector<std::uint8_t> every_function(const RenderPlan& plan) {
  return std::vector<std::uint8_t>(plan.function_count(), 1);
}

}  // namespace nutik
