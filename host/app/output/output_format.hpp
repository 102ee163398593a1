// What values a picture has.
#pragma once

#include <filesystem>

#include "app/command_line/options.hpp"
#include "session/capture.hpp"
#include "session/exposed_picture.hpp"

namespace nutik::app {

// From --depth, the picture's name and what the capture holds. Throws UsageError where they contradict each
// other.
[[nodiscard]] OutputFormat output_format(const Options& options, const std::filesystem::path& output,
                                         const CaptureFormat& capture);

// The same where no file is written: the capture's own depth unless --depth says another.
[[nodiscard]] OutputFormat output_format(const Options& options, const CaptureFormat& capture);

// What --negative asks for in a file of such values. Throws UsageError where it is not known, or the file
// holds no codes.
[[nodiscard]] NegativeLight negative_light(const Options& options, ValueType type,
                                           const std::filesystem::path& output);

}  // namespace nutik::app
