// The median of values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace nutik {

// The upper of the two in the middle where there is an even number. There is one value at least.
template <typename Value>
[[nodiscard]] Value median(std::vector<Value> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace nutik
