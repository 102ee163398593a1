#include "tik/block_headers.hpp"

#include <algorithm>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "imev/block.hpp"
#include "imev/block_builder.hpp"
#include "system/checksum.hpp"

namespace nutik::tik {

bool is_whole(const BlockHeader& header) {
  return std::memcmp(header.magic, kBlockMagic, sizeof header.magic) == 0 &&
         header.header_checksum == checksum_of(header, offsetof(BlockHeader, header_checksum));
}

bool is_packed(const BlockHeader& header) {
  return header.codec != static_cast<std::uint32_t>(CodecId::none);
}

std::uint64_t exposures_offset(std::uint64_t block_offset) { return block_offset + sizeof(BlockHeader); }

std::uint64_t payload_offset(std::uint64_t block_offset, const BlockHeader& header) {
  return align_up(exposures_offset(block_offset) + header.exposure_bytes, kAlignment);
}

std::string flaw_of(const BlockHeader& header, const HeaderPlace& place, std::uint64_t file_bytes) {
  if (header.block != place.block) return format("its header is that of block {}", header.block);
  if (header.first_sample != place.first_sample) {
    return format("its header tells of sample {} as its first", header.first_sample);
  }
  if (header.sample_count == 0 || header.sample_count > kLargestBlockSamples) {
    return format("its header tells of {} samples; it can have 1 … {}", header.sample_count,
                  kLargestBlockSamples);
  }
  if (header.codec > static_cast<std::uint32_t>(CodecId::rice)) {
    return format("its codec {} is not known", header.codec);
  }
  const std::uint64_t exposure_bytes = place.is_regular ? 0 : header.sample_count * sizeof(Exposure);
  if (header.exposure_bytes != exposure_bytes) {
    return format("its header tells of {} bytes of exposures, not {}", header.exposure_bytes, exposure_bytes);
  }
  if (header.payload_bytes > kLargestPayloadBytes ||
      (!is_packed(header) && header.payload_bytes != header.stored_bytes)) {
    return format("its header tells of {} bytes of payload", header.payload_bytes);
  }
  // The block's start lies in the file and exposures take a mebibyte at most: no sum comes near 2^64.
  if (!fits(payload_offset(place.offset, header), header.stored_bytes, file_bytes)) {
    return format("its {} bytes reach beyond the file's end", header.stored_bytes);
  }
  return {};
}

std::vector<Exposure> load_exposures(std::span<const std::byte> bytes) {
  std::vector<Exposure> exposures(bytes.size() / sizeof(Exposure));
  if (!exposures.empty()) std::memcpy(exposures.data(), bytes.data(), exposures.size() * sizeof(Exposure));
  return exposures;
}

namespace {

// The same with the times of what was filmed. Of a file of earlier programs these are what made samples left of them.
Timeline with_pictures(const Timeline& timeline, const Header& header) {
  MadeSamples made = *header.made;
  if (!made.cut_to(timeline.sample_count())) return timeline;
  const std::size_t count = made.after.size();
  if (const auto* const rate = header.filmed ? std::get_if<Rational>(&*header.filmed) : nullptr)
    return timeline.with_pictures(Timeline::constant(*rate, header.shutter_angle, count));
  std::vector<Exposure> exposures;
  if (header.filmed) {
    exposures = std::get<std::vector<Exposure>>(*header.filmed);
    if (exposures.size() < count) throw InputError("not every picture has one");
    exposures.resize(count);
  } else {
    const std::vector<bool> is_made = made.marks();
    for (std::uint64_t k = 0; k < is_made.size(); ++k)
      if (!is_made[k]) exposures.push_back({timeline.start_ns(k), timeline.end_ns(k)});
  }
  const std::int64_t duration_ns = std::max(timeline.duration_ns(), exposures.back().end_ns);
  return timeline.with_pictures(Timeline::stored(std::move(exposures), duration_ns, header.shutter_angle));
}

}  // namespace

Timeline timeline_of(const Header& header, std::uint64_t samples, std::vector<Exposure> exposures,
                     std::optional<std::int64_t> duration_ns, const std::string& name) {
  try {
    if (header.rate) return Timeline::constant(*header.rate, header.shutter_angle, samples);
    const Timeline timeline = duration_ns
                                  ? Timeline::stored(std::move(exposures), *duration_ns, header.shutter_angle)
                                  : Timeline::explicit_exposures(std::move(exposures));
    return header.made ? with_pictures(timeline, header) : timeline;
  } catch (const Error& error) {
    throw InputError(nutik::format("{}: its times are damaged: {}", name, error.what()));
  }
}

}  // namespace nutik::tik
