// What a large picture takes on the device.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>

#include "render/render_plan.hpp"
#include "support/random_case.hpp"
#include "support/rendering.hpp"

namespace nutik::test {
namespace {

// 64 samples of 8K in one block, 6.4 GB as rasters: 2 % of the tiles change at every sample, others every time. It
// lies in memory that lasts, as a mapped file does, or is copied to where the device reads it.
class LargeScene final : public CaptureSource {
 public:
  static constexpr std::uint32_t kSamples = 64;
  static constexpr double kChanging = 0.02;

  LargeScene() {
    format_.shape = {7680, 4320, 3};
    const BlockGeometry geometry(format_, kSamples);
    Random random(3);
    std::vector<TileEntry> entries;
    std::vector<std::vector<std::uint8_t>> changes(geometry.tile_count);  // samples, of each tile
    bytes_ = geometry.directory_bytes();
    for (std::vector<std::uint8_t>& samples : changes) {
      const auto next = [&] { return 1 + std::log(random.real(1e-9, 1.0)) / std::log(1 - kChanging); };
      samples.push_back(0);
      for (double k = next(); k < kSamples; k += next()) {
        if (static_cast<std::uint8_t>(k) > samples.back()) samples.push_back(static_cast<std::uint8_t>(k));
      }
      const auto rows = static_cast<std::uint32_t>(samples.size());
      entries.push_back({static_cast<std::uint32_t>(bytes_ / kBlockAlignment), rows});
      bytes_ += geometry.rows_bytes(rows);
    }
    memory_.reserve(bytes_);
    std::memcpy(memory_.data(), entries.data(), entries.size() * sizeof(TileEntry));
    for (std::size_t tile = 0; tile < entries.size(); ++tile) {
      std::byte* const body = memory_.data() + entries[tile].offset * kBlockAlignment;
      const std::uint64_t list_bytes = geometry.row_index_bytes(entries[tile].rows());
      if (list_bytes != 0) std::memcpy(body, changes[tile].data(), changes[tile].size());
      const std::uint64_t row_bytes = geometry.row_bytes();
      for (std::size_t row = 0; row < changes[tile].size(); ++row) {
        std::memset(body + list_bytes + row * row_bytes, static_cast<int>((tile + row) % 256), row_bytes);
      }
    }
  }

  [[nodiscard]] const CaptureFormat& format() const override { return format_; }
  [[nodiscard]] const Timeline& timeline() const override { return timeline_; }
  [[nodiscard]] std::uint64_t block_count() const override { return 1; }
  [[nodiscard]] BlockExtent block_extent(std::uint64_t /*block*/) const override { return {0, kSamples}; }

  bool is_copied = false;

 private:
  BlockLease lend(std::uint64_t block, const LeaseTerms& /*terms*/) override {
    const std::span<const std::byte> payload(memory_.data(), bytes_);
    return is_copied ? BlockLease(block_extent(block), payload)
                     : BlockLease::within(block_extent(block), payload, 0, bytes_);
  }

  CaptureFormat format_;
  Timeline timeline_ = Timeline::constant({240, 1}, Timeline::kFullShutter, kSamples);
  PageBuffer memory_;
  std::uint64_t bytes_ = 0;
};

// Blocks, tables, sums and functions of pixels, as they are allocated, in every arithmetic. The picture is that of a
// column of it, whose sums are there at once.
TEST(LargePicture, TakesLittleOfTheDevice) {
  LargeScene scene;
  const Shape& shape = scene.format().shape;
  const RenderPlan plan = make_plan(scene, {{0, GainFunction::boxcar(0, scene.timeline().duration_ns())}},
                                    Mask::uniform(shape.width, shape.height, 0), {});
  const double raw = static_cast<double>(LargeScene::kSamples * scene.format().sample_bytes());
  for (const Precision precision : first_precisions()) {
    OpenClRenderer renderer(renderer_options(precision));
    const RenderControl of_column{.rectangle = Rectangle{3001, 0, 40, shape.height}};
    const Rendered column = renderer.render(plan, scene, {ValueType::code8, 255}, of_column);
    EXPECT_EQ(column.statistics.launches, 1u);
    for (const bool is_copied : {false, true}) {
      scene.is_copied = is_copied;
      renderer.keep_resident(is_copied ? &scene : nullptr);
      const Rendered rendered = renderer.render(plan, scene, {ValueType::code8, 255});
      const double share = static_cast<double>(rendered.statistics.device_bytes) / raw;
      std::printf("%s%s: %.3f of the raw bytes on the device, blocks %.3f, %llu launches\n",
                  to_text(precision).c_str(), is_copied ? ", copied" : "", share,
                  static_cast<double>(rendered.statistics.payload_bytes) / raw,
                  static_cast<unsigned long long>(rendered.statistics.launches));
      EXPECT_LE(share, 0.1) << to_text(precision);
      EXPECT_GT(rendered.statistics.launches, 1u);
      EXPECT_EQ(rendered.statistics.blocks, 1u);
      EXPECT_TRUE(part_of(rendered.picture, *of_column.rectangle) == column.picture.bytes);
    }
  }
}

}  // namespace
}  // namespace nutik::test
