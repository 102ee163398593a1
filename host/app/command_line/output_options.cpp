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
             (kReadsClips & ~set_of(Id::batch, Id::check, Id::validate)) | set_of(Id::recover, Id::noise),
             &Options::output),
      one_of(
          valued(
              0, "depth", "BITS", kGroup,
              "8, 16 or float: light as it is, with negatives (default: the capture's own, float for .pfm)",
              set_of(Id::expose, Id::video, Id::validate), &Options::depth),
          {"8", "16", "float"}),
      one_of(valued(0, "negative", "HOW", kGroup,
                    "what codes make of light below 0: saturate (black), offset (light 0 is mid-grey, light "
                    "below it "
                    "darker), abs (as bright as light above it) (default: saturate)",
                    kExposesFreely, &Options::negative),
             {"saturate", "offset", "abs"}),
      one_of(valued(0, "codec", "NAME", kGroup,
                    "pack blocks with none (large, quickest to expose), lz4, zstd or zstd:1 … zstd:19 "
                    "(default: zstd)",
                    bit(Id::encode), &Options::codec),
             {"none", "lz4", "zstd", "zstd:"}),
      one_of(valued(0, "tiles", "KIND", kGroup,
                    "auto, or all tiles as dense, rows or records, for experiments (default: auto)",
                    kEncodesClips, &Options::tiles),
             {"auto", "dense", "rows", "records"}),
      valued(0, "block-samples", "N", kGroup, "samples in a block (default: 64, fewer for large pictures)",
             kEncodesClips, &Options::block_samples),
      valued(0, "activity", "MAP.png", kGroup,
             "also write how often each pixel changes, as a grey picture: black never, white most often, "
             "between them sRGB",
             bit(Id::info), &Options::activity),
      flag(0, "json", kGroup, "answer with one JSON object, for scripts", kAnswersInJson, &Options::json),
      flag(0, "no-recipe", kGroup,
           "do not keep in the picture how it was made: names, functions and options (see nutik-cl again)",
           set_of(Id::expose, Id::batch, Id::sweep), &Options::no_recipe),
      flag('q', "quiet", kGroup, "no progress bar and no summary", kAllCommands, &Options::quiet),
      flag('v', "verbose", kGroup,
           "say more: what is read and what is skipped, in which precision and why, how fast and with how "
           "much memory; every step of a trace",
           (kExposes & ~bit(Id::mask)) | bit(Id::trace), &Options::verbose),
  };
}

}  // namespace nutik::app
