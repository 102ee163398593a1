#include "tik/codec.hpp"

#include <gtest/gtest.h>

#include "capture/error.hpp"
#include "support/random_case.hpp"

namespace nutik::tik {
namespace {

using test::RandomCase;

const Codec kCodecs[] = {{CodecId::none, 0}, {CodecId::lz4, 0}, {CodecId::zstd, 0}, {CodecId::zstd, 9}};

TEST(Codec, GivesEveryPayloadBackBitForBit) {
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    const RandomCase random(seed);
    const MemoryCapture capture = random.encode();
    for (std::uint64_t b = 0; b < capture.block_count(); ++b) {
      const BlockView view = capture.view(b);
      const BlockGeometry geometry(random.capture, view.extent().sample_count);
      for (const Codec& codec : kCodecs) {
        const std::vector<std::byte> stored = pack(codec, geometry, view.payload());
        std::vector<std::byte> payload(view.payload().size(), std::byte{0xEE});
        unpack(codec.id, geometry, stored, payload);
        ASSERT_TRUE(std::equal(payload.begin(), payload.end(), view.payload().begin()))
            << random.text() << ", block " << b << ", " << codec.text();
      }
    }
  }
}

// A damaged payload is refused or gives other codes; it never reads or writes outside.
TEST(Codec, SurvivesDamage) {
  std::uint64_t refused = 0, tried = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const RandomCase random(seed);
    const MemoryCapture capture = random.encode();
    const BlockView view = capture.view(0);
    const BlockGeometry geometry(random.capture, view.extent().sample_count);
    for (const Codec& codec : {kCodecs[1], kCodecs[2]}) {
      const std::vector<std::byte> stored = pack(codec, geometry, view.payload());
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
          unpack(codec.id, geometry, damaged, payload);
        } catch (const InputError&) {
          ++refused;
        }
      }
    }
  }
  EXPECT_GT(refused, tried / 4);
}

TEST(Codec, ReadsItsNames) {
  EXPECT_EQ(Codec::parse("none").id, CodecId::none);
  EXPECT_EQ(Codec::parse("zstd:19").level, 19);
  for (const char* text : {"", "zip", "zstd:", "zstd:0", "zstd:20", "zstd:3x", "lz4:1"}) {
    EXPECT_THROW(static_cast<void>(Codec::parse(text)), UsageError) << text;
  }
}

}  // namespace
}  // namespace nutik::tik
