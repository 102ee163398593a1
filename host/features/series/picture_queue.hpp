// Pictures made and written side by side: PictureLine exposes several at once, PictureQueue writes them on a thread of
// its own.
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

namespace nutik {

class PictureQueue {
 public:
  // `failed` is called on that thread, one call at a time, for a picture that could not be written, with
  // what was given to push() and why.
  using Failed = std::function<void(std::size_t number, const Error& error)>;
  explicit PictureQueue(Failed failed)
      : writing_(std::async(std::launch::async, [this, failed = std::move(failed)] {
          const ClosedAtEnd closed(jobs_);  // nobody waits for a writer that is gone
          while (const auto job = jobs_.pop()) {
            try {
              write_picture(job->path, job->picture, job->text, job->wishes);
            } catch (const OutputError& error) {
              failed(job->number, error);
            } catch (const UsageError& error) {
              failed(job->number, error);
            }
          }
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

  // Waits while kWaiting pictures wait. Throws what ended the writing thread. `number` comes back in `failed`; `text`
  // goes into the picture.
  void push(std::size_t number, std::filesystem::path path, Picture picture, std::string text,
            const FileWishes& wishes) {
    Job job{number, std::move(path), std::move(picture), std::move(text), wishes};
    job.wishes.check = {};  // a picture that is made is kept
    if (!jobs_.push(std::move(job))) finish();
  }
  // Waits until everything is written. Nothing can be pushed any more.
  void finish() {
    jobs_.close();
    writing_.get();
  }

 private:
  struct Job {
    std::size_t number;
    std::filesystem::path path;
    Picture picture;
    std::string text;
    FileWishes wishes;
  };

  // One being written, one waiting: more would only hold memory.
  static constexpr std::size_t kWaiting = 1;

  Channel<Job> jobs_{kWaiting};
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

 private:
  std::size_t length_;
  std::stop_source stop_;
  std::mutex failing_;
  std::exception_ptr failure_;
  std::deque<std::future<Made>> line_;  // last: its threads use what is above
};

}  // namespace nutik
