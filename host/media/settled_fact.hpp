// What is taken where people and files may have said something, and who did: the fact to be told of it.
#pragma once

#include <optional>
#include <vector>

#include "capture/fact.hpp"
#include "capture/format.hpp"
#include "capture/rational.hpp"

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

inline std::string pixel_aspect_text(const Rational& aspect) {
  if (aspect == Rational{1, 1}) return "square pixels";
  return format("pixels {}:{}", aspect.numerator, aspect.denominator);
}

}  // namespace nutik
