// Reads a .tik file: maps it, checks what it says of itself, and hands out its blocks.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "capture/error.hpp"
#include "imev/capture_source.hpp"
#include "system/mapped_file.hpp"
#include "tik/file_layout.hpp"
#include "tik/header.hpp"

namespace nutik::tik {

// Saves what is whole of a .tik that was cut off.
struct Recovery {
  std::uint64_t block_count = 0;
  std::uint64_t sample_count = 0;
  std::uint64_t lost_bytes = 0;  // after the last whole block
};

// Copies the whole blocks at the front of a cut-off .tik into a new, complete one. Throws InputError
// where there is none, OutputError where it cannot be written.
Recovery recover(const std::filesystem::path& damaged, const std::filesystem::path& whole);

// A .tik that cannot be read to its end, of which recover() may save the front.
struct Recoverable : InputError {
  Recoverable(const std::string& message, std::string file_name)
      : InputError(message), name(std::move(file_name)) {}

  std::string name;
};

// Any number of threads may acquire blocks and ask for everything else, at a time.
class Reader final : public CaptureSource {
 public:
  // `-` is standard input. Throws InputError where the file is no .tik, of another version, damaged at its front;
  // Recoverable where it is damaged at its end or cut off.
  explicit Reader(const std::filesystem::path& path);

  [[nodiscard]] const CaptureFormat& format() const override { return header_.capture; }
  [[nodiscard]] const Timeline& timeline() const override { return timeline_; }
  [[nodiscard]] std::uint64_t block_count() const override { return index_.size(); }
  [[nodiscard]] BlockExtent block_extent(std::uint64_t block) const override {
    return {index_[block].first_sample, index_[block].sample_count};
  }

  // A packed block lends all of its payload.
  [[nodiscard]] std::uint64_t lent_bytes(std::uint64_t block) const override {
    return index_[block].codec == static_cast<std::uint32_t>(CodecId::none) ? 0 : index_[block].payload_bytes;
  }

  [[nodiscard]] bool is_unchecked(std::uint64_t block) const override {
    return lent_bytes(block) == 0 && !are_right_[block];
  }

  // Unpacks a packed block, checks another.
  void preload(std::uint64_t block) override;

  // A block as it lies in the file, its checksum compared. Throws as acquire() does.
  struct StoredBlock {
    BlockHeader header;
    std::span<const std::byte> payload;
  };
  [[nodiscard]] StoredBlock stored(std::uint64_t block) const;
  // Its payload is not looked at again soon: a capture may be larger than memory.
  void release(const StoredBlock& block) const { file_.release(block.payload); }
  // The raster of the picture at the front.
  [[nodiscard]] std::span<const std::byte> first_sample() const;

  // A block's tile directory alone: what kinds of tiles it has costs no look at their bodies. Only the
  // header's checksum is checked.
  [[nodiscard]] std::vector<TileEntry> directory(std::uint64_t block) const;

  [[nodiscard]] const Header& header() const { return header_; }
  [[nodiscard]] std::span<const IndexEntry> index() const { return index_; }
  // XXH3-64 of the footer, which holds that of all block headers, which hold those of everything else: so this tells
  // any two captures apart and reads 128 bytes. Of a file of an earlier program, whose footer lacks it, that of all
  // block headers, one behind the other, and the footer. Damaged blocks are not noticed.
  [[nodiscard]] std::uint64_t content_checksum() const;
  [[nodiscard]] std::uint64_t file_bytes() const { return file_.bytes().size(); }

 private:
  void read_footer();
  void check_front() const;
  void check_unchanged() const override { file_.check(); }
  // A block that is not packed is lent where it is mapped; a packed one where it is unpacked.
  BlockLease lend(std::uint64_t block, const LeaseTerms& terms) override;
  [[nodiscard]] BlockLease unpacked(std::uint64_t block, const BlockHeader& header,
                                    const LeaseTerms& terms) const;
  [[nodiscard]] BlockLease take_preloaded(std::uint64_t block);
  // Checksums, and of a block that is not packed the payload.
  // Once for each block: check_unchanged() tells where the file was written to since.
  void check(std::uint64_t block, const BlockHeader& header) const;
  // Whether all is well with a payload as check() looks at it, in one pass.
  [[nodiscard]] bool is_right(std::uint64_t block, const BlockHeader& header,
                              std::span<const std::byte> payload) const;
  using TileRuns = std::vector<std::pair<std::uint64_t, std::uint64_t>>;
  // Directory and sample numbers: a file that was made up can have wrong ones under right checksums. Of the tiles
  // [first, last) of each pair that was unpacked; without them of all.
  void check_payload(std::uint64_t block, std::span<const std::byte> payload,
                     const std::optional<TileRuns>& unpacked = {}) const;
  [[nodiscard]] std::uint64_t mapped_offset(std::uint64_t block, const BlockHeader& header) const;

  [[nodiscard]] BlockHeader block_header(std::uint64_t block) const;
  [[nodiscard]] std::span<const std::byte> stored_payload(std::uint64_t block,
                                                          const BlockHeader& header) const;
  // Throws where its checksum does not match.
  [[nodiscard]] std::span<const std::byte> whole_payload(std::uint64_t block,
                                                         const BlockHeader& header) const;
  [[noreturn]] void fail(const std::string& why) const;
  [[noreturn]] void fail_block(std::uint64_t block, const std::string& why) const;

  std::string name_;
  MappedFile file_;
  mutable std::vector<std::atomic<bool>> are_right_;  // blocks that were checked
  Header header_;
  std::vector<IndexEntry> index_;
  Timeline timeline_ = Timeline::constant({1, 1}, Timeline::kFullShutter, 0);

  std::mutex preloading_;  // guards what follows
  std::map<std::uint64_t, BlockLease> preloaded_;
};

}  // namespace nutik::tik
