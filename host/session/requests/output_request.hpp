// What a picture file shall hold: depth, transfer function, negative light, quality.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "capture/error.hpp"
#include "capture/picture.hpp"
#include "media/writers/picture_writer.hpp"
#include "render/renderer.hpp"

namespace nutik {

// The codes of the capture itself, as they are: its transfer function, its white code where the depth is its own.
struct SourceCodes {};

struct OutputRequest {
  std::optional<Depth> depth;             // none: the capture's own, light where the file holds no codes
  std::optional<NegativeLight> negative;  // none: black
  // How light becomes codes, whose white is the last one that their type holds. None: sRGB, which screens show.
  std::optional<std::variant<Transfer, SourceCodes>> transfer = std::nullopt;
  std::optional<int> quality = std::nullopt;  // of lossy files, 1 … 100
  std::optional<std::uint32_t> crf = std::nullopt;  // of films, on their codec's own scale
  std::optional<std::string> bounds = std::nullopt;  // the file of a map of what each pixel may be off by
  bool keep_pixels = false;  // in files that people look at, too, whose pixels are made square otherwise
};

// `source`, or what Transfer::parse() knows, but for functions that go beyond a screen's white. Throws UsageError.
[[nodiscard]] std::variant<Transfer, SourceCodes> parse_out_transfer(std::string_view text);

// What the file's writer needs of it. Pixels are kept, too, if 16 bits or the capture's own codes were asked for: those
// are to be measured.
[[nodiscard]] FileWishes file_wishes(const OutputRequest& request);

// Throws UsageError where a quality was asked for and a file of this name has none.
void check_quality(const OutputRequest& request, const std::filesystem::path& output);

// For a file of this name. Throws UsageError where it cannot hold what was asked for.
[[nodiscard]] OutputFormat output_format(const OutputRequest& request, const std::filesystem::path& output,
                                         const CaptureFormat& capture);

// The same where no file is written: the capture's own depth unless another was asked for.
[[nodiscard]] OutputFormat output_format(const OutputRequest& request, const CaptureFormat& capture);

// The same for values of a type that is known: a video's.
[[nodiscard]] OutputFormat output_format(const OutputRequest& request, const std::filesystem::path& output,
                                         ValueType type, const CaptureFormat& capture);

// `, codes srgb with white 65535 (the capture's: linear with white 4095)`, `, codes srgb in bt709 (the capture's: srgb
// in p3)`; nothing where a picture's codes are the capture's, or it holds light.
[[nodiscard]] std::string codes_text(const CaptureFormat& capture, const OutputFormat& output);

}  // namespace nutik
