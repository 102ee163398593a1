#include "media/read_ahead.hpp"

#include <algorithm>

namespace nutik {
namespace {

// Enough that decoding goes on while a block is closed or exposed.
constexpr std::uint64_t kRasterBytes = 64 << 20;

std::size_t raster_count(const Clip& clip) {
  return std::clamp<std::uint64_t>(kRasterBytes / clip.info().format.sample_bytes(), 2, 64);
}

}  // namespace

ReadAhead::ReadAhead(Clip& clip, std::uint64_t most)
    : clip_(clip), decoded_(raster_count(clip)), spare_(raster_count(clip)) {
  for (std::size_t i = 0; i < raster_count(clip); ++i) spare_.push(Raster(clip.info().format.sample_bytes()));
  decoding_ = std::async(std::launch::async, [this, most] { decode(most); });
}

ReadAhead::~ReadAhead() {
  decoded_.close();
  spare_.close();
}

void ReadAhead::decode(std::uint64_t most) {
  const ClosedAtEnd closed(decoded_);
  for (std::uint64_t sample = 0; sample < most; ++sample) {
    auto raster = spare_.pop();
    if (!raster || !clip_.read(*raster) || !decoded_.push(std::move(*raster))) return;
  }
}

std::span<const std::byte> ReadAhead::next() {
  if (current_) spare_.push(std::move(*current_));
  current_ = decoded_.pop();
  if (current_) return *current_;
  if (decoding_.valid()) decoding_.get();
  return {};
}

}  // namespace nutik
