#include "render/reference_renderer.hpp"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "capture/memory_needs.hpp"
#include "imev/each_block.hpp"
#include "render/code_scale.hpp"
#include "render/combining_renderer.hpp"
#include "render/value_walk.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

// Walks along the values of a rectangle, block by block.
class Reference {
 public:
  Reference(const RenderPlan& plan, const Timeline& timeline, const Rectangle& rectangle)
      : plan_(plan), timeline_(timeline), rectangle_(rectangle), grid_(plan.capture.shape) {
    for (const PlannedFunction& planned : plan.functions) {
      gains_.push_back(walk_along(planned, plan.duration_ns));
    }
    std::uint64_t walked = std::uint64_t{rectangle.width} * rectangle.height;
    if (!plan.map->mixed.empty()) {
      first_walks_.push_back(0);
      for (std::uint64_t pixel = 0; pixel < walked; ++pixel) {
        first_walks_.push_back(first_walks_.back() + std::max<std::size_t>(1, shares_at(pixel).size()));
      }
      walked = first_walks_.back();
    }
    walks_.resize(walked * plan.capture.shape.channels);
  }

  void add_block(const PlannedBlock& planned, const BlockView& block, bool follows_the_one_before,
                 const RenderControl& control) {
    const std::vector<SampleTimes> times = timeline_.times(planned.extent.range());
    const WalkedBlock walked{times, follows_the_one_before, times.back().after_ns == plan_.duration_ns};
    std::vector<std::size_t> first_pieces;  // where each function's walk starts
    for (const GainWalk& gain : gains_) first_pieces.push_back(gain.piece_at(times.front().before_ns));
    const std::uint32_t first_row = rectangle_.y / kTileSide;
    const std::uint32_t last_row = (rectangle_.y + rectangle_.height - 1) / kTileSide;
    const std::uint32_t first_column = rectangle_.x / kTileSide;
    const std::uint32_t last_column = (rectangle_.x + rectangle_.width - 1) / kTileSide;
    parallel_for(last_row - first_row + 1, [&](std::uint64_t row) {
      throw_if_cancelled(control);
      std::vector<ChangeRecord> history;
      for (std::uint32_t column = first_column; column <= last_column; ++column) {
        for_each_pixel(column, static_cast<std::uint32_t>(first_row + row),
                       [&](std::uint32_t x, std::uint32_t y, std::uint64_t pixel) {
                         block.read_history(grid_.tile_of(x, y), TileGrid::lane_of(x, y), history);
                         for_each_function(pixel, [&](std::uint64_t walk, std::size_t function) {
                           walk_pixel(walk, history, walked, gains_[function], first_pieces[function]);
                         });
                       });
      }
    });
  }

  // Light of value i of the rectangle once all blocks were added.
  [[nodiscard]] double light(std::uint64_t i) const {
    const std::uint32_t channels = plan_.capture.shape.channels;
    const std::uint64_t pixel = i / channels;
    const auto light_of = [&](std::uint64_t walk, std::size_t function) {
      return exposed_light(walks_[walk * channels + i % channels].sum, gains_[function]);
    };
    const std::span<const Share> shares = shares_at(pixel);
    const std::uint64_t walk = first_walk(pixel);
    if (shares.empty()) return light_of(walk, plan_.function_of(in_picture(pixel)));
    return mixed_light(shares,
                       [&](std::size_t i_share) { return light_of(walk + i_share, shares[i_share].of); });
  }

 private:
  // A pixel of the rectangle, in the picture.
  [[nodiscard]] std::uint64_t in_picture(std::uint64_t pixel) const {
    return (rectangle_.y + pixel / rectangle_.width) * plan_.capture.shape.width + rectangle_.x +
           pixel % rectangle_.width;
  }

  [[nodiscard]] std::span<const Share> shares_at(std::uint64_t pixel) const {
    return plan_.shares_of(in_picture(pixel));
  }

  [[nodiscard]] std::uint64_t first_walk(std::uint64_t pixel) const {
    return first_walks_.empty() ? pixel : first_walks_[pixel];
  }

  // Calls visit(walk, function) for each function that exposes a pixel of the rectangle.
  template <typename Visit>
  void for_each_function(std::uint64_t pixel, Visit visit) const {
    std::uint64_t walk = first_walk(pixel);
    const std::span<const Share> shares = shares_at(pixel);
    if (shares.empty()) visit(walk, plan_.function_of(in_picture(pixel)));
    for (const Share& share : shares) visit(walk++, share.of);
  }

  // Calls visit(x, y, pixel of the rectangle) for the pixels that a tile shares with the rectangle.
  template <typename Visit>
  void for_each_pixel(std::uint32_t tile_column, std::uint32_t tile_row, Visit visit) const {
    const std::uint32_t left = std::max(rectangle_.x, tile_column * kTileSide);
    const std::uint32_t right = std::min(rectangle_.x + rectangle_.width, (tile_column + 1) * kTileSide);
    const std::uint32_t top = std::max(rectangle_.y, tile_row * kTileSide);
    const std::uint32_t bottom = std::min(rectangle_.y + rectangle_.height, (tile_row + 1) * kTileSide);
    for (std::uint32_t y = top; y < bottom; ++y) {
      for (std::uint32_t x = left; x < right; ++x) {
        visit(x, y, std::uint64_t{y - rectangle_.y} * rectangle_.width + (x - rectangle_.x));
      }
    }
  }

  void walk_pixel(std::uint64_t walk, const std::vector<ChangeRecord>& history, const WalkedBlock& block,
                  const GainWalk& gain, std::size_t first_piece) {
    const std::uint32_t channels = plan_.capture.shape.channels;
    for (std::uint32_t channel = 0; channel < channels; ++channel) {
      const auto sample_of = [&](std::size_t r) { return history[r].sample; };
      const auto light_of = [&](std::size_t r) {
        return light_of_code(plan_.capture, history[r].codes[channel]);
      };
      walk_block(walks_[walk * channels + channel], gain, first_piece, block, history.size(), sample_of,
                 light_of, [](const WalkStep&) {});
    }
  }

  const RenderPlan& plan_;
  const Timeline& timeline_;
  Rectangle rectangle_;
  TileGrid grid_;
  std::vector<GainWalk> gains_;  // by planned function
  std::vector<std::uint64_t>
      first_walks_;               // of each pixel of the rectangle, and one more; none of a hard mask
  std::vector<ValueWalk> walks_;  // [walk][channel]: one for each function of each pixel
};

// A rectangle's light.
Picture light_of(const RenderPlan& plan, CaptureSource& source, const Rectangle& rectangle,
                 const RenderControl& control, std::uint32_t white_code) {
  Reference reference(plan, source.timeline(), rectangle);
  BlockCursor cursor(source);
  for (std::size_t b = 0; b < plan.blocks.size(); ++b) {
    const PlannedBlock& planned = plan.blocks[b];
    const bool follows = b > 0 && plan.blocks[b - 1].block + 1 == planned.block;
    reference.add_block(planned, cursor.at(planned.block), follows, control);
    if (control.progress) control.progress((b + 1) * rectangle.height, plan.blocks.size() * rectangle.height);
  }
  throw_if_cancelled(control);
  Picture light({rectangle.width, rectangle.height, plan.capture.shape.channels}, ValueType::light64,
                white_code);
  for (std::uint64_t i = 0; i < light.shape.value_count(); ++i)
    light.values<double>()[i] = reference.light(i);
  return light;
}

// What it takes for each value that it walks along: the walk, its light, and that as it is stored.
constexpr std::uint64_t kWalkBytes = sizeof(ValueWalk) + 2 * sizeof(double);

// How many rows of pixels are walked along at a time. Whole rows of tiles: a tile is read for all of its pixels.
std::uint32_t rows_at_once(const RenderPlan& plan, const CaptureSource& source, const Shape& shape,
                           ValueType type, std::uint64_t allowed) {
  if (allowed == 0) return shape.height;
  std::uint64_t block_bytes = 0;
  for (const PlannedBlock& planned : plan.blocks) {
    block_bytes = std::max(block_bytes, source.lent_bytes(planned.block));
  }
  const std::uint64_t tile_row =
      std::uint64_t{shape.width} * shape.channels * kTileSide * kWalkBytes * plan.map->mixed.max_functions();
  const MemoryNeeds needs{{"the picture", shape.value_count() * value_bytes(type)},
                          {"a block", block_bytes},
                          {"sums of a row of tiles", tile_row}};
  const std::uint64_t rows = (1 + needs.rest_of(allowed) / tile_row) * kTileSide;
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(rows, shape.height));
}

}  // namespace

// In strips, each of which goes through all blocks: one, unless memory is short.
Rendered ReferenceRenderer::render_part(const RenderPlan& plan, CaptureSource& source,
                                        const OutputFormat& output, const Rectangle& rectangle,
                                        const RenderControl& control) {
  if (plan.combine != Combine::integral) {
    RenderControl of_part = control;
    of_part.rectangle = rectangle;
    return CombiningRenderer().render(plan, source, output, of_part);
  }
  const Shape shape{rectangle.width, rectangle.height, plan.capture.shape.channels};
  const std::uint32_t rows = source.is_forward_only()
                                 ? shape.height
                                 : rows_at_once(plan, source, shape, output.type, control.memory_bytes);
  Rendered rendered;
  Picture& picture = rendered.picture;
  if (rows < shape.height) {
    picture = Picture({shape.width, 0, shape.channels}, output.type, output.white_code);
    picture.bytes.reserve(shape.value_count() * value_bytes(output.type));
  }
  for (std::uint32_t y = 0; y < shape.height; y += rows) {
    const Rectangle strip{rectangle.x, rectangle.y + y, rectangle.width, std::min(rows, shape.height - y)};
    RenderControl of_strip = control;
    if (control.progress) {
      of_strip.progress = [&](std::uint64_t done, std::uint64_t) {
        control.progress(y * plan.blocks.size() + done, plan.blocks.size() * shape.height);
      };
    }
    Picture part = stored(light_of(plan, source, strip, of_strip, output.white_code), plan.capture, output,
                          rendered.saturation);
    if (rows == shape.height) {
      picture = std::move(part);
    } else {
      picture.bytes.insert(picture.bytes.end(), part.bytes.begin(), part.bytes.end());
      picture.shape.height += part.shape.height;
    }
  }
  return rendered;
}

}  // namespace nutik
