#include "tik/codec.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>

#include "capture/error.hpp"
#include "support/random_case.hpp"

namespace nutik::tik {
namespace {

using test::RandomCase;

const Codec kCodecs[] = {
    {CodecId::none, 0}, {CodecId::lz4, 0}, {CodecId::zstd, 0}, {CodecId::rice, 0}, {CodecId::zstd, 9}};

// Packed into the memory of what was packed before.
std::vector<std::byte> packed(const Codec& codec, const BlockGeometry& geometry, std::span<const std::byte> payload) {
  static std::vector<std::vector<std::byte>> parts;
  pack(codec, geometry, payload, parts);
  std::vector<std::byte> all;
  for (const std::vector<std::byte>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

TEST(Codec, GivesEveryPayloadBackBitForBit) {
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    const RandomCase random(seed);
    const MemoryCapture capture = random.encode();
    for (std::uint64_t b = 0; b < capture.block_count(); ++b) {
      const BlockView view = capture.view(b);
      const BlockGeometry geometry(random.capture, view.extent().sample_count);
      for (const Codec& codec : kCodecs) {
        const std::vector<std::byte> stored = packed(codec, geometry, view.payload());
        std::vector<std::byte> payload(view.payload().size(), std::byte{0xEE});
        unpack(codec.id, geometry, stored, payload);
        ASSERT_TRUE(std::equal(payload.begin(), payload.end(), view.payload().begin()))
            << random.text() << ", block " << b << ", " << codec.text();
      }
    }
  }
}

// Reads everything in a payload that may hold anything, as a renderer would; returns whether it was refused.
// What matters is that nothing is read outside: sanitizers see it.
bool is_refused_when_read(const CaptureFormat& capture, BlockExtent extent,
                          std::span<const std::byte> payload) {
  try {
    const BlockView view(capture, extent, payload);
    std::vector<ChangeRecord> history;
    for (std::uint64_t tile = 0; tile < view.geometry().tile_count; ++tile) {
      for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
        view.read_history(tile, lane, history);
        std::uint32_t next = 0;
        for (const ChangeRecord& record : history) {
          EXPECT_TRUE(record.sample >= next && record.sample < extent.sample_count) << record.sample;
          next = record.sample + 1;
        }
        EXPECT_EQ(history.front().sample, 0u);
      }
    }
    std::vector<std::byte> raster(capture.sample_bytes());
    view.read_sample(extent.sample_count - 1, raster);
  } catch (const InputError&) {
    return true;
  }
  return false;
}

// A damaged payload is refused, when it is unpacked or when it is read, or gives other codes; nothing reads
// or writes outside.
TEST(Codec, SurvivesDamage) {
  std::uint64_t unpacked = 0, read = 0, tried = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const RandomCase random(seed);
    const MemoryCapture capture = random.encode();
    const BlockView view = capture.view(0);
    for (const Codec& codec : {kCodecs[0], kCodecs[1], kCodecs[2], kCodecs[3]}) {
      const std::vector<std::byte> stored = packed(codec, view.geometry(), view.payload());
      test::Random draw(seed);
      for (int i = 0; i < 30; ++i) {
        std::vector<std::byte> damaged = stored;
        const auto at =
            static_cast<std::size_t>(draw.whole(0, static_cast<std::int64_t>(damaged.size()) - 1));
        damaged[at] ^= static_cast<std::byte>(draw.whole(1, 255));
        if (i % 5 == 0) damaged.resize(at);
        std::vector<std::byte> payload(view.payload().size());
        ++tried;
        try {
          unpack(codec.id, view.geometry(), damaged, payload);
        } catch (const InputError&) {
          continue;
        }
        ++unpacked;
        if (!is_refused_when_read(random.capture, view.extent(), payload)) ++read;
      }
    }
  }
  std::printf("of %llu damaged payloads %llu were unpacked, %llu of them read\n",
              static_cast<unsigned long long>(tried), static_cast<unsigned long long>(unpacked),
              static_cast<unsigned long long>(read));
}

TEST(Codec, RefusesWhatNoPayloadIsStoredAs) {
  const RandomCase random(3);
  const MemoryCapture capture = random.encode();
  const BlockView view = capture.view(0);
  const BlockGeometry& geometry = view.geometry();
  // The stored form's front: group count, 0, then {tile count, packed bytes} for each group.
  const auto with_word = [](std::vector<std::byte> stored, std::size_t word, std::uint32_t value) {
    std::memcpy(stored.data() + word * 4, &value, sizeof value);
    return stored;
  };
  const auto word_of = [](const std::vector<std::byte>& stored, std::size_t word) {
    std::uint32_t value;
    std::memcpy(&value, stored.data() + word * 4, sizeof value);
    return value;
  };
  for (const Codec& codec : {kCodecs[1], kCodecs[2], kCodecs[3]}) {
    const std::vector<std::byte> stored = packed(codec, geometry, view.payload());
    const auto message = [&](const std::vector<std::byte>& damaged, std::uint64_t payload_bytes) {
      std::vector<std::byte> payload(payload_bytes);
      try {
        unpack(codec.id, geometry, damaged, payload);
      } catch (const InputError& error) {
        return std::string(error.what());
      }
      return std::string("nothing was thrown");
    };
    const auto refused = [&](const std::vector<std::byte>& damaged) {
      return message(damaged, view.payload().size()) == "its packed payload is damaged";
    };
    const std::string name = codec.text();
    ASSERT_EQ(message(stored, view.payload().size()), "nothing was thrown") << name;
    for (std::size_t bytes = 0; bytes < stored.size(); ++bytes) {
      EXPECT_TRUE(refused({stored.begin(), stored.begin() + static_cast<std::ptrdiff_t>(bytes)}))
          << name << " cut to " << bytes << " of " << stored.size();
    }
    std::vector<std::byte> longer = stored;
    longer.push_back(std::byte{0});
    EXPECT_TRUE(refused(longer)) << name << ": a byte too many";

    const std::uint32_t groups = word_of(stored, 0);
    const std::uint32_t tiles = word_of(stored, 2);
    for (const std::uint32_t count : {0u, groups - 1, groups + 1, 0xFFFF'FFFFu}) {
      EXPECT_TRUE(refused(with_word(stored, 0, count))) << name << ": " << count << " groups";
    }
    for (const std::uint32_t count : {0u, tiles - 1, tiles + 1, 0xFFFF'FFFFu}) {
      EXPECT_TRUE(refused(with_word(stored, 2, count))) << name << ": a group of " << count << " tiles";
    }
    EXPECT_TRUE(refused(with_word(stored, 3, word_of(stored, 3) - 1))) << name << ": a group cut short";
    for (const std::uint64_t bytes : {view.payload().size() - 64, view.payload().size() + 64}) {
      EXPECT_EQ(message(stored, bytes), "its packed payload is damaged") << name << ": another size";
    }
  }
}

TEST(Codec, RefusesATileThatNoBlockCanHave) {
  const CaptureFormat capture{.shape = {8, 8, 1}};
  const BlockGeometry geometry(capture, 3);
  // A longer block's payload: 9 rows, or 8 slots of records.
  const BlockGeometry longer(capture, 9);
  for (const std::uint32_t count : {9u, 8u | TileEntry::kRecordsFlag}) {
    const TileEntry entry{1, count};
    std::vector<std::byte> payload(longer.directory_bytes() + longer.body_bytes(entry));
    std::memcpy(payload.data(), &entry, sizeof entry);
    for (const Codec& codec : {kCodecs[1], kCodecs[2], kCodecs[3]}) {
      const std::vector<std::byte> stored = packed(codec, longer, payload);
      std::vector<std::byte> unpacked(payload.size());
      unpack(codec.id, longer, stored, unpacked);
      try {
        unpack(codec.id, geometry, stored, unpacked);
        FAIL() << "a tile of " << count << " was accepted";
      } catch (const InputError& error) {
        EXPECT_STREQ(error.what(),
                     entry.is_records()
                         ? "tile 0 has 8 change records a pixel; in 3 samples there are at most 2"
                         : "tile 0 has 9 rows; 3 samples have at most as many");
      }
    }
  }
}

TEST(Codec, ReadsItsNames) {
  EXPECT_EQ(Codec::parse("none").id, CodecId::none);
  EXPECT_EQ(Codec::parse("zstd:19").level, 19);
  for (const char* text : {"", "zip", "zstd:", "zstd:0", "zstd:20", "zstd:3x", "lz4:1", "rice:1"}) {
    EXPECT_THROW(static_cast<void>(Codec::parse(text)), UsageError) << text;
  }
}

}  // namespace
}  // namespace nutik::tik
