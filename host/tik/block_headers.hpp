// A block's header, and what of it can be believed. docs/reference/tik-format.md has the layout.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/timeline.hpp"
#include "tik/file_layout.hpp"
#include "tik/header.hpp"

namespace nutik::tik {

template <typename T>
[[nodiscard]] T load(std::span<const std::byte> bytes, std::uint64_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

// Whether [offset, offset + bytes) lies within a file of `size` bytes, without overflow.
[[nodiscard]] inline bool fits(std::uint64_t offset, std::uint64_t bytes, std::uint64_t size) {
  return offset <= size && bytes <= size - offset;
}

// By its magic and its checksum.
[[nodiscard]] bool is_whole(const BlockHeader& header);
[[nodiscard]] bool is_packed(const BlockHeader& header);

[[nodiscard]] std::uint64_t exposures_offset(std::uint64_t block_offset);
[[nodiscard]] std::uint64_t payload_offset(std::uint64_t block_offset, const BlockHeader& header);

// What a header has to agree with: where it stands, and what was read before it.
struct HeaderPlace {
  std::uint64_t offset;
  std::uint64_t block;
  std::uint64_t first_sample;
  bool is_regular;  // the capture has a constant rate
};

// What a header, whose checksum may be right and the rest made up, says that cannot be; empty where all of it
// can, and then its exposures and its payload lie within the file and none of the offsets above overflows.
[[nodiscard]] std::string flaw_of(const BlockHeader& header, const HeaderPlace& place,
                                  std::uint64_t file_bytes);

[[nodiscard]] std::vector<Exposure> load_exposures(std::span<const std::byte> bytes);

// The timeline that a file states. Throws InputError beginning with `name`, also where a person may not state such a
// rate either.
[[nodiscard]] Timeline timeline_of(const Header& header, std::uint64_t samples,
                                   std::vector<Exposure> exposures, std::optional<std::int64_t> duration_ns,
                                   const std::string& name);

// Said of all that lies in front of the blocks, whose checksum each of them holds.
inline constexpr const char* kDamagedFront =
    "the text or picture at its start is damaged, which says when and how it was filmed; encode the clip "
    "again";

}  // namespace nutik::tik
