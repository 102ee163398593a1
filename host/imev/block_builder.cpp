#include "imev/block_builder.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "imev/expected_values.hpp"
#include "imev/tile_log.hpp"
#include "imev/tile_step.hpp"
#include "system/parallel.hpp"

namespace nutik {

std::uint32_t default_block_samples(const CaptureFormat& capture, std::uint64_t block_bytes) {
  const std::uint64_t fitting = block_bytes / std::max<std::uint64_t>(capture.sample_bytes(), 1);
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(fitting, 1, kDefaultBlockSamples));
}

namespace {

// Whether the largest payload that a block of so many samples may come to stays within the limit. One tile
// takes less than 2^26 bytes, so that only their number needs care.
bool fits_payload(const CaptureFormat& capture, std::uint32_t samples, TilePolicy policy) {
  const BlockGeometry geometry(capture, samples);
  const std::uint64_t room = largest_body_bytes(geometry, policy);
  return geometry.tile_count <= kLargestPayloadBytes / (room + sizeof(TileEntry) + kBlockAlignment);
}

void check_block_samples(const CaptureFormat& capture, std::uint32_t samples, TilePolicy policy) {
  if (samples == 0 || samples > kLargestBlockSamples) {
    throw UsageError(format("a block of {} samples is outside 1 … {}", samples, kLargestBlockSamples));
  }
  if (fits_payload(capture, samples, policy)) return;
  std::uint32_t fitting = 0, too_many = samples;
  while (fitting + 1 < too_many) {
    const std::uint32_t middle = std::midpoint(fitting, too_many);
    (fits_payload(capture, middle, policy) ? fitting : too_many) = middle;
  }
  throw UsageError(format(
      "a block of {} samples of {} x {} pixels may come to more than the {} GiB that a block can have; "
      "use --block-samples {} or less",
      samples, capture.shape.width, capture.shape.height, kLargestPayloadBytes >> 30, fitting));
}

// Calls visit(tile, raster) for every tile of a sample. Tiles at the right and bottom edge are padded first.
template <typename Visit>
void for_each_tile(const CaptureFormat& source, const TileGrid& grid, std::span<const std::byte> sample,
                   Visit visit) {
  const Shape& shape = source.shape;
  const std::size_t value_bytes = std::size_t{shape.channels} * source.code_bytes;
  alignas(64) std::array<std::byte, kTilePixels * 3 * 2> padded;
  std::uint64_t tile = 0;
  for (std::uint32_t top = 0; top < shape.height; top += kTileSide) {
    for (std::uint32_t left = 0; left < shape.width; left += kTileSide, ++tile) {
      if (left + kTileSide <= shape.width && top + kTileSide <= shape.height) {
        visit(tile, TileRaster{sample.data() + (std::size_t{top} * shape.width + left) * value_bytes,
                               std::size_t{shape.width} * shape.channels});
        continue;
      }
      grid.for_each_lane(tile, [&](std::uint32_t lane, std::uint64_t pixel) {
        std::memcpy(padded.data() + lane * value_bytes, sample.data() + pixel * value_bytes, value_bytes);
      });
      visit(tile, TileRaster{padded.data(), std::size_t{kTileSide} * shape.channels});
    }
  }
}

void check_white(const CaptureFormat& source, std::span<const std::byte> raster, std::uint64_t sample) {
  const std::uint32_t largest_possible = source.code_bytes == 1 ? 255 : 65'535;
  if (source.white_code >= largest_possible) return;
  const std::uint32_t largest = largest_code(raster, source.code_bytes);
  if (largest > source.white_code) {
    throw InputError(
        format("sample {} has a code of {}, above the white code {}; state the right one "
               "with --white",
               sample, largest, source.white_code));
  }
}

}  // namespace

class BlockBuilder::Implementation {
 public:
  Implementation(const CaptureFormat& source, std::uint32_t block_samples, TilePolicy policy)
      : source_(source), grid_(source.shape), block_samples_(block_samples), policy_(policy) {}
  virtual ~Implementation() = default;

  void add(std::span<const std::byte> raster) {
    if (raster.size() != source_.sample_bytes()) {
      throw std::logic_error("a sample's raster has the wrong size");
    }
    if (is_full()) throw std::logic_error("a full block was given another sample");
    check_white(source_, raster, first_sample_ + samples_);
    add_sample(raster);
    ++samples_;
  }

  [[nodiscard]] bool is_full() const { return samples_ == block_samples_; }
  [[nodiscard]] bool is_empty() const { return samples_ == 0; }
  [[nodiscard]] BlockExtent extent() const { return {first_sample_, samples_}; }

  FinishedBlock finish(PageBuffer& into) {
    if (is_empty()) throw std::logic_error("a block without samples was finished");
    const FinishedBlock finished = close_block(into);
    begin_next();
    return finished;
  }

  void pass(std::span<const std::byte> raster) {
    if (!is_empty()) throw std::logic_error("a sample was passed over within a block");
    // Where a block starts from its own samples, whatever was held before.
    if (source_.noise.tolerance == 0) {
      ++first_sample_;
      return;
    }
    add(raster);
    begin_next();
  }

 protected:
  virtual void add_sample(std::span<const std::byte> raster) = 0;
  virtual FinishedBlock close_block(PageBuffer& into) = 0;
  virtual void clear() = 0;

  CaptureFormat source_;
  TileGrid grid_;
  std::uint32_t block_samples_;
  TilePolicy policy_;
  std::uint64_t first_sample_ = 0;
  std::uint32_t samples_ = 0;

 private:
  void begin_next() {
    first_sample_ += samples_;
    samples_ = 0;
    clear();
  }
};

// Compares each sample with what is held when it comes: nothing has to be known of later ones.
class BlockBuilder::Comparing final : public Implementation {
 public:
  Comparing(const CaptureFormat& source, std::uint32_t block_samples, TilePolicy policy)
      : Implementation(source, block_samples, policy),
        row_bytes_(BlockGeometry(source, block_samples).row_bytes()),
        step_(step_function(source)),
        held_(grid_.tile_count() * row_bytes_),
        log_(source, block_samples, policy) {}

 private:
  void add_sample(std::span<const std::byte> raster) override {
    const bool starts = samples_ == 0;  // and a start is no record
    TileStep step{};
    // The capture's first sample is held whatever it is: nothing was held before.
    step.tolerance = starts && first_sample_ == 0 ? 0 : source_.noise.tolerance;
    for_each_tile(source_, grid_, raster, [&](std::uint64_t tile, const TileRaster& tile_raster) {
      step.raster = tile_raster;
      step.held = held_.data() + tile * row_bytes_;
      step.counts = starts ? nullptr : log_.counts(tile);
      const std::uint64_t changes = step_(step);
      if (changes == 0 && !starts && policy_ != TilePolicy::dense) return;
      std::memcpy(log_.add_row(tile, samples_, starts ? 0 : changes), step.held, row_bytes_);
    });
  }

  FinishedBlock close_block(PageBuffer& into) override { return log_.finish(samples_, into); }
  void clear() override { log_.clear(); }

  std::uint64_t row_bytes_;
  StepFunction step_;
  PageBuffer held_;  // [tile][C][64] codes
  TileLog log_;
};

// Collects a block's samples: what noisy ones stand for is known when all of them are there.
class BlockBuilder::Averaging final : public Implementation {
 public:
  Averaging(const CaptureFormat& source, std::uint32_t block_samples, TilePolicy policy)
      : Implementation(source, block_samples, policy),
        row_bytes_(BlockGeometry(source, block_samples).row_bytes()),
        gather_(gather_function(source)),
        expected_(source),
        codes_(grid_.tile_count() * block_samples * row_bytes_),
        log_(held_format(source), block_samples, policy) {}

 private:
  [[nodiscard]] std::byte* codes_at(std::uint64_t tile, std::uint32_t sample) {
    return codes_.data() + (tile * block_samples_ + sample) * row_bytes_;
  }

  void add_sample(std::span<const std::byte> raster) override {
    for_each_tile(source_, grid_, raster, [&](std::uint64_t tile, const TileRaster& tile_raster) {
      gather_(tile_raster, codes_at(tile, samples_));
    });
  }

  FinishedBlock close_block(PageBuffer& into) override {
    parallel_for(grid_.rows(), [this](std::uint64_t row) {
      ExpectedValues::Held held;
      const std::uint64_t first = row * grid_.columns();
      for (std::uint64_t tile = first; tile < first + grid_.columns(); ++tile) {
        expected_.find(codes_at(tile, 0), samples_, held);
        log_tile(tile, held);
      }
    });
    return log_.finish(samples_, into);
  }

  void log_tile(std::uint64_t tile, const ExpectedValues::Held& held) {
    const std::size_t row_values = held.codes.size() / samples_;
    std::uint16_t* counts = log_.counts(tile);
    for (std::uint32_t sample = 0; sample < samples_; ++sample) {
      const std::uint64_t changes = held.changes[sample];
      if (changes == 0 && sample != 0 && policy_ != TilePolicy::dense) continue;
      std::memcpy(log_.add_row(tile, sample, changes), held.codes.data() + sample * row_values,
                  row_values * sizeof(std::uint16_t));
      for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
        counts[lane] = static_cast<std::uint16_t>(counts[lane] + (changes >> lane & 1));
      }
    }
  }

  void clear() override { log_.clear(); }

  std::uint64_t row_bytes_;  // of the source's codes
  GatherFunction gather_;
  ExpectedValues expected_;
  PageBuffer codes_;  // [tile][sample][C][64] of the source
  TileLog log_;
};

BlockBuilder::BlockBuilder(const CaptureFormat& source, std::uint32_t block_samples, TilePolicy policy) {
  check_block_samples(held_format(source), block_samples, policy);
  if (source.noise.camera) {
    implementation_ = std::make_unique<Averaging>(source, block_samples, policy);
  } else {
    implementation_ = std::make_unique<Comparing>(source, block_samples, policy);
  }
}

BlockBuilder::~BlockBuilder() = default;
BlockBuilder::BlockBuilder(BlockBuilder&&) noexcept = default;
BlockBuilder& BlockBuilder::operator=(BlockBuilder&&) noexcept = default;

void BlockBuilder::add(std::span<const std::byte> raster) { implementation_->add(raster); }
bool BlockBuilder::is_full() const { return implementation_->is_full(); }
bool BlockBuilder::is_empty() const { return implementation_->is_empty(); }
BlockExtent BlockBuilder::extent() const { return implementation_->extent(); }
FinishedBlock BlockBuilder::finish(PageBuffer& into) { return implementation_->finish(into); }
void BlockBuilder::pass(std::span<const std::byte> raster) { implementation_->pass(raster); }

}  // namespace nutik
