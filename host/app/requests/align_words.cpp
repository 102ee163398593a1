#include "app/command_line/option_table.hpp"
#include "app/requests/requests.hpp"
#include "session/below/error.hpp"
#include "session/below/format.hpp"
#include "system/input_bytes.hpp"

namespace nutik::app {

std::optional<AlignRequest> align_request(const Options& options) {
  if (!options.align && !options.align_along) {
    for (const char* name : {"align-to", "unseen", "camera-path", "camera-plot", "coverage"}) {
      if (!find_option(name)->is_in(options)) continue;
      throw UsageError(
          format("--{} is said of pictures that are aligned: add --align rigid, or another motion", name));
    }
    return std::nullopt;
  }
  AlignRequest request;
  if (options.align_along) {
    if (options.align || options.align_to) {
      throw UsageError(format("--align-along says motion and reference already; leave {} out",
                              options.align ? "--align" : "--align-to"));
    }
    const std::string name = input_title(*options.align_along);
    request.path.emplace(parse_camera_path(InputBytes(*options.align_along).text(), name));
  } else {
    const auto motion = camera_motion_of(*options.align);
    if (!motion) {
      throw UsageError(
          format("--align '{}' is no motion; choose translation, rigid or homography", *options.align));
    }
    request.motion = *motion;
  }
  if (options.align_to) request.reference = StatedTime::parse(*options.align_to, "--align-to");
  if (options.unseen == "hold") {
    request.unseen = Unseen::held;
  } else if (options.unseen && *options.unseen != "crop") {
    throw UsageError(format("--unseen '{}' is neither crop nor hold", *options.unseen));
  }
  return request;
}

}  // namespace nutik::app
