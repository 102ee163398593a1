// A damaged file may hold indices behind its block's end. A kernel takes them for the end: what lies behind the tables
// has no say in the picture, and is not read.
#include <gtest/gtest.h>

#include <cstring>
#include <numeric>
#include <vector>

#include "opencl/build_options.hpp"
#include "opencl/kernel_layout.hpp"
#include "opencl/kernel_sources.hpp"
#include "opencl/opencl_api.hpp"

namespace nutik {
namespace {

// A tile of one block under one function, in whole numbers: sample k weighs 1, so that boundary k is k.
class OneTile {
 public:
  static constexpr std::uint64_t kBehindTheTable = 1'000'000;

  explicit OneTile(std::uint32_t sample_count) : sample_count_(sample_count) {
    const Work work{Precision::fixed, {8, 1, 8, 1}, false};
    program_ = cl::Program(context_, std::string(kernel_source("expose")));
    program_.build({device_}, expose_options(work, {.shape = {8, 8, 1}}, "NUTIK_LIGHT_LINEAR", false).c_str());
  }

  // Bytes of an index list: one for each of `count` indices, or two in long blocks.
  [[nodiscard]] std::vector<std::byte> indices(const std::vector<std::uint32_t>& list) const {
    std::vector<std::byte> bytes;
    for (const std::uint32_t index : list) {
      bytes.push_back(static_cast<std::byte>(index & 0xFF));
      if (sample_count_ > 255) bytes.push_back(static_cast<std::byte>(index >> 8));
    }
    bytes.resize(align_up(bytes.size(), kBlockAlignment));
    return bytes;
  }
  [[nodiscard]] static std::vector<std::byte> row(std::uint8_t code) {
    return std::vector<std::byte>(kTilePixels, std::byte{code});
  }

  // Σ light · weight of each pixel.
  [[nodiscard]] std::vector<std::uint64_t> expose(std::uint32_t count,
                                                  const std::vector<std::vector<std::byte>>& body) {
    std::vector<std::byte> payload(kBlockAlignment);
    const TileEntry entry{1, count};
    std::memcpy(payload.data(), &entry, sizeof entry);
    for (const auto& part : body) payload.insert(payload.end(), part.begin(), part.end());
    // As many rows again lie behind the block's, and hold what must not count.
    std::vector<std::uint64_t> weights(2 * sample_count_ + 1, 1), boundaries(2 * sample_count_ + 1);
    std::iota(boundaries.begin(), boundaries.end(), std::uint64_t{0});
    for (std::size_t k = sample_count_ + 1; k < boundaries.size(); ++k) boundaries[k] = kBehindTheTable;
    for (std::size_t k = sample_count_; k < weights.size(); ++k) weights[k] = kBehindTheTable;

    std::vector<BlockEntry> blocks{{0, 0, 0, sample_count_, 0}};
    std::vector<BlockPart> parts{{{0, static_cast<std::uint16_t>(sample_count_)}, 0}};
    std::vector<std::uint8_t> exposes{1};
    std::vector<std::uint64_t> gains{1}, kept{0}, bundles{0};
    std::vector<std::uint32_t> tiles{0};
    std::vector<std::uint16_t> of_tile{0};
    std::vector<std::uint8_t> of_lane(kTilePixels, 0);
    std::vector<std::uint64_t> sums(kTilePixels, 0);
    const auto buffer = [&](auto& values) {
      return cl::Buffer(context_, values.begin(), values.end(), false);
    };
    const cl::Buffer result = buffer(sums);
    ExposeKernel kernel(program_, "expose");
    kernel(cl::EnqueueArgs(queue_, cl::NDRange(8)), buffer(payload), buffer(blocks), buffer(parts), buffer(gains),
           buffer(weights), buffer(boundaries), buffer(tiles), buffer(of_tile), buffer(of_lane), buffer(exposes),
           buffer(sums), buffer(kept), buffer(bundles), result, ExposeLaunch{1, 1, 1, 1});
    queue_.enqueueReadBuffer(result, CL_TRUE, 0, sums.size() * sizeof(std::uint64_t), sums.data());
    return sums;
  }

 private:
  std::uint32_t sample_count_;
  cl::Device device_ = all_devices().front();
  cl::Context context_{device_};
  cl::CommandQueue queue_{context_, device_};
  cl::Program program_;
};

// By samples of a block: an index takes one byte or two.
class DamagedIndex : public testing::TestWithParam<std::uint32_t> {
 protected:
  const std::uint32_t samples_ = GetParam();
  const std::uint32_t behind_ = samples_ + samples_ / 2;
  OneTile tile_{samples_};
};

TEST_P(DamagedIndex, OfARecordIsTheBlocksEnd) {
  const auto sums =
      tile_.expose(TileEntry::kRecordsFlag | 1u,
                   {OneTile::row(3), tile_.indices(std::vector(kTilePixels, behind_)), OneTile::row(200)});
  for (const std::uint64_t sum : sums) ASSERT_EQ(sum, 3u * samples_);
}

TEST_P(DamagedIndex, OfARowIsTheBlocksEnd) {
  const auto sums =
      tile_.expose(3, {tile_.indices({0, 11, behind_}), OneTile::row(3), OneTile::row(5), OneTile::row(200)});
  for (const std::uint64_t sum : sums) ASSERT_EQ(sum, 3u * 11 + 5u * (samples_ - 11));
}

INSTANTIATE_TEST_SUITE_P(, DamagedIndex, testing::Values(64u, 300u));

}  // namespace
}  // namespace nutik
