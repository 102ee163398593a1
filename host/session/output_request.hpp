// What values a picture is asked to have.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "capture/error.hpp"
#include "capture/picture.hpp"
#include "media/picture_writer.hpp"
#include "render/renderer.hpp"

namespace nutik {

struct OutputRequest {
  std::optional<Depth> depth;             // none: the capture's own, light where the file holds no codes
  std::optional<NegativeLight> negative;  // none: black

  friend bool operator==(const OutputRequest&, const OutputRequest&) = default;
};

// Codes were to show light below 0, and the file holds floating point, which keeps it.
struct LightIsKept : UsageError {
  explicit LightIsKept(const std::filesystem::path& file);
  std::filesystem::path output;
};

// For a file of this name. Throws UsageError where it cannot hold what was asked for, LightIsKept.
[[nodiscard]] OutputFormat output_format(const OutputRequest& request, const std::filesystem::path& output,
                                         const CaptureFormat& capture);

// The same where no file is written: the capture's own depth unless another was asked for.
[[nodiscard]] OutputFormat output_format(const OutputRequest& request, const CaptureFormat& capture);

// What light below 0 becomes in a file of such values. Throws LightIsKept.
[[nodiscard]] NegativeLight negative_light(const OutputRequest& request, ValueType type,
                                           const std::filesystem::path& output);

}  // namespace nutik
