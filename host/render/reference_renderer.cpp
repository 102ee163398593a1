#include "render/reference_renderer.hpp"

#include <vector>

#include "imev/block.hpp"
#include "render/code_scale.hpp"
#include "render/value_walk.hpp"
#include "system/page_buffer.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

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
    const WalkedBlock walked{times, follows_the_one_before, times.back().after_ns == plan_.duration_ns};
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
          walk_pixel(pixel, history, walked, first_pieces[plan_.function_of_pixel[pixel]]);
        });
      }
    });
  }

  // Light of value i once all blocks were added.
  [[nodiscard]] double light(std::uint64_t i) const {
    return exposed_light(walks_[i].sum, gains_[plan_.function_of_pixel[i / plan_.capture.shape.channels]]);
  }

 private:
  void walk_pixel(std::uint64_t pixel, const std::vector<ChangeRecord>& history, const WalkedBlock& block,
                  std::size_t first_piece) {
    const std::uint32_t channels = plan_.capture.shape.channels;
    const GainWalk& gain = gains_[plan_.function_of_pixel[pixel]];
    for (std::uint32_t channel = 0; channel < channels; ++channel) {
      const auto sample_of = [&](std::size_t r) { return history[r].sample; };
      const auto light_of = [&](std::size_t r) {
        return light_of_code(plan_.capture, history[r].codes[channel]);
      };
      walk_block(walks_[pixel * channels + channel], gain, first_piece, block, history.size(), sample_of,
                 light_of, [](const WalkStep&) {});
    }
  }

  const RenderPlan& plan_;
  const Timeline& timeline_;
  TileGrid grid_;
  std::vector<GainWalk> gains_;   // by planned function
  std::vector<ValueWalk> walks_;  // by value
};

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

  saturation_ = {};
  if (output.type == ValueType::light32) {
    Picture picture(plan.capture.shape, output.type, output.white_code);
    for (std::uint64_t i = 0; i < picture.shape.value_count(); ++i) {
      picture.values<float>()[i] = static_cast<float>(reference.light(i));
    }
    return picture;
  }
  Picture light(plan.capture.shape, ValueType::light64, output.white_code);
  for (std::uint64_t i = 0; i < light.shape.value_count(); ++i) {
    light.values<double>()[i] = reference.light(i);
  }
  if (output.type == ValueType::light64) return light;
  const CodeScale scale(plan.capture.transfer, output);
  saturation_ = count_saturated(light, scale);
  return encoded(light, scale, output);
}

}  // namespace nutik
