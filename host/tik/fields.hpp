// What a .tik says of itself beside its text: a list of fields, to which later programs may add without a new version.
//
//   char[8] "TIKfield"   u64 bytes of the list, all of it   u32 fields   u32 zeros
//   for each field:      char[4] tag   u32 flags   u64 bytes of its data   data, filled up with zeros to 8 bytes
//   u64 checksum of all before it
//
// Flag 1: whoever does not know the tag must not read the file. Fields without it are passed over.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace nutik::tik {

struct Field {
  std::string tag;  // four characters
  bool must_be_understood = false;
  std::string data;
  friend bool operator==(const Field&, const Field&) = default;
};

[[nodiscard]] std::vector<std::byte> packed_fields(std::span<const Field> fields);

struct ReadFields {
  std::vector<Field> fields;
  std::size_t bytes = 0;  // of the list
};

// Reads a list that starts with the bytes. Throws InputError, beginning with `name`, where it is damaged or cut off.
[[nodiscard]] ReadFields read_fields(std::span<const std::byte> bytes, const std::string& name);

}  // namespace nutik::tik
