#include "app/command_line/option_groups.hpp"

namespace nutik::app {
namespace {

using Id = CommandId;

constexpr std::string_view kGroup = "Output";

}  // namespace

std::vector<Option> output_options() {
  return {
      valued('o', "output", "FILE", kGroup,
             "where to write; without it the last operand, or a name made from the inputs",
             bit(Id::encode) | kExposesFunctions | bit(Id::recover) | bit(Id::noise), &Options::output),
      valued(0, "depth", "BITS", kGroup,
             "8, 16 or float: light as it is, with negatives (default: the capture's own, float for .pfm)",
             kExposesFunctions, &Options::depth),
      valued(
          0, "codec", "NAME", kGroup,
          "pack blocks with none (large, quickest to expose), lz4, zstd or zstd:1 … zstd:19 (default: zstd)",
          bit(Id::encode), &Options::codec),
      valued(0, "tiles", "KIND", kGroup,
             "auto, or all tiles as dense, rows or records, for experiments (default: auto)", kReadsClips,
             &Options::tiles),
      valued(0, "block-samples", "N", kGroup, "samples in a block (default: 64, fewer for large pictures)",
             kReadsClips, &Options::block_samples),
      valued(0, "activity", "MAP.png", kGroup,
             "also write how often each pixel changes, as a grey picture: black never, white most often, "
             "between them sRGB",
             bit(Id::info), &Options::activity),
      flag('q', "quiet", kGroup, "no progress bar and no summary", kAllCommands, &Options::quiet),
      flag('v', "verbose", kGroup, "also say in which precision, how fast and with how much memory", kExposes,
           &Options::verbose),
  };
}

}  // namespace nutik::app
