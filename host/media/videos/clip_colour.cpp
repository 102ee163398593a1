#include "media/videos/clip_colour.hpp"

#include "media/settled_fact.hpp"

namespace nutik::videos {
namespace {

bool is_colour_yuv(const Probe& probe) { return is_yuv(probe.pixel_format) && !probe.pixels.is_grey; }

}  // namespace

YuvCoding yuv_coding(const Probe& probe, const ClipOptions& options, const std::string& name) {
  if (!is_colour_yuv(probe)) refuse_yuv_options(options);
  if (options.chroma_at && !interpolates_chroma(probe.pixel_format, probe.pixels)) {
    throw UsageError(format("each pixel of {} has {}: leave the place of chroma out", name,
                            probe.pixels.is_everyday()
                                ? "the chroma of the sample that it shares, as in all video of 8 bits"
                                : "chroma of its own"),
                     {Setting::chroma_place});
  }
  if (!probe.unread_matrix.empty() && !options.matrix) {
    throw InputError(
        format("{} names a matrix by which no RGB is made here, {}: its colours would be wrong. Convert "
               "it, for example with ffmpeg -vf zscale=matrix=709, or state the matrix that it really has",
               name, probe.unread_matrix),
        {Setting::matrix});
  }
  return {options.matrix.value_or(probe.matrix.value_or(usual_matrix(probe.shape.height))),
          options.range.value_or(probe.range.value_or(CodeRange::limited)), options.chroma_at};
}

void describe(ClipInfo& info, const Probe& probe, const ClipOptions& options) {
  const PixelKind& pixels = probe.pixels;
  CaptureFormat& capture = info.format;
  std::vector<Fact>& facts = info.facts;
  if (pixels.is_grey && pixels.bits > 8) {
    const bool fills_its_bits = pixels.bits == 16;
    settle_white(info, options.white_code,
                 fills_its_bits ? std::nullopt : std::optional(pixels.white_code()));
  }
  // Deep grey pictures, and those of 16 bits, come from scientific cameras, which are linear; other deep colour from
  // film cameras.
  const bool is_scientific = pixels.bits > 8 && (pixels.is_grey || pixels.bits == 16);
  // Everyday cameras name BT.709's curve whatever theirs is, and players show sRGB's. Others are meant.
  const bool is_meant = !pixels.is_everyday() || probe.transfer != Transfer::bt709();
  const auto named = is_meant ? probe.transfer : std::nullopt;
  capture.transfer =
      settle(facts, options.transfer, named, is_scientific ? Transfer::linear() : Transfer::srgb(),
             Setting::transfer, [](const Transfer& transfer) { return "transfer " + transfer.text(); });
  if (facts.back().origin == Origin::assumed && !probe.transfer_name.empty()) {
    facts.back().remark = format("the file names {}", probe.transfer_name);
  }
  if (is_colour_yuv(probe)) {
    settle(facts, options.matrix, probe.matrix, usual_matrix(probe.shape.height), Setting::matrix,
           [](YuvMatrix matrix) { return format("matrix {}", to_text(matrix)); });
    settle(facts, options.range, probe.range, CodeRange::limited, Setting::range,
           [](CodeRange range) { return format("{} range", to_text(range)); });
  }
  if (interpolates_chroma(probe.pixel_format, pixels)) {
    settle(facts, options.chroma_at, probe.chroma_at, kDefaultChromaPlace, Setting::chroma_place,
           [](ChromaPlace place) { return format("chroma at {}", to_text(place)); });
  }
  if (!pixels.is_grey) {
    const bool is_wide =
        options.matrix.value_or(probe.matrix.value_or(usual_matrix(probe.shape.height))) == YuvMatrix::bt2020;
    capture.primaries = settle(
        facts, options.primaries, probe.primaries, is_wide ? Primaries::bt2020 : Primaries::bt709,
        Setting::primaries, [](Primaries primaries) { return format("primaries {}", to_text(primaries)); });
    if (facts.back().origin == Origin::file && !probe.near_primaries.empty()) {
      facts.back().remark = format("it names {}", probe.near_primaries);
    }
  }
  capture.pixel_aspect = settle(facts, options.pixel_aspect, probe.pixel_aspect, Rational{1, 1},
                                Setting::pixel_aspect, pixel_aspect_text);
}

}  // namespace nutik::videos
