// The sums of the last exposure of the resident capture: where one function of several is changed, only its pixels are
// exposed again.
//
//   in:      exposures, one after another
//   out:     of each the functions whose pixels have to be exposed
//   always:  a picture is the same to the last bit, whether the sums of its other pixels were made for it or before
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "opencl/developer.hpp"
#include "opencl/device_tables.hpp"
#include "render/render_plan.hpp"

namespace nutik {

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

}  // namespace nutik
