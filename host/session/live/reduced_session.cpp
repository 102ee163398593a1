#include "session/live/reduced_session.hpp"

#include <utility>

#include "media/clip_part.hpp"
#include "session/clips/capture_clip.hpp"

namespace nutik {

std::shared_ptr<Session> reduced_session(Session& whole, std::uint32_t divisor,
                                         const ReportedProgress& progress, std::stop_token stop) {
  SourceRequest source;
  source.path = whole.source().path;
  if (whole.timeline().is_constant()) source.shutter_angle = whole.timeline().shutter_angle();
  ComputingRequest computing = whole.devices().request();
  computing.memory.bytes /= 4;
  auto devices = std::make_shared<Devices>(computing);
  devices->start();
  ClipOptions reduced;
  reduced.scale = ClipScale{divisor};
  const auto open = [&whole, reduced] {
    return take_part(open_capture_clip(whole.capture()), whole.source().path, reduced);
  };
  return std::make_shared<Session>(
      source, std::move(devices),
      Session::Terms{.progress = progress, .stop = std::move(stop), .open_clip = open});
}

}  // namespace nutik
