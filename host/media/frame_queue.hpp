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
#include <optional>
#include <string>
#include <vector>

#include "media/writers/video_writer.hpp"
#include "system/channel.hpp"

namespace nutik {

class FrameQueue {
 public:
  // Enough that a frame which takes longer than others, to expose or to encode, stops nobody.
  static constexpr std::size_t kDefaultWaiting = 4;

  // `open` is called on that thread: what encodes takes a while to load. So many frames may wait. Frames of another
  // shape are written in square pixels of `square`.
  explicit FrameQueue(std::function<std::unique_ptr<VideoWriter>()> open,
                      std::size_t max_waiting = kDefaultWaiting, std::optional<Shape> square = {});
  // Without finish() the video is dropped.
  ~FrameQueue();
  FrameQueue(const FrameQueue&) = delete;
  FrameQueue& operator=(const FrameQueue&) = delete;

  // Waits while frames wait already. Returns false where writing has failed; finish() then throws why.
  bool push(Picture picture, std::string text = {}, std::uint64_t number = 0) {
    return frames_.push({std::move(picture), std::move(text), number});
  }

  // Writes what was pushed and ends the video. Throws OutputError.
  void finish();

  // After finish().
  [[nodiscard]] bool has_sound() const { return writer_->has_sound(); }
  [[nodiscard]] std::vector<std::string> notes() const { return writer_->notes(); }

 private:
  struct Frame {
    Picture picture;
    std::string text;
    std::uint64_t number;
  };

  void write(const std::function<std::unique_ptr<VideoWriter>()>& open);

  std::optional<Shape> square_;
  Channel<Frame> frames_;
  std::unique_ptr<VideoWriter> writer_;
  std::future<void> writing_;
};

}  // namespace nutik
