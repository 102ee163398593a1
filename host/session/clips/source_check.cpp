#include "session/clips/source_check.hpp"

#include <algorithm>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "imev/each_block.hpp"
#include "imev/expected_values.hpp"
#include "media/clip_part.hpp"
#include "session/clips/clip_source.hpp"
#include "session/text/number_text.hpp"

namespace nutik {
namespace {

std::string samples_text(const CaptureFormat& format) {
  return nutik::format("{}, {} bits, white code {}", shape_text(format.shape), format.code_bytes * 8,
                       format.white_code);
}

// What the samples of a capture were before it was encoded.
CaptureFormat source_format(const CaptureFormat& capture) {
  CaptureFormat source = capture;
  if (capture.noise.camera) {
    source.white_code = capture.noise.camera->white_code;
    source.code_bytes = source.white_code > 255 ? 2 : 1;
  }
  return source;
}

// The same clip gives the same path.
AlignRequest same_alignment(const tik::Alignment& aligned) {
  AlignRequest request;
  request.motion = camera_motion_of(aligned.motion).value_or(request.motion);
  request.reference = StatedTime::of_pictures(static_cast<std::int64_t>(aligned.reference));
  request.unseen = aligned.holds_unseen ? Unseen::held : Unseen::cropped;
  return request;
}

}  // namespace

SourceCheck compare_with_source(tik::Reader& capture, SourceRequest clip, const MemoryBudget& memory,
                                const ReportedProgress& progress) {
  const CaptureFormat wanted = source_format(capture.format());
  const std::string name = input_title(clip.path.string());
  const std::uint64_t sample_count = capture.timeline().sample_count();
  const auto& made = capture.header().made;
  clip.noise = NoNoise{};  // the capture has its noise model
  if (!clip.clip.white_code && wanted.code_bytes == 2) clip.clip.white_code = wanted.white_code;
  if (const auto& aligned = capture.header().alignment; aligned && !clip.align)
    clip.align = same_alignment(*aligned);
  clip.between.reset();  // only samples that were filmed are compared
  const std::uint64_t pictures = made ? made->after.size() : sample_count;
  const auto& part = capture.header().part;
  const bool is_part = part && !clip.clip.from;
  if (is_part) clip.clip.from = ClipMoment{static_cast<std::int64_t>(part->first), true};
  if (!clip.clip.crop) clip.clip.crop = crop_told(capture.header().facts);
  ClipSource source = open_clip_source(clip, memory);
  if (is_part && clip.align && !clip.clip.to && source.capture.shape != wanted.shape) {
    // The crop of aligned pictures follows from where the part ends. One that was cut off ended later.
    clip.clip.to = ClipMoment{static_cast<std::int64_t>(part->first + pictures), true};
    source = open_clip_source(clip, memory);
  }
  if (source.capture.shape != wanted.shape || source.capture.code_bytes != wanted.code_bytes ||
      source.capture.white_code != wanted.white_code) {
    throw InputError(format("{} is not what the capture was made from: it has {}, the capture {}", name,
                            samples_text(source.capture), samples_text(wanted)),
                     {Setting::crop, Setting::scale});
  }

  const MemoryNeeds needs{{"pictures within the decoder", source.clip->info().decoder_bytes},
                          {"a picture of the clip", wanted.sample_bytes()},
                          {"two pictures of the capture", 2 * capture.format().sample_bytes()},
                          {"a block", largest_block(capture)}};
  needs.rest_of(memory.bytes);
  SourceCheck check{SourceComparison(wanted), capture.file_bytes(), wanted.sample_bytes() * pictures, false,
                    sample_count - pictures};
  const std::vector<bool> is_made = made ? made->marks() : std::vector<bool>(sample_count);
  std::uint64_t picture = 0;
  std::vector<std::byte> raster(wanted.sample_bytes());
  for_each_block(capture, [&](const BlockView& block) {
    for (std::uint32_t k = 0; k < block.extent().sample_count; ++k) {
      const std::uint64_t sample = block.extent().first_sample + k;
      if (!is_made[sample] && !source.clip->read(raster)) {
        throw InputError(format("{} is not what the capture was made from: it has {} pictures, the capture {}", name,
                                picture, pictures),
                         {Setting::from});
      }
      check.comparison.add(block, k, is_made[sample] ? std::span<const std::byte>() : raster);
      if (!is_made[sample]) ++picture;
      if (progress) progress(sample, sample_count);
    }
  });
  check.clip_goes_on = source.clip->read(raster);
  return check;
}

void check_stated_transfer(const tik::Header& header, const std::string& name,
                           const std::optional<Transfer>& stated) {
  const Transfer& held = header.capture.transfer;
  if (!stated || Transfer::restated(held, *stated) == held) return;
  const char* const why = header.capture.noise.camera ? "what a camera's noise explains was held as its mean"
                          : header.is_scaled          ? "pictures were scaled"
                          : header.alignment          ? "pictures were moved by fractions of a pixel"
                          : header.made               ? "samples were made between pictures, in light"
                                                      : nullptr;
  if (why == nullptr) return;
  throw UsageError(
      format("{} holds codes that are means of light by {}: {}. By {} that light has other means, and "
             "no code says which; encode the clip again with it",
             name, held.text(), why, stated->text()),
      {Setting::transfer});
}

}  // namespace nutik
