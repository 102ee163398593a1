// What is stated by name, as the library's requests have it. Values are words, as on the command line.
#pragma once

#include <map>
#include <string>

#include "session/devices.hpp"
#include "session/requests/source_request.hpp"

namespace nutik::python {

// By the names of Python's arguments.
using Settings = std::map<std::string, std::string>;

// How a clip or a capture at a path is read. Throws UsageError.
[[nodiscard]] SourceRequest source_request(const std::string& path, const Settings& settings);

// Which renderer computes, with how much memory: `renderer`, `device`, `memory` in bytes. Throws UsageError.
[[nodiscard]] ComputingRequest computing_request(const Settings& settings);

}  // namespace nutik::python
