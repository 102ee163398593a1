#include "app/output/output_name.hpp"
#include "app/output/report.hpp"
#include "app/words/stated_requests.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "features/schema/options.hpp"
#include "media/stills/still_sequence.hpp"
#include "session/clips/measured_noise.hpp"
#include "system/output_file.hpp"

namespace nutik::app {
namespace {

// `red: 1.82 codes at 20.1 … 3.05 at 231 (41 points), read 0.0021 and shot 0.00012 fit within 0.6 %`
std::string channel_text(const NoiseEstimate& estimate, std::size_t channel) {
  const ChannelNoise& noise = estimate.noise.channels[channel];
  const NoisePoint &dark = noise.points.front(), &bright = noise.points.back();
  return format(
      "  {:<6}{:.3g} codes at {:.4g} … {:.3g} at {:.4g} ({} points); read {:.3g} and shot {:.3g} {} "
      "within {:.1f} %",
      channel_name(estimate.channels.size(), channel), dark.sd, dark.code, bright.sd, bright.code,
      noise.points.size(), noise.read, noise.shot,
      noise.curve == NoiseCurve::sensor ? "fit them" : "fit them only",
      100 * estimate.channels[channel].misfit);
}

}  // namespace

int run_noise(const Options& options) {
  const Stopwatch stopwatch;
  if (options.operands.empty()) {
    throw UsageError("a clip of a still scene is missing: nutik-cl noise still-scene.mp4 -o camera.noise");
  }
  for (const std::string& name : options.operands) {
    if (is_tik(name)) {
      throw UsageError(
          format("{} is a capture: noise is measured on the clip that a capture was made from", name));
    }
  }
  const std::filesystem::path output =
      options.output ? *options.output : sequence_name(options.operands.front()) + ".noise";
  check_output(output, OutputKind::noise, options.operands, replacing(options));

  ClipTold told;
  const NoiseEstimate estimate =
      measure_noise(options.operands, clip_request(options, options.operands.front()).clip,
                    NoiseEstimator::kMaxSamples, memory_budget(options), told);
  std::vector<std::string> comments;
  for (const std::string& name : options.operands) {
    comments.push_back("measured on " + std::filesystem::path(name).filename().string());
  }
  write_text(output, noise_text(estimate.noise, comments));

  Answer answer{
      {{"noise", output.string()}, {"samples", estimate.sample_count}, {"channels", Json::array()}}};
  double still = 1;
  for (std::size_t channel = 0; channel < estimate.channels.size(); ++channel) {
    const NoiseEstimate::Channel& measured = estimate.channels[channel];
    still = std::min(still, measured.still_share);
    answer.json["channels"].push_back({{"still_share", measured.still_share},
                                       {"alike_share", measured.shared},
                                       {"uneven_share", measured.uneven}});
    answer.details.push_back(channel_text(estimate, channel));
  }
  answer.json["seconds"] = stopwatch.seconds();
  answer.line = format("{}: measured on {} samples, {:.1f} % of the pixels still, {:.2f} s", output.string(),
                       estimate.sample_count, 100 * still, stopwatch.seconds());
  answer.tell_source(told.facts, told.notes);
  std::ranges::move(noise_notes(estimate), std::back_inserter(answer.notes));
  return tell(options, output, answer, options.output.has_value());
}

}  // namespace nutik::app
