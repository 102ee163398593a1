// Sums of light · ns over blocks, halves and bundles of the resident capture, in one arithmetic, on the device from one
// exposure to the next: what they have in common wherever gains are steady (docs/explanation/model.md, "Steady gain").
//
//   in:      plans, one exposure after another
//   out:     of each the sums that need not be made, and which it is worth to make now
//   always:  a picture is the same to the last bit, whether sums were kept or not. They take no more than a limit; what
//            was used longest ago goes first
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "opencl/developer.hpp"
#include "opencl/device_memory.hpp"
#include "opencl/opencl_api.hpp"
#include "render/render_plan.hpp"

namespace nutik {

// What an exposure need not read.
struct SumsInUse {
  struct Entry {
    std::size_t planned;      // its block in the plan, of a bundle the last
    std::uint32_t kept_bits;  // as in BlockEntry
    std::uint64_t offset;     // in sums
  };
  cl::Buffer sums;
  std::vector<Entry> entries;            // in time order
  std::vector<std::uint32_t> kept_bits;  // by planned block, as in BlockEntry; empty: nothing is kept
  std::vector<bool> skipped;             // planned blocks of which nothing is read; empty: none
};

class KeptSums {
 public:
  // Forgets what is kept: of another capture nothing is right.
  void clear();

  // The next exposure of the resident capture begins. The sums that it is worth to make before it, for which there is
  // room within `max_bytes`.
  [[nodiscard]] std::vector<SummedBlocks> begin_exposure(const RenderPlan& plan, std::span<const std::uint8_t> exposes,
                                                         Precision precision, std::uint64_t max_bytes,
                                                         const DeviceInfo& device);

  // Makes room for one of them. It is kept once all bands of the picture are stored, whole rows of it.
  [[nodiscard]] std::size_t slot_for(DeviceMemory& memory);
  void store(std::size_t slot, const ExposedBand& exposed, cl::CommandQueue& queue) const;
  void keep(std::size_t slot, const SummedBlocks& blocks);

  // The plan whose exposure they are: light · ns of these blocks, of every pixel. Stays until the next call.
  [[nodiscard]] const RenderPlan& plan_for(const SummedBlocks& blocks, const RenderPlan& plan,
                                           const CaptureSource& source);

  // For the exposure that has begun: the sums of the functions that it exposes.
  [[nodiscard]] SumsInUse in_use(const RenderPlan& plan, std::span<const std::uint8_t> exposes,
                                 std::span<const ExposedBand> bands) const;

  [[nodiscard]] std::uint64_t bytes() const { return slots_.size() * slot_bytes_; }

 private:
  struct Slot {
    std::optional<SummedBlocks> blocks;  // none until they are kept
    std::uint64_t exposure = 0;          // the last one that wanted it
  };

  // Whether it may go.
  [[nodiscard]] bool is_idle(const Slot& slot) const;
  [[nodiscard]] std::uint64_t slot_sums() const;
  [[nodiscard]] SumsInUse parts_of_light(const RenderPlan& of_light) const;

  Precision precision_ = Precision::single_;  // always the same
  std::optional<Transfer> transfer_;
  std::uint64_t tile_bytes_ = 0;
  std::uint64_t slot_bytes_ = 0;
  std::uint64_t capacity_ = 0;  // in slots
  std::uint64_t exposure_ = 0;
  cl::Buffer sums_;  // [slot][tile][channel][plane][64]
  std::vector<Slot> slots_;
  std::map<SummedBlocks, std::size_t> slot_of_;
  std::set<SummedBlocks> was_wanted_;
  std::map<Halves, RenderPlan> light_;
};

}  // namespace nutik
