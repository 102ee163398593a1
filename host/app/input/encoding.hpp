// Turns a clip into a capture file: three stages side by side, so that decoding goes on while a block is closed,
// packed and written.
//
//   a thread        decodes samples               │ rasters, reused (media/read_ahead.hpp)
//   this one        builds blocks from them       │ payloads, reused
//   another         packs and writes the blocks
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/input/capture_input.hpp"
#include "app/output/progress.hpp"
#include "media/read_ahead.hpp"
#include "system/channel.hpp"
#include "tik/writer.hpp"

namespace nutik::app {

class Encoding {
 public:
  // Reads the first sample. Throws InputError where there is none or where the clip's times cannot be used,
  // OutputError where `output` cannot be written. `input` names the clip in messages; `options` must
  // outlive the encoding.
  Encoding(SourceClip source, const SourceOptions& options, const tik::Codec& codec, const std::string& input,
           const std::filesystem::path& output);

  // Encodes all of the clip; the file appears under its name at the end. Returns its timeline.
  Timeline run(Progress& progress);

  [[nodiscard]] std::uint64_t bytes_written() const { return writer_->bytes_written(); }
  [[nodiscard]] const SourceClip& source() const { return source_; }

 private:
  struct Block {
    BlockExtent extent;
    PageBuffer payload;
    FinishedBlock finished;
  };

  [[nodiscard]] Timeline timeline_for(std::uint64_t samples) const;
  void warn_of_count(std::uint64_t samples) const;
  std::uint64_t build(Progress& progress);  // how many samples there were
  bool hand_over_block();                   // false where nobody stores blocks any more
  void store();

  SourceClip source_;
  const SourceOptions& options_;
  std::string input_;
  BlockBuilder builder_;
  Timeline times_;  // as announced
  std::optional<tik::Writer> writer_;

  ReadAhead samples_;
  std::span<const std::span<const std::byte>> first_;  // the first sample, until the next are asked for
  Channel<Block> blocks_;                              // built
  Channel<PageBuffer> spare_payloads_;
};

}  // namespace nutik::app
