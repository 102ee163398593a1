#include "system/freed_memory.hpp"

#include <malloc.h>

namespace nutik {

void return_freed_memory() {
#ifdef __GLIBC__
  // Blocks from this size on are mapped, each for itself, and unmapped when they are freed. Otherwise the limit grows
  // to 32 MiB with what is freed, and pictures leave holes in heaps.
  constexpr int kMappedFrom = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, kMappedFrom);
  mallopt(M_TRIM_THRESHOLD, 2 * kMappedFrom);
#endif
}

}  // namespace nutik
