#include "opencl/sample_combiner.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "capture/format.hpp"
#include "render/code_scale.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

// Elements of a table are counted in 32 bits.
constexpr std::uint64_t kMaxTableBytes = 4ull << 30;

// What changes no result: a sample without a gain is that, and so is none.
double nothing(const RenderPlan& plan) {
  return plan.combine == Combine::darken ? std::numeric_limits<double>::infinity() : 0.0;
}

bool is_one_gain(const SampleGains& each) {
  return each.gains.empty() || (each.gains.front() > 0.0 && std::ranges::all_of(each.gains, [&](double gain) {
                                  return gain == each.gains.front();
                                }));
}

// Rows of tiles whose light is there at a time.
constexpr std::uint32_t kRowsAtOnce = 16 * kTileSide;

// Calls visit(tile of the band, lane, pixel of the picture, pixel of the rectangle) for each pixel that both have.
template <typename Visit>
void for_each_pixel(const Band& band, const Shape& shape, const Rectangle& rectangle, Visit visit) {
  const std::uint32_t columns = TileGrid(shape).columns();
  parallel_for(band.tile_count / band.columns, [&](std::uint64_t row) {
    for (std::uint64_t tile = row * band.columns; tile < (row + 1) * band.columns; ++tile) {
      const std::uint64_t in_picture = band.tile_in_picture(tile);
      const auto left = static_cast<std::uint32_t>(in_picture % columns) * kTileSide;
      const auto top = static_cast<std::uint32_t>(in_picture / columns) * kTileSide;
      const std::uint32_t right = std::min(left + kTileSide, rectangle.x + rectangle.width);
      const std::uint32_t bottom = std::min(top + kTileSide, rectangle.y + rectangle.height);
      for (std::uint32_t y = std::max(top, rectangle.y); y < bottom; ++y) {
        for (std::uint32_t x = std::max(left, rectangle.x); x < right; ++x) {
          visit(tile, TileGrid::lane_of(x, y), std::uint64_t{y} * shape.width + x,
                std::uint64_t{y - rectangle.y} * rectangle.width + (x - rectangle.x));
        }
      }
    }
  });
}

}  // namespace

SampleCombiner::SampleCombiner(const RenderPlan& plan, std::vector<SampleGains> gains)
    : plan_(plan),
      gains_(std::move(gains)),
      scales_(!std::ranges::all_of(gains_, is_one_gain)),
      light_(plan.capture.transfer.light_of_all_codes(plan.capture.white_code, plan.capture.code_bytes)) {
  if (!scales_) return;
  for (const PlannedBlock& block : plan.blocks)
    levels_ = std::max(levels_, static_cast<std::uint32_t>(std::bit_width(block.extent.sample_count)));
}

bool SampleCombiner::has_normal_products() const {
  constexpr double kLeast = std::numeric_limits<double>::min();
  const auto least_light = std::ranges::upper_bound(light_, 0.0);
  return least_light == light_.end() || std::ranges::all_of(gains_, [&](const SampleGains& each) {
           return std::ranges::all_of(each.gains,
                                      [&](double gain) { return gain == 0.0 || gain * *least_light >= kLeast; });
         });
}

std::string SampleCombiner::options() const {
  return format(" -DNUTIK_DARKENS={:d} -DNUTIK_SCALES={:d}", plan_.combine == Combine::darken, scales_);
}

std::vector<TableSlice> SampleCombiner::slices(const DeviceInfo& device, std::uint64_t max_bytes) const {
  return cut_tables(plan_, {sizeof(double), false, levels_}, device, std::min(max_bytes, kMaxTableBytes));
}

SliceTables SampleCombiner::tables(const TableSlice& slice, DeviceMemory& memory) const {
  const std::size_t functions = gains_.size();
  const auto rows = static_cast<std::uint32_t>(slice.last_row - slice.first_row);
  const std::size_t level_size = scales_ ? rows * functions : 1;
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
      const bool darkens = plan_.combine == Combine::darken;
      gains[level * level_size + i] = darkens ? std::min(first, second) : std::max(first, second);
    }
  }
  return {{}, {}, memory.upload(parts), memory.upload(gains), rows};
}

// The light of a part of the picture.
template <typename Result, typename LightOf>
Picture SampleCombiner::light_of(const ExposedBand& combined, std::span<const Result> results, const Rectangle& part,
                            LightOf light_of_result) const {
  const FunctionMap& map = *combined.map.host;
  const std::uint32_t channels = plan_.capture.shape.channels;
  Picture picture({part.width, part.height, channels}, ValueType::light64, plan_.capture.white_code);
  const auto to = picture.values<double>();
  const auto add = [&](std::uint64_t tile, std::uint32_t lane, std::uint64_t pixel, std::uint64_t in_part) {
    const std::uint64_t first = map.is_mixed() ? map.first_of[tile] : tile;
    const std::uint64_t last = map.is_mixed() ? map.first_of[tile + 1] : tile + 1;
    const bool is_one = last - first == 1, is_blended = !plan_.shares_of(pixel).empty();
    for (std::uint32_t channel = 0; channel < channels; ++channel) {
      double sum = 0.0;
      for (std::uint64_t k = first; k < last; ++k) {
        const std::uint32_t share = is_one ? kWholeShare : map.shares[k * kTilePixels + lane];
        if (share == 0) continue;
        const std::uint16_t function = is_one ? plan_.function_of(pixel) : map.of_lane[k * kTilePixels + lane];
        sum += (is_blended ? share : 1) *
               light_of_result(results[(k * channels + channel) * kTilePixels + lane], function);
      }
      to[in_part * channels + channel] = is_blended ? sum / kWholeShare : sum;
    }
  };
  for_each_pixel(combined.band, plan_.capture.shape, part, add);
  return picture;
}

// Codes of 8 bits become codes by a table.
template <typename Code>
void SampleCombiner::develop_codes(const ExposedBand& combined, std::span<const std::uint8_t> results,
                              const CombinedPicture& to) const {
  const CodeMaking making = CodeMaking::of(plan_.capture, to.output);
  const CodeScale scale(making.transfer, to.output);
  const auto functions = static_cast<std::uint32_t>(gains_.size());
  Picture lights({static_cast<std::uint32_t>(light_.size()), functions, 1}, ValueType::light64, 0);
  for (std::size_t i = 0; i < lights.shape.value_count(); ++i)
    lights.values<double>()[i] = light_of_code(static_cast<std::uint32_t>(i % light_.size()), i / light_.size());
  to_shown_light(lights, making);
  const Picture codes = encoded(lights, scale, to.output);
  std::vector<std::uint8_t> ends;  // 1: saturates below, 2: above
  for (const double light : lights.values<double>())
    ends.push_back((scale.saturates_below(light) ? 1 : 0) | (scale.saturates_above(light) ? 2 : 0));
  const auto table = codes.values<Code>();
  const auto out = to.picture.values<Code>();
  const std::uint32_t channels = plan_.capture.shape.channels;
  std::atomic<std::uint64_t> below{0}, above{0};
  for_each_pixel(combined.band, plan_.capture.shape, to.rectangle,
                 [&](std::uint64_t tile, std::uint32_t lane, std::uint64_t pixel, std::uint64_t in_rectangle) {
                   const std::size_t of_function = plan_.function_of(pixel) * light_.size();
                   unsigned end = 0;
                   for (std::uint32_t channel = 0; channel < channels; ++channel) {
                     const std::size_t at = of_function + results[(tile * channels + channel) * kTilePixels + lane];
                     out[in_rectangle * channels + channel] = table[at];
                     end |= ends[at];
                   }
                   if ((end & 1) != 0) ++below;
                   if ((end & 2) != 0) ++above;
                 });
  to.saturation += {below, above};
}

template <typename Result, typename LightOf>
void SampleCombiner::develop_results(const ExposedBand& combined, cl::CommandQueue& queue, const CombinedPicture& to,
                                LightOf light_of_result) const {
  const Band& band = combined.band;
  std::vector<Result> results(band.sum_tiles * plan_.capture.shape.channels * kTilePixels);
  queue.enqueueReadBuffer(combined.sums, CL_TRUE, 0, results.size() * sizeof(Result), results.data());
  const bool has_table = holds_codes(to.output.type) && plan_.map->mixed.empty() &&
                         !CodeMaking::of(plan_.capture, to.output).conversion;
  if constexpr (sizeof(Result) == 1) {
    if (has_table && to.output.type == ValueType::code8) return develop_codes<std::uint8_t>(combined, results, to);
    if (has_table) return develop_codes<std::uint16_t>(combined, results, to);
  }
  const std::uint64_t row_bytes = to.picture.bytes.size() / to.picture.shape.height;
  const std::uint32_t top = std::max(band.first_row, to.rectangle.y);
  const std::uint32_t bottom = std::min(band.first_row + band.shape.height, to.rectangle.y + to.rectangle.height);
  for (std::uint32_t y = top; y < bottom; y += kRowsAtOnce) {
    const Rectangle part{to.rectangle.x, y, to.rectangle.width, std::min(kRowsAtOnce, bottom - y)};
    const Picture made = stored(light_of(combined, std::span<const Result>(results), part, light_of_result),
                                plan_.capture, to.output, to.saturation, true);
    const auto row = to.picture.bytes.begin() + static_cast<std::ptrdiff_t>((y - to.rectangle.y) * row_bytes);
    std::ranges::copy(made.bytes, row);
  }
}

double SampleCombiner::light_of_code(std::uint32_t code, std::size_t function) const {
  const std::vector<double>& gains = gains_[function].gains;
  return gains.empty() ? 0.0 : gains.front() * light_[code];
}

void SampleCombiner::develop(const ExposedBand& combined, cl::CommandQueue& queue, const CombinedPicture& to) const {
  const auto of_code = [this](std::uint32_t code, std::size_t function) { return light_of_code(code, function); };
  if (scales_) {
    develop_results<double>(combined, queue, to,
                            [](double light, std::size_t) { return std::isinf(light) ? 0.0 : light; });
  } else if (plan_.capture.code_bytes == 1) {
    develop_results<std::uint8_t>(combined, queue, to, of_code);
  } else {
    develop_results<std::uint16_t>(combined, queue, to, of_code);
  }
}

}  // namespace nutik
