// Exposes a picture: the sums of its bands, with kernels/expose.cl.
//
//   in:      a plan, the capture it was made for, the bands of its picture
//   out:     each band's sums, handed over to be developed
//   always:  a picture is the same however it is cut (allocation_cuts.hpp). Where all blocks stay on the device until
//            the exposure ends, one band is exposed and developed after another, so that only its own sums are there:
//            those of a large picture that changes little take more than its blocks. Else all bands are exposed chunk
//            by chunk, for chunks come once
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "opencl/block_feed.hpp"
#include "opencl/developer.hpp"
#include "opencl/device_tables.hpp"
#include "opencl/kept_sums.hpp"
#include "opencl/render_memory.hpp"

namespace nutik {

// What exposures on a device have in common.
struct ExposingDevice {
  const DeviceInfo& info;
  cl::CommandQueue& queue;
  BlockFeed& feed;
  DeviceTables& tables;
  bool last_block_first;  // OpenClOptions
};

// What is exposed: of a plan the pixels of some functions (of others the bands have the sums), and what need not be read.
struct ExposedPlan {
  const RenderPlan& plan;
  const SumsInUse& kept;
  std::span<const std::uint8_t> exposes;  // by function
};

class Exposer {
 public:
  // `kernel` is that of kernels/expose.cl, built for the picture, `light` the values of its codes. The plan has blocks.
  // All that is given must live as long.
  Exposer(const ExposingDevice& device, const Work& work, const ExposedPlan& what, CaptureSource& source,
          const RenderMemory& shares, cl::Kernel kernel, cl::Buffer light, DeviceMemory& memory,
          RenderStatistics& statistics)
      : device_(device),
        work_(work),
        plan_(what.plan),
        source_(source),
        shares_(shares),
        kept_(what.kept),
        exposes_(what.exposes),
        kernel_(std::move(kernel)),
        light_(std::move(light)),
        memory_(memory),
        statistics_(statistics) {}

  // Calls develop(band) for each, once, from top to bottom, while its sums are there. Throws InputError for a damaged
  // block, DeviceError, Cancelled.
  using Develop = std::function<void(const ExposedBand& exposed)>;
  void expose(std::span<ExposedBand> bands, const RenderControl& control, const Develop& develop);

 private:
  // Whether all of the plan's blocks are in `fetched_` now, to stay.
  bool fetch_all();
  void sum_up(std::span<const ExposedBand> bands, std::span<const TableSlice> slices,
              const RenderControl& control);
  void launch(const cl::Buffer& payload, std::span<const BlockEntry> entries, const SliceTables& tables,
              std::span<const ExposedBand> bands, bool is_first);
  // Planned blocks [first, last) that are read.
  [[nodiscard]] std::size_t read_blocks(std::size_t first, std::size_t last) const;
  // Those of a slice whose blocks are not behind planned block `last`, from `next` on.
  void add_kept(const TableSlice& slice, std::size_t last, std::size_t& next,
                std::vector<BlockEntry>& entries) const;
  void add_correction(const TableSlice& slice, std::size_t planned, std::vector<BlockEntry>& entries) const;
  BlockFeed::Chunk next_chunk();

  const ExposingDevice& device_;
  const Work& work_;
  const RenderPlan& plan_;
  CaptureSource& source_;
  const RenderMemory& shares_;
  const SumsInUse& kept_;
  std::span<const std::uint8_t> exposes_;
  cl::Kernel kernel_;
  cl::Buffer light_;
  DeviceMemory& memory_;
  RenderStatistics& statistics_;
  std::vector<BlockFeed::Chunk> fetched_;  // the plan's first ones, ahead of any launch
};

}  // namespace nutik
