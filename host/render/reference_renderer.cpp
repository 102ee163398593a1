#include "render/reference_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "imev/block.hpp"
#include "render/edge_walk.hpp"
#include "system/page_buffer.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

// Where the walk along one value (a channel of a pixel) has come to.
struct Walk {
  CompensatedSum sum;
  double light = 0.0;  // at the end of the block before
};

class Reference {
 public:
  Reference(const RenderPlan& plan, const Timeline& timeline)
      : plan_(plan),
        timeline_(timeline),
        grid_(plan.capture.shape),
        walks_(plan.capture.shape.value_count()) {
    for (const PlannedFunction& planned : plan.functions) {
      gains_.emplace_back(planned.function.pieces(plan.duration_ns));
    }
  }

  void add_block(const PlannedBlock& planned, const BlockView& block, bool follows_the_one_before) {
    const std::vector<SampleTimes> times = timeline_.times(planned.extent.range());
    std::vector<std::size_t> first_pieces;  // where each function's walk starts
    for (const GainWalk& gain : gains_) first_pieces.push_back(gain.piece_at(times.front().before_ns));
    parallel_for(grid_.rows(), [&](std::uint64_t tile_row) {
      std::vector<ChangeRecord> history;
      for (std::uint32_t column = 0; column < grid_.columns(); ++column) {
        const std::uint64_t tile = tile_row * grid_.columns() + column;
        grid_.for_each_lane(tile, [&](std::uint32_t lane, std::uint64_t pixel) {
          if (TileGrid::lane_of(static_cast<std::uint32_t>(pixel % plan_.capture.shape.width),
                                static_cast<std::uint32_t>(pixel / plan_.capture.shape.width)) != lane) {
            return;  // padding
          }
          block.read_history(tile, lane, history);
          walk_pixel(pixel, history, times, first_pieces[plan_.function_of_pixel[pixel]],
                     follows_the_one_before);
        });
      }
    });
  }

  // Light of value i once all blocks were added.
  [[nodiscard]] double light(std::uint64_t i) const {
    const GainWalk& gain = gains_[plan_.function_of_pixel[i / plan_.capture.shape.channels]];
    if (gain.support_ns() == 0) return 0.0;
    const double mean = walks_[i].sum.value() / static_cast<double>(gain.support_ns());
    return std::scalbn(mean, gain.exponent());
  }

 private:
  void walk_pixel(std::uint64_t pixel, const std::vector<ChangeRecord>& history,
                  const std::vector<SampleTimes>& times, std::size_t first_piece,
                  bool follows_the_one_before) {
    const std::uint32_t channels = plan_.capture.shape.channels;
    const GainWalk& gain = gains_[plan_.function_of_pixel[pixel]];
    for (std::uint32_t channel = 0; channel < channels; ++channel) {
      Walk& walk = walks_[pixel * channels + channel];
      std::size_t piece = first_piece;
      const auto expose = [&](const LightStretch& light) {
        gain.for_each_interval(
            light.begin_ns, light.end_ns, piece,
            [&](std::int64_t begin_ns, std::int64_t end_ns, double gain0, double gain1) {
              walk.sum.add(integrate_interval(static_cast<double>(end_ns - begin_ns), light.at(begin_ns),
                                              light.at(end_ns), gain0, gain1));
            });
      };

      // The gap before the block's first sample, then each record: a ramp across the gap before it,
      // then its constant light until the next record's gap, the block's end or the capture's end.
      for (std::size_t r = 0; r < history.size(); ++r) {
        const ChangeRecord& record = history[r];
        const double light = plan_.capture.transfer.light_of(static_cast<double>(record.codes[channel]) /
                                                             plan_.capture.white_code);
        const SampleTimes& from = times[record.sample];
        const bool has_before = r > 0 || follows_the_one_before;
        expose({from.before_ns, from.start_ns, has_before ? walk.light : light, light});
        const bool is_last = r + 1 == history.size();
        const SampleTimes& until = is_last ? times.back() : times[history[r + 1].sample - 1];
        const bool ends_capture = is_last && until.after_ns == plan_.duration_ns;
        expose({from.start_ns, ends_capture ? until.after_ns : until.end_ns, light, light});
        walk.light = light;
      }
    }
  }

  const RenderPlan& plan_;
  const Timeline& timeline_;
  TileGrid grid_;
  std::vector<GainWalk> gains_;  // by planned function
  std::vector<Walk> walks_;      // by value
};

template <typename Value>
void store_codes(const Reference& reference, const Transfer& transfer, Picture& picture) {
  const auto values = picture.values<Value>();
  for (std::uint64_t i = 0; i < values.size(); ++i) {
    const double fraction = transfer.fraction_of(std::clamp(reference.light(i), 0.0, 1.0));
    values[i] = static_cast<Value>(std::floor(fraction * picture.white_code + 0.5));
  }
}

}  // namespace

Picture ReferenceRenderer::render(const RenderPlan& plan, CaptureSource& source, const OutputFormat& output) {
  Reference reference(plan, source.timeline());
  PageBuffer payload;
  for (std::size_t b = 0; b < plan.blocks.size(); ++b) {
    const PlannedBlock& planned = plan.blocks[b];
    const std::uint64_t bytes = source.prepare(planned.block);
    payload.reserve(bytes);
    source.read(planned.block, payload.first(bytes));
    const bool follows = b > 0 && plan.blocks[b - 1].block + 1 == planned.block;
    reference.add_block(planned, BlockView(plan.capture, planned.extent, payload.first(bytes)), follows);
  }

  Picture picture(plan.capture.shape, output.type, output.white_code);
  switch (output.type) {
    case ValueType::code8: store_codes<std::uint8_t>(reference, plan.capture.transfer, picture); break;
    case ValueType::code16: store_codes<std::uint16_t>(reference, plan.capture.transfer, picture); break;
    case ValueType::light32:
      for (std::uint64_t i = 0; i < picture.shape.value_count(); ++i) {
        picture.values<float>()[i] = static_cast<float>(reference.light(i));
      }
      break;
    case ValueType::light64:
      for (std::uint64_t i = 0; i < picture.shape.value_count(); ++i) {
        picture.values<double>()[i] = reference.light(i);
      }
      break;
  }
  return picture;
}

}  // namespace nutik
