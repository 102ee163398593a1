// The commands by number, and sets of them: which options belong to which.
#pragma once

#include <cstdint>

namespace nutik {

enum class CommandId {
  encode,
  expose,
  info,
  devices,
  recover,
  retime,
  join,
  batch,
  check,
  trace,
  mask,
  contact,
  activity,
  sweep,
  video,
  noise,
  shutter,
  reproduce,
  validate,
  background,
  study,
  solve,
  thumbnail,
  completion,
  man
};

// A bit for each.
using CommandSet = std::uint32_t;
static_assert(static_cast<unsigned>(CommandId::man) < 32, "the last one has a bit");
[[nodiscard]] constexpr CommandSet bit(CommandId id) { return 1u << static_cast<unsigned>(id); }

template <typename... Ids>
[[nodiscard]] constexpr CommandSet set_of(Ids... ids) {
  return (bit(ids) | ...);
}

}  // namespace nutik
