#include "studio/live/overview.hpp"

#include <algorithm>

#include "features/activity/activity.hpp"
#include "studio/live/picture_image.hpp"

namespace nutik::studio {
namespace {

constexpr std::uint64_t kThumbnails = 12;
constexpr int kThumbnailHeight = 90;  // twice what the strip is high, for screens of many pixels

}  // namespace

CaptureOverview thumbnails_of(Session& session, const Job& job) {
  const Timeline& timeline = session.timeline();
  const std::uint64_t count = std::min(kThumbnails, timeline.sample_count());
  CaptureOverview overview;
  for (std::uint64_t k = 0; k < count; ++k) {
    job.progress(k, count);
    const std::uint64_t sample = (2 * k + 1) * timeline.sample_count() / (2 * count);
    ExposureRequest exposure;
    exposure.start = StatedTime::of_pictures(static_cast<std::int64_t>(sample));
    exposure.gains = PlainInterval{StatedTime::of_pictures(1), Shutter()};
    RenderControl control;
    control.stop = job.stop;
    const QImage image = image_of(session.render(exposure, screen_format(), control).picture);
    overview.thumbnails.push_back(
        {timeline.start_ns(sample), image.scaledToHeight(kThumbnailHeight, Qt::SmoothTransformation)});
  }
  return overview;
}

std::vector<double> changed_shares_of(Session& session, const Job& job) {
  const MeasuredActivity measured = measure_activity(session, {}, job.progress);
  std::vector<double> shares(session.timeline().sample_count());
  for (std::uint64_t sample = 0; sample < shares.size(); ++sample)
    shares[sample] = measured.changed_share(sample);
  return shares;
}

Waveform waveform_of(Session& session, QPoint pixel) {
  const Timeline& timeline = session.timeline();
  const std::int64_t duration_ns = timeline.duration_ns();
  ExposureRequest everything;
  everything.gains = PlainInterval{StatedTime::of_nanoseconds(duration_ns), Shutter()};
  const TracedExposure traced = session.trace(
      everything, TracedPixel{static_cast<std::uint32_t>(pixel.x()), static_cast<std::uint32_t>(pixel.y())});
  Waveform waveform{pixel, std::vector<double>(timeline.sample_count())};
  const Trace& trace = traced.traces.front();
  auto step = trace.steps.begin();
  for (std::uint64_t sample = 0; sample < waveform.light.size(); ++sample) {
    const std::int64_t time_ns = timeline.start_ns(sample);
    while (step + 1 < trace.steps.end() && step->end_ns <= time_ns) ++step;
    double sum = 0;
    for (std::uint32_t channel = 0; channel < trace.channels; ++channel)
      sum += step->values[channel].begin_light;
    waveform.light[sample] = sum / trace.channels;
  }
  return waveform;
}

}  // namespace nutik::studio
