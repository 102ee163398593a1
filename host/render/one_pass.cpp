#include "render/one_pass.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "imev/each_block.hpp"
#include "imev/sample_cursor.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

constexpr std::uint64_t kMostValues = 1u << 14;  // of a picture
constexpr std::uint64_t kSumBytes = 32u << 20;   // of all pictures of a pass
constexpr std::size_t kMostPictures = 4096;      // of a pass, whose plans are kept
constexpr std::uint64_t kLightBytes = 4u << 20;  // of samples that are weighed together

// A plan's sums: of the block that is read, and of all before.
struct Sums {
  explicit Sums(const RenderPlan& plan, std::size_t values)
      : table(*plan.functions.front().table),
        exponent(plan.functions.front().table->summary().exponent),
        block(values),
        all(values) {}

  void start(std::uint64_t number) {
    weights = table.block(number);
    std::ranges::fill(block, 0.0);
  }
  void end() {
    for (std::size_t i = 0; i < all.size(); ++i) all[i] += block[i];
  }
  // Light of the samples from `first` on, one row of values after another.
  void add(std::uint32_t first, std::uint32_t count, const double* light) {
    const std::uint32_t begin = std::max<std::uint32_t>(first, weights.span.first);
    const std::uint32_t end = std::min<std::uint32_t>(first + count, weights.span.last);
    for (std::uint32_t sample = begin; sample < end; ++sample) {
      const double weight = weights.weights[sample - weights.span.first];
      const double* const row = light + std::size_t{sample - first} * block.size();
      for (std::size_t i = 0; i < block.size(); ++i) block[i] += weight * row[i];
    }
  }

  GainTable::Reader table;
  int exponent;
  BlockTable weights = {};
  std::vector<double> block, all;
};

// The light of a rectangle of samples.
class Rows {
 public:
  Rows(const CaptureFormat& capture, const Rectangle& rectangle)
      : capture_(capture),
        rectangle_(rectangle),
        light_(capture.transfer.light_of_all_codes(capture.white_code, capture.code_bytes)),
        raster_(capture.sample_bytes()) {}

  void read(const SampleCursor& sample, double* light) {
    sample.read(raster_);
    with_codes(capture_.code_bytes, raster_.data(), [&](const auto* codes) { look_up(codes, light); });
  }

 private:
  template <typename Code>
  void look_up(const Code* codes, double* light) const {
    const std::size_t channels = capture_.shape.channels, row = rectangle_.width * channels;
    for (std::size_t y = rectangle_.y; y < std::size_t{rectangle_.y} + rectangle_.height; ++y) {
      const Code* const from = codes + (y * capture_.shape.width + rectangle_.x) * channels;
      for (std::size_t i = 0; i < row; ++i) *light++ = light_[from[i]];
    }
  }

  const CaptureFormat& capture_;
  Rectangle rectangle_;
  std::vector<double> light_;  // of each code
  std::vector<std::byte> raster_;
};

std::size_t values_of(const RenderPlan& plan, const Rectangle& rectangle) {
  return std::size_t{rectangle.width} * rectangle.height * plan.capture.shape.channels;
}

}  // namespace

bool suits_one_pass(const RenderPlan& plan) {
  return plan.combine == Combine::integral && plan.functions.size() == 1 && plan.map->mixed.empty() &&
         plan.capture.shape.value_count() <= kMostValues;
}

std::size_t pictures_in_one_pass(const RenderPlan& plan, const Rectangle& rectangle, std::uint64_t most_bytes) {
  return std::clamp<std::size_t>(std::min(kSumBytes, most_bytes) / (2 * sizeof(double) * values_of(plan, rectangle)), 1,
                                 kMostPictures);
}

std::vector<Picture> expose_in_one_pass(std::span<const RenderPlan> plans, CaptureSource& source,
                                        const Rectangle& rectangle, const RenderControl& control) {
  if (plans.empty()) return {};
  const CaptureFormat& capture = plans.front().capture;
  const std::size_t values = values_of(plans.front(), rectangle);
  const auto at_once = static_cast<std::uint32_t>(std::max<std::size_t>(1, kLightBytes / (sizeof(double) * values)));
  std::vector<Sums> sums;
  std::map<std::uint64_t, std::vector<std::size_t>> wanting;  // plans by block
  for (const RenderPlan& plan : plans) {
    for (const PlannedBlock& block : plan.blocks) wanting[block.block].push_back(sums.size());
    sums.emplace_back(plan, values);
  }
  Rows rows(capture, rectangle);
  std::vector<double> light;
  BlockCursor blocks(source);
  std::uint64_t read = 0;
  for (const auto& entry : wanting) {
    const std::uint64_t number = entry.first;
    const std::vector<std::size_t>& wanted = entry.second;
    throw_if_cancelled(control);
    const BlockView block = blocks.at(number);
    std::uint32_t first = block.extent().sample_count, last = 0;
    for (const std::size_t i : wanted) {
      sums[i].start(number);
      if (sums[i].weights.span.empty()) continue;
      first = std::min<std::uint32_t>(first, sums[i].weights.span.first);
      last = std::max<std::uint32_t>(last, sums[i].weights.span.last);
    }
    SampleCursor cursor(capture.shape, block);
    for (; first < last; first += at_once) {
      const std::uint32_t count = std::min(at_once, last - first);
      light.resize(std::size_t{count} * values);
      for (std::uint32_t k = 0; k < count; ++k) {
        cursor.go_to(first + k);
        rows.read(cursor, light.data() + std::size_t{k} * values);
      }
      throw_if_cancelled(control);
      parallel_for(wanted.size(), [&](std::uint64_t i) { sums[wanted[i]].add(first, count, light.data()); });
    }
    for (const std::size_t i : wanted) sums[i].end();
    if (control.progress) control.progress(++read, wanting.size());
  }
  source.check_unchanged();
  std::vector<Picture> pictures;
  for (const Sums& each : sums) {
    Picture& picture = pictures.emplace_back(Shape{rectangle.width, rectangle.height, capture.shape.channels},
                                             ValueType::light64, capture.white_code);
    for (std::size_t i = 0; i < values; ++i) picture.values<double>()[i] = std::scalbn(each.all[i], each.exponent);
  }
  return pictures;
}

}  // namespace nutik
