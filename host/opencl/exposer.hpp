// Exposes a picture: the sums of its bands, with kernels/expose.cl, or what kernels/combine.cl makes of them.
//
//   in:      a plan, the capture it was made for, the bands of its picture
//   out:     each band's sums, handed over to be developed
//   always:  a picture is the same however it is cut (allocation_cuts.hpp). Where all blocks stay on the device until
//            the exposure ends, one band is exposed and developed after another, so that only its own sums are there:
//            those of a large picture that changes little take more than its blocks. Else all bands are exposed chunk
//            by chunk, for chunks come once
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "opencl/block_feed.hpp"
#include "opencl/developer.hpp"
#include "opencl/gain_columns.hpp"
#include "opencl/kept_sums.hpp"
#include "opencl/render_memory.hpp"
#include "render/render_plan.hpp"

namespace nutik {

// What exposures on a device have in common.
struct ExposingDevice {
  const DeviceInfo& info;
  cl::CommandQueue& queue;
  BlockFeed& feed;
  bool last_block_first;  // OpenClOptions
};

// A kernel that goes over blocks, with what it reads beside them.
struct BlockKernel {
  std::vector<TableSlice> slices;
  std::function<SliceTables(const TableSlice& slice)> tables = {};
  // Over entries of a chunk, into the sums of a band.
  std::function<cl::Event(const cl::Buffer& chunk, const cl::Buffer& entries, const SliceTables& tables,
                          const ExposedBand& exposed, const ExposeLaunch& launch)>
      launch = {};
};

// What is exposed: of a plan the pixels of some functions (of others the bands have the sums), and what need not be
// read.
struct ExposedPlan {
  const RenderPlan& plan;
  SumsInUse kept;
  std::vector<std::uint8_t> exposes;  // by function
};

class Exposer {
 public:
  // The plan has blocks. It, the capture, memory and statistics must live as long.
  Exposer(const ExposingDevice& device, const Work& work, const ExposedPlan& what, CaptureSource& source,
          const RenderMemory& shares, BlockKernel kernel, DeviceMemory& memory, RenderStatistics& statistics)
      : device_(device),
        work_(work),
        plan_(what.plan),
        source_(source),
        shares_(shares),
        kept_(what.kept),
        kernel_(std::move(kernel)),
        memory_(memory),
        statistics_(statistics) {}

  // Calls develop(band) for each, once, from top to bottom, while its sums are there. Throws InputError for a damaged
  // block, DeviceError, Cancelled.
  using Develop = std::function<void(const ExposedBand& exposed)>;
  void expose(std::span<ExposedBand> bands, const RenderControl& control, const Develop& develop);

 private:
  // Whether all of the plan's blocks are in `fetched_` now, to stay.
  bool fetch_all();
  void sum_up(std::span<const ExposedBand> bands, const RenderControl& control);
  void launch(const cl::Buffer& payload, std::span<const BlockEntry> entries, const SliceTables& tables,
              std::span<const ExposedBand> bands, const RenderControl& control, bool is_first);
  // Planned blocks [first, last) that are read.
  [[nodiscard]] std::size_t read_blocks(std::size_t first, std::size_t last) const;
  // Those of a slice whose blocks are not behind planned block `last`, from `next` on.
  void add_kept(const TableSlice& slice, std::size_t last, std::size_t& next, std::vector<BlockEntry>& entries) const;
  void add_correction(const TableSlice& slice, std::size_t planned, std::vector<BlockEntry>& entries) const;
  BlockFeed::Chunk next_chunk();

  ExposingDevice device_;
  Work work_;
  const RenderPlan& plan_;
  CaptureSource& source_;
  RenderMemory shares_;
  SumsInUse kept_;
  BlockKernel kernel_;
  DeviceMemory& memory_;
  RenderStatistics& statistics_;
  std::size_t read_ = 0, to_read_ = 0;     // blocks, each as often as bands are exposed
  std::vector<BlockFeed::Chunk> fetched_;  // the plan's first ones, ahead of any launch
};

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

// Exposes the resident capture again and again: what exposures before have made is not made again.
//
//   in:      exposures of one capture, one after another, each as its plan
//   out:     each band's sums, handed over to be developed
//   always:  a picture is the same to the last bit whatever was exposed before (kept_sums.hpp, LastExposure)
class IncrementalExposer {
 public:
  // What one exposure is made with.
  struct Means {
    std::function<void(const ExposedPlan& what, std::span<ExposedBand> bands, const Exposer::Develop& done)> expose;
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
  SumsInUse sums_in_use(const Means& means, const RenderPlan& plan, const CaptureSource& source, Precision precision,
                        std::uint64_t max_bytes, std::span<const std::uint8_t> exposes,
                        std::span<const ExposedBand> bands);

  std::map<Precision, KeptSums> kept_;
  LastExposure last_;
};

// All of a plan's functions are exposed.
[[nodiscard]] inline std::vector<std::uint8_t> every_function(const RenderPlan& plan) {
  return std::vector<std::uint8_t>(plan.function_count(), 1);
}

}  // namespace nutik
