#include "imev/changed_row.hpp"

#include <bit>
#include <cstring>

#include "imev/tile.hpp"

namespace nutik {
namespace {

std::uint32_t code_at(const CaptureFormat& capture, const std::byte* row, std::uint32_t channel,
                      std::uint32_t lane) {
  // Little-endian: the low byte of a wider code is its first.
  std::uint16_t code = 0;
  std::memcpy(&code, row + (channel * kTilePixels + lane) * capture.code_bytes, capture.code_bytes);
  return code;
}

void set_code(const CaptureFormat& capture, std::byte* row, std::uint32_t channel, std::uint32_t lane,
              std::uint32_t code) {
  const auto stored = static_cast<std::uint16_t>(code);
  std::memcpy(row + (channel * kTilePixels + lane) * capture.code_bytes, &stored, capture.code_bytes);
}

bool is_further(const CaptureFormat& capture, const std::byte* held, const std::byte* row,
                std::uint32_t lane) {
  for (std::uint32_t channel = 0; channel < capture.shape.channels; ++channel) {
    const std::uint32_t before = code_at(capture, held, channel, lane),
                        after = code_at(capture, row, channel, lane);
    if ((before > after ? before - after : after - before) > capture.noise.tolerance) return true;
  }
  return false;
}

}  // namespace

void write_change(const CaptureFormat& capture, const PixelChange& change, std::byte* row) {
  const Shape& shape = capture.shape;
  const std::uint32_t x = change.pixel % shape.width, y = change.pixel / shape.width;
  const std::uint32_t left = x % kTileSide, top = y % kTileSide;
  const std::uint32_t right = x + 1 == shape.width ? kTileSide - 1 : left;
  const std::uint32_t bottom = y + 1 == shape.height ? kTileSide - 1 : top;
  for (std::uint32_t channel = 0; channel < shape.channels; ++channel) {
    for (std::uint32_t down = top; down <= bottom; ++down) {
      for (std::uint32_t across = left; across <= right; ++across) {
        set_code(capture, row, channel, down * kTileSide + across, change.codes[channel]);
      }
    }
  }
}

std::uint64_t differing_lanes(const CaptureFormat& capture, const std::byte* held, std::byte* row) {
  std::uint64_t further = 0;
  for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
    if (is_further(capture, held, row, lane)) {
      further |= std::uint64_t{1} << lane;
      continue;
    }
    for (std::uint32_t channel = 0; channel < capture.shape.channels; ++channel) {
      set_code(capture, row, channel, lane, code_at(capture, held, channel, lane));
    }
  }
  return further;
}

}  // namespace nutik
