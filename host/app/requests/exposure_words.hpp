// Exposures, series of them and videos, as the command line states them.
//
//   always:  what is read of a request is read here: function file and mask, whose warnings are printed
#pragma once

#include <string>

#include "app/command_line/options.hpp"
#include "session/exposure_request.hpp"
#include "session/frames_request.hpp"
#include "session/series_request.hpp"

namespace nutik::app {

// Throws UsageError where the options contradict each other, InputError with all mistakes of the function file.
[[nodiscard]] ExposureRequest exposure_request(const Options& options);
// For naming the picture: `FnFile`, `0.4s-10ms`.
[[nodiscard]] std::string exposure_label(const Options& options);

// What --every and --count make of an exposure. Throws UsageError where they make no sense.
[[nodiscard]] SeriesRequest series_request(const Options& options);
// Throws as exposure_request() does.
[[nodiscard]] FramesRequest frames_request(const Options& options);

// The shutter of that name, and what --gain and --ev multiply light with. Throw UsageError where they are not known.
[[nodiscard]] Shutter parse_shutter(const std::string& shape, const std::optional<std::string>& error);
[[nodiscard]] double brightening(const Options& options);

}  // namespace nutik::app
