// A value that all copies share.
#pragma once

#include <memory>
#include <utility>

namespace nutik {

// An immutable value that all copies share: as cheap to copy as a pointer, equal to another that holds the same.
template <typename Value>
class Shared {
 public:
  explicit Shared(Value value) : value_(std::make_shared<const Value>(std::move(value))) {}

  [[nodiscard]] const Value& operator*() const { return *value_; }
  [[nodiscard]] const Value* operator->() const { return value_.get(); }

  friend bool operator==(const Shared& a, const Shared& b) { return a.value_ == b.value_ || *a == *b; }

 private:
  std::shared_ptr<const Value> value_;
};

}  // namespace nutik
