#include "media/frame_queue.hpp"

#include <utility>

namespace nutik {

FrameQueue::FrameQueue(std::function<std::unique_ptr<VideoWriter>()> open, std::size_t most_waiting)
    : pictures_(most_waiting),
      writing_(std::async(std::launch::async, [this, open = std::move(open)] { write(open); })) {}

FrameQueue::~FrameQueue() { pictures_.close(); }

void FrameQueue::write(const std::function<std::unique_ptr<VideoWriter>()>& open) {
  const ClosedAtEnd closed(pictures_);
  writer_ = open();
  while (const auto picture = pictures_.pop()) writer_->write(*picture);
}

void FrameQueue::finish() {
  pictures_.close();
  writing_.get();
  writer_->finish();
}

}  // namespace nutik
