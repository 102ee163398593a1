// Requests as options state them: whoever parses options, on the command line or in Python, asks the same.
//
//   always:  options that contradict each other are refused as UsageError before anything large is read
#pragma once

#include <string>

#include "features/schema/options.hpp"
#include "features/sheets/sheet_request.hpp"
#include "session/devices.hpp"
#include "session/requests/exposure_request.hpp"
#include "session/requests/source_request.hpp"

namespace nutik {

// How the clip of this name is to be read. Reads a noise file and a camera's path: InputError.
[[nodiscard]] SourceRequest clip_request(const Options& options, const std::string& name);

[[nodiscard]] ComputingRequest computing_request(const Options& options);

// An exposure as far as one command line states it without reading functions or a mask: how it is weighed, normalized
// and brightened. Functions or interval, start and mask are added by whoever asks. Reads the picture of a delay.
[[nodiscard]] ExposureRequest exposure_without_gains(const Options& options);
[[nodiscard]] Shutter stated_shutter(const Options& options);
// What `gain` and `ev` multiply light with.
[[nodiscard]] double brightening(const Options& options);

[[nodiscard]] SweepRequest sweep_request(const Options& options);

// Which moments of what moves are shown, and what between them.
[[nodiscard]] StudyRequest study_request(const Options& options);

}  // namespace nutik
