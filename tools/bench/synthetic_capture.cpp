#include "synthetic_capture.hpp"

#include <algorithm>
#include <cstring>

namespace nutik::bench {
namespace {

constexpr std::uint32_t kRowStep = 4;
constexpr std::uint32_t kSlots = 4;

TileEntry entry_for(Content content, std::uint32_t samples) {
  switch (content) {
    case Content::dense: return {0, samples};
    case Content::rows: return {0, (samples + kRowStep - 1) / kRowStep};
    case Content::records: return {0, std::min(kSlots, samples - 1) | TileEntry::kRecordsFlag};
    case Content::still: return {0, 1};
  }
  return {0, 1};
}

void write_index(std::byte* list, std::uint64_t at, std::uint32_t bytes, std::uint32_t sample) {
  const auto wide = static_cast<std::uint16_t>(sample);
  std::memcpy(list + at * bytes, &wide, bytes);
}

}  // namespace

SyntheticCapture::SyntheticCapture(const CaptureFormat& capture, std::uint64_t sample_count,
                                   std::uint32_t block_samples, Content content, std::uint32_t rate)
    : capture_(capture), timeline_(Timeline::constant({rate, 1}, Timeline::kFullShutter, sample_count)) {
  for (std::uint64_t first = 0; first < sample_count; first += block_samples) {
    const auto count =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(block_samples, sample_count - first));
    const BlockGeometry geometry(capture, count);
    const std::uint64_t bytes =
        geometry.directory_bytes() + geometry.tile_count * geometry.body_bytes(entry_for(content, count));
    blocks_.push_back({{first, count}, bytes_, bytes});
    bytes_ += bytes;
  }
  memory_ = PageBuffer(bytes_);
  // Random everywhere, then directories and indices over it; codes stay below the white code.
  const std::uint64_t mask = capture.code_bytes == 1 ? ~0ull : 0x0FFF'0FFF'0FFF'0FFFull;
  std::uint64_t state = 0x9E37'79B9'7F4A'7C15u;
  for (std::uint64_t at = 0; at < bytes_; at += 8) {
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    const std::uint64_t codes = state & mask;
    std::memcpy(memory_.data() + at, &codes, 8);
  }
  for (const Block& block : blocks_) {
    const BlockGeometry geometry(capture, block.extent.sample_count);
    std::byte* payload = memory_.data() + block.offset;
    std::uint64_t offset = geometry.directory_bytes();
    for (std::uint64_t tile = 0; tile < geometry.tile_count; ++tile) {
      TileEntry entry = entry_for(content, block.extent.sample_count);
      entry.offset = static_cast<std::uint32_t>(offset / kBlockAlignment);
      std::memcpy(payload + tile * sizeof entry, &entry, sizeof entry);
      std::byte* body = payload + offset;
      if (entry.is_records()) {
        for (std::uint32_t slot = 0; slot < entry.slots(); ++slot) {
          std::byte* index = body + geometry.row_bytes() + slot * geometry.slot_bytes();
          for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
            const std::uint32_t spread = block.extent.sample_count / (entry.slots() + 1);
            write_index(
                index, lane, geometry.index_bytes(),
                1 + slot * spread + static_cast<std::uint32_t>((lane * 7 + tile) % std::max(spread, 1u)));
          }
        }
      } else if (geometry.row_index_bytes(entry.rows()) != 0) {
        for (std::uint32_t row = 0; row < entry.rows(); ++row) {
          write_index(body, row, geometry.index_bytes(), row * kRowStep);
        }
      }
      offset += geometry.body_bytes(entry);
    }
  }
}

}  // namespace nutik::bench
