#include "tik/writer.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "capture/error.hpp"
#include "imev/block_lease.hpp"

namespace nutik::tik {
namespace {

template <typename T>
std::span<const std::byte> bytes_of(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

// Netpbm has one byte a value up to a maximum of 255, above that two, the high one first.
std::vector<std::byte> netpbm_raster(const CaptureFormat& capture, std::span<const std::byte> sample) {
  const bool wide = capture.white_code > 255;
  if (capture.code_bytes == 1) return {sample.begin(), sample.end()};
  std::vector<std::byte> raster;
  raster.reserve(capture.shape.value_count() * (wide ? 2 : 1));
  for (std::size_t i = 0; i < sample.size(); i += 2) {
    if (wide) raster.push_back(sample[i + 1]);
    raster.push_back(sample[i]);
  }
  return raster;
}

void pad(OutputFile& file) {
  constexpr std::array<std::byte, kAlignment> kZeros{};
  file.write(std::span(kZeros).first(align_up(file.size(), kAlignment) - file.size()));
}

Header with_codec(Header header, const Codec& codec) {
  header.codec = codec.text();
  return header;
}

}  // namespace

Writer::Writer(const std::filesystem::path& path, const Header& header, const Codec& codec,
               std::span<const std::byte> first_sample, std::uint32_t max_threads,
               OutputFile::Lasting lasting)
    : Writer(path, with_codec(header, codec), codec,
             NetpbmRaster{netpbm_raster(header.capture, first_sample)}, max_threads, lasting) {}

Writer Writer::from_raster(const std::filesystem::path& path, const Header& header,
                           std::span<const std::byte> raster) {
  return {path,
          header,
          Codec{CodecId::none, 0},
          NetpbmRaster{{raster.begin(), raster.end()}},
          1,
          OutputFile::Lasting::recoverable};
}

Writer::Writer(const std::filesystem::path& path, Header header, const Codec& codec,
               const NetpbmRaster& raster, std::uint32_t max_threads, OutputFile::Lasting lasting)
    : file_(path, lasting), header_(std::move(header)), codec_(codec), max_threads_(max_threads) {
  header_.version = kVersion;
  std::vector<std::byte> front = raster.bytes;
  const std::string text = header_.text();
  const auto text_bytes = std::as_bytes(std::span(text));
  front.insert(front.begin(), text_bytes.begin(), text_bytes.end());
  // Never 'P', after which a reader would look for a second picture.
  front.push_back(std::byte{'\n'});
  front.resize(align_up(front.size(), kAlignment));
  const std::vector<std::byte> fields = packed_fields(header_.fields());
  front.insert(front.end(), fields.begin(), fields.end());
  front.resize(align_up(front.size(), kAlignment));
  front_checksum_ = checksum(front);
  file_.write(front);
}

void Writer::append(const BuiltBlock& block, std::span<const Exposure> exposures) {
  const BlockGeometry geometry(header_.capture, block.extent.sample_count);
  const PayloadParts parts(geometry, block.payload);
  std::vector<std::span<const std::byte>> packed_parts;
  std::span<const std::span<const std::byte>> stored = parts.parts();
  std::uint64_t stored_bytes = parts.bytes();
  Codec codec = codec_;
  if (codec_.id != CodecId::none) {
    codec = pack_block(geometry, block.payload);
    packed_parts.assign(packed_.begin(), packed_.end());
    stored = packed_parts;
    stored_bytes = 0;
    for (const std::span<const std::byte> part : stored) stored_bytes += part.size();
  }
  BlockHeader header{};
  header.first_sample = block.extent.first_sample;
  header.sample_count = block.extent.sample_count;
  header.codec = static_cast<std::uint32_t>(codec.id);
  header.stored_bytes = stored_bytes;
  header.payload_bytes = parts.bytes();
  header.record_count = block.record_count;
  append(header, stored, exposures);
}

Codec Writer::pack_block(const BlockGeometry& geometry, std::span<const std::byte> payload) {
  const Codec rice{CodecId::rice, 0};
  if (codec_.id == CodecId::rice || header_.capture.noise.tolerance == 0) {
    pack(codec_, geometry, payload, packed_, max_threads_, packing_);
    return codec_;
  }
  pack(rice, geometry, payload, packed_, max_threads_);  // quick, and told of by what follows
  std::uint64_t bytes = 0;
  for (const std::vector<std::byte>& part : packed_) bytes += part.size();
  if (!pack(codec_, geometry, payload, other_, max_threads_, packing_, bytes)) return rice;
  std::swap(packed_, other_);
  return codec_;
}

void Writer::append(const BlockHeader& stored, std::span<const std::byte> payload,
                    std::span<const Exposure> exposures) {
  append(stored, {&payload, 1}, exposures);
}

void Writer::append(BlockHeader header, std::span<const std::span<const std::byte>> payload,
                    std::span<const Exposure> exposures) {
  if (exposures.size() != (header_.rate ? 0 : header.sample_count) || header.first_sample != sample_count_) {
    throw std::logic_error("a block does not continue its .tik file");
  }
  std::memcpy(header.magic, kBlockMagic, sizeof header.magic);
  header.block = index_.size();
  header.exposure_bytes = exposures.size_bytes();
  header.exposures_checksum = exposures.empty() ? 0 : checksum(std::as_bytes(exposures));
  header.front_checksum = front_checksum_;

  const std::uint64_t offset = file_.size();
  index_.push_back({offset, header.first_sample, header.sample_count, header.codec, header.stored_bytes,
                    header.payload_bytes, header.record_count});
  // The header comes last: it holds the checksum of the payload, which is summed up while it is written.
  file_.write(std::vector<std::byte>(sizeof header));
  file_.write(std::as_bytes(exposures));
  pad(file_);
  header.payload_checksum = write_summed(payload);
  pad(file_);
  header.header_checksum = checksum_of(header, offsetof(BlockHeader, header_checksum));
  file_.replace(offset, bytes_of(header));
  headers_.add(bytes_of(header));
  sample_count_ += header.sample_count;
}

std::uint64_t Writer::write_summed(std::span<const std::span<const std::byte>> parts) {
  constexpr std::size_t kRunBytes = 256 << 10;  // stays in a core's cache
  Checksum checksum;
  const auto write_run = [&] {
    checksum.add(run_);
    file_.write(run_);
    run_.clear();
  };
  for (std::span<const std::byte> part : parts) {
    while (!part.empty()) {
      const auto taken = part.first(std::min(part.size(), kRunBytes - run_.size()));
      run_.insert(run_.end(), taken.begin(), taken.end());
      part = part.subspan(taken.size());
      if (run_.size() == kRunBytes) write_run();
    }
  }
  write_run();
  return checksum.value();
}

void Writer::finish(const Timeline& timeline) {
  if (timeline.sample_count() != sample_count_ || timeline.is_constant() != header_.rate.has_value()) {
    throw std::logic_error("a .tik file was finished with another timeline");
  }
  finish_file(file_, index_, headers_.value(), timeline);
}

void finish_file(OutputFile& file, std::span<const IndexEntry> index, std::uint64_t headers_checksum,
                 const Timeline& timeline) {
  pad(file);  // a file that was cut off right behind a payload lacks its padding
  Footer footer{};
  footer.sample_count = timeline.sample_count();
  footer.block_count = index.size();
  footer.duration_ns = timeline.duration_ns();
  footer.index_offset = file.size();
  footer.index_checksum = checksum(std::as_bytes(index));
  footer.headers_checksum = headers_checksum;
  file.write(std::as_bytes(index));
  pad(file);
  if (!timeline.is_constant()) {
    footer.exposures_offset = file.size();
    footer.exposures_checksum = checksum(std::as_bytes(timeline.table()));
    file.write(std::as_bytes(timeline.table()));
    pad(file);
  }
  footer.checksum = checksum_of(footer, offsetof(Footer, checksum));
  std::memcpy(footer.magic, kFooterMagic, sizeof footer.magic);
  file.write(bytes_of(footer));
  file.commit();
}

}  // namespace nutik::tik
