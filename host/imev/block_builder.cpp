#include "imev/block_builder.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstring>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "imev/expected_values.hpp"
#include "imev/tile_log.hpp"
#include "imev/tile_step.hpp"
#include "system/parallel.hpp"

namespace nutik {

static_assert(BlockBuilder::kSamplesAtOnce == kStepSamples);

std::uint32_t default_block_samples(const CaptureFormat& capture, std::uint64_t block_bytes) {
  const std::uint64_t fitting = block_bytes / std::max<std::uint64_t>(capture.sample_bytes(), 1);
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(fitting, 1, kDefaultBlockSamples));
}

BlockLimits default_block_limits(const CaptureFormat& source, std::uint64_t block_bytes) {
  // The first sample, the changes, and the sample that is one too many.
  const std::uint64_t unchanged = 2 * source.sample_bytes();
  if (source.noise.camera || block_bytes < unchanged + source.sample_bytes()) {
    return default_block_samples(source, std::min(kDefaultBlockBytes, block_bytes));
  }
  return {kDefaultBlockSamples, std::min(kDefaultBlockBytes, block_bytes - unchanged)};
}

namespace {

// What a sample adds to a block where everything changes.
std::uint64_t changing_bytes(const CaptureFormat& capture) {
  const BlockGeometry geometry(capture, 1);
  return geometry.tile_count * geometry.row_bytes();
}

// The samples of a block in which everything always changes.
std::uint32_t busy_samples(const CaptureFormat& capture, const BlockLimits& limits) {
  const std::uint64_t changing = (limits.changed_bytes - 1) / changing_bytes(capture) + 1;
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(limits.samples, changing + 1));
}

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
  throw UsageError(
      format(
          "a block of {} samples of {} x {} pixels may come to more than the {} GiB that a block can have; "
          "use {} or fewer",
          samples, capture.shape.width, capture.shape.height, kLargestPayloadBytes >> 30, fitting),
      {Setting::block_samples});
}

using StripRasters = std::array<const std::byte*, kStepSamples>;

// A tile in every sample of a step. At the right and bottom edge it is padded: pixels outside the picture repeat the
// edge's.
class StepTile {
 public:
  // Tells where it lies in each sample; returns how many values a row is from the next.
  std::size_t take(const CaptureFormat& source, const TileGrid& grid,
                   std::span<const std::span<const std::byte>> samples, std::uint64_t tile, StripRasters& rasters) {
    const auto [width, height, channels] = source.shape;
    const std::size_t value_bytes = std::size_t{channels} * source.code_bytes;
    const std::uint64_t x = tile % grid.columns() * kTileSide, y = tile / grid.columns() * kTileSide;
    const bool is_whole = x + kTileSide <= width && y + kTileSide <= height;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      rasters[k] = is_whole ? samples[k].data() + (y * width + x) * value_bytes : padded_[k].data();
      if (is_whole) continue;
      grid.for_each_lane(tile, [&](std::uint32_t lane, std::uint64_t pixel) {
        std::memcpy(padded_[k].data() + lane * value_bytes, samples[k].data() + pixel * value_bytes, value_bytes);
      });
    }
    return std::size_t{is_whole ? width : kTileSide} * channels;
  }

 private:
  alignas(64) std::array<std::array<std::byte, kTilePixels * 3 * 2>, kStepSamples> padded_;
};

// Calls visit(first tile, count, row_values) for strips of neighbours in a row of tiles, at most kStripTiles each: how
// many values a row of a tile is from the next. `rasters` is then where the first tile lies in every sample: it is not
// handed over, for processors wait where pointers are copied, two at a time, right after they were written one by one.
// Tiles at the right and bottom edge are padded first.
template <typename Visit>
void for_each_strip(const CaptureFormat& source, const TileGrid& grid, std::uint64_t row,
                    std::span<const std::span<const std::byte>> samples, StripRasters& rasters, Visit visit) {
  StepTile tile;
  const std::uint64_t first = row * grid.columns(), end = first + grid.columns();
  const std::uint64_t whole = (row + 1) * kTileSide <= source.shape.height ? source.shape.width / kTileSide : 0;
  for (std::uint64_t at = first, count = 0; at < end; at += count) {
    count = at < first + whole ? std::min<std::uint64_t>(kStripTiles, first + whole - at) : 1;
    const std::size_t row_values = tile.take(source, grid, samples, at, rasters);
    visit(at, static_cast<std::uint32_t>(count), row_values);
  }
}

// The lanes of a tile, as bits, that are pixels of the picture: what pads it has no change records.
std::uint64_t lanes_inside(const Shape& shape, const TileGrid& grid, std::uint64_t tile) {
  const std::uint64_t width = std::min<std::uint64_t>(kTileSide, shape.width - tile % grid.columns() * kTileSide);
  const std::uint64_t height = std::min<std::uint64_t>(kTileSide, shape.height - tile / grid.columns() * kTileSide);
  const std::uint64_t rows = ~std::uint64_t{0} >> (kTilePixels - height * kTileSide);
  return rows & (0xFFU >> (kTileSide - width)) * 0x0101'0101'0101'0101U;
}

void check_white(const CaptureFormat& source, std::uint32_t largest, std::uint64_t sample) {
  if (largest <= source.white_code) return;
  throw InputError(format("sample {} has a code of {}, above the white code {}; state the right one", sample,
                          largest, source.white_code),
                   {Setting::white_code});
}

void check_white(const CaptureFormat& source, std::span<const std::byte> raster, std::uint64_t sample) {
  const std::uint32_t largest_possible = source.code_bytes == 1 ? 255 : 65'535;
  if (source.white_code >= largest_possible) return;
  check_white(source, largest_code(raster, source.code_bytes), sample);
}

void check_white(const CaptureFormat& source, const PixelChange& change, std::uint64_t sample) {
  for (std::uint32_t channel = 0; channel < source.shape.channels; ++channel) {
    check_white(source, change.codes[channel], sample);
  }
}

}  // namespace

class BlockBuilder::Implementation {
 public:
  using Samples = std::span<const std::span<const std::byte>>;  // rasters

  Implementation(const CaptureFormat& source, const BlockLimits& limits, TilePolicy policy)
      : source_(source),
        grid_(source.shape),
        limits_(limits),
        policy_(policy),
        changing_bytes_(changing_bytes(source)) {}
  virtual ~Implementation() = default;

  void add(Samples rasters) {
    if (rasters.size() > room()) throw std::logic_error("a full block was given another sample");
    if (is_empty() && !rasters.empty()) {
      changed_bytes_ = 0;
      begin_block();
    }
    while (!rasters.empty()) {
      // A block's first sample is compared with something else than those after it.
      const std::size_t count = is_empty() ? 1 : std::min<std::size_t>(rasters.size(), kStepSamples);
      for (std::size_t k = 0; k < count; ++k) {
        if (rasters[k].size() != source_.sample_bytes()) {
          throw std::logic_error("a sample's raster has the wrong size");
        }
        check_white(source_, rasters[k], first_sample_ + samples_ + k);
      }
      add_samples(rasters.first(count));
      samples_ += static_cast<std::uint32_t>(count);
      rasters = rasters.subspan(count);
    }
  }

  void add_changes(std::span<const PixelChange> changes) {
    if (room() == 0 || is_empty() || !takes_changes()) {
      throw std::logic_error("a block was told changes of a sample that it does not take like this");
    }
    add_sample_of(changes);
    ++samples_;
  }
  [[nodiscard]] virtual bool takes_changes() const { return false; }

  [[nodiscard]] std::uint32_t room() const {
    if (is_empty()) return std::min(limits_.samples, busy_samples(source_, limits_));
    if (changed_bytes_ >= limits_.changed_bytes) return 0;
    const std::uint64_t changing = (limits_.changed_bytes - changed_bytes_ - 1) / changing_bytes_ + 1;
    return static_cast<std::uint32_t>(
        std::min({std::uint64_t{limits_.samples} - samples_, changing, fitting_memory()}));
  }
  [[nodiscard]] bool is_empty() const { return samples_ == 0; }
  [[nodiscard]] BlockExtent extent() const { return {first_sample_, samples_}; }

  FinishedBlock finish(PageBuffer& into, const std::stop_token& stop) {
    if (is_empty()) throw std::logic_error("a block without samples was finished");
    carry();
    const FinishedBlock finished = close_block(into, stop);
    begin_next();
    return finished;
  }

  void build_in(PageBuffer memory) {
    if (!is_empty()) throw std::logic_error("a block's memory was replaced within it");
    if (memory.size() > 0) take_memory(std::move(memory));
  }

  void pass(std::span<const std::byte> raster) {
    if (!is_empty()) throw std::logic_error("a sample was passed over within a block");
    // Where a block starts from its own samples, whatever was held before.
    if (source_.noise.tolerance == 0) {
      ++first_sample_;
      return;
    }
    add({&raster, 1});
    carry();
    begin_next();
  }

 protected:
  // At most kStepSamples; a block's first one alone.
  virtual void add_samples(Samples samples) = 0;
  virtual void add_sample_of(std::span<const PixelChange> /*changes*/) {}
  // How many more samples the block's memory takes.
  [[nodiscard]] virtual std::uint64_t fitting_memory() const { return limits_.samples; }
  // Keeps what the next block starts from, before this one is closed.
  virtual void carry() {}
  virtual FinishedBlock close_block(PageBuffer& into, const std::stop_token& stop) = 0;
  virtual void begin_block() = 0;
  virtual void take_memory(PageBuffer memory) = 0;

  CaptureFormat source_;
  TileGrid grid_;
  BlockLimits limits_;
  TilePolicy policy_;
  std::uint64_t first_sample_ = 0;
  std::uint32_t samples_ = 0;
  std::uint64_t changing_bytes_;     // by a sample in which everything does
  std::uint64_t changed_bytes_ = 0;  // since the block's first sample

 private:
  void begin_next() {
    first_sample_ += samples_;
    samples_ = 0;
  }
};

// Compares each sample with what is held when it comes: nothing has to be known of later ones.
class BlockBuilder::Comparing final : public Implementation {
  // Where a step writes the rows of tiles that may have no room for them: most have none.
  class SpareRows {
   public:
    [[nodiscard]] std::byte* of_tile(std::uint32_t number) { return rows_[number].data(); }

   private:
    alignas(64) std::array<std::array<std::byte, kStepSamples * kTilePixels * 3 * 2>, kStripTiles> rows_;
  };

 public:
  Comparing(const CaptureFormat& source, const BlockLimits& limits, TilePolicy policy, std::uint32_t threads)
      : Implementation(source, limits, policy),
        threads_(threads),
        row_bytes_(BlockGeometry(source, limits.samples).row_bytes()),
        step_(step_function(source)),
        held_(source.noise.tolerance == 0 ? 0 : grid_.tile_count() * row_bytes_),
        log_(source, limits.samples, policy, limits.memory_bytes) {}

  [[nodiscard]] bool takes_changes() const override { return policy_ != TilePolicy::dense; }

 private:
  // One at a time where tiles that all moved to larger rooms might come to more than twice the limit.
  [[nodiscard]] std::uint64_t fitting_memory() const override {
    if (log_.bytes() >= limits_.memory_bytes) return 0;
    return log_.bytes() < limits_.memory_bytes / 4 ? limits_.samples : 1;
  }

  // Rows of tiles side by side; then, one after the other, the tiles that need more room than they have.
  void add_samples(Samples samples) override {
    constexpr std::uint64_t kBytesAtOnce = 1 << 20;  // another thread takes longer to begin than fewer take
    const std::uint64_t rows = kBytesAtOnce / (grid_.columns() * row_bytes_ * samples.size()) + 1;
    std::vector<std::vector<std::uint64_t>> without_room(grid_.rows());
    std::atomic<std::uint64_t> changed_bytes = 0;
    const auto add_rows_of_tiles = [&](std::uint64_t first, std::uint64_t last) {
      for (std::uint64_t row = first; row < last; ++row) {
        changed_bytes += add_row_of_tiles(row, samples, without_room[row]);
      }
    };
    parallel_for_parts(grid_.rows(), rows, add_rows_of_tiles, threads_);
    if (is_empty()) return;  // a start is no record, and has room
    const auto count = static_cast<std::uint32_t>(samples_ + samples.size());
    const BlockCourse course{count, expected_samples(count)};
    changed_bytes_ += changed_bytes;
    for (const std::vector<std::uint64_t>& tiles : without_room) {
      for (const std::uint64_t tile : tiles) add_to_larger_room(tile, samples, course);
    }
  }

  // Returns how many bytes the new rows take. Tiles without room for theirs are listed, and stay as they are.
  std::uint64_t add_row_of_tiles(std::uint64_t row, Samples samples, std::vector<std::uint64_t>& without_room) {
    const bool starts = is_empty();
    std::uint64_t changed_bytes = 0;
    StripStep step = step_of(samples);
    SpareRows spare_rows;
    std::array<std::byte*, kStripTiles> from;
    const auto visit = [&](std::uint64_t first, std::uint32_t tiles, std::size_t row_values) {
      step.row_values = row_values;
      step.tile_count = tiles;
      for (std::uint32_t i = 0; i < tiles; ++i) {
        log_.fetch_list(first + i);
        const bool has_room = log_.has_room(first + i, step.sample_count);
        step.next[i] = from[i] = has_room ? log_.next_row(first + i) : spare_rows.of_tile(i);
        step.held[i] = starts ? held_before(first + i, step.next[i]) : log_.last_row(first + i);
      }
      step_(step);
      for (std::uint32_t i = 0; i < tiles; ++i) {
        const auto written = static_cast<std::uint64_t>(step.next[i] - from[i]);
        if (written == 0) continue;
        if (from[i] == spare_rows.of_tile(i)) {
          without_room.push_back(first + i);
        } else {
          changed_bytes += written;
          list_rows(first + i, step, i);
        }
      }
    };
    for_each_strip(source_, grid_, row, samples, step.rasters, visit);
    return changed_bytes;
  }

  void add_to_larger_room(std::uint64_t tile, Samples samples, BlockCourse course) {
    StripStep step = step_of(samples);
    StepTile raster;
    SpareRows rows;
    step.row_values = raster.take(source_, grid_, samples, tile, step.rasters);
    step.tile_count = 1;
    step.held[0] = log_.last_row(tile);
    step.next[0] = rows.of_tile(0);
    step_(step);
    const auto written = static_cast<std::uint64_t>(step.next[0] - rows.of_tile(0));
    log_.make_room(tile, static_cast<std::uint32_t>(written / row_bytes_), course);
    std::memcpy(log_.next_row(tile), rows.of_tile(0), written);
    changed_bytes_ += written;
    list_rows(tile, step, 0);
  }

  [[nodiscard]] StripStep step_of(Samples samples) const {
    StripStep step{};
    step.sample_count = static_cast<std::uint32_t>(samples.size());
    // The capture's first sample is held whatever it is: nothing was held before.
    const bool is_first = is_empty() && first_sample_ == 0;
    step.tolerance = is_first ? 0 : source_.noise.tolerance;
    step.steps = CodeSteps::of(source_);
    step.writes_all = is_empty() || policy_ == TilePolicy::dense;
    return step;
  }

  // Tells the log the samples of a tile's new rows, which a step wrote where they belong. `number` is the tile's in the
  // step's strip.
  void list_rows(std::uint64_t tile, const StripStep& step, std::uint32_t number) {
    std::array<std::uint16_t, kStepSamples> at;
    const std::uint64_t inside = lanes_inside(source_.shape, grid_, tile);
    std::uint32_t rows = 0, changes = inside == ~std::uint64_t{0} ? step.change_counts[number] : 0;
    for (std::uint32_t k = 0; k < step.sample_count; ++k) {
      if (inside != ~std::uint64_t{0})
        changes += static_cast<std::uint32_t>(std::popcount(step.changes[k][number] & inside));
      at[rows] = static_cast<std::uint16_t>(samples_ + k);
      rows += step.writes_all || step.changes[k][number] != 0 ? 1 : 0;
    }
    log_.add_rows(tile, std::span(at).first(rows), is_empty() ? 0 : changes);
  }

  void add_sample_of(std::span<const PixelChange> changes) override {
    changed_tiles_.clear();
    for (const PixelChange& change : changes) {
      if (change.pixel >= source_.shape.pixel_count()) {
        throw std::logic_error("a change lies outside the picture");
      }
      check_white(source_, change, first_sample_ + samples_);
      const std::uint32_t x = change.pixel % source_.shape.width, y = change.pixel / source_.shape.width;
      changed_tiles_.emplace_back(grid_.tile_of(x, y), &change);
    }
    // Changes of one tile side by side, in the order in which they came.
    std::ranges::sort(changed_tiles_);
    const BlockCourse course{samples_ + 1, expected_samples(samples_ + 1)};
    for (auto at = changed_tiles_.begin(); at != changed_tiles_.end();) {
      const std::uint64_t tile = at->first;
      alignas(64) std::array<std::byte, kTilePixels * 3 * 2> row;
      std::memcpy(row.data(), log_.last_row(tile), row_bytes_);
      for (; at != changed_tiles_.end() && at->first == tile; ++at) write_change(source_, *at->second, row.data());
      add_row(tile, row.data(), course);
    }
  }

  // What a tile holds from this sample on, as far as it differs from what it held by more than the tolerance.
  void add_row(std::uint64_t tile, std::byte* row, BlockCourse course) {
    const std::byte* const held = log_.last_row(tile);
    const std::uint64_t changed = differing_lanes(source_, held, row);
    if (changed == 0) return;
    if (!log_.has_room(tile, 1)) log_.make_room(tile, 1, course);
    std::memcpy(log_.next_row(tile), row, row_bytes_);
    const auto at = static_cast<std::uint16_t>(samples_);
    const std::uint64_t inside = lanes_inside(source_.shape, grid_, tile);
    log_.add_rows(tile, {&at, 1}, static_cast<std::uint32_t>(std::popcount(changed & inside)));
    changed_bytes_ += row_bytes_;
  }

  // How many samples the block will have if it goes on changing as it did so far: before that is known, as many as the
  // one before it. `samples` is how many there are with those that are being added.
  [[nodiscard]] std::uint32_t expected_samples(std::uint32_t samples) const {
    if (samples_ <= 1) return std::max(samples_before_, std::min(2 * samples, limits_.samples));
    const std::uint64_t changed_by_sample = std::max<std::uint64_t>(changed_bytes_ / (samples_ - 1), 1);
    const std::uint64_t more = std::min<std::uint64_t>(
        (limits_.changed_bytes - changed_bytes_) / changed_by_sample, limits_.samples);
    // An eighth more than that: where the guess is one short, all busy tiles have to move once again.
    return static_cast<std::uint32_t>(
        std::clamp<std::uint64_t>((samples_ + more) * 9 / 8 + 1, samples, limits_.samples));
  }

  // What a tile held at the end of the block before. Without a tolerance a block starts from its own sample
  // whatever that was, and the room for its first row serves as well.
  [[nodiscard]] const std::byte* held_before(std::uint64_t tile, const std::byte* first_row) const {
    return source_.noise.tolerance == 0 ? first_row : held_.data() + tile * row_bytes_;
  }
  void carry() override {
    if (source_.noise.tolerance == 0) return;
    for (std::uint64_t tile = 0; tile < grid_.tile_count(); ++tile) {
      std::memcpy(held_.data() + tile * row_bytes_, log_.last_row(tile), row_bytes_);
    }
  }
  FinishedBlock close_block(PageBuffer& into, const std::stop_token& /*stop*/) override {
    samples_before_ = samples_;
    return log_.finish(samples_, into);
  }
  void begin_block() override { log_.begin(); }
  void take_memory(PageBuffer memory) override { log_.take_memory(std::move(memory)); }

  std::uint32_t threads_;
  std::uint64_t row_bytes_;
  StepFunction step_;
  std::vector<std::pair<std::uint64_t, const PixelChange*>> changed_tiles_;  // of a sample
  PageBuffer held_;  // [tile][C][64] codes at the end of the block before, where there is a tolerance
  TileLog log_;
  std::uint32_t samples_before_ = 0;  // of the block before
};

// Collects a block's samples: what noisy ones stand for is known when all of them are there.
class BlockBuilder::Averaging final : public Implementation {
 public:
  Averaging(const CaptureFormat& source, const BlockLimits& limits, TilePolicy policy)
      : Implementation(source, limits, policy),
        row_bytes_(BlockGeometry(source, limits.samples).row_bytes()),
        gather_(gather_function(source)),
        expected_(source),
        codes_(grid_.tile_count() * limits.samples * row_bytes_),
        log_(held_format(source), limits.samples, policy) {}

 private:
  [[nodiscard]] std::byte* codes_at(std::uint64_t tile, std::uint32_t sample) {
    return codes_.data() + (tile * limits_.samples + sample) * row_bytes_;
  }

  void add_samples(Samples samples) override {
    const std::size_t tile_bytes = std::size_t{kTileSide} * source_.shape.channels * source_.code_bytes;
    StripRasters rasters{};
    const auto visit = [&](std::uint64_t first, std::uint32_t tiles, std::size_t row_values) {
      for (std::uint32_t i = 0; i < tiles; ++i) {
        for (std::uint32_t k = 0; k < samples.size(); ++k) {
          gather_({rasters[k] + i * tile_bytes, row_values}, codes_at(first + i, samples_ + k));
        }
      }
    };
    for (std::uint64_t row = 0; row < grid_.rows(); ++row) {
      for_each_strip(source_, grid_, row, samples, rasters, visit);
    }
  }

  FinishedBlock close_block(PageBuffer& into, const std::stop_token& stop) override {
    parallel_for(grid_.rows(), [&](std::uint64_t row) {
      if (stop.stop_requested()) throw Cancelled();
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
    const std::uint64_t inside = lanes_inside(source_.shape, grid_, tile);
    for (std::uint32_t sample = 0; sample < samples_; ++sample) {
      const std::uint64_t changes = held.changes[sample];
      if (changes == 0 && sample != 0 && policy_ != TilePolicy::dense) continue;
      std::memcpy(log_.next_row(tile), held.codes.data() + sample * row_values,
                  row_values * sizeof(std::uint16_t));
      const auto at = static_cast<std::uint16_t>(sample);
      log_.add_rows(tile, {&at, 1}, static_cast<std::uint32_t>(std::popcount(changes & inside)));
    }
  }

  void begin_block() override { log_.begin_full(); }
  void take_memory(PageBuffer memory) override { log_.take_memory(std::move(memory)); }

  std::uint64_t row_bytes_;  // of the source's codes
  GatherFunction gather_;
  ExpectedValues expected_;
  PageBuffer codes_;  // [tile][sample][C][64] of the source
  TileLog log_;
};

BlockBuilder::BlockBuilder(const CaptureFormat& source, const BlockLimits& limits, TilePolicy policy,
                           std::uint32_t threads) {
  const CaptureFormat held = held_format(source);
  check_block_samples(held, limits.samples == 0 ? 0 : busy_samples(held, limits), policy);
  if (source.noise.camera) {
    implementation_ = std::make_unique<Averaging>(source, limits, policy);
  } else {
    implementation_ = std::make_unique<Comparing>(source, limits, policy, threads);
  }
}

BlockBuilder::~BlockBuilder() = default;
BlockBuilder::BlockBuilder(BlockBuilder&&) noexcept = default;
BlockBuilder& BlockBuilder::operator=(BlockBuilder&&) noexcept = default;

void BlockBuilder::add(std::span<const std::byte> raster) { implementation_->add({&raster, 1}); }
void BlockBuilder::add(std::span<const std::span<const std::byte>> rasters) { implementation_->add(rasters); }
bool BlockBuilder::takes_changes() const { return implementation_->takes_changes(); }
void BlockBuilder::add_changes(std::span<const PixelChange> changes) {
  implementation_->add_changes(changes);
}
std::uint32_t BlockBuilder::room() const { return implementation_->room(); }
bool BlockBuilder::is_empty() const { return implementation_->is_empty(); }
BlockExtent BlockBuilder::extent() const { return implementation_->extent(); }
FinishedBlock BlockBuilder::finish(PageBuffer& into, const std::stop_token& stop) {
  return implementation_->finish(into, stop);
}
void BlockBuilder::build_in(PageBuffer memory) { implementation_->build_in(std::move(memory)); }
void BlockBuilder::pass(std::span<const std::byte> raster) { implementation_->pass(raster); }

}  // namespace nutik
