// Files that were cut off, damaged or made up: what is refused, what is lost, what is saved.
#include <gtest/gtest.h>

#include <cstring>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "imev/expected_values.hpp"
#include "support/messages.hpp"
#include "support/payloads.hpp"
#include "support/scratch.hpp"
#include "support/tik_files.hpp"
#include "system/checksum.hpp"
#include "tik/reader.hpp"

namespace nutik::tik {
namespace {

using test::noisy_case;
using test::payload_of;
using test::RandomCase;
using test::Scratch;
using test::write_tik;

RandomCase case_with_blocks(std::uint64_t at_least) {
  for (std::uint64_t seed = 0;; ++seed) {
    RandomCase random(seed);
    if (random.encode().block_count() >= at_least && random.capture.shape.pixel_count() > 64) return random;
  }
}

// Rate, shutter and size stand in the text: a changed digit would give another picture without a word.
TEST(TikDamage, RefusesAnyChangeBeforeItsFirstBlock) {
  const RandomCase random(3);
  const Scratch scratch;
  const std::string whole = test::read_file(write_tik(random, {CodecId::none, 0}, scratch));
  const std::size_t first_block = whole.find(std::string_view(kBlockMagic, sizeof kBlockMagic));
  ASSERT_NE(first_block, std::string::npos);
  for (std::size_t byte = 0; byte < first_block; ++byte) {
    std::string flipped = whole;
    flipped[byte] = static_cast<char>(flipped[byte] ^ (1 << byte % 8));
    const auto path = scratch.write("flipped.tik", flipped);
    EXPECT_THROW(Reader{path}, InputError) << "byte " << byte;
    EXPECT_THROW(recover(path, scratch / "new.tik"), InputError) << "byte " << byte;
  }
}

TEST(TikDamage, IsNotRecoveredWithoutNeed) {
  const RandomCase random(3);
  const Scratch scratch;
  const auto path = write_tik(random, {CodecId::none, 0}, scratch);
  EXPECT_NE(test::message_of<InputError>([&] { recover(path, scratch / "new.tik"); }).find("was not cut off"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(scratch / "new.tik"));
}

TEST(TikDamage, ADamagedBlockCostsThatBlockOnly) {
  const RandomCase random = case_with_blocks(3);
  const Scratch scratch;
  const auto path = write_tik(random, {CodecId::none, 0}, scratch);
  std::string bytes = test::read_file(path);
  const std::uint64_t offset = Reader(path).acquire(1).mapping_offset();
  bytes[offset + 200] = static_cast<char>(bytes[offset + 200] ^ 1);
  scratch.write("damaged.tik", bytes);
  Reader reader(scratch / "damaged.tik");
  const SampleRange samples = reader.block_extent(1).range();
  EXPECT_NO_THROW(static_cast<void>(payload_of(reader, 0)));
  EXPECT_NO_THROW(static_cast<void>(payload_of(reader, 2)));
  const std::string message = test::message_of<InputError>([&] { return payload_of(reader, 1); });
  EXPECT_NE(message.find(format("the block of samples {} to {}", samples.first, samples.last - 1)),
            std::string::npos)
      << message;
  EXPECT_NE(message.find("damaged: its checksum does not match"), std::string::npos) << message;
}

TEST(TikDamage, RecoversANoisyCaptureWithItsNoise) {
  RandomCase random = noisy_case(3);
  random.block_samples = 1;
  const Scratch scratch;
  const std::string whole = test::read_file(write_tik(random, {CodecId::zstd, 0}, scratch));
  const Recovery recovery = recover(
      scratch.write("cut.tik", std::string_view(whole).substr(0, whole.size() - 100)), scratch / "saved.tik");
  EXPECT_EQ(recovery.sample_count, random.timeline.sample_count());
  EXPECT_EQ(Reader(scratch / "saved.tik").format(), held_format(random.capture));
}

TEST(TikDamage, IsRecoveredUpToItsLastWholeBlock) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const RandomCase random(seed);
    SCOPED_TRACE(random.text());
    const Scratch scratch;
    const auto path = write_tik(random, {CodecId::zstd, 0}, scratch);
    const std::string bytes = test::read_file(path);
    std::vector<std::uint64_t> block_ends;
    const MemoryCapture capture = random.encode();
    {
      const Reader reader(path);
      for (const IndexEntry& entry : reader.index()) {
        std::uint64_t end = entry.offset + sizeof(BlockHeader) + entry.stored_bytes;
        if (!random.timeline.is_constant()) end += align_up(entry.sample_count * sizeof(Exposure), 64);
        block_ends.push_back(end);
      }
    }
    test::Random draw(seed);
    for (int i = 0; i < 6; ++i) {
      std::filesystem::remove(scratch / "new.tik");
      const auto cut = static_cast<std::uint64_t>(draw.whole(1, static_cast<std::int64_t>(bytes.size()) - 1));
      scratch.write("cut.tik", std::string_view(bytes).substr(0, cut));
      const auto whole = static_cast<std::uint64_t>(
          std::count_if(block_ends.begin(), block_ends.end(), [&](std::uint64_t end) { return end <= cut; }));
      if (whole == 0) {
        EXPECT_NE(test::message_of<InputError>([&] { Reader(scratch / "cut.tik"); }), "");
        EXPECT_NE(test::message_of<InputError>([&] { recover(scratch / "cut.tik", scratch / "new.tik"); }),
                  "");
        EXPECT_FALSE(std::filesystem::exists(scratch / "new.tik"));
        continue;
      }
      EXPECT_NE(test::message_of<Recoverable>([&] { Reader(scratch / "cut.tik"); }), "");
      const Recovery recovery = recover(scratch / "cut.tik", scratch / "new.tik");
      EXPECT_EQ(recovery.block_count, whole);
      Reader reader(scratch / "new.tik");
      ASSERT_EQ(reader.block_count(), whole);
      for (std::uint64_t b = 0; b < whole; ++b) {
        const auto payload = payload_of(reader, b);
        const auto expected = capture.view(b).payload();
        ASSERT_TRUE(std::equal(payload.begin(), payload.end(), expected.begin(), expected.end()));
        const BlockExtent extent = reader.block_extent(b);
        EXPECT_EQ(reader.timeline().start_ns(extent.first_sample),
                  random.timeline.start_ns(extent.first_sample));
      }
    }
  }
}

// A file whose headers' checksums are right, whatever they say.
std::string with_header(std::string file, std::uint64_t offset,
                        const std::function<void(BlockHeader&)>& change) {
  BlockHeader header;
  std::memcpy(&header, file.data() + offset, sizeof header);
  change(header);
  header.header_checksum = checksum_of(header, offsetof(BlockHeader, header_checksum));
  std::memcpy(file.data() + offset, &header, sizeof header);
  return file;
}

TEST(TikDamage, BelievesNoHeaderThatCannotBe) {
  struct Lie {
    std::string complaint;
    std::function<void(BlockHeader&)> tell;
  };
  const std::uint64_t most = ~std::uint64_t{0};
  const std::vector<Lie> lies{
      {"its header is that of block 2", [](BlockHeader& header) { ++header.block; }},
      {"as its first", [](BlockHeader& header) { ++header.first_sample; }},
      {"its header tells of 0 samples; it can have 1 … 65535",
       [](BlockHeader& header) { header.sample_count = 0; }},
      {"its header tells of 65536 samples", [](BlockHeader& header) { header.sample_count = 65'536; }},
      {"its codec 4 is not known", [](BlockHeader& header) { header.codec = 4; }},
      {"bytes of exposures, not", [](BlockHeader& header) { header.exposure_bytes += 16; }},
      {"bytes of exposures, not", [](BlockHeader& header) { header.exposure_bytes += 8; }},
      {"bytes of exposures, not", [&](BlockHeader& header) { header.exposure_bytes = most; }},
      {"bytes of exposures, not", [&](BlockHeader& header) { header.exposure_bytes = most - 191; }},
      {"bytes of payload", [&](BlockHeader& header) { header.payload_bytes = most; }},
      {"beyond the file's end", [&](BlockHeader& header) { header.stored_bytes = most; }},
      {"beyond the file's end", [&](BlockHeader& header) { header.stored_bytes = most - 63; }},
  };
  bool regular = false, irregular = false;
  for (std::uint64_t seed = 0; seed < 60 && !(regular && irregular); ++seed) {
    const RandomCase random(seed);
    bool& done = random.timeline.is_constant() ? regular : irregular;
    if (done || random.encode().block_count() < 3) continue;
    done = true;
    const Scratch scratch;
    const auto path = write_tik(random, {CodecId::zstd, 0}, scratch);
    const std::string file = test::read_file(path);
    const std::uint64_t offset = Reader(path).index()[1].offset;
    std::vector<Lie> told = lies;
    if (!random.timeline.is_constant()) {
      told.push_back({"0 bytes of exposures, not", [](BlockHeader& header) { header.exposure_bytes = 0; }});
    }
    for (const Lie& lie : told) {
      SCOPED_TRACE(random.text() + ": " + lie.complaint);
      Reader reader(scratch.write("lie.tik", with_header(file, offset, lie.tell)));
      const std::string message = test::message_of<InputError>([&] { return payload_of(reader, 1); });
      EXPECT_NE(message.find(lie.complaint), std::string::npos) << message;
      EXPECT_NO_THROW(static_cast<void>(payload_of(reader, 0)));

      std::filesystem::remove(scratch / "saved.tik");
      const std::string cut = with_header(file, offset, lie.tell);
      scratch.write("cut.tik", std::string_view(cut).substr(0, cut.size() - sizeof(Footer)));
      EXPECT_EQ(recover(scratch / "cut.tik", scratch / "saved.tik").block_count, 1u);
    }
  }
  EXPECT_TRUE(regular && irregular);
}

TEST(TikDamage, BelievesNoIndexThatCannotBe) {
  const Scratch scratch;
  std::string file = test::read_file(write_tik(RandomCase(3), {CodecId::zstd, 0}, scratch));
  const std::size_t footer_offset = file.size() - sizeof(Footer);
  Footer footer;
  std::memcpy(&footer, file.data() + footer_offset, sizeof footer);
  std::memset(file.data() + footer.index_offset + offsetof(IndexEntry, payload_bytes), 0xFF, 8);
  footer.index_checksum = checksum(
      std::as_bytes(std::span(file).subspan(footer.index_offset, footer.block_count * sizeof(IndexEntry))));
  footer.checksum = checksum_of(footer, offsetof(Footer, checksum));
  std::memcpy(file.data() + footer_offset, &footer, sizeof footer);
  const auto path = scratch.write("lie.tik", file);
  const std::string message = test::message_of<InputError>([&] { Reader reader(path); });
  EXPECT_NE(message.find("its index contradicts itself"), std::string::npos) << message;
}

}  // namespace
}  // namespace nutik::tik
