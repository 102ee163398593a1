// Exposes the resident capture again and again: what exposures before have made is not made again.
//
//   in:      exposures of one capture, one after another, each as its plan
//   out:     each band's sums, handed over to be developed
//   always:  a picture is the same to the last bit whatever was exposed before (kept_sums.hpp, LastExposure)
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "opencl/developer.hpp"
#include "opencl/device_tables.hpp"
#include "opencl/exposer.hpp"
#include "opencl/kept_sums.hpp"
#include "render/render_plan.hpp"

namespace nutik {

// The sums of the last exposure of the resident capture: where one function of several is changed, only its pixels are
// exposed again.
//
//   in:      exposures, one after another
//   out:     of each the functions whose pixels have to be exposed
//   always:  a picture is the same to the last bit, whether the sums of its other pixels were made for it or before

class LastExposure {
 public:
  void clear() { held_.clear(); }

  // By function, whether it has to be exposed; bands get the sums of all others. Nothing is held from here on, until
  // hold() was called for every band and complete().
  [[nodiscard]] std::vector<std::uint8_t> take(const RenderPlan& plan, Precision precision,
                                               std::span<ExposedBand> bands);
  void hold(const ExposedBand& exposed) { made_.push_back({exposed.band, exposed.map.map, exposed.sums}); }
  void complete(const RenderPlan& plan, Precision precision);

 private:
  struct Held {
    Band band;
    std::shared_ptr<const MaskMap> map;
    cl::Buffer sums;
  };

  std::vector<Held> held_;
  std::vector<Held> made_;  // of the exposure that runs
  std::vector<TableColumnSource> functions_;
  Precision precision_ = Precision::single_;
  std::optional<Transfer> transfer_;
};

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
