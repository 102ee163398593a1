#include <gtest/gtest.h>

#include <cstring>
#include <opencv2/imgcodecs.hpp>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "imev/expected_values.hpp"
#include "support/messages.hpp"
#include "support/program.hpp"
#include "support/random_case.hpp"
#include "support/scratch.hpp"
#include "tik/checksum.hpp"
#include "tik/reader.hpp"
#include "tik/writer.hpp"

namespace nutik::tik {
namespace {

using test::RandomCase;
using test::Scratch;

std::filesystem::path write(const RandomCase& random, const Codec& codec, const Scratch& scratch) {
  const std::filesystem::path path = scratch / "capture.tik";
  Header header;
  header.capture = held_format(random.capture);
  if (random.timeline.is_constant()) header.rate = random.timeline.rate();
  header.shutter_angle = random.timeline.shutter_angle();
  Writer writer(path, header, codec, to_held_codes(random.capture, random.rasters.front()));
  const MemoryCapture capture = random.encode();
  for (std::uint64_t b = 0; b < capture.block_count(); ++b) {
    const BlockView view = capture.view(b);
    std::span<const Exposure> exposures;
    if (!random.timeline.is_constant()) {
      exposures = random.timeline.table().subspan(view.extent().first_sample, view.extent().sample_count);
    }
    writer.append({view.extent(), view.payload(), 0}, exposures);
  }
  writer.finish(random.timeline);
  return path;
}

std::vector<std::byte> payload_of(Reader& reader, std::uint64_t block) {
  std::vector<std::byte> payload(reader.prepare(block));
  reader.read(block, payload);
  return payload;
}

void expect_same_capture(const RandomCase& random, Reader& reader) {
  const MemoryCapture capture = random.encode();
  EXPECT_EQ(reader.format(), held_format(random.capture));
  ASSERT_EQ(reader.block_count(), capture.block_count());
  ASSERT_EQ(reader.timeline().sample_count(), random.timeline.sample_count());
  EXPECT_EQ(reader.timeline().duration_ns(), random.timeline.duration_ns());
  for (std::uint64_t k = 0; k < random.timeline.sample_count(); ++k) {
    ASSERT_EQ(reader.timeline().start_ns(k), random.timeline.start_ns(k));
    ASSERT_EQ(reader.timeline().end_ns(k), random.timeline.end_ns(k));
  }
  for (std::uint64_t b = 0; b < reader.block_count(); ++b) {
    const auto payload = payload_of(reader, b);
    const auto expected = capture.view(b).payload();
    ASSERT_TRUE(std::equal(payload.begin(), payload.end(), expected.begin(), expected.end()));
    if (!reader.region().empty()) {
      const auto mapped = reader.region().subspan(reader.region_offset(b), payload.size());
      ASSERT_TRUE(std::equal(payload.begin(), payload.end(), mapped.begin()));
      EXPECT_EQ(reader.region_offset(b) % kBlockAlignment, 0u);
    }
  }
}

TEST(TikFile, IsKnownAgainByItsContent) {
  const Scratch scratch, other;
  RandomCase random(3);
  const auto path = write(random, Codec::parse("none"), scratch);
  const std::uint64_t checksum = Reader(path).content_checksum();
  EXPECT_EQ(Reader(write(random, Codec::parse("none"), other)).content_checksum(), checksum);
  // One code of the last sample.
  const std::uint32_t code = test::code_at(random.capture, random.rasters.back(), 0);
  test::set_code(random.capture, random.rasters.back(), 0, code == 0 ? 1 : code - 1);
  EXPECT_NE(Reader(write(random, Codec::parse("none"), other)).content_checksum(), checksum);
  random.timeline = Timeline::constant({7, 1}, {180, 1}, random.timeline.sample_count());
  EXPECT_NE(Reader(write(random, Codec::parse("none"), other)).content_checksum(), checksum);
}

// A random case whose camera's noise is known: points or a sensor, with as many digits as doubles have.
RandomCase noisy_case(std::uint64_t seed) {
  RandomCase random(seed);
  CaptureFormat& capture = random.capture;
  capture.noise = {};
  capture.noise.sigmas = 2.0 + 1.0 / 3;
  capture.noise.camera = CameraNoise{capture.white_code, capture.transfer, {}};
  for (std::uint32_t c = 0; c < capture.shape.channels; ++c) {
    const NoiseCurve curve = (seed + c) % 2 == 0 ? NoiseCurve::sensor : NoiseCurve::points;
    capture.noise.camera->channels.push_back(
        {curve, 0.01 / 3, 0.001 / 3, {{1.0 / 3, 1.5, 7}, {200.0 / 3, 10.0 / 3, 1'000'000}}});
  }
  return random;
}

TEST(TikFile, CarriesTheNoiseItWasEncodedWith) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const RandomCase random = noisy_case(seed);
    SCOPED_TRACE(random.text());
    const Scratch scratch;
    const std::filesystem::path path = write(random, {CodecId::zstd, 0}, scratch);
    Reader reader(path);
    expect_same_capture(random, reader);
    const std::string text = test::read_file(path);
    EXPECT_NE(text.find("\n# TIK sigmas: 2.33"), std::string::npos);
    EXPECT_NE(text.find(format("\n# TIK noise: white {}\n", random.capture.white_code)), std::string::npos);
    EXPECT_EQ(text.find("# TIK tolerance"), std::string::npos);
  }
}

TEST(TikFile, RecoversANoisyCaptureWithItsNoise) {
  RandomCase random = noisy_case(3);
  random.block_samples = 1;
  const Scratch scratch;
  const std::string whole = test::read_file(write(random, {CodecId::zstd, 0}, scratch));
  const Recovery recovery = recover(
      scratch.write("cut.tik", std::string_view(whole).substr(0, whole.size() - 100)), scratch / "saved.tik");
  EXPECT_EQ(recovery.sample_count, random.timeline.sample_count());
  EXPECT_EQ(Reader(scratch / "saved.tik").format(), held_format(random.capture));
}

TEST(TikFile, RefusesNoiseOfOtherPictures) {
  const RandomCase random = noisy_case(3);
  const Scratch scratch;
  const std::string whole = test::read_file(write(random, {CodecId::none, 0}, scratch));
  const auto message = [&](std::string_view was, std::string_view is) {
    std::string changed = whole;
    changed.replace(changed.find(was), was.size(), is);
    try {
      static_cast<void>(parse_header(std::as_bytes(std::span(changed)), "a.tik"));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("nothing was thrown");
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
      Reader reader(write(random, {codec, 0}, scratch));
      expect_same_capture(random, reader);
    }
  }
}

// Any Netpbm reader shows the first sample: OpenCV and Netpbm itself.
TEST(TikFile, OpensAsAPictureOfTheFirstSample) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const RandomCase random(seed);
    SCOPED_TRACE(random.text());
    const Scratch scratch;
    const auto path = write(random, {CodecId::zstd, 0}, scratch);
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
  const std::string text = test::read_file(write(random, {CodecId::lz4, 0}, scratch)).substr(0, 600);
  for (const std::string& line : {std::string("# TIK 0 - an image evolution model"),
                                  format("# TIK channels: {}", random.capture.shape.channels),
                                  format("# TIK transfer: {}", random.capture.transfer.text()),
                                  format("# TIK tolerance: {} codes", random.capture.noise.tolerance),
                                  std::string("# TIK codec: lz4")}) {
    EXPECT_NE(text.find(line), std::string::npos) << "no '" << line << "' in\n" << text;
  }
}

RandomCase case_with_blocks(std::uint64_t at_least) {
  for (std::uint64_t seed = 0;; ++seed) {
    RandomCase random(seed);
    if (random.encode().block_count() >= at_least && random.capture.shape.pixel_count() > 64) return random;
  }
}

// Rate, shutter and size stand in the text: a changed digit would give another picture without a word.
TEST(TikFile, RefusesAnyChangeBeforeItsFirstBlock) {
  const RandomCase random(3);
  const Scratch scratch;
  const std::string whole = test::read_file(write(random, {CodecId::none, 0}, scratch));
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

TEST(TikFile, IsNotRecoveredWithoutNeed) {
  const RandomCase random(3);
  const Scratch scratch;
  const auto path = write(random, {CodecId::none, 0}, scratch);
  EXPECT_NE(test::message_of<InputError>([&] { recover(path, scratch / "new.tik"); }).find("was not cut off"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(scratch / "new.tik"));
}

TEST(TikFile, UnpacksAheadWhatItIsAskedFor) {
  std::uint64_t seed = 0;
  while (RandomCase(seed).timeline.sample_count() < 4) ++seed;
  RandomCase random(seed);
  random.block_samples = 2;
  for (const CodecId codec : {CodecId::none, CodecId::zstd}) {
    const Scratch scratch;
    Reader reader(write(random, {codec, 0}, scratch));
    ASSERT_GE(reader.block_count(), 2u);
    reader.preload(1);
    expect_same_capture(random, reader);
  }
}

TEST(TikFile, ADamagedBlockCostsThatBlockOnly) {
  const RandomCase random = case_with_blocks(3);
  const Scratch scratch;
  const auto path = write(random, {CodecId::none, 0}, scratch);
  std::string bytes = test::read_file(path);
  std::uint64_t offset = 0;
  {
    Reader reader(path);
    offset = reader.region_offset(1);
  }
  bytes[offset + 200] = static_cast<char>(bytes[offset + 200] ^ 1);
  scratch.write("damaged.tik", bytes);
  Reader reader(scratch / "damaged.tik");
  const SampleRange samples = reader.block_extent(1).range();
  EXPECT_NO_THROW(payload_of(reader, 0));
  EXPECT_NO_THROW(payload_of(reader, 2));
  const std::string message = test::message_of<InputError>([&] { payload_of(reader, 1); });
  EXPECT_NE(message.find(format("the block of samples {} to {}", samples.first, samples.last - 1)),
            std::string::npos)
      << message;
  EXPECT_NE(message.find("damaged: its checksum does not match"), std::string::npos) << message;
}

TEST(TikFile, IsRecoveredUpToItsLastWholeBlock) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const RandomCase random(seed);
    SCOPED_TRACE(random.text());
    const Scratch scratch;
    const auto path = write(random, {CodecId::zstd, 0}, scratch);
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
      const std::string message = test::message_of<InputError>([&] { Reader(scratch / "cut.tik"); });
      EXPECT_NE(message, "nothing was thrown");
      if (whole == 0) {
        EXPECT_NE(test::message_of<InputError>([&] { recover(scratch / "cut.tik", scratch / "new.tik"); }),
                  "nothing was thrown");
        EXPECT_FALSE(std::filesystem::exists(scratch / "new.tik"));
        continue;
      }
      EXPECT_NE(message.find("nutik-cl recover"), std::string::npos) << message;
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

TEST(TikFile, BelievesNoHeaderThatCannotBe) {
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
      {"its codec 3 is not known", [](BlockHeader& header) { header.codec = 3; }},
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
    const auto path = write(random, {CodecId::zstd, 0}, scratch);
    const std::string file = test::read_file(path);
    const std::uint64_t offset = Reader(path).index()[1].offset;
    std::vector<Lie> told = lies;
    if (!random.timeline.is_constant()) {
      told.push_back({"0 bytes of exposures, not", [](BlockHeader& header) { header.exposure_bytes = 0; }});
    }
    for (const Lie& lie : told) {
      SCOPED_TRACE(random.text() + ": " + lie.complaint);
      Reader reader(scratch.write("lie.tik", with_header(file, offset, lie.tell)));
      const std::string message = test::message_of<InputError>([&] { payload_of(reader, 1); });
      EXPECT_NE(message.find(lie.complaint), std::string::npos) << message;
      EXPECT_NO_THROW(payload_of(reader, 0));

      std::filesystem::remove(scratch / "saved.tik");
      const std::string cut = with_header(file, offset, lie.tell);
      scratch.write("cut.tik", std::string_view(cut).substr(0, cut.size() - sizeof(Footer)));
      EXPECT_EQ(recover(scratch / "cut.tik", scratch / "saved.tik").block_count, 1u);
    }
  }
  EXPECT_TRUE(regular && irregular);
}

TEST(TikFile, TellsOtherFilesApart) {
  const Scratch scratch;
  const auto refusal = [&](std::string_view content) {
    const auto path = scratch.write("x.tik", content);
    return test::message_of<InputError>([&] { Reader reader(path); });
  };
  EXPECT_NE(refusal("").find("no .tik file"), std::string::npos);
  EXPECT_NE(refusal("hello").find("no .tik file"), std::string::npos);
  EXPECT_NE(refusal("P6\n2 2\n255\n123456789012").find("is a Netpbm picture, not a .tik file"),
            std::string::npos);
  EXPECT_NE(refusal("P6\n# TIK FPS=120\n2 2\n255\n...").find("TIK file of another program"),
            std::string::npos);
  EXPECT_NE(refusal("P6\n#TIK v1\n2 2\n255\n...").find("TIK file of another program"), std::string::npos);
  EXPECT_NE(refusal("P6\n# TIK 7 - something newer\n").find("version 7; this program reads version 0"),
            std::string::npos);
  EXPECT_NE(refusal("P6\n# TIK 0 - cut\n# TIK size: 2 x").find("header is damaged"), std::string::npos);
}

}  // namespace
}  // namespace nutik::tik
