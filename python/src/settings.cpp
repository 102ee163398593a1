#include "settings.hpp"

#include <charconv>
#include <functional>
#include <string_view>

#include "session/below/capture.hpp"
#include "session/below/error.hpp"
#include "session/below/format.hpp"
#include "session/clips/clip_source.hpp"
#include "session/clips/measured_noise.hpp"
#include "system/input_bytes.hpp"

namespace nutik::python {
namespace {

std::uint32_t whole_number(const std::string& text, std::string_view name, std::uint32_t least,
                           std::uint32_t most) {
  std::uint32_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [read, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || read != end || value < least || value > most)
    throw UsageError(format("{}={} is no whole number of {} … {}", name, text, least, most));
  return value;
}

// `480x270:yuv420p10le`
RawVideo raw_video(const std::string& text) {
  const auto colon = text.find(':'), by = text.find('x');
  if (colon == std::string::npos || by > colon) {
    throw UsageError(format(
        "raw='{}' describes no video; write its size and pixel format, as in '480x270:yuv420p10le'", text));
  }
  constexpr std::uint32_t kLargestSide = 65'536;
  return {whole_number(text.substr(0, by), "raw", 1, kLargestSide),
          whole_number(text.substr(by + 1, colon - by - 1), "raw", 1, kLargestSide), text.substr(colon + 1)};
}

AlignRequest& aligned(SourceRequest& request, std::string_view name) {
  if (request.align) return *request.align;
  throw UsageError(
      format("{}= is said of pictures that are aligned: add align='rigid', or another motion", name));
}

void set_motion(SourceRequest& request, const std::string& text) {
  const auto motion = camera_motion_of(text);
  if (!motion)
    throw UsageError(format("align='{}' is no motion; choose 'translation', 'rigid' or 'homography'", text));
  request.align.emplace();
  request.align->motion = *motion;
}

void set_unseen(SourceRequest& request, const std::string& text) {
  if (text != "hold" && text != "crop")
    throw UsageError(format("unseen='{}' is neither 'crop' nor 'hold'", text));
  aligned(request, "unseen").unseen = text == "hold" ? Unseen::held : Unseen::cropped;
}

void set_noise(SourceRequest& request, const std::string& text) {
  if (request.tolerance > 0)
    throw UsageError("noise= and tolerance= both say what is no change; leave one out");
  if (text == "auto") {
    request.noise = NoiseOfClip{};
  } else {
    request.noise = StatedNoise{text, read_noise_file(text)};
  }
}

void set_sigmas(SourceRequest& request, const std::string& text) {
  if (std::holds_alternative<NoNoise>(request.noise)) {
    throw UsageError(
        "sigmas= counts standard deviations of a camera's noise: it needs noise='camera.noise' or "
        "noise='auto'");
  }
  request.sigmas = std::stod(text);
}

using Set = std::function<void(SourceRequest&, const std::string&)>;

// By name, in the order in which they are set: some refer to those before them.
const std::vector<std::pair<std::string, Set>>& setters() {
  constexpr std::uint32_t kLargestCode = 65'535;
  static const std::vector<std::pair<std::string, Set>> kSetters{
      {"rate", [](auto& r, auto& t) { r.clip.rate = Rational::parse(t, "rate"); }},
      {"shutter_angle", [](auto& r, auto& t) { r.shutter_angle = Rational::parse(t, "shutter_angle"); }},
      {"white", [](auto& r, auto& t) { r.clip.white_code = whole_number(t, "white", 1, kLargestCode); }},
      {"raw", [](auto& r, auto& t) { r.clip.raw = raw_video(t); }},
      {"transfer", [](auto& r, auto& t) { r.clip.transfer = Transfer::parse(t); }},
      {"matrix", [](auto& r, auto& t) { r.clip.matrix = parse_yuv_matrix(t); }},
      {"range", [](auto& r, auto& t) { r.clip.range = parse_code_range(t); }},
      {"chroma_at", [](auto& r, auto& t) { r.clip.chroma_at = parse_chroma_place(t); }},
      {"primaries", [](auto& r, auto& t) { r.clip.primaries = parse_primaries(t); }},
      {"pixel_aspect", [](auto& r, auto& t) { r.clip.pixel_aspect = parse_pixel_aspect(t); }},
      {"begin", [](auto& r, auto& t) { r.clip.from = clip_moment(StatedTime::parse(t, "begin"), "begin"); }},
      {"end", [](auto& r, auto& t) { r.clip.to = clip_moment(StatedTime::parse(t, "end"), "end"); }},
      {"deinterlace", [](auto& r, auto& t) { r.clip.interlaced = parse_deinterlacing(t); }},
      {"as_far_as_it_goes", [](auto& r, auto&) { r.clip.ends_at_damage = true; }},
      {"deflicker", [](auto& r, auto&) { r.deflickered = true; }},
      {"contrast", [](auto& r, auto& t) { r.clip.events.contrast = parse_contrast(t); }},
      {"start_picture", [](auto& r, auto& t) { r.clip.events.start = parse_start_light(t); }},
      {"tick", [](auto& r, auto& t) { r.clip.events.tick_ns = tick_ns(StatedTime::parse(t, "tick"), "tick"); }},
      {"crop", [](auto& r, auto& t) { r.clip.crop = parse_crop(t); }},
      {"scale", [](auto& r, auto& t) { r.clip.scale = parse_scale(t); }},
      {"align", set_motion},
      {"align_to",
       [](auto& r, auto& t) { aligned(r, "align_to").reference = StatedTime::parse(t, "align_to"); }},
      {"unseen", set_unseen},
      {"tolerance", [](auto& r, auto& t) { r.tolerance = whole_number(t, "tolerance", 0, kLargestCode); }},
      {"noise", set_noise},
      {"sigmas", set_sigmas},
      {"tiles", [](auto& r, auto& t) { r.tiles = parse_tile_policy(t); }},
      {"block_samples",
       [](auto& r, auto& t) { r.block_samples = whole_number(t, "block_samples", 1, kLargestBlockSamples); }},
  };
  return kSetters;
}

}  // namespace

SourceRequest source_request(const std::string& path, const Settings& settings) {
  SourceRequest request;
  request.path = path;
  for (const auto& each : setters()) {
    const auto stated = settings.find(each.first);
    if (stated != settings.end()) each.second(request, stated->second);
  }
  // Made here so that a senseless rate or angle is refused before anything is opened.
  static_cast<void>(Timeline::constant(request.clip.rate.value_or(Rational{1, 1}),
                                       request.shutter_angle.value_or(Timeline::kFullShutter), 1));
  return request;
}

ComputingRequest computing_request(const Settings& settings) {
  ComputingRequest request = ComputingRequest::of_environment();
  if (const auto memory = settings.find("memory"); memory != settings.end())
    request.memory = MemoryBudget{std::stoull(memory->second)};
  if (const auto renderer = settings.find("renderer"); renderer != settings.end()) {
    if (renderer->second != "opencl" && renderer->second != "reference")
      throw UsageError(
          format("renderer='{}' is not known; choose 'opencl' or 'reference'", renderer->second));
    if (renderer->second == "reference") request.renderer = RendererKind::reference;
  }
  const auto device = settings.find("device");
  if (request.renderer == RendererKind::reference) {
    if (device != settings.end())
      throw UsageError("device= chooses an OpenCL device; the reference uses none");
    request.device.clear();
  } else if (device != settings.end()) {
    request.device = device->second;
  }
  return request;
}

}  // namespace nutik::python
