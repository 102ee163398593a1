#include "media/stills/picture_text.hpp"

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"
#include "media/formats/input_kinds.hpp"
#include "media/module.hpp"
#include "media/stills/picture_files.hpp"
#include "system/mapped_file.hpp"

namespace nutik {
namespace {

// The comments behind the first line of a PGM or PPM.
std::optional<std::string> netpbm_comment(std::string_view file) {
  auto at = file.find('\n');
  while (at != std::string_view::npos && at + 1 < file.size() && file[at + 1] == '#') {
    const auto end = file.find('\n', at + 1);
    if (end == std::string_view::npos) break;
    std::string_view comment = file.substr(at + 2, end - at - 2);
    if (comment.starts_with(' ')) comment.remove_prefix(1);
    if (comment.starts_with(kPictureTextStart)) return std::string(comment);
    at = end;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> read_picture_text(const std::filesystem::path& path) {
  const MappedFile file(path);
  const std::string_view bytes = as_text(file.bytes());
  std::optional<std::string> text;
  if (inputs::kPng.begins(bytes)) {
    text = read_png_text(file.bytes(), kPictureTextKeyword, path.string());
  } else if (inputs::kJpeg.begins(bytes)) {
    text = read_jpeg_comments(file.bytes(), path.string());
  } else if (inputs::kExr.begins(bytes)) {
    text = still_module().read_exr_text(path, kPictureTextKeyword);
  } else if (bytes.starts_with("II") || bytes.starts_with("MM")) {
    text = read_tiff_description(path);
  } else if (bytes.size() > 2 && bytes[0] == 'P' && (bytes[1] == '5' || bytes[1] == '6')) {
    text = netpbm_comment(bytes);
  } else if (!bytes.starts_with("PF") && !bytes.starts_with("Pf")) {
    throw InputError(
        format("{} is no PNG, TIFF, JPEG, OpenEXR, PGM or PPM: it can carry no recipe", path.string()));
  }
  if (text && !text->starts_with(kPictureTextStart)) text.reset();
  return text;
}

}  // namespace nutik
