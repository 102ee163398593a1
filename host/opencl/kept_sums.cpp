#include "opencl/kept_sums.hpp"

#include <algorithm>
#include <utility>

#include "opencl/kernel_numbers.hpp"

namespace nutik {
namespace {

// A sum is of the whole picture. Where most of it is exposed with a steady gain there, making it takes as long as
// reading rows; it is worth it at once, but for the first exposure, which may be the last. Where less is, it is worth
// it when it is wanted again.
constexpr double kShareAtOnce = 0.75;
constexpr double kShareAgain = 0.25;

// Exposures for which a sum that nobody wants stays all the same: where more are wanted than there is room for, some
// stay rather than all go by turns. A half, or a bundle of some of its group's blocks, is soon made again.
constexpr std::uint64_t kIdleExposures = 64;
constexpr std::uint64_t kIdleExposuresOfPart = 8;

bool is_of_cut(const SummedBlocks& blocks) {
  return blocks.halves != Halves::both || (blocks.is_bundle() && blocks.count < kGroupBlocks);
}

// One function in one planned block.
struct Part {
  bool is_live;
  std::optional<SummedBlocks> sum;  // none where its gain is not steady
};

Part part_of(const PlannedFunction& function, const PlannedBlock& planned) {
  if (function.table->span_in(planned.extent).empty()) return {false, {}};
  const SteadyGain steady = function.table->steady_in(planned.block);
  if (!steady.is_steady()) return {true, {}};
  return {true, steady.bundle};
}

std::uint32_t kept_as(const SummedBlocks& blocks) { return 1u << blocks.index(); }

bool is_corrected(const PlannedFunction& function, const PlannedBlock& planned) {
  return function.table->has_corrected() && !function.table->steady_in(planned.block).corrected.empty();
}

bool has_mixed_tiles(std::span<const ExposedBand> bands) {
  return std::ranges::any_of(bands, [](const ExposedBand& exposed) {
    return std::ranges::find(exposed.map.host->of_tile, kMixedFunctions) != exposed.map.host->of_tile.end();
  });
}

}  // namespace

void KeptSums::clear() { *this = KeptSums(); }

std::vector<SummedBlocks> KeptSums::begin_exposure(const RenderPlan& plan, std::span<const std::uint8_t> exposes,
                                                   Precision precision, std::uint64_t max_bytes,
                                                   const DeviceInfo& device) {
  const std::uint64_t tile_bytes = sums_bytes(1, plan.capture.shape.channels, precision);
  const std::uint64_t slot_bytes = TileGrid(plan.capture.shape).tile_count() * tile_bytes;
  const std::uint64_t room = std::min(max_bytes, device.largest_allocation_bytes) / slot_bytes;
  if (plan.capture.transfer != transfer_ || room < slots_.size()) clear();
  precision_ = precision;
  transfer_ = plan.capture.transfer;
  tile_bytes_ = tile_bytes;
  slot_bytes_ = slot_bytes;
  const std::uint64_t blocks = plan.layout->blocks.size();
  // With delays nearly all tiles have several functions and are read all the same; and the sums' own kernels, of plans
  // without delays, are not the ones that were tested for this plan.
  if (precision == Precision::fixed || plan.map->has_delays()) return {};
  // Blocks, groups, and as many of what ends of boxcars cut: halves, and bundles of some of their group's blocks.
  if (capacity_ == 0) capacity_ = std::min(room, 2 * blocks + blocks / kGroupBlocks);
  ++exposure_;

  std::map<SummedBlocks, std::uint64_t> pixels;  // that want it
  for (std::size_t f = 0; f < plan.functions.size(); ++f) {
    if (!exposes[f]) continue;
    for (const PlannedBlock& planned : plan.blocks) {
      const Part part = part_of(plan.functions[f], planned);
      if (part.sum && part.sum->first == planned.block) pixels[*part.sum] += plan.functions[f].pixel_count;
    }
  }
  std::vector<SummedBlocks> worth;
  const auto all = static_cast<double>(plan.capture.shape.pixel_count());
  for (const auto& [sum, count] : pixels) {
    if (const auto slot = slot_of_.find(sum); slot != slot_of_.end()) {
      slots_[slot->second].exposure = exposure_;
      continue;
    }
    const double share = static_cast<double>(count) / all;
    const bool was_wanted = !was_wanted_.insert(sum).second;
    if (share >= (was_wanted ? kShareAgain : kShareAtOnce) && exposure_ > 1) worth.push_back(sum);
  }
  std::uint64_t rooms = capacity_ - slots_.size();
  for (const Slot& slot : slots_) rooms += is_idle(slot);
  // A boxcar that moves on wants the blocks of the bundle that it leaves: they are read for the bundle anyhow.
  std::set<SummedBlocks> with_blocks(worth.begin(), worth.end());
  for (const SummedBlocks& sum : worth) {
    for (std::uint64_t block = sum.first; sum.count > 1 && block < sum.first + sum.count; ++block) {
      if (!slot_of_.contains({block, 1})) with_blocks.insert({block, 1});
    }
  }
  if (with_blocks.size() <= rooms) worth.assign(with_blocks.begin(), with_blocks.end());
  if (worth.size() > rooms) worth.resize(rooms);
  // Bundles last, of blocks that are there by then.
  std::stable_partition(worth.begin(), worth.end(), [](const SummedBlocks& sum) { return sum.count == 1; });
  return worth;
}

bool KeptSums::is_idle(const Slot& slot) const {
  const bool is_part = slot.blocks && is_of_cut(*slot.blocks);
  return slot.exposure + (is_part ? kIdleExposuresOfPart : kIdleExposures) < exposure_;
}

std::size_t KeptSums::slot_for(DeviceMemory& memory) {
  if (sums_() == nullptr) sums_ = memory.allocate(capacity_ * slot_bytes_, CL_MEM_READ_WRITE);
  if (slots_.size() < capacity_) {
    slots_.push_back({{}, 0});
    return slots_.size() - 1;
  }
  const auto age = [this](const Slot& slot) {
    return std::pair(!(is_idle(slot) && slot.blocks && is_of_cut(*slot.blocks)), slot.exposure);
  };
  const auto oldest = std::ranges::min_element(slots_, {}, age);
  if (oldest->blocks) slot_of_.erase(*oldest->blocks);
  *oldest = {{}, 0};
  return static_cast<std::size_t>(oldest - slots_.begin());
}

const RenderPlan& KeptSums::plan_for(const SummedBlocks& blocks, const RenderPlan& plan,
                                     const CaptureSource& source) {
  auto found = light_.find(blocks.halves);
  if (found == light_.end()) {
    const Shape& shape = plan.capture.shape;
    RenderPlan made =
        make_plan(source, {{0, GainFunction({{0, 1.0}})}}, Mask::uniform(shape.width, shape.height, 0), {});
    made.capture = plan.capture;
    made.sums_light = blocks.halves;
    found = light_.emplace(blocks.halves, std::move(made)).first;
  }
  RenderPlan& light = found->second;
  light.blocks.clear();
  std::uint64_t row = 0;
  for (std::uint64_t block = blocks.first; block < blocks.first + blocks.count; ++block) {
    light.blocks.push_back({block, light.layout->blocks[block], row});
    row += light.blocks.back().row_count();
  }
  return light;
}

void KeptSums::store(std::size_t slot, const ExposedBand& exposed, cl::CommandQueue& queue) const {
  queue.enqueueCopyBuffer(exposed.sums, sums_, 0, slot * slot_bytes_ + exposed.band.first_tile * tile_bytes_,
                          exposed.band.tile_count * tile_bytes_);
  queue.finish();
}

void KeptSums::keep(std::size_t slot, const SummedBlocks& blocks) {
  slots_[slot] = {blocks, exposure_};
  slot_of_[blocks] = slot;
}

std::uint64_t KeptSums::slot_sums() const {
  return slot_bytes_ / (precision_ == Precision::double_ ? sizeof(double) : sizeof(float));
}

// As many blocks of a bundle as a shorter one has, which begins with the same, then one by one: so their sum is what it
// is where rows are read, for that is added up from the first block on.
SumsInUse KeptSums::parts_of_light(const RenderPlan& of_light) const {
  const std::size_t blocks = of_light.blocks.size();
  SumsInUse used{sums_, {}, std::vector<std::uint32_t>(blocks), std::vector<bool>(blocks)};
  const std::uint64_t first = of_light.blocks.front().block;
  std::size_t next = 0;
  for (std::size_t count = blocks - 1; count > 0 && next == 0; --count) {
    const auto slot = slot_of_.find({first, count});
    if (slot == slot_of_.end()) continue;
    next = count;
    std::fill_n(used.skipped.begin(), next, true);
    used.entries.push_back({next - 1, kept_as({first, 1}), slot->second * slot_sums()});
  }
  for (; next < blocks; ++next) {
    const SummedBlocks block{first + next, 1};
    const auto slot = blocks > 1 ? slot_of_.find(block) : slot_of_.end();
    if (slot == slot_of_.end()) continue;
    used.skipped[next] = true;
    used.entries.push_back({next, kept_as(block), slot->second * slot_sums()});
  }
  return used;
}

SumsInUse KeptSums::in_use(const RenderPlan& plan, std::span<const std::uint8_t> exposes,
                           std::span<const ExposedBand> bands) const {
  if (slot_of_.empty() && std::ranges::find(exposes, 0) == exposes.end()) return {};
  if (plan.sums_light) return parts_of_light(plan);
  SumsInUse used{
      sums_, {}, std::vector<std::uint32_t>(plan.blocks.size()), std::vector<bool>(plan.blocks.size())};
  const bool exposes_any = std::ranges::find(exposes, 1) != exposes.end();
  const bool reads_all = exposes_any && has_mixed_tiles(bands);
  for (std::size_t b = 0; b < plan.blocks.size(); ++b) {
    bool is_read = reads_all;
    for (std::size_t f = 0; f < plan.functions.size(); ++f) {
      const Part part = exposes[f] ? part_of(plan.functions[f], plan.blocks[b]) : Part{false, {}};
      if (!part.is_live) continue;
      is_read |= is_corrected(plan.functions[f], plan.blocks[b]);
      const auto slot = part.sum ? slot_of_.find(*part.sum) : slot_of_.end();
      if (slot == slot_of_.end()) {
        is_read = true;
        continue;
      }
      const std::uint32_t as = kept_as(*part.sum);
      if ((used.kept_bits[b] & as) == 0 && part.sum->last() == plan.blocks[b].block) {
        used.entries.push_back({b, as, slot->second * slot_sums()});
      }
      used.kept_bits[b] |= as;
    }
    used.skipped[b] = !is_read;
  }
  // Sums of functions that need no block begin with one all the same: with 0.
  if (exposes_any && used.entries.empty() && std::ranges::find(used.skipped, false) == used.skipped.end()) {
    used.skipped.front() = false;
  }
  return used;
}

}  // namespace nutik
