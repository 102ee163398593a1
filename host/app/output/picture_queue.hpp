// Writes pictures on a thread of its own, while the next ones are exposed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <future>
#include <string>

#include "capture/picture.hpp"
#include "system/channel.hpp"

namespace nutik::app {

class PictureQueue {
 public:
  // `failed` is called on that thread, one call at a time, for a picture that could not be written, with
  // what was given to push() and the reason.
  using Failed = std::function<void(std::size_t number, const std::string& message)>;
  explicit PictureQueue(Failed failed);
  // Waits until everything is written.
  ~PictureQueue();
  PictureQueue(const PictureQueue&) = delete;
  PictureQueue& operator=(const PictureQueue&) = delete;

  // Waits while too many pictures wait already. `number` tells the caller which one failed.
  void push(std::size_t number, std::filesystem::path path, Picture picture);
  // Waits until everything is written. Nothing can be pushed any more.
  void finish();

 private:
  struct Job {
    std::size_t number;
    std::filesystem::path path;
    Picture picture;
  };

  // One being written, one waiting: more would only hold memory.
  static constexpr std::size_t kWaiting = 1;

  Channel<Job> jobs_{kWaiting};
  std::future<void> writing_;
};

}  // namespace nutik::app
