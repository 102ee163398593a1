#include "features/schema/requests.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "plot/canvas.hpp"
#include "session/clips/clip_source.hpp"
#include "session/clips/measured_noise.hpp"
#include "session/text/number_text.hpp"
#include "session/text/text_table.hpp"
#include "sheet/contact_sheet.hpp"
#include "system/input_bytes.hpp"

namespace nutik {
namespace {

std::optional<AlignRequest> align_request(const Options& options) {
  if (!options.align && !options.align_along) {
    for (const char* name : {"align-to", "unseen", "align-report", "camera-path", "camera-plot", "coverage"}) {
      if (!options.has(name)) continue;
      throw UsageError(Advice{
          format("`{}` is said of pictures that are aligned: add `align rigid`, or another motion", name)});
    }
    return std::nullopt;
  }
  AlignRequest request;
  if (options.align_along) {
    if (options.align || options.align_to) {
      throw UsageError(Advice{format("`align-along` says motion and reference already; leave `{}` out",
                                     options.align ? "align" : "align-to")});
    }
    request.path.emplace(
        parse_camera_path(InputBytes(*options.align_along).text(), input_title(*options.align_along)));
  } else {
    request.motion = *options.align;
  }
  request.reference = options.align_to;
  request.unseen = options.unseen.value_or(request.unseen);
  return request;
}

void read_noise(SourceRequest& request, const Options& options) {
  if (options.noise && options.has("tolerance"))
    throw UsageError(Advice{"`noise` and `tolerance` both say what is no change; leave one out"});
  if (options.has("sigmas") && !options.noise) {
    throw UsageError(Advice{
        "`sigmas` counts standard deviations of a camera's noise: it needs `noise FILE` or `noise auto`"});
  }
  if (options.noise == kAutomaticNoise) {
    request.noise = NoiseOfClip{};
  } else if (options.noise) {
    request.noise = StatedNoise{*options.noise, read_noise_file(*options.noise)};
  }
}

Rectangle region_of(const std::string& text) {
  const std::vector<double> n = parse_numbers(text, "region");
  const auto is_whole = [](double each) { return each >= 0 && each <= 65'535 && each == std::floor(each); };
  if (n.size() != 4 || !std::ranges::all_of(n, is_whole) || n[2] == 0 || n[3] == 0) {
    throw UsageError(
        Advice{format("`region` '{}' is no rectangle; write whole pixels: X,Y,WIDTH,HEIGHT", text)});
  }
  const auto pixels = [&](std::size_t i) { return static_cast<std::uint32_t>(n[i]); };
  return {pixels(0), pixels(1), pixels(2), pixels(3)};
}

// What says nothing to a style without a subject.
void refuse_for_style(const Options& options, StudyStyle style) {
  const bool is_slit = style == StudyStyle::slit;
  const auto fail = [&](std::string_view name, std::string_view why) {
    throw UsageError(Advice{
        format("`{}` says nothing to `style {}`, which {}; leave it out", name, options.text("style"), why)});
  };
  for (const char* name : {"moments", "feather", "by", "spacing", "trail"}) {
    const bool is_of_strips = name == std::string_view("moments") || name == std::string_view("feather");
    if (options.has(name) && !(is_slit && is_of_strips))
      fail(name, is_slit ? "shows a moment in each strip" : "shows no subject");
  }
  if (options.has("region")) fail("region", "follows no subject");
}

}  // namespace

SourceRequest clip_request(const Options& options, const std::string& name) {
  SourceRequest request = options.source;
  request.path = name;
  request.align = align_request(options);
  read_noise(request, options);
  // Made here so that a senseless rate or angle is refused before anything is opened.
  static_cast<void>(Timeline::constant(request.clip.rate.value_or(Rational{1, 1}),
                                       request.shutter_angle.value_or(Timeline::kFullShutter), 1));
  return request;
}

ComputingRequest computing_request(const Options& options) {
  ComputingRequest request = ComputingRequest::of_environment();
  if (options.memory) request.memory = *options.memory;
  request.strict = options.strict;
  if (options.renderer == RendererKind::reference) {
    if (options.device)
      throw UsageError(Advice{"`device` chooses an OpenCL device; the reference uses none"});
    if (options.has("precision"))
      throw UsageError(Advice{"`precision` goes with OpenCL; the reference uses double"});
    request.device.clear();
    request.renderer = RendererKind::reference;
    return request;
  }
  if (options.device) request.device = *options.device;
  request.precision = options.precision;
  return request;
}

ExposureRequest exposure_without_gains(const Options& options) {
  ExposureRequest request = options.asked;
  request.plan.transfer = options.source.clip.transfer;
  if (options.combining.is_mean) request.normalization = Normalization::parse("integral");
  if (options.combining.is_mean && options.has("normalize"))
    throw UsageError(Advice{"`combine mean` divides by the gain's integral, and so says `normalize`; use one"});
  request.plan.combine = options.combining.how;
  if (request.plan.combine != Combine::integral && request.normalization.text() != Normalization().text())
    throw UsageError(Advice{"`normalize` divides an integral, and `combine` takes single samples here; leave one out"});
  if (request.plan.combine != Combine::integral && request.delay)
    throw UsageError(Advice{"`combine` goes with one time for all pixels, and `delay` has one for each; use one"});
  request.gain = brightening(options);
  if (request.delay) request.delay->read();
  return request;
}

Shutter stated_shutter(const Options& options) {
  return {options.shutter.value_or(ShutterShape()),
          options.shutter_error.value_or(ShutterShape::kDefaultError)};
}

double brightening(const Options& options) {
  const double gain = options.gain.value_or(ExposureRequest().gain) * (options.ev ? std::exp2(*options.ev) : 1.0);
  if (!std::isfinite(gain) || gain == 0.0) {
    std::vector<std::string> stated;
    for (const char* name : {"gain", "ev"}) {
      if (options.has(name)) stated.push_back(format("`{} {}`", name, options.text(name)));
    }
    throw UsageError(Advice{format("{} makes a picture of nothing but {}; choose a number nearer to {}",
                                   joined(stated, " "), gain == 0.0 ? "black" : "infinite light",
                                   options.gain ? "1" : "0")});
  }
  return gain;
}

SweepRequest sweep_request(const Options& options) {
  const std::vector<SweepRange>& ranges = options.sweep;
  if (ranges.empty()) {
    throw UsageError(
        Advice{"what is varied? Add `shift 0..1s/0.1s`, `scale-gain 0.5..2/0.25` or `stretch 0.5..2/0.5`"});
  }
  if (ranges.size() > 2)
    throw UsageError("three parameters do not fit a sheet; vary one, or two as rows and columns");
  std::uint64_t pictures = 1;
  for (const SweepRange& range : ranges) {
    const std::uint64_t count = range.count();
    if (count > sheet::kMaxPictures || pictures * count > sheet::kMaxPictures) {
      throw UsageError(format("a sheet holds {} pictures and this sweep makes {}{}; take a larger STEP",
                              sheet::kMaxPictures, pictures > 1 ? format("{} x ", pictures) : "", count));
    }
    pictures *= count;
  }
  return {ranges};
}

StudyRequest study_request(const Options& options) {
  StudyRequest request = options.study;
  const bool is_slit = request.style == StudyStyle::slit;
  if (options.has("slit-from") && !is_slit)
    throw UsageError(Advice{"`slit-from` goes with `style slit` only; leave it out, or state that style"});
  if (is_slit || request.style == StudyStyle::clean) refuse_for_style(options, request.style);
  for (const Said& said : options.said) {
    if (said.option == "region") request.regions.push_back(region_of(said.words.front()));
  }
  request.joins_trail = options.joins_by_itself();
  request.by_codes = options.by;
  request.feather = options.feather;
  if (!options.has("moments")) request.moments = usual_moments(request.style);
  check_study(request);
  return request;
}

}  // namespace nutik
