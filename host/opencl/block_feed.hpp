// Brings the blocks of an exposure to where the kernel reads them, while it still reads those before.
//
//   in:      planned blocks, in time order, the slices their tables are cut into, and the capture they are blocks of
//   out:     chunks: blocks of one slice in one buffer, for one launch a band (allocation_cuts.hpp)
//   always:  copies of blocks take no more than two chunks (one block at least each); those of the resident
//            capture stay besides (ResidentBlocks), and are not read again. Blocks that lie in the host's
//            memory already, or are built there, are not copied at all where the device reads it too. Of packed ones
//            only those groups of tiles are unpacked that the exposure reads (needed_tiles.hpp)
#pragma once

#include <array>
#include <cstdint>
#include <future>
#include <list>
#include <span>
#include <unordered_map>
#include <vector>

#include "imev/capture_source.hpp"
#include "opencl/allocation_cuts.hpp"
#include "opencl/device.hpp"
#include "opencl/kernel_layout.hpp"
#include "opencl/needed_tiles.hpp"
#include "opencl/opencl_api.hpp"
#include "opencl/uploads.hpp"
#include "render/render_plan.hpp"
#include "system/page_buffer.hpp"

namespace nutik {

// Memory that blocks are read into, one behind the other.
struct Slab {
  PageBuffer host;    // where the device reads the host's memory
  cl::Buffer device;  // where it does not
  std::uint64_t capacity = 0;
  std::uint64_t used = 0;
  std::uint64_t exposure = 0;  // the last one that needed it
};

// A block in a slab.
struct BlockPlace {
  Slab* slab = nullptr;
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;
  std::vector<bool> tiles;  // whose bodies are there; empty: all
};

// Blocks of one capture that stay where kernels read them, from one exposure to the next.
//
//   always:  they take no more than a limit. Where another block needs room, what the exposure that runs does not need
//            goes first, and of that what was not needed for longest; what it does need stays, and the block goes
//            without
class ResidentBlocks {
 public:
  [[nodiscard]] const BlockPlace* find(std::uint64_t block) const;
  void keep(std::uint64_t block, BlockPlace place) { places_[block] = std::move(place); }
  // Its place is room that nobody uses, as long as the slab stays.
  void forget(std::uint64_t block) { places_.erase(block); }
  void clear();

  // An exposure begins, which needs these blocks; so many bytes are the limit.
  void begin(std::span<const PlannedBlock> needed, std::uint64_t max_bytes);

  // A slab for so many bytes, to be filled from its front; null where there is no room. `make_room(slab, bytes)` gives
  // one that is too small a larger memory.
  template <typename MakeRoom>
  Slab* new_slab(std::uint64_t bytes, MakeRoom make_room) {
    if (!drop_others(bytes)) return nullptr;
    Slab& slab = slabs_.emplace_back();
    make_room(slab, bytes);
    bytes_ += slab.capacity;
    slab.exposure = exposure_;
    return &slab;
  }
  // The slab that was made last; null where there is none.
  [[nodiscard]] Slab* last_slab() { return slabs_.empty() ? nullptr : &slabs_.back(); }
  void use(Slab& slab) const { slab.exposure = exposure_; }

  // What the slabs take.
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 private:
  void drop(std::list<Slab>::iterator slab);
  // Makes room for so many bytes; false where what the exposure needs leaves none.
  bool drop_others(std::uint64_t bytes);

  std::uint64_t max_bytes_ = 0;
  std::uint64_t bytes_ = 0;
  std::uint64_t exposure_ = 0;
  std::list<Slab> slabs_;
  std::unordered_map<std::uint64_t, BlockPlace> places_;  // by block of the capture
};

struct FeedLimits {
  std::uint64_t chunk_bytes;
  std::uint64_t resident_bytes;  // of the resident capture
  bool reads_ahead = true;       // false: copies take no more than one chunk
};

class BlockFeed {
 public:
  struct Chunk {
    BlockLease lease;  // of what lies in other memory than the feed's
    cl::Buffer payload;
    std::vector<BlockEntry> entries;
    std::uint64_t payload_bytes = 0;  // of the blocks, without what lies between them
    std::uint64_t host_bytes = 0;     // of other memory than the feed's
    bool stays = false;               // where it is until the exposure ends, whatever else is asked for
  };

  BlockFeed(cl::Context context, const cl::Device& device, const DeviceInfo& info);

  // Blocks of this capture stay once they have been read, until another is resident; null: of none. It must
  // live that long.
  void keep_resident(const CaptureSource* source);

  // All four must live until the last chunk has been taken, or stop(). `skipped` planned blocks are left out; empty:
  // none.
  void start(const RenderPlan& plan, std::span<const TableSlice> slices, CaptureSource& source,
             const NeededTiles& tiles, const FeedLimits& limits, std::vector<bool> skipped = {});

  // The next chunk, in time order; not to be called after the last block. Whoever asks has given the chunk before
  // back, unless it stays. Throws InputError for a damaged block, DeviceError for one that the device cannot hold.
  [[nodiscard]] Chunk next();

  // Waits for what is being read ahead, and forgets it: where an exposure fails.
  void stop();

  // What the feed's own memory takes on the device now.
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 private:
  // Where a chunk's blocks are copied or unpacked to; chosen with the first of them.
  struct Filling {
    Slab* slab = nullptr;
    bool stays = false;  // it is part of the resident capture's
  };

  [[nodiscard]] bool is_resident() const { return source_ == resident_source_; }
  // Where a block lies since an exposure before, with all that this one needs of it; null where it does not.
  [[nodiscard]] const BlockPlace* resident_place(const PlannedBlock& planned) const;
  [[nodiscard]] WantsTiles wants(const PlannedBlock& planned);
  [[nodiscard]] bool is_in_mapped_file(const BlockLease& lease) const;
  [[nodiscard]] bool is_used_uncopied(const BlockLease& lease) const;
  void check_size(const PlannedBlock& planned, std::uint64_t bytes) const;
  BlockEntry entry(std::uint64_t offset) const;
  [[nodiscard]] const TableSlice& slice() const { return slices_[slice_]; }
  [[nodiscard]] bool ends_slice() const { return next_ >= slice().last_block; }
  void advance();

  Chunk next_chunk();
  Chunk resident_chunk();
  Chunk mapped_chunk(BlockLease lease);
  void check_ahead();
  Chunk uncopied_chunk(BlockLease lease);
  Chunk filled_chunk();
  BlockLease lease_next(Filling& filling);
  [[nodiscard]] std::byte* unpacking_place(const Filling& filling);
  [[nodiscard]] bool was_unpacked(const Filling& filling, const BlockLease& lease);
  // A place for so many bytes more, in a slab that the first block chooses; false where that is full.
  bool take_room(Filling& filling, std::uint64_t bytes);
  Slab& slab_for(std::uint64_t bytes, bool& stays);
  void make_room(Slab& slab, std::uint64_t bytes);
  BlockPlace store(Slab& slab, const BlockLease& lease);
  cl::Buffer buffer_of(Slab& slab) const;

  cl::Context context_;
  DeviceInfo info_;
  FeedLimits limits_{0, 0};
  Uploads uploads_;

  const RenderPlan* plan_ = nullptr;
  CaptureSource* source_ = nullptr;
  const NeededTiles* tiles_ = nullptr;
  std::span<const TableSlice> slices_;
  std::size_t slice_ = 0;  // that the next planned block is part of
  std::size_t next_ = 0;   // planned block that is not skipped
  std::vector<bool> skipped_;
  BlockLease pending_;  // of that block, where it did not fit the chunk before
  std::uint64_t mapped_bytes_ = 0;
  std::size_t checked_ahead_ = 0;  // planned blocks, of those in a mapped file
  std::uint64_t bytes_ = 0;

  std::array<Slab, 2> passing_;  // used in turns
  std::size_t turn_ = 0;
  PageBuffer upload_memory_;

  const CaptureSource* resident_source_ = nullptr;
  ResidentBlocks resident_;
  bool is_read_by_kernel_ = false;  // the last slab, in this exposure: nothing is added to it meanwhile
  std::vector<bool> unpacked_;      // tiles of the block that was acquired last; empty: all

  std::future<Chunk> reading_;  // ahead
};

}  // namespace nutik
