// What is taken where people and files may have said something, and who did: the fact to be told of it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "capture/fact.hpp"
#include "capture/format.hpp"
#include "capture/rational.hpp"
#include "media/clip.hpp"

namespace nutik {

// What was stated, else what the file names, else what is usual. Appends the fact, worded by `text`.
template <typename Value, typename Text>
Value settle(std::vector<Fact>& facts, const std::optional<Value>& stated, const std::optional<Value>& named,
             const Value& usual, Setting setting, Text text) {
  const Origin origin = stated ? Origin::stated : named ? Origin::file : Origin::assumed;
  const Value value = stated ? *stated : named ? *named : usual;
  facts.push_back({text(value), origin, setting});
  return value;
}

// The white of codes of 16 bits; `named` where files say how many of these are used. `is_noted`: a note says so where
// white is assumed.
inline std::uint32_t settle_white(ClipInfo& info, const std::optional<std::uint32_t>& stated,
                                  const std::optional<std::uint32_t>& named, bool is_noted = true) {
  constexpr std::uint32_t kDefault = 65'535;
  if (is_noted && !stated && !named) {
    info.notes.emplace_back(
        "the files do not say how many of their 16 bits are used: white is taken to be 65535; state "
        "another, 4095 for 12 bits",
        std::vector{Setting::white_code});
  }
  return settle(info.facts, stated, named, kDefault, Setting::white_code,
                [](std::uint32_t code) { return format("white {}", code); });
}

inline std::string pixel_aspect_text(const Rational& aspect) {
  if (aspect == Rational{1, 1}) return "square pixels";
  return format("pixels {}:{}", aspect.numerator, aspect.denominator);
}

}  // namespace nutik
