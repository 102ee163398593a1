// Which pictures of a clip the samples of a capture are, where they are not all of them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace nutik {

struct PartOfClip {
  std::uint64_t first = 0;     // picture of the clip, from 0
  std::int64_t start_ns = 0;   // of that one, from the start of the clip's first: 0 or more
  std::uint64_t pictures = 0;  // that the clip has; 0: it does not say
  std::string clip;            // its file's name, without folders
  std::string checksum = {};   // of its files; empty: not known

  // `pictures 2 … 5 of 6, whose time 0 is 0.02 s after the clip's`; `end` is behind the last one, if that is known.
  [[nodiscard]] std::string text(std::optional<std::uint64_t> end) const;
  friend bool operator==(const PartOfClip&, const PartOfClip&) = default;
};

// Whether a line of a capture's facts is that text.
[[nodiscard]] bool tells_part(std::string_view fact);

}  // namespace nutik
