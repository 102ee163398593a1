// Pictures made and written side by side: PictureLine exposes several at once, a PictureQueue's thread writes them.
#pragma once

#include <cstddef>
#include <deque>
#include <exception>
#include <filesystem>
#include <functional>
#include <future>
#include <mutex>
#include <stop_token>
#include <string>
#include <utility>

#include "capture/error.hpp"
#include "capture/memory_needs.hpp"
#include "capture/picture.hpp"
#include "media/writers/picture_writer.hpp"
#include "render/renderer.hpp"
#include "session/memory_budget.hpp"
#include "system/channel.hpp"
#include "system/interruption.hpp"

namespace nutik {

// A picture, and the file that it goes into. The number is of whoever pushes it.
struct PictureJob {
  std::uint64_t number = 0;
  std::filesystem::path path = {};
  Picture picture;
  std::string text = {};
  FileWishes wishes = {};

  // Though a signal has come: what is made is kept. Throws OutputError, UsageError.
  void write() const {
    FileWishes whole = wishes;
    whole.check = {};
    write_picture(path, picture, text, whole);
  }
};

class PictureQueue {
 public:
  // `write` is called on that thread, and takes the pictures in the order in which they were pushed until no more come.
  // So many may wait: with one beside it that is written, more only hold memory where all take as long.
  explicit PictureQueue(std::function<void(Channel<PictureJob>& jobs)> write, std::size_t max_waiting = kWaiting)
      : jobs_(max_waiting), writing_(std::async(std::launch::async, [this, write = std::move(write)] {
          const ClosedAtEnd closed(jobs_);  // nobody waits for a writer that is gone
          write(jobs_);
        })) {}
  // Waits until everything is written.
  ~PictureQueue() { jobs_.close(); }
  PictureQueue(const PictureQueue&) = delete;
  PictureQueue& operator=(const PictureQueue&) = delete;

  // What the pictures take that wait and are written, values of a type that follows from the capture's format.
  [[nodiscard]] static NeedsOfFormat needs(const std::function<ValueType(const CaptureFormat&)>& type_of) {
    return [type_of](const CaptureFormat& capture) {
      return MemoryNeeds{{"pictures that are written",
                          (kWaiting + 1) * capture.shape.value_count() * value_bytes(type_of(capture))}};
    };
  }

  // Waits while as many wait as may. Returns false where writing has failed; finish() then throws why.
  bool push(PictureJob job) { return jobs_.push(std::move(job)); }
  // Waits until everything is written. Nothing can be pushed any more.
  void finish() {
    jobs_.close();
    writing_.get();
  }

 private:
  static constexpr std::size_t kWaiting = 1;

  Channel<PictureJob> jobs_;
  std::future<void> writing_;
};

// Pictures that are made at the same time, and handed on in the order in which they were asked for.
//
//   in:      for each, work that makes it with a RenderControl
//   out:     what work returned, the oldest first
//   always:  no more than `length` are in line. With 1 a picture is made when it is taken, by whoever takes it. What
//            one throws first stops the others, and is thrown by the next take()
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

  // Makes so many, of which the k-th is work_of(k)'s, and hands them on until hand_on(k, made) returns false.
  template <typename WorkOf, typename HandOn>
  void make(std::size_t count, const ReportedProgress& progress, const WorkOf& work_of, const HandOn& hand_on) {
    std::size_t asked = 0;
    for (std::size_t k = 0; k < count; ++k) {
      check_interruption();
      if (progress) progress(k, count);
      for (; asked < count && !is_full(); ++asked) add(work_of(asked));
      if (!hand_on(k, take())) return;
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
