// A few values by what they were made from: the ones used last, while what they take stays within a budget. The one
// used last stays whatever it takes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <list>
#include <utility>

namespace nutik {

// A Value says how many bytes() it takes.
template <typename Value>
class Recent {
 public:
  explicit Recent(std::uint64_t max_bytes) : max_bytes_(max_bytes) {}

  // The one that `is_it`; null if there is none.
  template <typename Is>
  [[nodiscard]] Value* find(Is is_it) {
    const auto found = std::ranges::find_if(values_, is_it);
    if (found == values_.end()) return nullptr;
    values_.splice(values_.begin(), values_, found);
    return &values_.front();
  }

  // Those that `are_useless` are kept no longer.
  template <typename Are>
  void forget(Are are_useless) {
    values_.remove_if(are_useless);
  }

  // Stays where it is until the next one is kept.
  Value& keep(Value value) {
    values_.push_front(std::move(value));
    std::uint64_t bytes = 0;
    auto last = values_.begin();
    for (; last != values_.end(); ++last) {
      bytes += last->bytes();
      if (bytes > max_bytes_ && last != values_.begin()) break;
    }
    values_.erase(last, values_.end());
    return values_.front();
  }

 private:
  std::uint64_t max_bytes_;
  std::list<Value> values_;
};

}  // namespace nutik
