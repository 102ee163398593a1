#include "app/command_line/option_groups.hpp"

namespace nutik::app {
namespace {

constexpr std::string_view kGroup = "The frames";
constexpr CommandSet kVideo = bit(CommandId::video);

}  // namespace

std::vector<Option> video_options() {
  return {
      valued(0, "out-fps", "RATE", kGroup, "frames a second that the video is played with (default: 24)",
             kVideo, &Options::out_fps),
      valued(0, "out-angle", "DEGREES", kGroup,
             "share of the time between frames that each is exposed, 360 being all of it; more makes them "
             "overlap "
             "(default: 180)",
             kVideo, &Options::out_angle),
      valued(0, "from", "TIME", kGroup, "where in the capture the video starts: 0.4s, 37f (default: 0s)",
             kVideo, &Options::from),
      valued(0, "to", "TIME", kGroup,
             "where it ends; frames that would go on behind it are left out (default: the capture's end)",
             kVideo, &Options::to),
      valued(
          0, "speed", "FACTOR", kGroup,
          "seconds of the capture in a second of the video: 0.25 is four times slower than life (default: 1)",
          kVideo, &Options::speed),
      one_of(
          valued(
              0, "video-codec", "NAME", kGroup,
              "ffv1 (lossless; .mkv, .avi), h264, h265 (.mp4, .mov, .mkv), vp9 (.webm, .mkv), prores (.mov, "
              ".mkv) or "
              "mjpeg (.avi, .mov, .mkv) (default: h264, in .mkv and .avi ffv1, in .webm vp9)",
              kVideo, &Options::video_codec),
          {"ffv1", "h264", "h265", "vp9", "prores", "mjpeg"}),
  };
}

}  // namespace nutik::app
