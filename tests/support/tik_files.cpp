#include "support/tik_files.hpp"

#include <gtest/gtest.h>

#include "imev/expected_values.hpp"
#include "support/payloads.hpp"
#include "tik/writer.hpp"

namespace nutik::test {

std::filesystem::path write_tik(const MemoryCapture& capture, std::span<const std::byte> first, const tik::Codec& codec,
                                const Scratch& scratch) {
  const std::filesystem::path path = scratch / "capture.tik";
  const Timeline& timeline = capture.timeline();
  tik::Header header;
  header.capture = capture.format();
  if (timeline.is_constant()) header.rate = timeline.rate();
  header.shutter_angle = timeline.shutter_angle();
  tik::Writer writer(path, header, codec, first);
  for (std::uint64_t b = 0; b < capture.block_count(); ++b) {
    const BlockView view = capture.view(b);
    std::span<const Exposure> exposures;
    if (!timeline.is_constant()) {
      exposures = timeline.table().subspan(view.extent().first_sample, view.extent().sample_count);
    }
    writer.append({view.extent(), view.payload(), 0}, exposures);
  }
  writer.finish(timeline);
  return path;
}

std::filesystem::path write_tik(const RandomCase& random, const tik::Codec& codec, const Scratch& scratch) {
  return write_tik(random.encode(), to_held_codes(random.capture, random.rasters.front()), codec, scratch);
}

std::filesystem::path write_saying(const tik::Reader& plain, const std::filesystem::path& copy,
                                   const std::function<void(tik::Header&)>& change) {
  tik::Header header = plain.header();
  change(header);
  auto writer = tik::Writer::from_raster(copy, header, plain.first_sample());
  for (std::uint64_t block = 0; block < plain.block_count(); ++block) {
    const auto [stored, payload] = plain.stored(block);
    std::span<const Exposure> exposures;
    if (!plain.timeline().is_constant())
      exposures = plain.timeline().table().subspan(stored.first_sample, stored.sample_count);
    writer.append(stored, payload, exposures);
  }
  writer.finish(plain.timeline());
  return copy;
}

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

void expect_same_capture(const RandomCase& random, tik::Reader& reader) {
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
    const BlockLease lease = reader.acquire(b);
    EXPECT_EQ(lease.extent(), capture.block_extent(b));
    if (reader.index()[b].codec == static_cast<std::uint32_t>(tik::CodecId::none)) {
      const auto mapped = lease.mapping().subspan(lease.mapping_offset(), payload.size());
      ASSERT_TRUE(std::equal(payload.begin(), payload.end(), mapped.begin()));
      EXPECT_EQ(lease.mapping_offset() % kBlockAlignment, 0u);
    } else {
      EXPECT_TRUE(lease.mapping().empty());
    }
  }
}

}  // namespace nutik::test
