#include "app/requests/requests.hpp"

#include "app/command_line/option_table.hpp"
#include "app/text/number_text.hpp"
#include "session/below/capture.hpp"
#include "session/below/error.hpp"
#include "session/below/format.hpp"
#include "session/clips/clip_source.hpp"
#include "session/clips/measured_noise.hpp"

namespace nutik::app {
namespace {

RawVideo parse_raw_video(const std::string& text) {
  const auto colon = text.find(':');
  if (colon == std::string::npos || text.find('x') > colon) {
    throw UsageError(format(
        "raw video '{}' is not described; write its size and pixel format, as in 480x270:yuv420p10le", text));
  }
  constexpr std::uint32_t kLargestSide = 65'536;
  const auto [width, height] =
      parse_pair(text.substr(0, colon), 'x', {"width", 1, kLargestSide}, {"height", 1, kLargestSide}, {});
  return {width, height, text.substr(colon + 1)};
}

// A .tik was described when it was made.
void refuse_source_options(const Options& options, const std::string& capture) {
  for (const Option& option : app::options()) {
    if (!option.describes_clip() || !option.is_in(options)) continue;
    throw UsageError(format("{} describes a clip that is encoded; {} was encoded already. {}", option.name(),
                            capture,
                            option.is_of(CommandId::retime)
                                ? format("To correct it: nutik-cl retime {} … {} NEW.tik", option.name(), capture)
                                : "Encode the clip again with it"));
  }
}

void read_noise(SourceRequest& request, const Options& options) {
  if (options.tolerance)
    request.tolerance = parse_whole_number(*options.tolerance, "--tolerance", 0, 65'535);
  if (options.noise && options.tolerance) {
    throw UsageError("--noise and --tolerance both say what is no change; leave one out");
  }
  if (options.sigmas && !options.noise) {
    throw UsageError(
        "--sigmas counts standard deviations of a camera's noise: it needs --noise FILE or --noise auto");
  }
  if (options.sigmas)
    request.sigmas =
        parse_number(*options.sigmas, "--sigmas", SourceRequest::kMinSigmas, SourceRequest::kMaxSigmas);
  if (options.noise == kAutomaticNoise) {
    request.noise = NoiseOfClip{};
  } else if (options.noise) {
    request.noise = StatedNoise{*options.noise, read_noise_file(*options.noise)};
  }
}

}  // namespace

SourceRequest source_request(const Options& options, const std::string& name) {
  // Standard input is looked at by the session, once all else that may be wrong is known.
  if (is_standard_input(name) || !is_tik(name)) return clip_request(options, name);
  refuse_source_options(options, name);
  SourceRequest request;
  request.path = name;
  if (options.transfer) request.clip.transfer = Transfer::parse(*options.transfer);
  return request;
}

SourceRequest clip_request(const Options& options, const std::string& name) {
  SourceRequest request;
  request.path = name;
  if (options.fps) request.clip.rate = Rational::parse(*options.fps, "--fps");
  if (options.shutter_angle)
    request.shutter_angle = Rational::parse(*options.shutter_angle, "--shutter-angle");
  if (options.white) request.clip.white_code = parse_whole_number(*options.white, "--white", 1, 65'535);
  if (options.raw) request.clip.raw = parse_raw_video(*options.raw);
  if (options.transfer) request.clip.transfer = Transfer::parse(*options.transfer);
  if (options.matrix) request.clip.matrix = parse_yuv_matrix(*options.matrix);
  if (options.range) request.clip.range = parse_code_range(*options.range);
  if (options.chroma_at) request.clip.chroma_at = parse_chroma_place(*options.chroma_at);
  if (options.primaries) request.clip.primaries = parse_primaries(*options.primaries);
  if (options.pixel_aspect) request.clip.pixel_aspect = parse_pixel_aspect(*options.pixel_aspect);
  if (options.clip_from)
    request.clip.from = clip_moment(StatedTime::parse(*options.clip_from, "--from"), "--from");
  if (options.clip_to) request.clip.to = clip_moment(StatedTime::parse(*options.clip_to, "--to"), "--to");
  if (options.deinterlace) request.clip.interlaced = parse_deinterlacing(*options.deinterlace);
  request.clip.ends_at_damage = options.as_far_as_it_goes;
  request.deflickered = options.deflicker;
  if (options.contrast) request.clip.events.contrast = parse_contrast(*options.contrast);
  if (options.start_picture) request.clip.events.start = parse_start_light(*options.start_picture);
  if (options.tick) request.clip.events.tick_ns = tick_ns(StatedTime::parse(*options.tick, "--tick"), "--tick");
  if (options.crop) request.clip.crop = parse_crop(*options.crop);
  if (options.scale) request.clip.scale = parse_scale(*options.scale);
  request.align = align_request(options);
  read_noise(request, options);
  if (options.tiles) request.tiles = parse_tile_policy(*options.tiles);
  if (options.block_samples) {
    request.block_samples =
        parse_whole_number(*options.block_samples, "--block-samples", 1, kLargestBlockSamples);
  }
  // Made here so that a senseless rate or angle is refused before anything is opened.
  static_cast<void>(Timeline::constant(request.clip.rate.value_or(Rational{1, 1}),
                                       request.shutter_angle.value_or(Timeline::kFullShutter), 1));
  return request;
}

}  // namespace nutik::app
