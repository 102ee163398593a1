#include "scene/clean_plate.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "scene/looks.hpp"
#include "scene/place_times.hpp"
#include "scene/tile_history.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

// What filling holes takes for each pixel: two regions and, where all is one part, that part while it grows.
constexpr std::uint64_t kHoleBytes = 2 + 3 * sizeof(std::size_t);

// Adds to a region its small holes: what it surrounds, and no more than so many pixels of it. A hole that hangs
// together, also over corners, with the picture's border or with more than `max_pixels` stays.
void fill_small_holes(Region& region, std::size_t max_pixels) {
  for (const std::vector<std::size_t>& part : parts_of(inverted(region), 1)) {
    const bool is_surrounded = std::ranges::none_of(part, [&](std::size_t pixel) {
      const std::size_t x = pixel % region.width, y = pixel / region.width;
      return x == 0 || y == 0 || x + 1 == region.width || y + 1 == region.height;
    });
    if (part.size() > max_pixels || !is_surrounded) continue;
    for (const std::size_t pixel : part) region.inside[pixel] = 1;
  }
}

// Finds the light that pixels hold longest, one pixel after another.
class LongestHeld {
 public:
  LongestHeld(const CodeBand& band, std::uint32_t channels)
      : band_(band), channels_(channels), durations_(band.bin_count()) {}

  // Leaves of `held`, which is not empty, what counts as one light. Returns for how long that is held.
  std::uint64_t keep_longest(std::vector<HeldCodes>& held) {
    constexpr std::uint32_t kOrder[] = {1, 0, 2};  // green tells most
    std::uint64_t duration = 0;
    for (std::uint32_t i = 0; i < channels_; ++i) {
      duration = keep_longest(held, channels_ == 1 ? 0 : kOrder[i]);
    }
    return duration;
  }

 private:
  // The same by one channel: moves a window over the bins that are held.
  std::uint64_t keep_longest(std::vector<HeldCodes>& held, std::uint32_t channel) {
    const auto bin_of = [&](const HeldCodes& each) { return band_.bin(channel, each.codes[channel]); };
    std::uint32_t low = ~0u, high = 0;
    std::uint64_t whole = 0;
    for (const HeldCodes& each : held) {
      const std::uint32_t bin = bin_of(each);
      low = std::min(low, bin);
      high = std::max(high, bin);
      whole += each.duration_ns;
    }
    const std::uint32_t window = band_.window();
    if (high - low < window) return whole;
    for (const HeldCodes& each : held) durations_[bin_of(each)] += each.duration_ns;
    std::uint64_t within = 0, longest = 0;
    std::uint32_t best = low;  // where the window of that begins
    for (std::uint32_t bin = low; bin <= high; ++bin) {
      within += durations_[bin];
      if (bin >= low + window) within -= durations_[bin - window];
      if (within > longest) {
        longest = within;
        best = bin + 1 >= low + window ? bin + 1 - window : low;
      }
    }
    std::fill(durations_.begin() + low, durations_.begin() + high + 1, 0);
    std::erase_if(held, [&](const HeldCodes& each) {
      const std::uint32_t bin = bin_of(each);
      return bin < best || bin >= best + window;
    });
    return longest;
  }

  const CodeBand& band_;
  std::uint32_t channels_;
  std::vector<std::uint64_t> durations_;  // by bin; 0 between calls
};

// Makes a plate strip by strip, a strip being rows of tiles.
class PlateMaker {
 public:
  PlateMaker(CaptureSource& capture, const CodeBand& band, const Looks& looks, const ReportedProgress& progress)
      : capture_(capture),
        band_(band),
        progress_(progress),
        grid_(capture.format().shape),
        light_of_code_(capture.format().transfer.light_of_all_codes(capture.format().white_code,
                                                                    capture.format().code_bytes)),
        rooms_(capture.block_count()) {
    const CaptureFormat& format = capture.format();
    const Timeline& timeline = capture.timeline();
    // What is seen at a look holds until the next.
    for (std::uint64_t k = 0; k <= timeline.sample_count(); ++k) {
      const std::uint64_t sample = looks.sample_or_end(looks.from(k));
      starts_ns_.push_back(sample < timeline.sample_count() ? timeline.start_ns(sample)
                                                            : timeline.duration_ns());
    }
    plate_.light = Picture(format.shape, ValueType::light64, format.white_code);
    plate_.uncertain = again_ = Region::none(format.shape.width, format.shape.height);
    sees_all_ = looks.count() == timeline.sample_count();
  }

  void make(std::uint32_t first_row, std::uint32_t last_row) {
    const std::uint64_t first = std::uint64_t{first_row} * grid_.columns();
    const std::uint64_t last = std::uint64_t{last_row} * grid_.columns();
    std::vector<BlockLease> leases;
    std::vector<BlockView> blocks;
    for (std::uint64_t block = 0; block < capture_.block_count(); ++block) {
      PageBuffer& room = rooms_[block];
      leases.push_back(capture_.acquire(
          block, {[&](std::uint64_t bytes) {
                    room.reserve(bytes);
                    return room.first(bytes);
                  },
                  [&](std::uint64_t from, std::uint64_t to) { return from < last && to > first; }}));
      tell(0);
      blocks.emplace_back(capture_.format(), leases.back().extent(), leases.back().payload());
    }
    parallel_for(last_row - first_row,
                 [&](std::uint64_t row) { make_row(blocks, first_row + static_cast<std::uint32_t>(row)); });
    leases.clear();
    for (PageBuffer& room : rooms_) room = {};  // other groups come to lie in it
  }

  // From here on only what is uncertain is made, again: of what it held while its whole place looked as it mostly does.
  // A few pixels amid such a place are part of it: all that stood there may have been as dark at them.
  void look_at_places() {
    const std::size_t side = PlaceTimes::cell_side(capture_.format().shape);
    Region places = plate_.uncertain;
    fill_small_holes(places, side * side);
    times_.emplace(capture_, places, band_, [&] { tell(1, 2); });
    std::size_t pixel = 0;
    for (std::uint32_t y = 0; y < places.height; ++y) {
      for (std::uint32_t x = 0; x < places.width; ++x, ++pixel) {
        if (places.inside[pixel] != 0 && times_->has_look(x, y)) plate_.uncertain.inside[pixel] = 1;
        again_.inside[pixel] = plate_.uncertain.inside[pixel] != 0 && !(sees_all_ && !times_->has_look(x, y));
      }
    }
  }
  // Where a place has no look, all that its pixels held counts, as it did before: of these nothing is made again.
  [[nodiscard]] bool makes_again() const { return again_.pixel_count() > 0; }

  [[nodiscard]] const Region& uncertain() const { return plate_.uncertain; }
  [[nodiscard]] Plate finished() && { return std::move(plate_); }

 private:
  // So many tiles more were made, of so many passes. Any thread tells, one after another: a row of tiles may take long.
  void tell(std::uint64_t tiles, std::uint64_t passes = kPasses) {
    check_interruption();
    if (!progress_) return;
    const std::scoped_lock lock(telling_);
    const std::uint64_t all = grid_.columns() * std::uint64_t{grid_.rows()};
    tiles_ = std::max(tiles_, std::min(tiles_ + tiles, passes * all));
    progress_(tiles_, kPasses * all);
  }

  void make_row(const std::vector<BlockView>& blocks, std::uint32_t tile_row) {
    if (times_) {
      make_uncertain(blocks, tile_row);
    } else if (capture_.format().code_bytes == 1) {
      make_tiles<std::uint8_t>(blocks, tile_row);
    } else {
      make_tiles<std::uint16_t>(blocks, tile_row);
    }
  }

  // Where all codes of a pixel count as one light, it is the mean of all.
  template <typename Code>
  void make_tiles(const std::vector<BlockView>& blocks, std::uint32_t tile_row) {
    LongestHeld longest(band_, channels());
    TileHistory<Code> history(blocks, starts_ns_);
    typename TileHistory<Code>::Codes least, most;
    typename TileHistory<Code>::Light sums;
    std::vector<HeldCodes> held;
    const auto all_ns = static_cast<std::uint64_t>(starts_ns_.back());
    for (std::uint32_t column = 0; column < grid_.columns(); ++column) {
      const std::uint64_t tile = std::uint64_t{tile_row} * grid_.columns() + column;
      history.read(tile);
      history.find_span(least, most);
      const auto is_one_light = [&](std::uint32_t lane) {
        for (std::uint32_t i = lane; i < channels() * kTilePixels; i += kTilePixels) {
          const std::uint32_t channel = i / kTilePixels;
          if (band_.bin(channel, most[i]) - band_.bin(channel, least[i]) >= band_.window()) return false;
        }
        return true;
      };
      sums.fill(0);
      bool has_sums = false;
      grid_.for_each_lane(tile, [&](std::uint32_t lane, std::uint64_t pixel) {
        if (is_one_light(lane)) {
          if (!has_sums) history.add_light(light_of_code_, sums);
          has_sums = true;
          for (std::uint32_t channel = 0; channel < channels(); ++channel) {
            light_of(pixel)[channel] = sums[channel * kTilePixels + lane] / static_cast<double>(all_ns);
          }
        } else {
          history.read_lane(lane, held);
          const std::uint64_t duration_ns = longest.keep_longest(held);
          set(pixel, held, duration_ns);
          plate_.uncertain.inside[pixel] = 2 * duration_ns < all_ns;
        }
      });
      tell(1);
    }
  }

  void make_uncertain(const std::vector<BlockView>& blocks, std::uint32_t tile_row) {
    LongestHeld longest(band_, channels());
    std::vector<ChangeRecord> history;
    std::vector<HeldCodes> held;
    const Shape& shape = capture_.format().shape;
    const std::uint32_t bottom = std::min(shape.height, (tile_row + 1) * kTileSide);
    for (std::uint32_t x = 0; x < shape.width; ++x) {
      if (x % kTileSide == 0) tell(1);
      for (std::uint32_t y = tile_row * kTileSide; y < bottom; ++y) {
        const std::uint64_t pixel = std::uint64_t{y} * shape.width + x;
        if (again_.inside[pixel] == 0) continue;
        held.clear();
        for (const BlockView& block : blocks) {
          block.read_history(grid_.tile_of(x, y), TileGrid::lane_of(x, y), history);
          add(block.extent(), history, x, y, held);
        }
        const std::uint64_t duration_ns = longest.keep_longest(held);
        set(pixel, held, duration_ns);
      }
    }
  }

  // What was held while the place's clock ran.
  void add(const BlockExtent& extent, const std::vector<ChangeRecord>& history, std::uint32_t x,
           std::uint32_t y, std::vector<HeldCodes>& held) const {
    std::int64_t end_ns = times_->clock_ns(x, y, extent.first_sample + history.front().sample);
    for (std::size_t r = 0; r < history.size(); ++r) {
      const std::uint32_t until = r + 1 < history.size() ? history[r + 1].sample : extent.sample_count;
      const std::int64_t begin_ns = std::exchange(end_ns, times_->clock_ns(x, y, extent.first_sample + until));
      const std::int64_t held_ns = end_ns - begin_ns;
      if (held_ns > 0) held.push_back({history[r].codes, static_cast<std::uint64_t>(held_ns)});
    }
  }

  // The mean of what was held as one light.
  void set(std::uint64_t pixel, const std::vector<HeldCodes>& held, std::uint64_t duration_ns) {
    for (std::uint32_t channel = 0; channel < channels(); ++channel) {
      double sum = 0;
      for (const HeldCodes& each : held) {
        sum += light_of_code_[each.codes[channel]] * static_cast<double>(each.duration_ns);
      }
      light_of(pixel)[channel] = sum / static_cast<double>(duration_ns);
    }
  }

  [[nodiscard]] std::uint32_t channels() const { return plate_.light.shape.channels; }
  [[nodiscard]] std::span<double> light_of(std::uint64_t pixel) {
    return plate_.light.values<double>().subspan(pixel * channels(), channels());
  }

  CaptureSource& capture_;
  static constexpr std::uint64_t kPasses = 3;  // looking at places is the second, making them again the third

  const CodeBand& band_;
  const ReportedProgress& progress_;
  std::mutex telling_;
  std::uint64_t tiles_ = 0;  // told of
  TileGrid grid_;
  std::vector<std::int64_t> starts_ns_;  // as TileHistory has them
  std::vector<double> light_of_code_;
  std::vector<PageBuffer> rooms_;  // for blocks that are unpacked
  Plate plate_;
  Region again_;  // what is made a second time
  bool sees_all_ = false;
  std::optional<PlaceTimes> times_;
};

}  // namespace

MemoryNeeds plate_needs(const CaptureFormat& capture) {
  MemoryNeeds needs = PlaceTimes::needs(capture);
  // Which are sought in before anything is looked at.
  const std::uint64_t hole_bytes = capture.shape.pixel_count() * kHoleBytes;
  if (hole_bytes > needs.bytes()) needs = {{"holes of uncertain places", hole_bytes}};
  needs.add("the background", capture.shape.pixel_count() * (capture.shape.channels * sizeof(double) + 4));
  return needs;
}

Plate make_plate(CaptureSource& capture, const CodeBand& band, std::uint64_t memory_bytes,
                 std::uint64_t max_samples,
                 const ReportedProgress& progress) {
  const std::uint32_t rows = TileGrid(capture.format().shape).rows();
  std::uint64_t unpacked_bytes = 0;
  for (std::uint64_t block = 0; block < capture.block_count(); ++block) {
    unpacked_bytes += capture.lent_bytes(block);
  }
  const std::uint64_t row_bytes = unpacked_bytes / rows + 1;
  MemoryNeeds needs = plate_needs(capture.format());
  needs.add("a row of tiles at all samples", row_bytes);
  const auto at_once =
      static_cast<std::uint32_t>(std::min<std::uint64_t>(1 + needs.rest_of(memory_bytes) / row_bytes, rows));
  PlateMaker maker(capture, band, Looks(capture.timeline().sample_count(), max_samples), progress);
  for (std::uint32_t row = 0; row < rows; row += at_once) maker.make(row, std::min(row + at_once, rows));
  if (maker.uncertain().pixel_count() > 0) {
    maker.look_at_places();
    for (std::uint32_t row = 0; row < rows && maker.makes_again(); row += at_once)
      maker.make(row, std::min(row + at_once, rows));
  }
  return std::move(maker).finished();
}

}  // namespace nutik
