#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "imev/capture_source.hpp"
#include "imev/sample_cursor.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

// The codes held at every sample, straight from the definition of a change record: whole steps of 2 T + 1 codes, of
// which the nearest leads as near to the new code as the tolerance T.
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
        const auto before = static_cast<std::int64_t>(code_at(capture, now, value));
        const auto after = static_cast<std::int64_t>(code_at(capture, raster, value));
        const std::int64_t tolerance = capture.noise.tolerance, step = 2 * tolerance + 1;
        const std::int64_t count = (std::abs(after - before) + tolerance) / step;
        const std::int64_t reached = before + (after < before ? -count : count) * step;
        set_code(capture, now, value,
                 static_cast<std::uint32_t>(std::clamp<std::int64_t>(reached, 0, capture.white_code)));
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

// A walk that leaves samples out, and looks at nothing that did not change.
TEST(SampleCursor, HoldsWhatTheSamplesDo) {
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    const RandomCase random(seed);
    const MemoryCapture capture = random.encode();
    const Shape& shape = capture.format().shape;
    std::vector<std::byte> held(capture.format().sample_bytes()), now(held.size());
    Random steps(seed);
    for (std::uint64_t block = 0; block < capture.block_count(); ++block) {
      const BlockView view = capture.view(block);
      SampleCursor cursor(shape, view);
      for (std::uint32_t k = 0; k < view.extent().sample_count;
           k += static_cast<std::uint32_t>(steps.whole(1, 3))) {
        const auto changed = cursor.go_to(k);
        std::vector<std::byte> walked(held.size());
        cursor.read(walked);
        view.read_sample(k, now);
        ASSERT_EQ(walked, now) << random.text() << ", sample " << k;
        for (std::uint64_t value = 0; k > 0 && value < shape.value_count(); ++value) {
          if (code_at(capture.format(), held, value) == code_at(capture.format(), now, value)) continue;
          const std::uint64_t pixel = value / shape.channels;
          const auto x = static_cast<std::uint32_t>(pixel % shape.width),
                     y = static_cast<std::uint32_t>(pixel / shape.width);
          ASSERT_TRUE(std::ranges::binary_search(changed, TileGrid(shape).tile_of(x, y)))
              << random.text() << ", sample " << k;
          ASSERT_EQ(cursor.code(x, y, static_cast<std::uint32_t>(value % shape.channels)),
                    code_at(capture.format(), now, value));
        }
        held = now;
      }
    }
  }
}

// No two codes of 8 bits differ by more than 255, none of 16 bits by more than 65535: from there on nothing
// changes, however large the tolerance.
TEST(Block, ToleratesWhateverATolerancePermits) {
  struct Case {
    std::uint32_t code_bytes, tolerance;
    bool changes;
  };
  for (const Case& each :
       {Case{1, 254, true}, Case{1, 255, false}, Case{1, 256, false}, Case{1, 300, false},
        Case{2, 65'534, true}, Case{2, 65'535, false}, Case{2, 65'536, false}, Case{2, 65'836, false}}) {
    CaptureFormat capture{
        .shape = {9, 8, 3}, .code_bytes = each.code_bytes, .white_code = each.code_bytes == 1 ? 255u : 65'535u};
    capture.noise.tolerance = each.tolerance;
    const Rasters rasters{std::vector<std::byte>(capture.sample_bytes(), std::byte{0}),
                          std::vector<std::byte>(capture.sample_bytes(), std::byte{0xFF})};
    const MemoryCapture encoded(capture, Timeline::constant({100, 1}, Timeline::kFullShutter, 2), rasters, 2);
    EXPECT_EQ(sample_of(encoded, 1), rasters[each.changes ? 1 : 0])
        << each.code_bytes << " bytes, tolerance " << each.tolerance;
  }
}

// By hand, a tolerance of 4: steps of 9, and the ends of the scale.
TEST(Block, MovesByWholeSteps) {
  CaptureFormat capture{.shape = {1, 1, 1}};
  capture.noise.tolerance = 4;
  using Codes = std::vector<int>;
  const auto held = [&](const Codes& codes) {
    Rasters rasters;
    for (const int code : codes) rasters.push_back({static_cast<std::byte>(code)});
    const MemoryCapture encoded(capture, Timeline::constant({100, 1}, Timeline::kFullShutter, codes.size()), rasters,
                                3);
    Codes all;
    for (std::uint64_t k = 0; k < codes.size(); ++k) all.push_back(static_cast<int>(sample_of(encoded, k)[0]));
    return all;
  };
  EXPECT_EQ(held({100, 104, 105, 101, 99, 0, 6, 255, 250, 248}),
            (Codes{100, 100, 109, 100, 100, 1, 10, 253, 253, 244}));
  EXPECT_EQ(held({250, 255, 250}), (Codes{250, 255, 246})) << "white";
  EXPECT_EQ(held({250, 7, 0, 9}), (Codes{250, 7, 0, 9})) << "black";
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
  Rasters rasters;
  std::vector<std::byte> raster(64, std::byte{100});
  for (std::uint32_t k = 0; k < samples; ++k) {
    change(k, raster);
    rasters.push_back(raster);
  }
  const CaptureFormat capture{.shape = {8, 8, 1}};
  return {capture, Timeline::constant({100, 1}, Timeline::kFullShutter, samples), rasters, block_samples, policy};
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
  BlockBuilder builder({.shape = {1, 1, 1}, .code_bytes = 2, .white_code = 4095}, 4, TilePolicy::automatic);
  const std::vector<std::byte> raster{std::byte{0x00}, std::byte{0x10}};  // 4096
  EXPECT_EQ(message_of<InputError>([&] { builder.add(raster); }),
            "sample 0 has a code of 4096, above the white code 4095; state the right one");
}

TEST(BlockBuilder, RefusesBlocksThatMayComeToMoreThanAnOffsetReaches) {
  CaptureFormat capture{.shape = {3840, 2160, 3}, .code_bytes = 2, .white_code = 65'535};
  const auto message = [&](std::uint32_t samples, TilePolicy policy) {
    return message_of<UsageError>([&] { BlockBuilder(capture, samples, policy); });
  };
  // 129600 tiles: 2120998 bytes each, less 72 for entry and padding. 5494 rows of 384 bytes and room for their
  // index take 2120704, one more 2121088.
  EXPECT_EQ(
      message(65'535, TilePolicy::automatic),
      "a block of 65535 samples of 3840 x 2160 pixels may come to more than the 256 GiB that a block can "
      "have; use 5494 or fewer");
  EXPECT_EQ(message(65'536, TilePolicy::automatic), "a block of 65536 samples is outside 1 … 65535");
  // A slot has an index of 128 bytes too: 384 + 512 (n - 1) bytes, n = 4142.
  expect_says(message(5495, TilePolicy::records), "use 4142 or fewer");
  capture.shape = {0xFFFF'FFF8, 0xFFFF'FFF8, 3};  // nearly 2^58 tiles: no product overflows
  expect_says(message(65'535, TilePolicy::dense), "256 GiB");
}

TEST(BlockView, RefusesADirectoryThatPointsOutside) {
  const auto everything = [](std::uint32_t k, std::vector<std::byte>& raster) {
    for (std::byte& code : raster) code = static_cast<std::byte>(k);
  };
  const MemoryCapture capture = one_tile(8, 8, TilePolicy::automatic, everything);
  const auto lent = capture.view(0).payload();
  const std::vector<std::byte> payload(lent.begin(), lent.end());
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

TEST(BlockView, TellsWhatATileCannotHave) {
  const MemoryCapture capture =
      one_tile(8, 8, TilePolicy::automatic, [](std::uint32_t, std::vector<std::byte>&) {});
  const BlockView view = capture.view(0);
  const auto message = [&](std::uint32_t count) {
    std::vector<std::byte> damaged(view.payload().begin(), view.payload().end());
    std::memcpy(damaged.data() + offsetof(TileEntry, count), &count, sizeof count);
    return message_of<InputError>([&] { BlockView(capture.format(), view.extent(), damaged); });
  };
  const std::string block = "the block of samples 0 to 7 is damaged: tile 0 ";
  EXPECT_EQ(message(1), "");
  EXPECT_EQ(message(0), block + "has no row");
  EXPECT_EQ(message(9), block + "has 9 rows; 8 samples have at most as many");
  EXPECT_EQ(message(8 | TileEntry::kRecordsFlag),
            block + "has 8 change records a pixel; in 8 samples there are at most 7");
}

// Of every kind of tile, and no others.
TEST(BlockView, RefusesCodesAboveWhite) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const RandomCase random(seed);
    const MemoryCapture capture = random.encode();
    const BlockView view = capture.view(0);
    const std::uint64_t tiles = view.geometry().tile_count;
    CaptureFormat kind = capture.format();
    std::vector<std::byte> raster(kind.sample_bytes());
    std::uint32_t largest = 0;
    for (std::uint32_t k = 0; k < view.extent().sample_count; ++k) {
      view.read_sample(k, raster);
      largest = std::max(largest, largest_code(raster, kind.code_bytes));
    }
    const auto message = [&](std::uint32_t white) {
      kind.white_code = white;
      const BlockView other(kind, view.extent(), view.payload());
      const std::string text = message_of<InputError>([&] { other.check_samples(0, tiles); });
      EXPECT_EQ(text.empty(), other.checked_until(0, view.payload().size()) == tiles) << text;
      return text;
    };
    EXPECT_EQ(message(largest), "") << random.text();
    if (largest == 0) continue;
    const std::string wanted = format("has a code of {}, above its white code {}", largest, largest - 1);
    EXPECT_NE(message(largest - 1).find(wanted), std::string::npos) << random.text();
  }
}

// One tile in a block of `samples` whose sample numbers are `indices`: of the rows of a rows tile, or of
// every pixel's records in a records tile.
class CraftedBlock {
 public:
  CraftedBlock(std::uint32_t samples, bool as_records, const std::vector<std::uint32_t>& indices)
      : extent_{40, samples} {
    capture_.shape = {8, 8, 1};
    const BlockGeometry geometry(capture_, samples);
    const auto count = static_cast<std::uint32_t>(indices.size());
    const TileEntry entry{1, as_records ? count | TileEntry::kRecordsFlag : count};
    payload_.resize(geometry.directory_bytes() + geometry.body_bytes(entry));
    std::memcpy(payload_.data(), &entry, sizeof entry);
    std::byte* at = payload_.data() + geometry.directory_bytes() + (as_records ? geometry.row_bytes() : 0);
    for (std::uint32_t i = 0; i < count; ++i) {
      for (std::uint32_t lane = 0; lane < (as_records ? kTilePixels : 1); ++lane) {
        std::memcpy(at, &indices[i], geometry.index_bytes());  // little-endian hosts
        at += geometry.index_bytes();
      }
      if (as_records) at = std::fill_n(at, geometry.row_bytes(), static_cast<std::byte>(i + 1));
    }
    // Rows differ, or their sample numbers would not matter.
    for (std::uint32_t i = 0; !as_records && i < count; ++i) {
      std::byte* row = payload_.data() + payload_.size() - (count - i) * geometry.row_bytes();
      std::fill_n(row, geometry.row_bytes(), static_cast<std::byte>(i));
    }
  }

  // What reading pixel 63, or sample 1, ends with.
  [[nodiscard]] std::string message() const {
    const BlockView view(capture_, extent_, payload_);
    std::vector<ChangeRecord> history;
    std::vector<std::byte> raster(64);
    const std::string of_history = message_of<InputError>([&] { view.read_history(0, 63, history); });
    const std::string of_sample = message_of<InputError>([&] { view.read_sample(1, raster); });
    EXPECT_EQ(of_history.empty(), of_sample.empty()) << of_history << " | " << of_sample;
    return of_history;
  }

 private:
  CaptureFormat capture_;
  BlockExtent extent_;
  std::vector<std::byte> payload_;
};

TEST(BlockView, RefusesSampleNumbersThatARowsTileCannotHave) {
  for (const std::uint32_t samples : {8u, 255u, 256u, 60'000u}) {
    const std::uint32_t last = samples - 1;
    const auto message = [&](const std::vector<std::uint32_t>& indices) {
      return CraftedBlock(samples, false, indices).message();
    };
    EXPECT_EQ(message({0, 3, last}), "") << samples;
    EXPECT_EQ(message({0}), "") << samples;
    EXPECT_EQ(message({1, 3, last}), format("the block of samples 40 to {} is damaged: tile 0: its first row "
                                            "is at sample 1, not 0",
                                            39 + samples));
    EXPECT_EQ(message({0, 3, 3}), format("the block of samples 40 to {} is damaged: tile 0: its row 2 is at "
                                         "sample 3 of {}, the one before at 3",
                                         39 + samples, samples));
    for (const std::vector<std::uint32_t>& indices : std::vector<std::vector<std::uint32_t>>{
             {last, 0}, {0, 0}, {0, 5, 4}, {0, samples, last}, {0, 3, samples}, {samples, samples}}) {
      EXPECT_NE(message(indices).find("is damaged"), std::string::npos) << samples << " " << indices[1];
    }
  }
}

TEST(BlockView, RefusesSampleNumbersThatARecordsTileCannotHave) {
  for (const std::uint32_t samples : {8u, 254u, 255u, 256u, 60'000u}) {
    const std::uint32_t last = samples - 1;
    const auto message = [&](const std::vector<std::uint32_t>& indices) {
      return CraftedBlock(samples, true, indices).message();
    };
    EXPECT_EQ(message({1, 3, last}), "") << samples;
    EXPECT_EQ(message({3, samples, samples}), "") << samples;
    EXPECT_EQ(message({3, 2}),
              format("the block of samples 40 to {} is damaged: tile 0, pixel 63: its change "
                     "record 1 is at sample 2 of {}, the one before at 3",
                     39 + samples, samples));
    // At sample 0 the start is held already; behind the padding there is nothing more.
    for (const std::vector<std::uint32_t>& indices : std::vector<std::vector<std::uint32_t>>{
             {0, 3}, {3, 3}, {last, 1}, {samples, 1}, {samples, 0}, {3, samples, last}}) {
      EXPECT_NE(message(indices).find("is damaged"), std::string::npos) << samples << " " << indices[0];
    }
    if (samples == 255) continue;  // no index of one byte is larger
    EXPECT_NE(message({3, samples + 1}).find("is damaged"), std::string::npos) << samples;
  }
}

}  // namespace
}  // namespace nutik::test
