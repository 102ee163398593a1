#include "scene/differing_cells.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>

#include "scene/clean_plate.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

constexpr std::uint32_t kMaxFineCellsToASide = 480;
constexpr std::uint64_t kNever = ~std::uint64_t{0};

}  // namespace

std::uint32_t Difference::side(const Shape& shape) {
  return (std::max(shape.width, shape.height) - 1) / kMaxFineCellsToASide + 1;
}

Difference::Difference(const CaptureFormat& capture, const Picture& plate, std::uint32_t by_codes)
    : shape_(capture.shape),
      grid_(shape_),
      white_code_(capture.white_code),
      by_codes_(by_codes),
      side_(side(shape_)),
      columns_((shape_.width - 1) / side_ + 1),
      rows_((shape_.height - 1) / side_ + 1),
      plate_(grid_.tile_count() * shape_.channels * kTilePixels * capture.code_bytes),
      difference_(shape_.pixel_count() * capture.code_bytes),
      seen_({columns_, rows_, shape_.channels}, code_type(capture), white_code_),
      seen_plate_(seen_),
      cells_{Region::none(columns_, rows_), Region::none(columns_, rows_),
             std::vector<float>(std::size_t{columns_} * rows_)},
      looked_at_(cells_.contrast.size(), kNever) {
  const std::size_t bytes = capture.code_bytes;
  for (std::uint64_t tile = 0; tile < grid_.tile_count(); ++tile) {
    grid_.for_each_lane(tile, [&](std::uint32_t lane, std::uint64_t pixel) {
      for (std::uint32_t channel = 0; channel < shape_.channels; ++channel) {
        std::memcpy(&plate_[((tile * shape_.channels + channel) * kTilePixels + lane) * bytes],
                    &plate.bytes[(pixel * shape_.channels + channel) * bytes], bytes);
      }
    });
    const std::byte* const codes = &plate_[tile * shape_.channels * kTilePixels * bytes];
    if (bytes == 1) {
      show_tile(static_cast<std::uint32_t>(tile), reinterpret_cast<const std::uint8_t*>(codes), seen_plate_);
    } else {
      show_tile(static_cast<std::uint32_t>(tile), reinterpret_cast<const std::uint16_t*>(codes), seen_plate_);
    }
  }
  seen_ = seen_plate_;
}

const DifferingCells& Difference::at(const Look& look) {
  if (plate_.size() == grid_.tile_count() * shape_.channels * kTilePixels) {
    update<std::uint8_t>(look);
  } else {
    update<std::uint16_t>(look);
  }
  cells_.solid = without_shadow(seen_, seen_plate_, cells_.region);
  return cells_;
}

template <typename Code>
void Difference::update(const Look& look) {
  parallel_for_parts(look.changed.size(), 1024, [&](std::uint64_t first, std::uint64_t last) {
    for (const std::uint32_t tile : look.changed.subspan(first, last - first)) {
      const Code* const codes = reinterpret_cast<const Code*>(look.held.codes(tile));
      update_tile(tile, codes);
      show_tile(tile, codes, seen_);
      mark_cells(tile, look.number);
    }
  });
  parallel_for_parts(cells_.contrast.size(), 1 << 14, [&](std::uint64_t first, std::uint64_t last) {
    for (std::uint64_t cell = first; cell < last; ++cell) {
      if (looked_at_[cell] != look.number) continue;
      update_cell<Code>(static_cast<std::uint32_t>(cell / columns_), static_cast<std::uint32_t>(cell % columns_));
    }
  });
}

// A cell may be several tiles'.
void Difference::mark_cells(std::uint32_t tile, std::uint64_t look) {
  const std::uint32_t left = tile % grid_.columns() * kTileSide, top = tile / grid_.columns() * kTileSide;
  const std::uint32_t right = std::min(left + kTileSide, shape_.width) - 1;
  const std::uint32_t bottom = std::min(top + kTileSide, shape_.height) - 1;
  for (std::uint32_t row = top / side_; row <= bottom / side_; ++row) {
    for (std::uint32_t column = left / side_; column <= right / side_; ++column) {
      std::atomic_ref(looked_at_[std::size_t{row} * columns_ + column]).store(look, std::memory_order_relaxed);
    }
  }
}

template <typename Code>
void Difference::update_tile(std::uint32_t tile, const Code* codes) {
  const std::size_t values = std::size_t{shape_.channels} * kTilePixels;
  const Code* const plate = reinterpret_cast<const Code*>(plate_.data()) + tile * values;
  std::array<Code, kTilePixels> most{};
  for (std::size_t first = 0; first < values; first += kTilePixels) {
    for (std::size_t lane = 0; lane < kTilePixels; ++lane) {
      const Code a = codes[first + lane], b = plate[first + lane];
      const auto apart = static_cast<Code>(std::max(a, b) - std::min(a, b));
      most[lane] = std::max(most[lane], apart);
    }
  }
  const std::uint32_t left = tile % grid_.columns() * kTileSide, top = tile / grid_.columns() * kTileSide;
  const std::uint32_t wide = std::min(kTileSide, shape_.width - left);
  const std::uint32_t high = std::min(kTileSide, shape_.height - top);
  Code* to = reinterpret_cast<Code*>(difference_.data()) + std::size_t{top} * shape_.width + left;
  for (std::uint32_t y = 0; y < high; ++y, to += shape_.width) {
    const Code* const from = most.data() + y * kTileSide;
    if (wide == kTileSide) {
      std::memcpy(to, from, kTileSide * sizeof(Code));  // of a size that is known
    } else {
      std::copy_n(from, wide, to);
    }
  }
}

template <typename Code>
void Difference::show_tile(std::uint32_t tile, const Code* codes, Picture& small) const {
  const std::uint32_t left = tile % grid_.columns() * kTileSide, top = tile / grid_.columns() * kTileSide;
  for (std::uint32_t row = (top + side_ - 1) / side_; row < rows_ && row * side_ < top + kTileSide; ++row) {
    for (std::uint32_t column = (left + side_ - 1) / side_; column < columns_ && column * side_ < left + kTileSide;
         ++column) {
      const std::size_t lane = (row * side_ - top) * kTileSide + column * side_ - left;
      for (std::uint32_t channel = 0; channel < shape_.channels; ++channel) {
        small.values<Code>()[(std::size_t{row} * columns_ + column) * shape_.channels + channel] =
            codes[channel * kTilePixels + lane];
      }
    }
  }
}

template <typename Code>
void Difference::update_cell(std::uint32_t row, std::uint32_t column) {
  const std::uint32_t left = column * side_, top = row * side_;
  const std::uint32_t wide = std::min(side_, shape_.width - left),
                      high = std::min(side_, shape_.height - top);
  std::uint32_t count = 0;
  std::uint64_t sum = 0;
  for (std::uint32_t y = top; y < top + high; ++y) {
    const Code* const apart =
        reinterpret_cast<const Code*>(difference_.data()) + std::size_t{y} * shape_.width + left;
    for (std::uint32_t x = 0; x < wide; ++x) {
      count += apart[x] > by_codes_ ? 1 : 0;
      sum += apart[x];
    }
  }
  const std::size_t cell = std::size_t{row} * columns_ + column;
  cells_.region.inside[cell] = 2 * count >= wide * high;
  cells_.contrast[cell] =
      static_cast<float>(static_cast<double>(sum) / (static_cast<double>(wide) * high * white_code_));
}

}  // namespace nutik
