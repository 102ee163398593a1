#include "session/clips/measured_noise.hpp"

#include <algorithm>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/noise_file.hpp"
#include "capture/text.hpp"
#include "session/clips/clip_source.hpp"
#include "system/input_bytes.hpp"
#include "system/mapped_file.hpp"

namespace nutik {
namespace {

constexpr double kLittleStill = 0.5;  // of the pixels
constexpr double kMuchShared = 0.25;  // of a variance
constexpr double kMuchUneven = 0.25;  // of the codes

std::string format_text(const CaptureFormat& format) {
  return nutik::format("{} x {} pixels, {} channel{}, {} bits, white code {}, transfer {}",
                       format.shape.width, format.shape.height, format.shape.channels,
                       format.shape.channels == 1 ? "" : "s", format.code_bytes * 8, format.white_code,
                       format.transfer.text());
}

}  // namespace

CameraNoise read_noise_file(const std::filesystem::path& path) {
  const MappedFile file(path);
  const auto bytes = file.bytes();
  check_text_bytes(path.string(), bytes.size());
  return parse_noise(as_text(bytes), path.string());
}

std::optional<std::string> transfer_note(const StatedNoise& stated, const Transfer& of_clip) {
  const CameraNoise& noise = stated.noise;
  // Measured points are in codes, whatever they stand for.
  const bool is_in_light = std::ranges::any_of(
      noise.channels, [](const ChannelNoise& channel) { return channel.curve == NoiseCurve::sensor; });
  if (!is_in_light || noise.transfer == of_clip) return std::nullopt;
  return format(
      "{} says transfer {} and the clip's is {}: read and shot noise are in light, and come to other codes; "
      "where the file's is wrong, measure the noise again or correct that line",
      stated.name, noise.transfer.text(), of_clip.text());
}

NoiseEstimate measure_noise(std::span<const std::string> clips, const ClipOptions& stated,
                            std::uint64_t max_samples, const MemoryBudget& memory, ClipTold& told) {
  ClipOptions options = stated;
  options.decoder_bytes = memory.bytes / 8;
  std::optional<CaptureFormat> first;
  std::optional<NoiseEstimator> estimator;
  for (const std::string& name : clips) {
    const std::unique_ptr<Clip> clip = open_clip(name, options);
    const CaptureFormat format = clip_format(*clip, options);
    for (const Note& note : clip->info().notes) told.notes.push_back(note);
    if (!first) {
      told.facts = clip->info().facts;
      const std::uint64_t within_decoder = clip->info().decoder_bytes;
      MemoryNeeds needs{{"pictures within the decoder", within_decoder}};
      needs.add(NoiseEstimator::needs(format, max_samples));
      static_cast<void>(needs.rest_of(memory.bytes));
      first = format;
      estimator.emplace(format,
                        NoiseEstimator::threads_in(memory.bytes - within_decoder, format, max_samples));
    } else if (format != *first) {
      throw InputError(nutik::format("{} is of another kind than {}: {} where that has {}", name,
                                     clips.front(), format_text(format), format_text(*first)));
    }
    estimator->add_clip(
        name, [&](std::span<std::byte> raster) { return clip->read(raster); }, max_samples);
  }
  return estimator->estimate();
}

std::string reason_for_no_noise(const NoiseEstimate& estimate) {
  double shared = 0, uneven = 0;
  for (const NoiseEstimate::Channel& channel : estimate.channels) {
    shared = std::max(shared, channel.shared);
    uneven = std::max(uneven, channel.uneven);
  }
  if (shared > kMuchShared) {
    return format(
        "pixels {} apart vary together, as noise of a sensor does not: something moves in most of the picture, "
        "or a codec took the noise away",
        kNeighbourPixels);
  }
  if (uneven > kMuchUneven) {
    return format(
        "at {:.0f} % of the codes some pixels vary more than others, as noise of a sensor does not: the camera or the "
        "scene moves, or a codec took the noise away",
        100 * uneven);
  }
  return {};
}

std::optional<Note> check_stillness(const Stillness& stillness, const SourceRequest& request) {
  const auto& [x, y, width, height] = stillness.region;
  const std::string where = format("{},{} … {},{}", x, y, x + width - 1, y + height - 1);
  const std::string when = format("pictures {} … {}", stillness.first_sample, stillness.last_sample);
  const char* cause = stillness.is_brightness
                          ? "the brightness of the whole picture drifts or flickers"
                          : "the camera or the scene moves, or a codec holds what it thinks is still";
  const char* first = "";
  if (stillness.is_brightness && !request.deflickered) first = "evened brightness (`deflicker`), ";
  if (!stillness.is_brightness && !request.align) first = "an aligned camera (`align rigid`), ";
  if (stillness.stray > stillness.limit) {
    throw InputError(
        format("{}: no noise can be measured on it: where pixels seem to stand still their light strays from what "
               "would be held for it by {:.2f} standard deviations of the noise, and the limit is {:.2f} "
               "(most at {}, by {:.2f}, and in {}): {}. {}",
               input_title(request.path.string()), stillness.stray, stillness.limit, where,
               stillness.max_stray, when, cause, kNoiseElsewhere),
        Advice{format("; or {}a part that stands still (`crop`, `from`, `to`)", first)});
  }
  if (stillness.max_stray <= stillness.max_limit) return std::nullopt;
  return Note(format("in {:.0f} % of the picture light changes by less than its noise: what is held there is "
                     "off by up to {:.2f} standard deviations of it (at {}), where {:.2f} may be; leave that "
                     "part out, or take a tolerance",
                     100 * stillness.stray_share, stillness.max_stray, where, stillness.max_limit),
              {Setting::crop, Setting::from, Setting::to});
}

std::vector<std::string> noise_notes(const NoiseEstimate& estimate) {
  std::vector<std::string> notes;
  double still = 1;
  bool is_sensor = true;
  for (std::size_t channel = 0; channel < estimate.channels.size(); ++channel) {
    still = std::min(still, estimate.channels[channel].still_share);
    is_sensor &= estimate.noise.channels[channel].curve == NoiseCurve::sensor;
  }
  if (still < kLittleStill) {
    notes.push_back(
        format("only {:.0f} % of the pixels are still: what moves slowly may count as noise; a still "
               "scene tells more",
               100 * still));
  }
  if (const std::string reason = reason_for_no_noise(estimate); !reason.empty())
    notes.push_back(reason + "; what moves leaves rings where codes are held within it");
  if (!is_sensor) {
    notes.push_back(
        "the noise is not that of a sensor (compressed clips are not, nor those whose transfer function is "
        "another): lines between the points are used, and nothing is known beyond them");
  }
  return notes;
}

}  // namespace nutik
