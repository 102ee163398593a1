// A list that a signal handler may walk at any time: it never gets shorter, and entries that are free are used again.
#pragma once

#include <atomic>

namespace nutik {

// A free entry of the list, or a new one at its front; no longer free. Entries have `next` and `is_free`. Whoever adds
// holds the list's lock; who only walks needs none.
template <typename Entry>
Entry& reused_entry(std::atomic<Entry*>& first) {
  Entry* entry = first.load();
  while (entry != nullptr && !entry->is_free) entry = entry->next;
  if (entry == nullptr) {
    entry = new Entry;
    entry->next = first.load();
    first.store(entry);
  }
  entry->is_free = false;
  return *entry;
}

}  // namespace nutik
