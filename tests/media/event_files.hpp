// Files of event cameras, written from lists of events by the formats' descriptions. Shares nothing with what reads
// them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "support/bytes.hpp"

namespace nutik::test {

struct Event {
  std::uint64_t us;
  unsigned x, y;
  bool up;
  friend bool operator==(const Event&, const Event&) = default;
};
using Events = std::vector<Event>;

inline std::string raw_header(const std::string& format, unsigned width, unsigned height) {
  return "% camera_integrator_name Prophesee\n% date 2023-03-29 16:37:46\n% format " + format +
         ";height=" + std::to_string(height) + ";width=" + std::to_string(width) + "\n% geometry " +
         std::to_string(width) + "x" + std::to_string(height) + "\n% end\n";
}

// Words of EVT 2.0, a time word before each event whose high time is another.
inline std::string evt2_words(const Events& events) {
  std::string words;
  std::uint64_t high = ~0ull;
  for (const Event& event : events) {
    if (event.us / 64 != high) words += little_endian(8ull << 28 | (event.us / 64 & 0xFFFFFFF), 4);
    high = event.us / 64;
    words += little_endian((event.up ? 1ull : 0ull) << 28 | event.us % 64 << 22 | event.x << 11 | event.y, 4);
  }
  return words;
}

// Events of one line, time and direction within 32 pixels of each other become one word. `legacy` swaps its halves.
inline std::string evt21_words(const Events& events, bool legacy) {
  std::string words;
  const auto add = [&](std::uint64_t upper, std::uint64_t lower) {
    words += legacy ? little_endian(upper, 4) + little_endian(lower, 4)
                    : little_endian(lower, 4) + little_endian(upper, 4);
  };
  std::uint64_t high = ~0ull;
  for (std::size_t i = 0; i < events.size();) {
    const Event& first = events[i];
    if (first.us / 64 != high) add(8ull << 28 | (first.us / 64 & 0xFFFFFFF), 0);
    high = first.us / 64;
    std::uint64_t mask = 0;
    const unsigned base = first.x / 32 * 32;
    for (; i < events.size(); ++i) {
      const Event& next = events[i];
      const bool is_same = next.us == first.us && next.y == first.y && next.up == first.up && next.x / 32 * 32 == base;
      if (!is_same || (mask >> (next.x - base) & 1) != 0 || mask >> (next.x - base) != 0) break;
      mask |= 1ull << (next.x - base);
    }
    add((first.up ? 1ull : 0ull) << 28 | first.us % 64 << 22 | base << 11 | first.y, mask);
  }
  return words;
}

// Single events, and vectors of 12, 12 and 8 where several stand side by side.
inline std::string evt3_words(const Events& events) {
  std::string words;
  const auto add = [&](std::uint64_t type, std::uint64_t value) { words += little_endian(type << 12 | value, 2); };
  std::uint64_t high = ~0ull, low = ~0ull;
  unsigned y = ~0u;
  for (std::size_t i = 0; i < events.size();) {
    const Event& first = events[i];
    if (first.us >> 12 != high) {
      add(8, first.us >> 12 & 0xFFF);
      low = ~0ull;
    }
    high = first.us >> 12;
    if ((first.us & 0xFFF) != low) add(6, first.us & 0xFFF);
    low = first.us & 0xFFF;
    if (first.y != y) add(0, first.y);
    y = first.y;
    std::uint64_t mask = 0;
    std::size_t end = i;
    for (; end < events.size(); ++end) {
      const Event& next = events[end];
      const bool is_same = next.us == first.us && next.y == first.y && next.up == first.up;
      if (!is_same || next.x < first.x || next.x - first.x >= 32 || mask >> (next.x - first.x) != 0) break;
      mask |= 1ull << (next.x - first.x);
    }
    if (end - i == 1) {
      add(2, first.x | (first.up ? 2048u : 0u));
    } else {
      add(3, first.x | (first.up ? 2048u : 0u));
      add(4, mask & 0xFFF);
      add(4, mask >> 12 & 0xFFF);
      add(5, mask >> 24 & 0xFF);
    }
    i = end;
  }
  return words;
}

inline std::string dat_file(const Events& events, unsigned width, unsigned height) {
  std::string file = "% Data file containing CD events.\n% Version 2\n% Date 2020-09-14 14:18:29\n% Height " +
                     std::to_string(height) + "\n% Width " + std::to_string(width) + "\n\x0c\x08";
  for (const Event& event : events) {
    file += little_endian(event.us & 0xFFFFFFFF, 4) +
            little_endian(event.x | event.y << 14 | (event.up ? 1ull : 0ull) << 28, 4);
  }
  return file;
}

}  // namespace nutik::test
