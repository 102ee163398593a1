// A queue between two threads that holds a limited number of values.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <tuple>
#include <utility>

namespace nutik {

template <typename T>
class Channel {
 public:
  explicit Channel(std::size_t capacity) : capacity_(capacity) {}

  // Waits for room. Returns false, and drops the value, where the channel is closed.
  bool push(T value) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return closed_ || values_.size() < capacity_; });
    if (closed_) return false;
    values_.push_back(std::move(value));
    changed_.notify_all();
    return true;
  }

  // Waits for a value. Nothing where the channel is closed and all it held has been taken.
  std::optional<T> pop() { return take(false); }
  // The same with the value that went in last: of memory to be used again, what caches may still hold.
  std::optional<T> pop_newest() { return take(true); }

  // No value goes in any more; who waits is woken.
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

 private:
  std::optional<T> take(bool newest) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return closed_ || !values_.empty(); });
    if (values_.empty()) return std::nullopt;
    T value = std::move(newest ? values_.back() : values_.front());
    newest ? values_.pop_back() : values_.pop_front();
    changed_.notify_all();
    return value;
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<T> values_;
  std::size_t capacity_;
  bool closed_ = false;
};

// Closes channels at the end of a scope, however it is left, so that no thread waits for one that is gone.
template <typename... Channels>
class ClosedAtEnd {
 public:
  explicit ClosedAtEnd(Channels&... channels) : channels_(channels...) {}
  ~ClosedAtEnd() {
    std::apply([](auto&... channel) { (channel.close(), ...); }, channels_);
  }
  ClosedAtEnd(const ClosedAtEnd&) = delete;
  ClosedAtEnd& operator=(const ClosedAtEnd&) = delete;

 private:
  std::tuple<Channels&...> channels_;
};

}  // namespace nutik
