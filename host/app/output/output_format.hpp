// What values a picture has.
#pragma once

#include <filesystem>

#include "app/command_line/options.hpp"
#include "capture/picture.hpp"
#include "render/renderer.hpp"

namespace nutik::app {

// From --depth, the picture's name and what the capture holds. Throws UsageError where they contradict each
// other.
[[nodiscard]] OutputFormat output_format(const Options& options, const std::filesystem::path& output,
                                         const CaptureFormat& capture);

// The same where no file is written: the capture's own depth unless --depth says another.
[[nodiscard]] OutputFormat output_format(const Options& options, const CaptureFormat& capture);

}  // namespace nutik::app
