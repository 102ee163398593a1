// What computes, as the options say it.
#pragma once

#include <memory>

#include "app/command_line/options.hpp"
#include "session/devices.hpp"

namespace nutik::app {

// Throws UsageError where the options do not go together or are not known.
[[nodiscard]] ComputingRequest computing_request(const Options& options);

// Not started yet. Kernels that are built are told of, unless --quiet.
[[nodiscard]] std::shared_ptr<Devices> make_devices(const Options& options);

}  // namespace nutik::app
