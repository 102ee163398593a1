// Writes a .tik file from front to end.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "imev/block.hpp"
#include "system/output_file.hpp"
#include "tik/codec.hpp"
#include "tik/format.hpp"
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
         std::span<const std::byte> first_sample, std::uint32_t most_threads = ~std::uint32_t{0},
         OutputFile::Lasting lasting = OutputFile::Lasting::yes);

  // Appends the next block; with an irregular timeline also its samples' exposures, times from the
  // first sample's start.
  void append(const BuiltBlock& block, std::span<const Exposure> exposures = {});

  // Writes index, exposures and footer and gives the file its name. The timeline must be the header's
  // kind and have as many samples as were appended.
  void finish(const Timeline& timeline);

  [[nodiscard]] std::uint64_t bytes_written() const { return file_.size(); }

 private:
  // Appends what lies in these parts; returns its checksum.
  std::uint64_t write_summed(std::span<const std::span<const std::byte>> parts);

  OutputFile file_;
  Header header_;
  Codec codec_;
  std::uint32_t most_threads_;  // that pack
  std::vector<IndexEntry> index_;
  std::uint64_t front_checksum_ = 0;  // of what stands before the first block
  std::uint64_t sample_count_ = 0;
};

// Writes what comes after the blocks (index, exposures, footer) and gives the file its name.
void finish_file(OutputFile& file, std::span<const IndexEntry> index, const Timeline& timeline);

}  // namespace nutik::tik
