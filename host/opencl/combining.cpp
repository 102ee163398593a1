#include "opencl/combining.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "capture/format.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

// Elements of a table are counted in 32 bits.
constexpr std::uint64_t kMaxTableBytes = 4ull << 30;

// Of no sample, or one without a gain.
double nothing(const RenderPlan& plan) {
  return plan.combine == Combine::darken ? std::numeric_limits<double>::infinity() : 0.0;
}

bool is_one_gain(const SampleGains& each) {
  return each.gains.empty() || (each.gains.front() > 0.0 && std::ranges::all_of(each.gains, [&](double gain) {
                                  return gain == each.gains.front();
                                }));
}

}  // namespace

Combining::Combining(const RenderPlan& plan, std::vector<SampleGains> gains)
    : plan_(plan),
      gains_(std::move(gains)),
      scales_(!std::ranges::all_of(gains_, is_one_gain)),
      light_(plan.capture.transfer.light_of_all_codes(plan.capture.white_code, plan.capture.code_bytes)) {
  if (!scales_) return;
  for (const PlannedBlock& block : plan.blocks)
    levels_ = std::max(levels_, static_cast<std::uint32_t>(std::bit_width(block.extent.sample_count)));
}

bool Combining::has_normal_products() const {
  constexpr double kLeast = std::numeric_limits<double>::min();
  const auto least_light = std::ranges::upper_bound(light_, 0.0);
  return least_light == light_.end() || std::ranges::all_of(gains_, [&](const SampleGains& each) {
           return std::ranges::all_of(each.gains,
                                      [&](double gain) { return gain == 0.0 || gain * *least_light >= kLeast; });
         });
}

std::string Combining::options() const {
  return format(" -DNUTIK_DARKENS={:d} -DNUTIK_SCALES={:d}", plan_.combine == Combine::darken, scales_);
}

std::vector<TableSlice> Combining::slices(DeviceInfo device, std::uint64_t max_bytes) const {
  device.largest_allocation_bytes /= levels_;
  return cut_tables(plan_, Precision::fixed, device, std::min(max_bytes, kMaxTableBytes) / levels_);
}

SliceTables Combining::tables(const TableSlice& slice, DeviceMemory& memory) const {
  const std::size_t functions = gains_.size();
  const std::size_t level_size = scales_ ? rows(slice) * functions : 1;
  std::vector<BlockPart> parts;
  std::vector<double> gains(levels_ * level_size, nothing(plan_));
  for (std::size_t b = slice.first_block; b < slice.last_block; ++b) {
    const auto& [block, extent, table_row] = plan_.blocks[b];
    for (std::size_t f = 0; f < functions; ++f) {
      const SampleRange& exposed = gains_[f].samples;
      const SampleRange held = extent.range();
      const std::uint64_t first = std::clamp(exposed.first, held.first, held.last),
                          last = std::max(first, std::min(exposed.last, held.last));
      const auto in_block = [&](std::uint64_t sample) { return static_cast<std::uint16_t>(sample - held.first); };
      parts.push_back({{in_block(first), in_block(last)}, 0});
      for (std::uint64_t sample = first; scales_ && sample < last; ++sample) {
        const double gain = gains_[f].gains[sample - exposed.first];
        if (gain > 0.0) gains[(table_row - slice.first_row + sample - held.first) * functions + f] = gain;
      }
    }
  }
  for (std::uint32_t level = 1; level < levels_; ++level) {
    const std::size_t half = (std::size_t{1} << (level - 1)) * functions;
    for (std::size_t i = 0; i < level_size; ++i) {
      const double* const from = &gains[(level - 1) * level_size + i];
      const double first = from[0], second = from[i + half < level_size ? half : 0];
      gains[level * level_size + i] = plan_.combine == Combine::darken ? std::min(first, second) : std::max(first, second);
    }
  }
  return {{}, {}, memory.upload(parts), memory.upload(gains)};
}

template <typename Result, typename LightOf>
void Combining::add_results(const ExposedBand& combined, cl::CommandQueue& queue, const Rectangle& rectangle,
                            Picture& picture, LightOf light_of) const {
  const FunctionMap& map = *combined.map.host;
  const std::uint32_t channels = plan_.capture.shape.channels, width = plan_.capture.shape.width;
  std::vector<Result> results(combined.band.sum_tiles * channels * kTilePixels);
  queue.enqueueReadBuffer(combined.sums, CL_TRUE, 0, results.size() * sizeof(Result), results.data());
  const auto to = picture.values<double>();
  parallel_for(combined.band.tile_count, [&](std::uint64_t tile) {
    const std::uint64_t first = map.is_mixed() ? map.first_of[tile] : tile;
    const std::uint64_t last = map.is_mixed() ? map.first_of[tile + 1] : tile + 1;
    const auto light = [&](std::uint64_t of_tile, std::uint32_t channel, std::uint32_t lane, std::uint16_t function) {
      return light_of(results[(of_tile * channels + channel) * kTilePixels + lane], function);
    };
    const auto add_pixel = [&](std::uint32_t lane, std::uint64_t pixel) {
      const std::uint64_t x = pixel % width - rectangle.x, y = pixel / width - rectangle.y;
      if (x >= rectangle.width || y >= rectangle.height) return;  // also what wraps around below 0
      const bool is_blended = !plan_.shares_of(pixel).empty();
      for (std::uint32_t channel = 0; channel < channels; ++channel) {
        double sum = 0.0;
        for (std::uint64_t k = first; k < last; ++k) {
          const std::uint32_t share = last - first == 1 ? kWholeShare : map.shares[k * kTilePixels + lane];
          if (share == 0) continue;
          const auto function = last - first == 1 ? plan_.function_of(pixel) : map.of_lane[k * kTilePixels + lane];
          sum += (is_blended ? share : 1) * light(k, channel, lane, function);
        }
        to[(y * rectangle.width + x) * channels + channel] = is_blended ? sum / kWholeShare : sum;
      }
    };
    TileGrid(plan_.capture.shape).for_each_lane(combined.band.tile_in_picture(tile), add_pixel);
  });
}

void Combining::add_light(const ExposedBand& combined, cl::CommandQueue& queue, const Rectangle& rectangle,
                          Picture& picture) const {
  const auto of_code = [this](std::uint32_t code, std::uint16_t function) {
    const std::vector<double>& gains = gains_[function].gains;
    return gains.empty() ? 0.0 : gains.front() * light_[code];
  };
  if (scales_) {
    add_results<double>(combined, queue, rectangle, picture,
                        [](double light, std::uint16_t) { return std::isinf(light) ? 0.0 : light; });
  } else if (plan_.capture.code_bytes == 1) {
    add_results<std::uint8_t>(combined, queue, rectangle, picture, of_code);
  } else {
    add_results<std::uint16_t>(combined, queue, rectangle, picture, of_code);
  }
}

}  // namespace nutik
