// Makes a series: exposures of one capture, each in a file of its own, which is written while the next is exposed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "session/requests/exposure_request.hpp"
#include "session/requests/output_request.hpp"
#include "session/session.hpp"

namespace nutik {

struct SeriesPicture {
  StatedTime start;
  std::filesystem::path path;
};

// `exposure` says all but where each begins. `add`, which may be empty, is told each picture as it was exposed, and
// returns the text that goes into its file. Throws what Session::render() does; OutputError at the first picture that cannot be written: the
// next ones are not exposed.
void make_series(Session& session, ExposureRequest exposure, const std::vector<SeriesPicture>& pictures,
                 const OutputFormat& output, const FileWishes& file, const ReportedProgress& progress,
                 const std::function<std::string(std::uint64_t number, ExposedPicture& exposed)>& add);

}  // namespace nutik
