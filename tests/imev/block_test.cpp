#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>

#include "capture/error.hpp"
#include "imev/capture_source.hpp"
#include "support/random_case.hpp"

namespace nutik {
namespace {

using test::code_at;
using test::Random;
using test::RandomCase;
using test::Rasters;

// The codes held at every sample, straight from the definition of a change record.
Rasters held_by_definition(const CaptureFormat& capture, const Rasters& rasters) {
  Rasters held;
  for (const auto& raster : rasters) {
    std::vector<std::byte> now = held.empty() ? raster : held.back();
    for (std::uint64_t pixel = 0; !held.empty() && pixel < capture.shape.pixel_count(); ++pixel) {
      bool changed = false;
      for (std::uint32_t c = 0; c < capture.shape.channels; ++c) {
        const std::uint64_t value = pixel * capture.shape.channels + c;
        const auto before = static_cast<int>(code_at(capture, now, value));
        const auto after = static_cast<int>(code_at(capture, raster, value));
        changed |= std::abs(after - before) > static_cast<int>(capture.noise.tolerance);
      }
      for (std::uint32_t c = 0; changed && c < capture.shape.channels; ++c) {
        const std::uint64_t value = pixel * capture.shape.channels + c;
        test::set_code(capture, now, value, code_at(capture, raster, value));
      }
    }
    held.push_back(std::move(now));
  }
  return held;
}

std::vector<std::byte> sample_of(const MemoryCapture& capture, std::uint64_t sample) {
  for (std::uint64_t block = 0; block < capture.block_count(); ++block) {
    const SampleRange range = capture.block_extent(block).range();
    if (sample < range.first || sample >= range.last) continue;
    std::vector<std::byte> raster(capture.format().sample_bytes());
    capture.view(block).read_sample(static_cast<std::uint32_t>(sample - range.first), raster);
    return raster;
  }
  return {};
}

TEST(Block, HoldsWhatTheDefinitionSays) {
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    const RandomCase random(seed);
    const MemoryCapture capture = random.encode();
    const Rasters held = held_by_definition(random.capture, random.rasters);
    for (std::uint64_t k = 0; k < held.size(); ++k) {
      ASSERT_EQ(sample_of(capture, k), held[k]) << random.text() << ", sample " << k;
    }
  }
}

TEST(Block, GivesASourceBackExactlyAtToleranceZero) {
  for (std::uint64_t seed = 200; seed < 260; ++seed) {
    RandomCase random(seed);
    random.capture.noise.tolerance = 0;
    for (const TilePolicy policy :
         {TilePolicy::automatic, TilePolicy::dense, TilePolicy::rows, TilePolicy::records}) {
      const MemoryCapture capture = random.encode(random.block_samples, policy);
      for (std::uint64_t k = 0; k < random.rasters.size(); ++k) {
        ASSERT_EQ(sample_of(capture, k), random.rasters[k]) << random.text() << ", sample " << k;
      }
    }
  }
}

// A grey capture of one tile whose samples are all `codes`, but for what `change` does.
MemoryCapture one_tile(std::uint32_t samples, std::uint32_t block_samples, TilePolicy policy,
                       const std::function<void(std::uint32_t, std::vector<std::byte>&)>& change) {
  CaptureFormat capture;
  capture.shape = {8, 8, 1};
  Rasters rasters;
  std::vector<std::byte> raster(64, std::byte{100});
  for (std::uint32_t k = 0; k < samples; ++k) {
    change(k, raster);
    rasters.push_back(raster);
  }
  return {capture, Timeline::constant({100, 1}, Timeline::kFullShutter, samples), rasters, block_samples,
          policy};
}

TEST(Block, StoresATileTheCheapestWay) {
  const auto kind = [](const MemoryCapture& capture) {
    const BlockView view = capture.view(0);
    return view.geometry().kind_of(view.entry(0));
  };
  const auto nothing = [](std::uint32_t, std::vector<std::byte>&) {};
  const auto everything = [](std::uint32_t k, std::vector<std::byte>& raster) {
    for (std::byte& code : raster) code = static_cast<std::byte>(k);
  };
  const auto one_moment = [](std::uint32_t k, std::vector<std::byte>& raster) {
    if (k == 30) raster.assign(64, std::byte{7});
  };
  // Every pixel changes once, each at its own time: 64 rows, or a single slot of records.
  const auto each_once = [](std::uint32_t k, std::vector<std::byte>& raster) { raster[k] = std::byte{9}; };
  EXPECT_EQ(kind(one_tile(64, 64, TilePolicy::automatic, nothing)), TileKind::still);
  EXPECT_EQ(kind(one_tile(64, 64, TilePolicy::automatic, everything)), TileKind::dense);
  EXPECT_EQ(kind(one_tile(64, 64, TilePolicy::automatic, one_moment)), TileKind::rows);
  EXPECT_EQ(kind(one_tile(64, 64, TilePolicy::automatic, each_once)), TileKind::records);
  EXPECT_EQ(kind(one_tile(64, 64, TilePolicy::dense, nothing)), TileKind::dense);
  EXPECT_EQ(kind(one_tile(64, 64, TilePolicy::records, nothing)), TileKind::records);
}

TEST(Block, AStartIsNoRecord) {
  const auto step = [](std::uint32_t k, std::vector<std::byte>& raster) {
    raster[5] = static_cast<std::byte>(k);
  };
  const MemoryCapture capture = one_tile(8, 4, TilePolicy::records, step);
  std::vector<ChangeRecord> history;
  capture.view(1).read_history(0, 5, history);
  ASSERT_EQ(history.size(), 4u);
  EXPECT_EQ(history[0], (ChangeRecord{0, {4, 0, 0}}));  // what is held at the block's first sample
  EXPECT_EQ(history[3], (ChangeRecord{3, {7, 0, 0}}));
  capture.view(1).read_history(0, 6, history);
  ASSERT_EQ(history.size(), 1u);  // a still pixel in a tile of records
}

TEST(BlockBuilder, RefusesCodesAboveWhite) {
  CaptureFormat capture;
  capture.shape = {1, 1, 1};
  capture.code_bytes = 2;
  capture.white_code = 4095;
  BlockBuilder builder(capture, 4, TilePolicy::automatic);
  const std::vector<std::byte> raster{std::byte{0x00}, std::byte{0x10}};  // 4096
  try {
    builder.add(raster);
    FAIL() << "4096 was accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "sample 0 has a code of 4096, above the white code 4095; state the right one with --white");
  }
}

TEST(BlockView, RefusesADirectoryThatPointsOutside) {
  const auto everything = [](std::uint32_t k, std::vector<std::byte>& raster) {
    for (std::byte& code : raster) code = static_cast<std::byte>(k);
  };
  MemoryCapture capture = one_tile(8, 8, TilePolicy::automatic, everything);
  std::vector<std::byte> payload(capture.prepare(0));
  capture.read(0, payload);
  const BlockExtent extent = capture.block_extent(0);
  for (const std::uint32_t word : {0u, 1u}) {
    for (const std::uint32_t value : {0u, 9u, 0x7FFF'FFFFu, 0x8000'0008u, 0xFFFF'FFFFu}) {
      std::vector<std::byte> damaged = payload;
      std::memcpy(damaged.data() + word * 4, &value, 4);
      EXPECT_THROW(BlockView(capture.format(), extent, damaged), InputError) << word << " " << value;
    }
  }
  EXPECT_THROW(BlockView(capture.format(), extent, std::span(payload).first(32)), InputError);
  EXPECT_NO_THROW(BlockView(capture.format(), extent, payload));
}

}  // namespace
}  // namespace nutik
