// Writes pictures on a thread of its own, while the next ones are exposed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <future>
#include <string>

#include "capture/error.hpp"
#include "capture/memory_needs.hpp"
#include "capture/picture.hpp"
#include "media/writers/picture_writer.hpp"
#include "session/memory_budget.hpp"
#include "system/channel.hpp"

namespace nutik {

class PictureQueue {
 public:
  // `failed` is called on that thread, one call at a time, for a picture that could not be written, with
  // what was given to push() and why.
  using Failed = std::function<void(std::size_t number, const Error& error)>;
  explicit PictureQueue(Failed failed);
  // Waits until everything is written.
  ~PictureQueue();
  PictureQueue(const PictureQueue&) = delete;
  PictureQueue& operator=(const PictureQueue&) = delete;

  // What the pictures take that wait and are written, values of a type that follows from the capture's format.
  [[nodiscard]] static NeedsOfFormat needs(const std::function<ValueType(const CaptureFormat&)>& type_of) {
    return [type_of](const CaptureFormat& capture) {
      return MemoryNeeds{{"pictures that are written",
                          (kWaiting + 1) * capture.shape.value_count() * value_bytes(type_of(capture))}};
    };
  }

  // Waits while too many pictures wait already. Throws what ended the writing thread, as finish() does. `number` tells the caller which one failed; `text` goes into
  // the picture (media/writers/picture_writer.hpp).
  void push(std::size_t number, std::filesystem::path path, Picture picture, std::string text,
            const FileWishes& wishes);
  // Waits until everything is written. Nothing can be pushed any more.
  void finish();

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

}  // namespace nutik
