#include "studio/live/opening.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "features/activity/activity.hpp"
#include "features/schema/option.hpp"
#include "features/schema/requests.hpp"
#include "session/live/live_pictures.hpp"
#include "session/live/session_of_part.hpp"
#include "session/text/number_text.hpp"
#include "studio/live/live_view.hpp"
#include "system/temporary_folder.hpp"

namespace nutik::studio {
namespace {

// Before so many bytes were written others on the same disk tell more about it than this capture.
constexpr std::uint64_t kMinTaken = 16'000'000;

std::uint64_t left_in(const std::filesystem::path& folder) {
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(folder, error);
  return error ? std::numeric_limits<std::uint64_t>::max() : space.available;
}

QImage image_at(Session& session, std::uint64_t picture, std::optional<Precision> precision, const Job& job) {
  ExposureRequest exposure;
  exposure.start = StatedTime::of_pictures(static_cast<std::int64_t>(picture));
  exposure.gains = PlainInterval{StatedTime::of_pictures(1), Shutter()};
  RenderControl control;
  control.stop = job.stop;
  control.precision = precision;
  control.is_chosen = true;
  return image_of(session.render(exposure, screen_format(), control).picture);
}

// The first picture, of a session that reads no further.
QImage first_picture(const SourceRequest& source, const std::shared_ptr<Devices>& devices,
                     std::optional<Precision> precision, const Job& job) {
  Session forward(source, devices, {.reading = Reading::forward, .progress = {}, .stop = job.stop});
  return image_at(forward, 0, precision, job);
}

}  // namespace

RoomWatch::RoomWatch(const std::filesystem::path& folder)
    : RoomWatch(folder, [folder] { return left_in(folder); }) {}

RoomWatch::RoomWatch(std::filesystem::path folder, Left left)
    : folder_(std::move(folder)), left_(std::move(left)), at_first_(left_()) {}

void RoomWatch::look(std::uint64_t done, std::uint64_t total) const {
  const std::uint64_t left = left_();
  if (done == 0 || done >= total || left >= at_first_ || at_first_ - left < kMinTaken) return;
  const double share = static_cast<double>(done) / static_cast<double>(total);
  const double needed = static_cast<double>(at_first_ - left) * (1 - share) / share;
  if (needed <= 1.25 * static_cast<double>(left)) return;
  throw OutputError(format(
      "the clip's temporary capture will not fit: {} of {} samples took {}, the rest needs some {}, and "
      "{} are left in {}; make room there, or name another folder in TMPDIR",
      done, total, bytes_text(at_first_ - left), bytes_text(static_cast<std::uint64_t>(needed)),
      bytes_text(left), folder_.string()));
}

Opened open_capture(const QString& path, const Stated& stated, std::shared_ptr<Devices> devices,
                    const Job& job, const std::function<void(QImage)>& first_look) {
  Options options;
  for (const auto& [name, value] : stated) option_of(CommandId::encode, name)->state(options, name, {value});
  const SourceRequest source = clip_request(options, path.toStdString());
  const bool is_clip = !is_tik(source.path);
  std::optional<Precision> precision;
  if (is_clip && first_look) {
    try {
      precision = Precision::fixed;
      first_look(first_picture(source, devices, precision, job));
    } catch (const DeviceError&) {  // which may compute it wrongly
      precision.reset();
      first_look(first_picture(source, devices, precision, job));
    }
  }
  const RoomWatch room(temporary_folder());
  const auto progress = [&](std::uint64_t done, std::uint64_t total) {
    if (is_clip) room.look(done, total);
    job.progress(done, total);
  };
  auto session = std::make_shared<Session>(
      source, std::move(devices),
      Session::Terms{.reading = Reading::whole, .progress = progress, .stop = job.stop});
  Opened opened{session, {path, session->format(), session->timeline(), stated}, {}};
  opened.facts.precision = precision;
  for (const Note& note : session->notes()) {
    opened.notes += sentence(note.text);
    if (std::ranges::find(note.settings, Setting::frame_rate) != note.settings.end())
      opened.notes.back() += Jobs::tr(" (File, How the clip is read)");
  }
  for (const std::string& warning : session->warnings()) opened.notes += sentence(warning);
  return opened;
}

Stretch stretch_between(const Marks& marks, std::shared_ptr<Session> session, const Job& job) {
  if (marks == Marks()) return {std::move(session)};
  ClipOptions part;
  if (marks.in_ns) part.from = ClipMoment{*marks.in_ns};
  if (marks.out_ns) part.to = ClipMoment{*marks.out_ns};
  std::shared_ptr<Session> taken = session_of_part(*session, part, job.progress, job.stop);
  const auto& of_clip = taken->capture().header().part;
  return {std::move(taken), of_clip ? of_clip->start_ns : 0};
}

namespace {

constexpr std::uint64_t kThumbnails = 12;
constexpr int kThumbnailHeight = 90;  // twice what the strip is high, for screens of many pixels

}  // namespace

CaptureOverview thumbnails_of(Session& session, const Job& job) {
  const Timeline& timeline = session.timeline().pictures();
  const std::uint64_t count = std::min(kThumbnails, timeline.sample_count());
  CaptureOverview overview;
  for (std::uint64_t k = 0; k < count; ++k) {
    job.progress(k, count);
    const std::uint64_t picture = (2 * k + 1) * timeline.sample_count() / (2 * count);
    const QImage image = image_at(session, picture, {}, job);
    overview.thumbnails.push_back(
        {timeline.start_ns(picture), image.scaledToHeight(kThumbnailHeight, Qt::SmoothTransformation)});
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
