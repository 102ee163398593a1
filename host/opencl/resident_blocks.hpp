// Blocks of one capture that stay where kernels read them, from one exposure to the next.
//
//   always:  they take no more than a limit. Where another block needs room, what the exposure that runs does not need
//            goes first, and of that what was not needed for longest; what it does need stays, and the block goes
//            without
#pragma once

#include <cstdint>
#include <list>
#include <span>
#include <unordered_map>
#include <vector>

#include "opencl/opencl_api.hpp"
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

}  // namespace nutik
