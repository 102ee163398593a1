// What a .tik file gives back, says in words, and is told apart by.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <opencv2/imgcodecs.hpp>
#include <thread>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "imev/expected_values.hpp"
#include "support/messages.hpp"
#include "support/payloads.hpp"
#include "support/program.hpp"
#include "support/scratch.hpp"
#include "support/tik_files.hpp"
#include "system/checksum.hpp"
#include "tik/block_headers.hpp"
#include "tik/reader.hpp"

namespace nutik::tik {
namespace {

using test::noisy_case;
using test::RandomCase;
using test::Scratch;
using test::write_tik;

TEST(TikFile, IsKnownAgainByItsContent) {
  const Scratch scratch, other;
  RandomCase random(3);
  const auto path = write_tik(random, Codec::parse("none"), scratch);
  const std::uint64_t checksum = Reader(path).content_checksum();
  EXPECT_EQ(Reader(write_tik(random, Codec::parse("none"), other)).content_checksum(), checksum);
  // One code of the last sample.
  const std::uint32_t code = test::code_at(random.capture, random.rasters.back(), 0);
  test::set_code(random.capture, random.rasters.back(), 0, code == 0 ? 1 : code - 1);
  EXPECT_NE(Reader(write_tik(random, Codec::parse("none"), other)).content_checksum(), checksum);
  random.timeline = Timeline::constant({7, 1}, {180, 1}, random.timeline.sample_count());
  EXPECT_NE(Reader(write_tik(random, Codec::parse("none"), other)).content_checksum(), checksum);
}

// An hour of a large clip has hundreds of thousands of blocks, maybe on another machine.
TEST(TikFile, IsKnownWithoutALookAtItsBlocks) {
  const Scratch scratch;
  const RandomCase random(3);
  const auto path = write_tik(random, Codec::parse("none"), scratch);
  const std::uint64_t checksum = Reader(path).content_checksum();
  std::string bytes = test::read_file(path);
  const std::uint64_t last_header = Reader(path).index().back().offset;
  bytes[last_header + offsetof(BlockHeader, payload_checksum)] ^= 1;
  EXPECT_EQ(Reader(scratch.write("damaged.tik", bytes)).content_checksum(), checksum);

  // Files of earlier programs have no such sum in the footer: there all headers are read.
  auto footer = load<Footer>(std::as_bytes(std::span(bytes)), bytes.size() - sizeof(Footer));
  footer.headers_checksum = 0;
  footer.checksum = checksum_of(footer, offsetof(Footer, checksum));
  std::memcpy(bytes.data() + bytes.size() - sizeof footer, &footer, sizeof footer);
  const std::uint64_t damaged = Reader(scratch.write("earlier.tik", bytes)).content_checksum();
  bytes[last_header + offsetof(BlockHeader, payload_checksum)] ^= 1;
  EXPECT_NE(Reader(scratch.write("earlier.tik", bytes)).content_checksum(), damaged);
}

TEST(TikFile, CarriesTheNoiseItWasEncodedWith) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const RandomCase random = noisy_case(seed);
    SCOPED_TRACE(random.text());
    const Scratch scratch;
    const std::filesystem::path path = write_tik(random, {CodecId::zstd, 0}, scratch);
    Reader reader(path);
    test::expect_same_capture(random, reader);
    const std::string text = test::read_file(path);
    EXPECT_NE(text.find("\n# TIK sigmas: 2.33"), std::string::npos);
    EXPECT_NE(text.find(format("\n# TIK noise: white {}\n", random.capture.white_code)), std::string::npos);
    EXPECT_EQ(text.find("# TIK tolerance"), std::string::npos);
  }
}

TEST(TikFile, RefusesNoiseOfOtherPictures) {
  const RandomCase random = noisy_case(3);
  const Scratch scratch;
  const std::string whole = test::read_file(write_tik(random, {CodecId::none, 0}, scratch));
  const auto message = [&](std::string_view was, std::string_view is) {
    std::string changed = whole;
    changed.replace(changed.find(was), was.size(), is);
    return test::message_of<InputError>([&] { return parse_header(std::as_bytes(std::span(changed)), "a.tik"); });
  };
  EXPECT_EQ(message("sigmas: 2", "sigmas: x"),
            "a.tik: the header is damaged: its sigmas are 'x.3333333333333335 standard deviations'");
  EXPECT_NE(message("noise: read", "noise: raed").find("'raed' is no key"), std::string::npos);
  EXPECT_EQ(message(format("noise: white {}", random.capture.white_code), "noise: white 100"),
            "a.tik: the header is damaged: its noise is that of other pictures");
}

TEST(TikFile, GivesBackWhatWasWritten) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const RandomCase random(seed);
    SCOPED_TRACE(random.text());
    for (const CodecId codec : {CodecId::none, CodecId::zstd}) {
      const Scratch scratch;
      Reader reader(write_tik(random, {codec, 0}, scratch));
      test::expect_same_capture(random, reader);
    }
  }
}

// Any Netpbm reader shows the first sample: OpenCV and Netpbm itself.
TEST(TikFile, OpensAsAPictureOfTheFirstSample) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const RandomCase random(seed);
    SCOPED_TRACE(random.text());
    const Scratch scratch;
    const auto path = write_tik(random, {CodecId::zstd, 0}, scratch);
    const auto netpbm = test::run_shell("pamfile capture.tik", scratch.folder());
    EXPECT_EQ(netpbm.status, 0) << netpbm.err;
    EXPECT_NE(netpbm.out.find(format("{} by {}", random.capture.shape.width, random.capture.shape.height)),
              std::string::npos)
        << netpbm.out;
    EXPECT_EQ(netpbm.out.find("Image 1"), std::string::npos) << "a second picture: " << netpbm.out;

    std::filesystem::copy_file(path, scratch / "capture.ppm");  // OpenCV goes by the name
    const cv::Mat picture = cv::imread((scratch / "capture.ppm").string(), cv::IMREAD_UNCHANGED);
    ASSERT_FALSE(picture.empty());
    const Shape& shape = random.capture.shape;
    ASSERT_EQ(picture.channels(), static_cast<int>(shape.channels));
    for (std::uint64_t value = 0; value < shape.value_count(); ++value) {
      const std::uint64_t pixel = value / shape.channels;
      const std::uint64_t channel = shape.channels == 3 ? 2 - value % 3 : 0;  // BGR
      const std::uint64_t at = pixel * shape.channels + channel;
      const std::uint32_t code =
          picture.depth() == CV_8U ? picture.ptr<std::uint8_t>()[at] : picture.ptr<std::uint16_t>()[at];
      ASSERT_EQ(code, test::code_at(random.capture, random.rasters[0], value)) << "value " << value;
    }
  }
}

TEST(TikFile, SaysWhatItIsInWords) {
  const RandomCase random(5);
  const Scratch scratch;
  const std::string text = test::read_file(write_tik(random, {CodecId::lz4, 0}, scratch)).substr(0, 600);
  for (const std::string& line : {std::string("# TIK 1 - an image evolution model"),
                                  format("# TIK channels: {}", random.capture.shape.channels),
                                  format("# TIK transfer: {}", random.capture.transfer.text()),
                                  format("# TIK tolerance: {} codes", random.capture.noise.tolerance),
                                  std::string("# TIK codec: lz4")}) {
    EXPECT_NE(text.find(line), std::string::npos) << "no '" << line << "' in\n" << text;
  }
}

TEST(TikFile, UnpacksAheadWhatItIsAskedFor) {
  std::uint64_t seed = 0;
  while (RandomCase(seed).timeline.sample_count() < 4) ++seed;
  RandomCase random(seed);
  random.block_samples = 2;
  for (const CodecId codec : {CodecId::none, CodecId::rice, CodecId::zstd}) {
    const Scratch scratch;
    Reader reader(write_tik(random, {codec, 0}, scratch));
    ASSERT_GE(reader.block_count(), 2u);
    EXPECT_EQ(reader.is_unchecked(1), codec == CodecId::none);
    reader.preload(1);
    EXPECT_FALSE(reader.is_unchecked(1));
    reader.preload(0);
    test::expect_same_capture(random, reader);
    // Once: what was unpacked ahead asks for no room, the next time does.
    reader.preload(0);
    reader.preload(1);
    const LeaseTerms no_room{[](std::uint64_t) { return std::span<std::byte>(); }};
    for (const std::uint64_t block : {1u, 0u}) {
      EXPECT_FALSE(reader.acquire(block, no_room).is_empty());
      EXPECT_EQ(reader.acquire(block, no_room).is_empty(), codec != CodecId::none);
    }
  }
}

// A payload is unpacked once, straight to where it is used; one that is not packed is lent where it is mapped.
TEST(TikFile, UnpacksToWhereThereIsRoom) {
  const RandomCase random(5);
  MemoryCapture capture = random.encode();
  const std::vector<std::byte> expected = test::payload_of(capture, 0);
  for (const CodecId codec : {CodecId::none, CodecId::rice, CodecId::lz4, CodecId::zstd}) {
    const Scratch scratch;
    Reader reader(write_tik(random, {codec, 0}, scratch));
    PageBuffer room(expected.size() + 1);
    std::uint64_t asked = 0;
    const BlockLease lease = reader.acquire(0, {[&](std::uint64_t bytes) {
                                              asked = bytes;
                                              return room.first(room.size());
                                            }});
    EXPECT_TRUE(std::ranges::equal(lease.payload(), expected));
    EXPECT_EQ(asked, codec == CodecId::none ? 0 : expected.size());
    EXPECT_EQ(lease.payload().data() == room.data(), codec != CodecId::none);
    const BlockLease none = reader.acquire(0, {[](std::uint64_t) { return std::span<std::byte>(); }});
    EXPECT_EQ(none.is_empty(), codec != CodecId::none);
  }
}

// Different blocks and the same one, some ahead, each lease for a while.
TEST(TikFile, IsReadBySeveralThreads) {
  RandomCase random(9);
  random.block_samples = 1;
  const MemoryCapture capture = random.encode();
  for (const CodecId codec : {CodecId::none, CodecId::zstd}) {
    const Scratch scratch;
    Reader reader(write_tik(random, {codec, 0}, scratch));
    EXPECT_FALSE(reader.is_forward_only());
    std::atomic<std::uint64_t> right = 0;
    const auto read = [&](std::uint64_t seed) {
      test::Random draw(seed);
      std::vector<BlockLease> leases;
      for (int turn = 0; turn < 50; ++turn) {
        const auto block =
            static_cast<std::uint64_t>(draw.whole(0, static_cast<std::int64_t>(reader.block_count()) - 1));
        if (draw.chance(0.3)) reader.preload(block);
        leases.push_back(reader.acquire(block));
        const BlockLease& any = draw.pick(leases);
        right += std::ranges::equal(any.payload(), capture.view(any.extent().first_sample).payload());
        if (leases.size() > 5) leases.erase(leases.begin() + draw.whole(0, 5));
      }
    };
    {
      std::vector<std::jthread> threads;
      for (std::uint64_t seed = 0; seed < 4; ++seed) threads.emplace_back(read, seed);
    }
    EXPECT_EQ(right, 200u);
  }
}

TEST(TikFile, TellsOtherFilesApart) {
  const Scratch scratch;
  const auto refusal = [&](std::string_view content) {
    const auto path = scratch.write("x.tik", content);
    return test::message_of<InputError>([&] { Reader reader(path); });
  };
  EXPECT_NE(refusal("").find("no .tik capture"), std::string::npos);
  EXPECT_NE(refusal("hello").find("no .tik capture"), std::string::npos);
  EXPECT_NE(refusal("P6\n2 2\n255\n123456789012").find("is a Netpbm picture, not a .tik file"),
            std::string::npos);
  EXPECT_NE(refusal("P6\n# TIK FPS=120\n2 2\n255\n...").find("TIK file of another program"),
            std::string::npos);
  EXPECT_NE(refusal("P6\n#TIK v1\n2 2\n255\n...").find("TIK file of another program"), std::string::npos);
  // An editor's hand.
  for (const char* changed : {"P6\r\n# TIK 1 - an\r\n", "P6\n# mine\n# TIK 1 - an\n"})
    EXPECT_NE(refusal(changed).find("the text at the file's start was changed"), std::string::npos);
  EXPECT_NE(refusal("P6\n# mine\n# TIK ").find("another program"), std::string::npos);
  EXPECT_NE(refusal("P6\n# TIK 7 - something newer\n").find("version 7; this program reads versions up to 1"),
            std::string::npos);
  EXPECT_NE(refusal("P6\n# TIK 0 - cut\n# TIK size: 2 x").find("header is damaged"), std::string::npos);
}

}  // namespace
}  // namespace nutik::tik
