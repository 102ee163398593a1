#include "imev/capture_source.hpp"

#include <cstring>
#include <stdexcept>

namespace nutik {

MemoryCapture::MemoryCapture(const CaptureFormat& capture, Timeline timeline,
                             std::span<const std::vector<std::byte>> rasters,
                             std::uint32_t block_samples, TilePolicy policy)
    : capture_(capture), timeline_(std::move(timeline)) {
  if (rasters.size() != timeline_.sample_count()) {
    throw std::logic_error("a capture has another number of samples than its timeline");
  }
  BlockBuilder builder(capture, block_samples, policy);
  const auto close = [&] {
    Block block{builder.extent(), {}, 0};
    block.bytes = builder.finish(block.payload);
    blocks_.push_back(std::move(block));
  };
  for (const std::vector<std::byte>& raster : rasters) {
    builder.add(raster);
    if (builder.is_full()) close();
  }
  if (!builder.is_empty()) close();
}

void MemoryCapture::read(std::uint64_t block, std::span<std::byte> into) {
  std::memcpy(into.data(), blocks_[block].payload.data(), blocks_[block].bytes);
}

BlockView MemoryCapture::view(std::uint64_t block) const {
  const Block& at = blocks_[block];
  return {capture_, at.extent, {at.payload.data(), at.bytes}};
}

}  // namespace nutik
