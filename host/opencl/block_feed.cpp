#include "opencl/block_feed.hpp"

#include <algorithm>
#include <utility>

#include "capture/format.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

constexpr std::uint64_t kPageBytes = 4096;
// Where a payload lies wider apart, copying it costs less than what a device may do with the room between.
constexpr std::uint64_t kMaxSpread = 4;
// Copying fewer bytes than these into a chunk of many blocks costs less than a launch of their own.
constexpr std::uint64_t kMinLent = 1 << 20;

}  // namespace

const BlockPlace* ResidentBlocks::find(std::uint64_t block) const {
  const auto found = places_.find(block);
  return found == places_.end() ? nullptr : &found->second;
}

void ResidentBlocks::clear() {
  places_.clear();
  slabs_.clear();
  bytes_ = 0;
}

void ResidentBlocks::begin(std::span<const PlannedBlock> needed, std::uint64_t max_bytes) {
  max_bytes_ = max_bytes;
  ++exposure_;
  if (places_.empty()) return;
  for (const PlannedBlock& planned : needed) {
    const auto found = places_.find(planned.block);
    if (found != places_.end()) found->second.slab->exposure = exposure_;
  }
  while (bytes_ > max_bytes_) drop(std::ranges::min_element(slabs_, {}, &Slab::exposure));
}

void ResidentBlocks::drop(std::list<Slab>::iterator slab) {
  std::erase_if(places_, [&](const auto& place) { return place.second.slab == &*slab; });
  bytes_ -= slab->capacity;
  slabs_.erase(slab);
}

bool ResidentBlocks::drop_others(std::uint64_t bytes) {
  if (bytes > max_bytes_) return false;
  while (bytes_ + bytes > max_bytes_) {
    const auto oldest = std::ranges::min_element(slabs_, {}, &Slab::exposure);
    if (oldest == slabs_.end() || oldest->exposure == exposure_) return false;
    drop(oldest);
  }
  return true;
}

BlockFeed::BlockFeed(cl::Context context, const cl::Device& device, const DeviceInfo& info)
    : context_(std::move(context)), info_(info), uploads_(context_, device) {}

void BlockFeed::keep_resident(const CaptureSource* source) {
  stop();
  resident_.clear();
  resident_source_ = source;
}

void BlockFeed::stop() {
  if (reading_.valid()) reading_.wait();
  reading_ = {};
  pending_ = {};
}

void BlockFeed::start(const RenderPlan& plan, std::span<const TableSlice> slices, CaptureSource& source,
                      const NeededTiles& tiles, const FeedLimits& limits, std::vector<bool> skipped) {
  stop();
  plan_ = &plan;
  slices_ = slices;
  source_ = &source;
  tiles_ = &tiles;
  limits_ = limits;
  limits_.chunk_bytes = std::min(limits_.chunk_bytes, info_.largest_allocation_bytes);
  slice_ = 0;
  skipped_ = std::move(skipped);
  next_ = 0;
  if (!skipped_.empty() && skipped_.front()) advance();
  mapped_bytes_ = 0;
  checked_ahead_ = 0;
  is_read_by_kernel_ = false;
  for (Slab& slab : passing_) slab.used = 0;
  resident_.begin(is_resident() ? plan.blocks : std::span<const PlannedBlock>(), limits_.resident_bytes);
}

BlockFeed::Chunk BlockFeed::next() {
  Chunk chunk = reading_.valid() ? reading_.get() : next_chunk();
  bytes_ = passing_[0].used + passing_[1].used + resident_.bytes();
  // What is resident or in a mapped file takes no time.
  if (limits_.reads_ahead && next_ < plan_->blocks.size() && mapped_bytes_ == 0 &&
      resident_place(plan_->blocks[next_]) == nullptr) {
    reading_ = std::async(std::launch::async, [this] { return next_chunk(); });
  }
  return chunk;
}

BlockFeed::Chunk BlockFeed::next_chunk() {
  while (ends_slice()) ++slice_;
  Chunk chunk = resident_place(plan_->blocks[next_]) != nullptr ? resident_chunk() : filled_chunk();
  chunk.stays |= next_ >= plan_->blocks.size();  // nothing follows that is read over the last one
  return chunk;
}

void BlockFeed::advance() {
  do {
    ++next_;
  } while (next_ < skipped_.size() && skipped_[next_]);
}

const BlockPlace* BlockFeed::resident_place(const PlannedBlock& planned) const {
  const BlockPlace* place = is_resident() ? resident_.find(planned.block) : nullptr;
  if (place == nullptr || place->tiles.empty() || tiles_->are_among(place->tiles, planned)) return place;
  return nullptr;
}

BlockEntry BlockFeed::entry(std::uint64_t offset) const {
  const PlannedBlock& planned = plan_->blocks[next_];
  return {offset, planned.table_row - slice().first_row, next_ - slice().first_block,
          planned.extent.sample_count, 0};
}

void BlockFeed::check_size(const PlannedBlock& planned, std::uint64_t bytes) const {
  if (bytes <= info_.largest_allocation_bytes) return;
  throw too_large(info_, bytes, format("a block of {} samples", planned.extent.sample_count),
                  "encode with fewer samples a block", {Setting::block_samples});
}

BlockFeed::Chunk BlockFeed::resident_chunk() {
  Chunk chunk;
  Slab* slab = resident_place(plan_->blocks[next_])->slab;
  for (; !ends_slice(); advance()) {
    const BlockPlace* place = resident_place(plan_->blocks[next_]);
    if (place == nullptr || place->slab != slab) break;
    chunk.entries.push_back(entry(place->offset));
    chunk.payload_bytes += place->bytes;
  }
  is_read_by_kernel_ |= slab == resident_.last_slab();
  chunk.payload = buffer_of(*slab);
  chunk.stays = true;
  return chunk;
}

BlockFeed::Chunk BlockFeed::mapped_chunk(BlockLease lease) {
  Chunk chunk;
  const std::span<const std::byte> mapping = lease.mapping();
  const std::uint64_t begin = lease.mapping_offset() / kPageBytes * kPageBytes;
  std::uint64_t bytes = 0;
  // As far as blocks lie behind the first one in its mapping.
  while (lease.mapping().data() == mapping.data() && lease.mapping_offset() >= begin) {
    const PlannedBlock& planned = plan_->blocks[next_];
    const std::uint64_t offset = lease.mapping_offset() - begin;
    const std::uint64_t end = align_up(offset + lease.bytes(), kBlockAlignment);
    check_size(planned, end - (chunk.entries.empty() ? 0 : bytes));
    if (!chunk.entries.empty() && end > info_.largest_allocation_bytes) break;
    chunk.entries.push_back(entry(offset));
    chunk.payload_bytes += lease.bytes();
    bytes = end;
    lease = {};
    advance();
    if (ends_slice()) break;
    check_ahead();
    lease = source_->acquire(plan_->blocks[next_].block,
                             {[](std::uint64_t) -> std::span<std::byte> { return {}; }});
  }
  pending_ = std::move(lease);
  mapped_bytes_ = std::min(bytes, mapping.size() - begin);
  chunk.host_bytes = mapped_bytes_;
  chunk.stays = true;
  chunk.payload = cl::Buffer(context_, CL_MEM_READ_ONLY | CL_MEM_USE_HOST_PTR, mapped_bytes_,
                             const_cast<std::byte*>(mapping.data()) + begin);
  return chunk;
}

// The next blocks in a mapped file, one a core: a checksum keeps no more than one busy.
void BlockFeed::check_ahead() {
  if (next_ < checked_ahead_) return;
  std::vector<std::uint64_t> unchecked;
  for (checked_ahead_ = next_; checked_ahead_ < plan_->blocks.size(); ++checked_ahead_) {
    if (unchecked.size() == core_count()) break;
    const std::uint64_t block = plan_->blocks[checked_ahead_].block;
    const bool is_skipped = !skipped_.empty() && skipped_[checked_ahead_];
    if (!is_skipped && source_->is_unchecked(block)) unchecked.push_back(block);
  }
  parallel_for(unchecked.size(), [&](std::uint64_t i) {
    try {
      source_->preload(unchecked[i]);
    } catch (const InputError&) {
      // Told when it is acquired, if it is: blocks before it come first.
    }
  });
}

// A block where its source has it.
BlockFeed::Chunk BlockFeed::uncopied_chunk(BlockLease lease) {
  Chunk chunk;
  chunk.entries.push_back(entry(0));
  chunk.payload_bytes = lease.bytes();
  chunk.host_bytes = lease.payload().size();
  chunk.payload = cl::Buffer(context_, CL_MEM_READ_ONLY | CL_MEM_USE_HOST_PTR, chunk.host_bytes,
                             const_cast<std::byte*>(lease.payload().data()));
  chunk.lease = std::move(lease);
  advance();
  return chunk;
}

// Blocks that are copied or unpacked to the feed's own memory, unless the first of them need not be.
BlockFeed::Chunk BlockFeed::filled_chunk() {
  Chunk chunk;
  Filling filling;
  for (; !ends_slice(); advance()) {
    const PlannedBlock& planned = plan_->blocks[next_];
    if (resident_place(planned) != nullptr) break;
    BlockLease lease = lease_next(filling);
    if (lease.is_empty()) break;
    if (!was_unpacked(filling, lease)) {
      const bool is_first = chunk.entries.empty();
      if (is_first && is_in_mapped_file(lease)) return mapped_chunk(std::move(lease));
      if (is_first && is_used_uncopied(lease)) return uncopied_chunk(std::move(lease));
      check_size(planned, lease.bytes());
      if (is_in_mapped_file(lease) || is_used_uncopied(lease) || !take_room(filling, lease.bytes())) {
        pending_ = std::move(lease);
        break;
      }
    }
    BlockPlace place = store(*filling.slab, lease);
    chunk.entries.push_back(entry(place.offset));
    chunk.payload_bytes += place.bytes;
    place.tiles = std::exchange(unpacked_, {});
    if (filling.stays) resident_.keep(planned.block, std::move(place));
  }
  is_read_by_kernel_ |= filling.stays;
  chunk.payload = buffer_of(*filling.slab);
  chunk.stays = filling.stays;
  return chunk;
}

// The next planned block, which its source may unpack to where the chunk is filled; empty where that is full.
BlockLease BlockFeed::lease_next(Filling& filling) {
  if (!pending_.is_empty()) return std::exchange(pending_, {});
  const PlannedBlock& planned = plan_->blocks[next_];
  return source_->acquire(planned.block, {[&](std::uint64_t bytes) -> std::span<std::byte> {
                                            check_size(planned, bytes);
                                            if (!take_room(filling, bytes)) return {};
                                            if (!info_.shares_host_memory) upload_memory_.reserve(bytes);
                                            return {unpacking_place(filling), bytes};
                                          },
                                          wants(planned)});
}

// What this exposure reads of a block; all of it where it is resident already, but with too little of it: once is
// enough.
WantsTiles BlockFeed::wants(const PlannedBlock& planned) {
  unpacked_.clear();
  if (!is_resident()) return tiles_->of(planned);
  if (resident_.find(planned.block) != nullptr) return {};
  return [this, reads = tiles_->of(planned)](std::uint64_t first, std::uint64_t last) {
    const bool is_read = reads(first, last);
    if (!is_read && unpacked_.empty()) {
      unpacked_.assign(TileGrid(plan_->capture.shape).tile_count(), false);
      std::fill_n(unpacked_.begin(), first, true);
    } else if (is_read && !unpacked_.empty()) {
      std::fill_n(unpacked_.begin() + static_cast<std::ptrdiff_t>(first), last - first, true);
    }
    return is_read;
  };
}

std::byte* BlockFeed::unpacking_place(const Filling& filling) {
  return info_.shares_host_memory ? filling.slab->host.data() + filling.slab->used : upload_memory_.data();
}

bool BlockFeed::was_unpacked(const Filling& filling, const BlockLease& lease) {
  return filling.slab != nullptr && lease.payload().data() == unpacking_place(filling);
}

// Whether the device reads a block, with those behind it, as part of the lasting memory they lie in.
bool BlockFeed::is_in_mapped_file(const BlockLease& lease) const {
  return info_.shares_host_memory && !lease.mapping().empty();
}

bool BlockFeed::is_used_uncopied(const BlockLease& lease) const {
  return info_.shares_host_memory && !is_resident() && lease.bytes() >= kMinLent &&
         lease.payload().size() <= std::min(info_.largest_allocation_bytes, kMaxSpread * lease.bytes());
}

bool BlockFeed::take_room(Filling& filling, std::uint64_t bytes) {
  if (filling.slab != nullptr) return filling.slab->used + bytes <= filling.slab->capacity;
  filling.slab = &slab_for(bytes, filling.stays);
  return true;
}

// Memory for a chunk that starts with a block of `bytes`.
Slab& BlockFeed::slab_for(std::uint64_t bytes, bool& stays) {
  const std::uint64_t room = std::max(align_up(bytes, kBlockAlignment), limits_.chunk_bytes);
  if (is_resident()) {
    stays = true;
    Slab* const open = is_read_by_kernel_ ? nullptr : resident_.last_slab();
    if (open != nullptr && open->used + bytes <= open->capacity) {
      resident_.use(*open);
      return *open;
    }
    const auto with_room = [this](Slab& slab, std::uint64_t wanted) { make_room(slab, wanted); };
    if (Slab* slab = resident_.new_slab(room, with_room)) {
      is_read_by_kernel_ = false;
      return *slab;
    }
  }
  stays = false;
  Slab& slab = passing_[turn_];
  if (limits_.reads_ahead) turn_ = 1 - turn_;
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

BlockPlace BlockFeed::store(Slab& slab, const BlockLease& lease) {
  BlockPlace place{&slab, slab.used, lease.bytes(), {}};
  if (info_.shares_host_memory) {
    std::byte* to = slab.host.data() + place.offset;
    if (lease.payload().data() != to) lease.copy_to(source_->format(), {to, place.bytes});
  } else {
    const std::byte* from = lease.payload().data();
    if (lease.payload().size() != place.bytes) {
      upload_memory_.reserve(place.bytes);
      lease.copy_to(source_->format(), upload_memory_.first(place.bytes));
      from = upload_memory_.data();
    }
    uploads_.write(slab.device, place.offset, {from, place.bytes});
  }
  slab.used = std::min(align_up(place.offset + place.bytes, kBlockAlignment), slab.capacity);
  return place;
}

cl::Buffer BlockFeed::buffer_of(Slab& slab) const {
  if (!info_.shares_host_memory) return slab.device;
  // Anew for each chunk: the device may have looked at what the memory held before.
  return {context_, CL_MEM_READ_ONLY | CL_MEM_USE_HOST_PTR, slab.used, slab.host.data()};
}

}  // namespace nutik
