#include "tik/rice.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>

#include "support/random_case.hpp"

namespace nutik::tik {
namespace {

using test::RandomCase;

// A payload whose tiles have rows of codes that nothing but `draw` knows, and room for it to be unpacked into.
struct DrawnPayload {
  BlockGeometry geometry;
  std::vector<TileEntry> entries;
  std::vector<std::byte> bytes;

  DrawnPayload(const CaptureFormat& capture, std::uint32_t samples) : geometry(capture, samples) {}

  void add_tile(std::uint32_t count, test::Random& draw, std::int64_t spread) {
    if (bytes.empty()) bytes.resize(geometry.directory_bytes());
    const TileEntry entry{static_cast<std::uint32_t>(bytes.size() / kBlockAlignment), count};
    entries.push_back(entry);
    bytes.resize(bytes.size() + geometry.body_bytes(entry));
    std::byte* const body = bytes.data() + entry.offset * kBlockAlignment;
    const std::uint64_t index = entry.is_records() ? 0 : geometry.row_index_bytes(entry.rows());
    for (std::uint32_t row = 0; index != 0 && row < entry.rows(); ++row) {
      const auto sample = static_cast<std::uint16_t>(2 * row);
      std::memcpy(body + row * geometry.index_bytes(), &sample, geometry.index_bytes());
    }
    const std::uint64_t end = geometry.body_bytes(entry);
    for (std::uint64_t at = index; at < end; at += geometry.code_bytes) {
      const auto code = static_cast<std::uint16_t>(1000 + draw.whole(-spread, spread) * draw.whole(0, 1));
      std::memcpy(body + at, &code, geometry.code_bytes);
    }
  }
};

// All tiles of a random capture's first block.
struct RandomGroup {
  RandomCase drawn;
  MemoryCapture capture = drawn.encode();
  BlockView view = capture.view(0);
  std::vector<TileEntry> entries;

  explicit RandomGroup(std::uint64_t seed) : drawn(seed) {
    for (std::uint64_t tile = 0; tile < view.geometry().tile_count; ++tile) entries.push_back(view.entry(tile));
  }
  [[nodiscard]] TileGroup group() const { return {entries, view.geometry()}; }
};

struct PackedGroup {
  std::vector<std::byte> head, body;
};

PackedGroup packed(const TileGroup& group, std::span<const std::byte> payload, RiceRoom& room,
                   Instructions instructions = Instructions::best) {
  const RiceGroup coded = encode_rice(group, payload, room, instructions);
  PackedGroup copy{coded.head, {coded.planes.begin(), coded.planes.end()}};
  copy.body.insert(copy.body.end(), coded.levels.begin(), coded.levels.end());
  return copy;
}
PackedGroup packed(const TileGroup& group, std::span<const std::byte> payload,
                   Instructions instructions = Instructions::best) {
  RiceRoom room;
  return packed(group, payload, room, instructions);
}

void expect_same_bytes_and_back(const TileGroup& group, std::span<const std::byte> payload,
                                const std::string& what) {
  const PackedGroup best = packed(group, payload);
  const PackedGroup portable = packed(group, payload, Instructions::portable);
  ASSERT_TRUE(best.head == portable.head && best.body == portable.body) << what;
  ASSERT_EQ(best.head.size(), rice_head_bytes(group)) << what;
  for (const Instructions instructions : {Instructions::best, Instructions::portable}) {
    std::vector<std::byte> unpacked(payload.size(), std::byte{0xEE});
    ASSERT_TRUE(decode_rice(group, best.head, best.body, unpacked, instructions)) << what;
    for (const TileEntry& entry : group.entries) {
      const std::size_t at = entry.offset * kBlockAlignment;
      ASSERT_EQ(std::memcmp(unpacked.data() + at, payload.data() + at, group.geometry.body_bytes(entry)), 0)
          << what;
    }
  }
}

TEST(Rice, AnyInstructionsMakeTheSameBytesOfCaptures) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const RandomGroup random(seed);
    expect_same_bytes_and_back(random.group(), random.view.payload(), random.drawn.text());
  }
}

// From codes that hardly change to those that do without rule, of one byte and of two: all shapes that planes have.
TEST(Rice, AnyInstructionsMakeTheSameBytesOfNoise) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    test::Random draw(seed);
    const std::uint32_t samples = seed % 8 < 4 ? 20 : 300;
    DrawnPayload payload({.shape = {8, 8, seed % 2 == 0 ? 1u : 3u}, .code_bytes = seed % 4 < 2 ? 1u : 2u}, samples);
    for (std::int64_t spread = 0; spread < 65'536; spread = spread * 3 + 1) {
      payload.add_tile(1, draw, spread);
      payload.add_tile(8, draw, spread);
      payload.add_tile(samples, draw, spread);
      payload.add_tile(5 | TileEntry::kRecordsFlag, draw, spread);
    }
    expect_same_bytes_and_back({payload.entries, payload.geometry}, payload.bytes,
                               "seed " + std::to_string(seed));
  }
}

// Nothing of a group is found in the next one that is packed in the same room, whether it is larger or smaller.
TEST(Rice, ARoomIsUsedAgain) {
  RiceRoom room;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const RandomGroup random(seed);
    const TileGroup group = random.group();
    const auto payload = random.view.payload();
    const PackedGroup again = packed(group, payload, room), fresh = packed(group, payload);
    EXPECT_TRUE(again.head == fresh.head && again.body == fresh.body) << random.drawn.text();
  }
}

// Codes that move by whole steps of a tolerance cost what as many single codes cost; those that do not come back as
// well.
TEST(Rice, CountsStepsOfATolerance) {
  for (const std::uint32_t code_bytes : {1u, 2u}) {
    for (const std::uint32_t channels : {1u, 3u}) {
      CaptureFormat capture{
          .shape = {8, 8, channels}, .code_bytes = code_bytes, .white_code = code_bytes == 1 ? 255u : 4095u};
      const auto packed_bytes = [&](std::int64_t step, std::uint32_t tolerance, bool strays) {
        capture.noise.tolerance = tolerance;
        test::Random draw(7);
        DrawnPayload payload(capture, 20);
        payload.add_tile(20, draw, 0);
        const std::uint64_t row = payload.geometry.row_bytes();
        std::byte* const body = payload.bytes.data() + payload.entries[0].offset * kBlockAlignment;
        for (std::uint64_t value = 0; value < row / code_bytes; ++value) {
          std::int64_t code = draw.whole(100, 120);
          for (std::uint32_t r = 0; r < 20; ++r) {
            const auto own = static_cast<std::uint16_t>(code + (strays && value == 5 && r == 9 ? 1 : 0));
            std::memcpy(body + r * row + value * code_bytes, &own, code_bytes);
            code = std::clamp<std::int64_t>(code + step * draw.whole(-3, 3), 0, capture.white_code);
          }
        }
        const TileGroup group{payload.entries, payload.geometry};
        expect_same_bytes_and_back(group, payload.bytes, std::to_string(channels) + " channels");
        return packed(group, payload.bytes).body.size();
      };
      const std::size_t single = packed_bytes(1, 0, false), steps = packed_bytes(9, 4, false);
      EXPECT_LE(steps, single + single / 20);
      EXPECT_GT(packed_bytes(9, 0, false), single + single / 2);
      EXPECT_GT(packed_bytes(9, 4, true), steps) << "a row that moved otherwise";
    }
  }
}

TEST(Rice, LeavesOutLowBitsThatNoCodeHas) {
  test::Random draw(1);
  DrawnPayload payload({.shape = {8, 8, 1}, .code_bytes = 2}, 20);
  payload.add_tile(20, draw, 200);
  const TileGroup group{payload.entries, payload.geometry};
  const std::size_t plain = packed(group, payload.bytes).body.size();
  for (std::size_t at = payload.geometry.directory_bytes(); at < payload.bytes.size(); at += 2) {
    std::uint16_t code;
    std::memcpy(&code, payload.bytes.data() + at, sizeof code);
    code = static_cast<std::uint16_t>(code * 16);
    std::memcpy(payload.bytes.data() + at, &code, sizeof code);
  }
  EXPECT_EQ(packed(group, payload.bytes).body.size(), plain);
  expect_same_bytes_and_back(group, payload.bytes, "codes times 16");
}

// Whatever the streams hold, nothing outside of them and the tiles is touched: canaries here, sanitizers where they
// watch. What still fits its marks gives other codes; checksums are there to tell.
TEST(Rice, SurvivesDamageOfEachStream) {
  std::uint64_t refused = 0, tried = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const RandomGroup random(seed);
    const TileGroup group = random.group();
    const PackedGroup coded = packed(group, random.view.payload());
    test::Random draw(seed);
    for (int i = 0; i < 60; ++i) {
      PackedGroup damaged = coded;
      std::vector<std::byte>& stream = i % 2 == 0 ? damaged.head : damaged.body;
      const auto at = static_cast<std::size_t>(draw.whole(0, static_cast<std::int64_t>(stream.size()) - 1));
      stream[at] ^= static_cast<std::byte>(draw.whole(1, 255));
      if (i % 6 == 1) stream.resize(at);
      constexpr std::size_t kCanary = 64;
      std::vector<std::byte> room(random.view.payload().size() + kCanary, std::byte{0xA5});
      const auto payload = std::span(room).first(random.view.payload().size());
      ++tried;
      const Instructions instructions = i % 4 < 2 ? Instructions::best : Instructions::portable;
      if (!decode_rice(group, damaged.head, damaged.body, payload, instructions)) ++refused;
      for (std::size_t c = 0; c < kCanary; ++c) {
        ASSERT_EQ(room[random.view.payload().size() + c], std::byte{0xA5}) << "seed " << seed << ", case " << i;
      }
    }
  }
  EXPECT_GT(refused, 0u);
  std::printf("of %llu damaged groups %llu were refused\n", static_cast<unsigned long long>(tried),
              static_cast<unsigned long long>(refused));
}

}  // namespace
}  // namespace nutik::tik
