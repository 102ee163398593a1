#include "opencl/block_feed.hpp"

#include <algorithm>

#include "capture/format.hpp"

namespace nutik {
namespace {

constexpr std::uint64_t kPageBytes = 4096;
// Where a payload lies wider apart, copying it costs less than what a device may do with the room between.
constexpr std::uint64_t kMostSpread = 4;

}  // namespace

BlockFeed::BlockFeed(cl::Context context, const cl::Device& device, const DeviceInfo& info,
                     const FeedLimits& limits)
    : context_(std::move(context)), info_(info), limits_(limits), copies_(context_, device) {
  limits_.chunk_bytes = std::min(limits_.chunk_bytes, info_.largest_allocation_bytes);
}

void BlockFeed::hold(const CaptureSource* source) {
  stop();
  held_.clear();
  held_slabs_.clear();
  held_bytes_ = 0;
  held_source_ = source;
}

void BlockFeed::stop() {
  if (reading_.valid()) reading_.wait();
  reading_ = {};
}

void BlockFeed::start(const RenderPlan& plan, std::span<const TableSlice> slices, CaptureSource& source) {
  stop();
  plan_ = &plan;
  slices_ = slices;
  source_ = &source;
  slice_ = 0;
  next_ = 0;
  pending_bytes_ = 0;
  in_place_bytes_ = 0;
  lent_bytes_ = 0;
  is_read_by_kernel_ = false;
  for (Slab& slab : passing_) slab.used = 0;
}

BlockFeed::Chunk BlockFeed::next() {
  Chunk chunk = reading_.valid() ? reading_.get() : next_chunk();
  bytes_ = in_place_bytes_ + lent_bytes_ + passing_[0].used + passing_[1].used + held_bytes_;
  // What is held or lies in place takes no time.
  if (next_ < plan_->blocks.size() && in_place_bytes_ == 0 &&
      !(source_ == held_source_ && holds(plan_->blocks[next_]))) {
    reading_ = std::async(std::launch::async, [this] { return next_chunk(); });
  }
  return chunk;
}

BlockFeed::Chunk BlockFeed::next_chunk() {
  if (next_ == slice().last_block) ++slice_;
  if (info_.shares_host_memory && !source_->region().empty()) return in_place_chunk();
  if (source_ == held_source_ && holds(plan_->blocks[next_])) return held_chunk();
  if (info_.shares_host_memory && source_ != held_source_) {
    const std::uint64_t bytes = prepared_bytes(plan_->blocks[next_]);
    const std::span<const std::byte> lent = source_->lent();
    if (lent.size() <= std::min(info_.largest_allocation_bytes, kMostSpread * bytes) && !lent.empty()) {
      return lent_chunk(lent, bytes);
    }
    pending_bytes_ = bytes;
  }
  return read_chunk();
}

BlockEntry BlockFeed::entry(std::uint64_t offset) const {
  const PlannedBlock& planned = plan_->blocks[next_];
  return {offset, planned.table_row - slice().first_row, next_ - slice().first_block,
          planned.extent.sample_count, 0};
}

std::uint64_t BlockFeed::prepared_bytes(const PlannedBlock& planned) {
  const std::uint64_t bytes = pending_bytes_ != 0 ? pending_bytes_ : source_->prepare(planned.block);
  pending_bytes_ = 0;
  return bytes;
}

void BlockFeed::check_size(const PlannedBlock& planned, std::uint64_t bytes) const {
  if (bytes <= info_.largest_allocation_bytes) return;
  throw too_large(info_, bytes, format("a block of {} samples", planned.extent.sample_count),
                  "encode with fewer samples a block (--block-samples)");
}

BlockFeed::Chunk BlockFeed::in_place_chunk() {
  Chunk chunk;
  const std::span<const std::byte> region = source_->region();
  const std::uint64_t begin = source_->region_offset(plan_->blocks[next_].block) / kPageBytes * kPageBytes;
  std::uint64_t bytes = 0;
  for (; next_ < slice().last_block; ++next_) {
    const PlannedBlock& planned = plan_->blocks[next_];
    const std::uint64_t offset = source_->region_offset(planned.block) - begin;
    const std::uint64_t payload = prepared_bytes(planned);
    const std::uint64_t end = align_up(offset + payload, kBlockAlignment);
    check_size(planned, end - (chunk.entries.empty() ? 0 : bytes));
    if (!chunk.entries.empty() && end > info_.largest_allocation_bytes) {
      pending_bytes_ = payload;
      break;
    }
    chunk.entries.push_back(entry(offset));
    chunk.payload_bytes += payload;
    bytes = end;
  }
  in_place_bytes_ = std::min(bytes, region.size() - begin);
  chunk.payload = cl::Buffer(context_, CL_MEM_READ_ONLY | CL_MEM_USE_HOST_PTR, in_place_bytes_,
                             const_cast<std::byte*>(region.data()) + begin);
  return chunk;
}

// A block where its source built it.
BlockFeed::Chunk BlockFeed::lent_chunk(std::span<const std::byte> lent, std::uint64_t bytes) {
  Chunk chunk;
  chunk.entries.push_back(entry(0));
  chunk.payload_bytes = bytes;
  lent_bytes_ = lent.size();
  chunk.payload = cl::Buffer(context_, CL_MEM_READ_ONLY | CL_MEM_USE_HOST_PTR, lent.size(),
                             const_cast<std::byte*>(lent.data()));
  ++next_;
  return chunk;
}

BlockFeed::Chunk BlockFeed::held_chunk() {
  Chunk chunk;
  Slab* slab = held_.at(plan_->blocks[next_].block).slab;
  for (; next_ < slice().last_block; ++next_) {
    const auto found = held_.find(plan_->blocks[next_].block);
    if (found == held_.end() || found->second.slab != slab) break;
    chunk.entries.push_back(entry(found->second.offset));
    chunk.payload_bytes += found->second.bytes;
  }
  is_read_by_kernel_ |= slab == held_slabs_.back().get();
  chunk.payload = buffer_of(*slab);
  return chunk;
}

BlockFeed::Chunk BlockFeed::read_chunk() {
  Chunk chunk;
  bool stays = false;
  Slab* slab = nullptr;
  for (; next_ < slice().last_block; ++next_) {
    const PlannedBlock& planned = plan_->blocks[next_];
    if (source_ == held_source_ && holds(planned)) break;
    const std::uint64_t bytes = prepared_bytes(planned);
    check_size(planned, bytes);
    if (slab == nullptr) {
      slab = &slab_for(bytes, stays);
    } else if (slab->used + bytes > slab->capacity) {
      pending_bytes_ = bytes;
      break;
    }
    const Place place = read_block(*slab, planned, bytes);
    chunk.entries.push_back(entry(place.offset));
    chunk.payload_bytes += bytes;
    if (stays) held_.emplace(planned.block, place);
    if (!source_->lent().empty()) {  // the kernel may still read the one before, where it was built
      ++next_;
      break;
    }
  }
  is_read_by_kernel_ |= stays;
  chunk.payload = buffer_of(*slab);
  return chunk;
}

// Memory for a chunk that starts with a block of `bytes`.
BlockFeed::Slab& BlockFeed::slab_for(std::uint64_t bytes, bool& stays) {
  const std::uint64_t room = std::max(align_up(bytes, kBlockAlignment), limits_.chunk_bytes);
  if (source_ == held_source_) {
    stays = true;
    const bool has_open = !held_slabs_.empty() && !is_read_by_kernel_;
    if (has_open && held_slabs_.back()->used + bytes <= held_slabs_.back()->capacity) {
      return *held_slabs_.back();
    }
    if (held_bytes_ + room <= limits_.held_bytes) {
      held_slabs_.push_back(std::make_unique<Slab>());
      make_room(*held_slabs_.back(), room);
      held_bytes_ += held_slabs_.back()->capacity;
      is_read_by_kernel_ = false;
      return *held_slabs_.back();
    }
  }
  stays = false;
  Slab& slab = passing_[turn_];
  turn_ = 1 - turn_;
  slab.used = 0;
  if (slab.capacity < room) make_room(slab, room);
  return slab;
}

void BlockFeed::make_room(Slab& slab, std::uint64_t bytes) {
  bytes = std::min(bytes, info_.largest_allocation_bytes);
  if (info_.shares_host_memory) {
    slab.host.reserve(bytes);
  } else {
    slab.device = cl::Buffer(context_, CL_MEM_READ_ONLY, bytes);
  }
  slab.capacity = bytes;
}

BlockFeed::Place BlockFeed::read_block(Slab& slab, const PlannedBlock& planned, std::uint64_t bytes) {
  const Place place{&slab, slab.used, bytes};
  if (info_.shares_host_memory) {
    source_->read(planned.block, {slab.host.data() + place.offset, bytes});
  } else {
    upload_memory_.reserve(bytes);
    source_->read(planned.block, upload_memory_.first(bytes));
    copies_.enqueueWriteBuffer(slab.device, CL_TRUE, place.offset, bytes, upload_memory_.data());
  }
  slab.used = std::min(align_up(place.offset + bytes, kBlockAlignment), slab.capacity);
  return place;
}

cl::Buffer BlockFeed::buffer_of(Slab& slab) const {
  if (!info_.shares_host_memory) return slab.device;
  // Anew for each chunk: the device may have looked at what the memory held before.
  return {context_, CL_MEM_READ_ONLY | CL_MEM_USE_HOST_PTR, slab.used, slab.host.data()};
}

}  // namespace nutik
