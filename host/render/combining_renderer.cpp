#include "render/combining_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "capture/error.hpp"
#include "capture/memory_needs.hpp"
#include "imev/each_block.hpp"
#include "render/code_scale.hpp"
#include "system/parallel.hpp"

namespace nutik {

namespace {

// What is written for a jump, for times strictly increase.
bool is_jump(const GainPiece& piece) {
  return piece.end_ns - piece.begin_ns <= 1 && piece.at(piece.begin_ns) != piece.at(piece.end_ns);
}

class Combiner {
 public:
  // `gains` are those of the plan's functions. Throws MemoryTooLittle where it takes more than `allowed` bytes; 0: any
  // number.
  Combiner(const RenderPlan& plan, const std::vector<SampleGains>& gains, const Rectangle& rectangle,
           std::uint64_t allowed)
      : plan_(plan),
        rectangle_(rectangle),
        grid_(plan.capture.shape),
        values_(plan.capture.shape.channels * kTilePixels),
        gains_(gains) {
    light_ = plan.capture.transfer.light_of_all_codes(plan.capture.white_code, plan.capture.code_bytes);
    std::vector<std::vector<std::uint16_t>> of_tile(grid_.tile_count());
    for_each_pixel([&](std::uint64_t, std::uint64_t tile, std::uint32_t, std::span<const Share> shares) {
      for (const Share& share : shares) {
        if (std::ranges::find(of_tile[tile], share.of) == of_tile[tile].end()) of_tile[tile].push_back(share.of);
      }
    });
    std::uint64_t codes = 0, lights = 0;
    for (const std::vector<std::uint16_t>& functions : of_tile) {
      for (const std::uint16_t function : functions) {
        codes += keeps_all() ? sizeof(std::uint16_t) * values_ * gains_[function].gains.size() : 0;
        lights += sizeof(double) * values_;
      }
    }
    const MemoryNeeds needs{{"codes of all exposed samples", codes}, {"light of pixels", lights}};
    if (allowed != 0 && needs.bytes() > allowed) throw MemoryTooLittle(allowed, needs);
    for (std::uint64_t tile = 0; tile < of_tile.size(); ++tile) {
      first_places_.push_back(places_.size());
      for (const std::uint16_t function : of_tile[tile]) {
        places_.push_back(
            {tile, function, std::vector<std::uint16_t>(keeps_all() ? values_ * gains_[function].gains.size() : 0),
             std::vector<double>(values_, darkens() ? std::numeric_limits<double>::infinity() : 0.0)});
      }
    }
  }

  void add(const BlockView& block) {
    parallel_for(places_.size(), [&](std::uint64_t i) {
      Place& place = places_[i];
      const std::uint64_t before = block.extent().first_sample;
      const auto clip = [&](std::uint64_t from, std::uint64_t until, auto visit) {
        const SampleRange& samples = gains_[place.function].samples;
        const std::uint64_t first = std::max(before + from, samples.first),
                            last = std::min(before + until, samples.last);
        if (first < last) visit(first - samples.first, last - samples.first);
      };
      const auto add_rows = [&](auto code) {
        block.for_each_row(place.tile, [&](std::uint32_t from, std::uint32_t until, const std::byte* codes) {
          clip(from, until, [&](std::uint64_t first, std::uint64_t last) {
            add_run(place, first, last, reinterpret_cast<const decltype(code)*>(codes), 0, 1);
          });
        });
      };
      if (block.entry(place.tile).is_records()) {
        add_records(block, place, clip);
      } else if (plan_.capture.code_bytes == 1) {
        add_rows(std::uint8_t{});
      } else {
        add_rows(std::uint16_t{});
      }
    });
  }

  [[nodiscard]] Picture light() {
    const std::uint32_t channels = plan_.capture.shape.channels;
    Picture picture({rectangle_.width, rectangle_.height, channels}, ValueType::light64, plan_.capture.white_code);
    parallel_for(places_.size(), [&](std::uint64_t i) { finish(places_[i]); });
    for_each_pixel([&](std::uint64_t i, std::uint64_t tile, std::uint32_t lane, std::span<const Share> shares) {
      for (std::uint32_t channel = 0; channel < channels; ++channel) {
        double sum = 0.0;
        for (const Share& share : shares) {
          std::uint64_t place = first_places_[tile];
          while (places_[place].function != share.of) ++place;
          const double light = places_[place].lights[channel * kTilePixels + lane];
          sum += shares.size() == 1 ? light : share.size * light;
        }
        picture.values<double>()[i * channels + channel] = shares.size() == 1 ? sum : sum / kWholeShare;
      }
    });
    return picture;
  }

 private:
  // A tile whose pixels, or some of them, have a function.
  struct Place {
    std::uint64_t tile;
    std::uint16_t function;
    std::vector<std::uint16_t> codes;  // of the middle one: [value][sample]
    std::vector<double> lights;        // [value]
  };

  [[nodiscard]] bool keeps_all() const { return plan_.combine == Combine::median; }
  [[nodiscard]] bool darkens() const { return plan_.combine == Combine::darken; }

  // Calls visit(pixel of the rectangle, tile, lane, shares).
  template <typename Visit>
  void for_each_pixel(Visit visit) const {
    std::uint64_t i = 0;
    for (std::uint32_t y = rectangle_.y; y < rectangle_.y + rectangle_.height; ++y) {
      for (std::uint32_t x = rectangle_.x; x < rectangle_.x + rectangle_.width; ++x) {
        const std::uint64_t pixel = std::uint64_t{y} * plan_.capture.shape.width + x;
        const std::span<const Share> shares = plan_.shares_of(pixel);
        const Share whole{plan_.function_of(pixel), kWholeShare};
        visit(i++, grid_.tile_of(x, y), TileGrid::lane_of(x, y), shares.empty() ? std::span(&whole, 1) : shares);
      }
    }
  }

  // What a tile's values from `begin` on, each `step`-th, hold from one of the function's samples until before another.
  template <typename Code>
  void add_run(Place& place, std::uint64_t first, std::uint64_t last, const Code* codes, std::size_t begin,
               std::size_t step) const {
    const std::vector<double>& gains = gains_[place.function].gains;
    if (keeps_all()) {
      for (std::size_t i = begin; i < values_; i += step) {
        const auto of_value = place.codes.begin() + static_cast<std::ptrdiff_t>(i * gains.size());
        std::fill_n(of_value + static_cast<std::ptrdiff_t>(first), last - first, codes[i]);
      }
      return;
    }
    for (std::uint64_t sample = first; sample < last; ++sample) {
      const double gain = gains[sample];
      if (gain <= 0.0 || (sample > first && gain == gains[sample - 1])) continue;
      for (std::size_t i = begin; i < values_; i += step) {
        const double light = gain * light_[codes[i]];
        place.lights[i] = darkens() ? std::min(place.lights[i], light) : std::max(place.lights[i], light);
      }
    }
  }

  template <typename Clip>
  void add_records(const BlockView& block, Place& place, Clip clip) const {
    std::vector<ChangeRecord> history;
    std::vector<std::uint16_t> codes(values_);
    for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
      block.read_history(place.tile, lane, history);
      for (std::size_t r = 0; r < history.size(); ++r) {
        for (std::size_t i = lane, channel = 0; i < values_; i += kTilePixels) codes[i] = history[r].codes[channel++];
        clip(history[r].sample, r + 1 < history.size() ? history[r + 1].sample : block.extent().sample_count,
             [&](std::uint64_t first, std::uint64_t last) {
               add_run(place, first, last, codes.data(), lane, kTilePixels);
             });
      }
    }
  }

  // A sample without a gain does not count.
  void finish(Place& place) const {
    const std::vector<double>& gains = gains_[place.function].gains;
    std::vector<double> lights;
    for (std::size_t i = 0; i < values_; ++i) {
      double& light = place.lights[i];
      if (!keeps_all()) {
        if (std::isinf(light)) light = 0.0;
        continue;
      }
      lights.clear();
      for (std::size_t sample = 0; sample < gains.size(); ++sample) {
        if (gains[sample] > 0.0) lights.push_back(gains[sample] * light_[place.codes[i * gains.size() + sample]]);
      }
      if (lights.empty()) continue;
      const auto middle = lights.begin() + static_cast<std::ptrdiff_t>(lights.size() / 2);
      std::ranges::nth_element(lights, middle);
      light = lights.size() % 2 == 1 ? *middle : (*std::max_element(lights.begin(), middle) + *middle) / 2;
    }
  }

  const RenderPlan& plan_;
  Rectangle rectangle_;
  TileGrid grid_;
  std::size_t values_;                     // of a tile
  const std::vector<SampleGains>& gains_;  // by planned function
  std::vector<double> light_;              // of each code
  std::vector<Place> places_;              // by tile
  std::vector<std::uint64_t> first_places_;
};

// Where all codes are kept, so many rows of pixels are made at a time.
std::uint32_t rows_at_once(const RenderPlan& plan, const CaptureSource& source, const Rectangle& rectangle,
                           std::uint64_t allowed) {
  if (plan.combine != Combine::median || source.is_forward_only() || allowed == 0) return rectangle.height;
  const std::uint64_t row_bytes = std::uint64_t{rectangle.width} * plan.capture.shape.channels * sizeof(std::uint16_t) *
                                  std::max<std::uint64_t>(plan.exposed_sample_count(), 1);
  const std::uint64_t rows = allowed / 2 / row_bytes / kTileSide * kTileSide;
  return static_cast<std::uint32_t>(
      std::clamp<std::uint64_t>(rows, std::min(kTileSide, rectangle.height), rectangle.height));
}

}  // namespace

SampleGains::SampleGains(const PlannedFunction& planned, const Timeline& timeline, std::int64_t duration_ns)
    : samples(exposed_samples(planned, timeline)) {
  std::vector<GainPiece> pieces = planned.function.pieces(duration_ns);
  std::erase_if(pieces, is_jump);
  const auto find = [&](bool holds) {
    gains.clear();
    std::size_t piece = 0;
    for (std::uint64_t sample = samples.first; sample < samples.last; ++sample) {
      const std::int64_t start_ns = timeline.start_ns(sample),
                         end_ns = holds ? timeline.reach_end_ns(sample) : timeline.end_ns(sample);
      while (piece + 1 < pieces.size() && pieces[piece].end_ns <= start_ns) ++piece;
      double& largest = gains.emplace_back(0.0);
      for (std::size_t p = piece; p < pieces.size() && pieces[p].begin_ns < end_ns; ++p) {
        if (pieces[p].end_ns <= start_ns) continue;
        for (const std::int64_t time_ns :
             {std::max(start_ns, pieces[p].begin_ns), std::min(end_ns, pieces[p].end_ns)}) {
          const double gain = pieces[p].at(time_ns);
          if (gain < 0.0) throw UsageError("light that is combined takes no gains below 0: they subtract it");
          largest = std::max(largest, gain);
        }
      }
    }
    return std::ranges::any_of(gains, [](double gain) { return gain > 0.0; });
  };
  if (!find(false)) find(true);
}

std::vector<SampleGains> sample_gains(const RenderPlan& plan, const Timeline& timeline) {
  std::vector<SampleGains> gains;
  for (const PlannedFunction& planned : plan.functions) gains.emplace_back(planned, timeline, plan.duration_ns);
  return gains;
}

Rendered CombiningRenderer::render_part(const RenderPlan& plan, CaptureSource& source, const OutputFormat& output,
                                        const Rectangle& rectangle, const RenderControl& control) {
  Rendered rendered;
  const std::vector<SampleGains> gains = sample_gains(plan, source.timeline());
  const std::uint32_t rows = rows_at_once(plan, source, rectangle, control.memory_bytes);
  rendered.picture = Picture({rectangle.width, 0, plan.capture.shape.channels}, output.type, output.white_code);
  std::uint64_t added = 0;
  for (std::uint32_t y = 0; y < rectangle.height; y += rows) {
    Combiner combiner(plan, gains,
                      {rectangle.x, rectangle.y + y, rectangle.width, std::min(rows, rectangle.height - y)},
                      control.memory_bytes);
    BlockCursor cursor(source);
    for (const PlannedBlock& planned : plan.blocks) {
      throw_if_cancelled(control);
      combiner.add(cursor.at(planned.block));
      if (control.progress) control.progress(++added, plan.blocks.size() * ((rectangle.height + rows - 1) / rows));
    }
    const Picture part = stored(combiner.light(), plan.capture, output, rendered.saturation, true);
    rendered.picture.bytes.insert(rendered.picture.bytes.end(), part.bytes.begin(), part.bytes.end());
    rendered.picture.shape.height += part.shape.height;
  }
  return rendered;
}

}  // namespace nutik
