// Raw ADΔER files (.adder): each event tells how much light a pixel had since its event before.
//
//   0  adder · version u8 · b · width u16 · height u16 · ticks a second u32 · reference interval u32 · Δt_max u32
//      · bytes of an event u8 · channels u8 · [from version 1 on: source u32] · [2: time u32] · [3: interval u32]
//   then events: x u16 · y u16 · [of 3 channels: 1 u8, channel u8] · D u8 · t u32
//
// Big end first. 2^D is the light of the time since the pixel's last event, in units of which the source's white has so
// many in a reference interval; t is that time in ticks, or counts from the start (time 1). D 255 repeats the light
// before, 253 is no event, all others from 128 on are no light. x = y = 65535 ends the file.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "media/clip.hpp"
#include "media/event_light.hpp"

namespace nutik {

// `info` is given the codes' format, facts and notes. Throws InputError if the file is no such file or holds no event,
// UsageError if what is stated cannot be said of it.
[[nodiscard]] EventLight read_adder_file(std::span<const std::byte> file, const std::string& name,
                                         const ClipOptions& options, ClipInfo& info);

}  // namespace nutik
