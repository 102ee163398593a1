// Pictures that are made at the same time, and handed on in the order in which they were asked for.
//
//   in:      for each, work that makes it with a RenderControl
//   out:     what work returned, the oldest first
//   always:  no more than `length` are in line. With 1 a picture is made when it is taken, by whoever takes it. What one
//            throws first stops the others, and is thrown by the next take()
#pragma once

#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <future>
#include <mutex>
#include <stop_token>
#include <utility>

#include "render/renderer.hpp"

namespace nutik {

template <typename Made>
class PictureLine {
 public:
  using Work = std::function<Made(const RenderControl& control)>;

  explicit PictureLine(std::size_t length) : length_(length) {}
  // Waits for what is being made, which is stopped.
  ~PictureLine() { stop_.request_stop(); }
  PictureLine(const PictureLine&) = delete;
  PictureLine& operator=(const PictureLine&) = delete;

  [[nodiscard]] bool is_empty() const { return line_.empty(); }
  [[nodiscard]] bool is_full() const { return line_.size() >= length_; }

  void add(Work work) {
    if (length_ == 1) {
      line_.push_back(std::async(std::launch::deferred, std::move(work), RenderControl()));
      return;
    }
    line_.push_back(std::async(std::launch::async, [this, work = std::move(work)] {
      RenderControl control;
      control.stop = stop_.get_token();
      control.by_one_device = true;
      try {
        return work(control);
      } catch (...) {
        const std::scoped_lock lock(failing_);
        if (!failure_) failure_ = std::current_exception();
        stop_.request_stop();
        throw;
      }
    }));
  }

  [[nodiscard]] Made take() {
    std::future<Made> oldest = std::move(line_.front());
    line_.pop_front();
    try {
      return oldest.get();
    } catch (...) {
      const std::scoped_lock lock(failing_);
      if (failure_) std::rethrow_exception(failure_);  // what came first
      throw;
    }
  }

 private:
  std::size_t length_;
  std::stop_source stop_;
  std::mutex failing_;
  std::exception_ptr failure_;
  std::deque<std::future<Made>> line_;  // last: its threads use what is above
};

}  // namespace nutik
