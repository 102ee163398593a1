// Writes a video's frames on a thread of its own, while the next ones are exposed.
//
//   in:      frames of one format
//   out:     what a VideoWriter makes of them
//   always:  frames are written in the order in which they were pushed
#pragma once

#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "media/video_writer.hpp"
#include "system/channel.hpp"

namespace nutik {

class FrameQueue {
 public:
  // `open` is called on that thread: what encodes takes a while to load.
  explicit FrameQueue(std::function<std::unique_ptr<VideoWriter>()> open);
  // Without finish() the video is dropped.
  ~FrameQueue();
  FrameQueue(const FrameQueue&) = delete;
  FrameQueue& operator=(const FrameQueue&) = delete;

  // Waits while frames wait already. Returns false where writing has failed; finish() then throws why.
  bool push(Picture picture) { return pictures_.push(std::move(picture)); }

  // Writes what was pushed and ends the video. Throws OutputError.
  void finish();

  // After finish().
  [[nodiscard]] std::vector<std::string> notes() const { return writer_->notes(); }

 private:
  void write(const std::function<std::unique_ptr<VideoWriter>()>& open);

  // Enough that a frame which takes longer than others, to expose or to encode, stops nobody.
  static constexpr std::size_t kWaiting = 4;

  Channel<Picture> pictures_{kWaiting};
  std::unique_ptr<VideoWriter> writer_;
  std::future<void> writing_;
};

}  // namespace nutik
