#include "media/read_ahead.hpp"

#include <algorithm>

namespace nutik {
namespace {

std::size_t raster_count(std::uint64_t sample_bytes, std::uint64_t ahead_bytes) {
  return std::clamp<std::uint64_t>(ahead_bytes / sample_bytes, 2, 64);
}

}  // namespace

ReadAhead::ReadAhead(Clip& clip, std::uint64_t ahead_bytes, std::uint64_t most)
    : clip_(clip),
      sample_bytes_(clip.info().format.sample_bytes()),
      raster_count_(raster_count(sample_bytes_, ahead_bytes)),
      decoded_(raster_count_),
      spare_(raster_count_) {
  for (std::size_t i = 0; i < raster_count_; ++i) spare_.push(PageBuffer(sample_bytes_));
  decoding_ = std::async(std::launch::async, [this, most] { decode(most); });
}

ReadAhead::~ReadAhead() {
  decoded_.close();
  spare_.close();
}

void ReadAhead::decode(std::uint64_t most) {
  const ClosedAtEnd closed(decoded_);
  for (std::uint64_t sample = 0; sample < most; ++sample) {
    auto raster = spare_.pop_newest();
    if (!raster || !clip_.read(raster->first(sample_bytes_)) || !decoded_.push(std::move(*raster))) return;
  }
}

std::span<const std::span<const std::byte>> ReadAhead::next(std::uint64_t most) {
  for (PageBuffer& raster : current_) spare_.push(std::move(raster));
  current_.clear();
  rasters_.clear();
  const std::uint64_t count = std::clamp<std::uint64_t>(most, 1, raster_count_ / 2);
  while (current_.size() < count) {
    auto raster = decoded_.pop();
    if (!raster) break;
    rasters_.push_back(raster->first(sample_bytes_));
    current_.push_back(std::move(*raster));
  }
  if (current_.empty() && decoding_.valid()) decoding_.get();
  return rasters_;
}

}  // namespace nutik
