// Writes a .tik file from front to end.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <utility>
#include <vector>

#include "imev/block.hpp"
#include "system/checksum.hpp"
#include "system/output_file.hpp"
#include "tik/codec.hpp"
#include "tik/file_layout.hpp"
#include "tik/header.hpp"

namespace nutik::tik {

// A block as it comes from a BlockBuilder: its payload may have room between its bodies.
struct BuiltBlock {
  BlockExtent extent;
  std::span<const std::byte> payload;
  std::uint64_t record_count = 0;
};

class Writer {
 public:
  // Starts the file with the picture of the first sample: header.capture.sample_bytes() bytes. Nothing
  // stands under `path` before finish(). Throws OutputError where it cannot be written.
  Writer(const std::filesystem::path& path, const Header& header, const Codec& codec,
         std::span<const std::byte> first_sample, std::uint32_t max_threads = ~std::uint32_t{0},
         OutputFile::Lasting lasting = OutputFile::Lasting::recoverable);

  // The same of a picture that lay at the front of another .tik: a Netpbm raster.
  static Writer from_raster(const std::filesystem::path& path, const Header& header,
                            std::span<const std::byte> raster);

  // What pack() tells of each block that is appended, by the codec that was asked for.
  void tell_of_packing(ReportedProgress packing) { packing_ = std::move(packing); }

  // Appends the next block; with an irregular timeline also its samples' exposures, times from the
  // first sample's start.
  void append(const BuiltBlock& block, std::span<const Exposure> exposures = {});

  // The same of a block as it lay in another .tik.
  void append(const BlockHeader& stored, std::span<const std::byte> payload,
              std::span<const Exposure> exposures);

  // Writes index, exposures and footer and gives the file its name. The timeline must be the header's
  // kind and have as many samples as were appended.
  void finish(const Timeline& timeline);

  [[nodiscard]] std::uint64_t bytes_written() const { return file_.size(); }

 private:
  struct NetpbmRaster {
    std::vector<std::byte> bytes;
  };
  Writer(const std::filesystem::path& path, Header header, const Codec& codec, const NetpbmRaster& raster,
         std::uint32_t max_threads, OutputFile::Lasting lasting);

  void append(BlockHeader header, std::span<const std::span<const std::byte>> payload,
              std::span<const Exposure> exposures);
  // Into packed_; returns the codec that did it. Rice's alone counts codes that move by steps of a tolerance: it packs
  // what it makes smaller than the codec that was asked for.
  Codec pack_block(const BlockGeometry& geometry, std::span<const std::byte> payload);
  // Appends what lies in these parts; returns its checksum.
  std::uint64_t write_summed(std::span<const std::span<const std::byte>> parts);

  OutputFile file_;
  Header header_;
  Codec codec_;
  std::uint32_t max_threads_;  // that pack
  ReportedProgress packing_;
  // The last block, whose memory the next one is packed into; and the same where two codecs pack it.
  std::vector<std::vector<std::byte>> packed_, other_;
  std::vector<std::byte> run_;  // of what is packed, to be written at once
  std::vector<IndexEntry> index_;
  Checksum headers_;  // of all block headers so far
  std::uint64_t front_checksum_ = 0;  // of what stands before the first block
  std::uint64_t sample_count_ = 0;
};

// Writes what comes after the blocks (index, exposures, footer) and gives the file its name.
// `headers_checksum` is that of all block headers, one behind the other.
void finish_file(OutputFile& file, std::span<const IndexEntry> index, std::uint64_t headers_checksum,
                 const Timeline& timeline);

}  // namespace nutik::tik
