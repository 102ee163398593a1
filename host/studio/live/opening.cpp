#include "studio/live/opening.hpp"

#include <algorithm>
#include <utility>

#include "session/below/error.hpp"
#include "studio/live/picture_image.hpp"
#include "studio/live/room_watch.hpp"
#include "system/temporary_folder.hpp"

namespace nutik::studio {
namespace {

// The first picture, of a session that reads no further.
QImage first_picture(const SourceRequest& source, const std::shared_ptr<Devices>& devices, const Job& job) {
  Session forward(source, devices, {.reading = Reading::forward, .progress = {}, .stop = job.stop});
  ExposureRequest exposure;
  exposure.start = StatedTime::of_pictures(0);
  exposure.gains = PlainInterval{StatedTime::of_pictures(1), Shutter()};
  RenderControl control;
  control.stop = job.stop;
  return image_of(forward.render(exposure, screen_format(), control).picture);
}

}  // namespace

Opened open_capture(const QString& path, const QString& rate, std::shared_ptr<Devices> devices,
                    const Job& job, const std::function<void(QImage)>& first_look) {
  SourceRequest source;
  source.path = path.toStdString();
  if (!rate.isEmpty()) source.clip.rate = Rational::parse(rate.toStdString(), "the frame rate");
  const bool is_clip = !path.endsWith(".tik", Qt::CaseInsensitive);
  if (is_clip) first_look(first_picture(source, devices, job));
  const RoomWatch room(temporary_folder());
  const auto progress = [&](std::uint64_t done, std::uint64_t total) {
    if (is_clip) room.look(done, total);
    job.progress(done, total);
  };
  auto session = std::make_shared<Session>(
      source, std::move(devices),
      Session::Terms{.reading = Reading::whole, .progress = progress, .stop = job.stop});
  Opened opened{session, {path, session->format(), session->timeline(), rate}, {}};
  for (const Note& note : session->notes()) {
    opened.notes += sentence(note.text);
    if (std::ranges::find(note.settings, Setting::frame_rate) != note.settings.end())
      opened.notes.back() += Jobs::tr(" (File, Frame rate)");
  }
  for (const std::string& warning : session->warnings()) opened.notes += sentence(warning);
  return opened;
}

}  // namespace nutik::studio
