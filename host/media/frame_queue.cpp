#include "media/frame_queue.hpp"

#include <utility>

#include "media/writers/picture_writer.hpp"

namespace nutik {

FrameQueue::FrameQueue(std::function<std::unique_ptr<VideoWriter>()> open, std::size_t max_waiting,
                       std::optional<Shape> square)
    : square_(square),
      frames_(max_waiting),
      writing_(std::async(std::launch::async, [this, open = std::move(open)] { write(open); })) {}

FrameQueue::~FrameQueue() { frames_.close(); }

void FrameQueue::write(const std::function<std::unique_ptr<VideoWriter>()>& open) {
  const ClosedAtEnd closed(frames_);
  writer_ = open();
  while (auto frame = frames_.pop()) {
    if (square_ && frame->picture.shape != *square_) frame->picture = in_square_pixels(frame->picture, *square_);
    writer_->write(frame->picture, frame->text, frame->number);
  }
}

void FrameQueue::finish() {
  frames_.close();
  writing_.get();
  writer_->finish();
}

}  // namespace nutik
