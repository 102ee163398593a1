#include "media/picture_writer.hpp"

#include <algorithm>
#include <array>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/extension.hpp"
#include "media/netpbm.hpp"
#include "media/png_file.hpp"
#include "media/tiff_file.hpp"
#include "system/output_file.hpp"

namespace nutik {
namespace {

struct FileKind {
  const char* extension;
  bool holds_codes;
  bool holds_light;
  std::uint32_t only_channels;  // 0: any
  void (*write)(OutputFile& file, const Picture& picture, const std::string& text);
};

void write_netpbm(OutputFile& file, const Picture& picture, const std::string& text) {
  file.write(netpbm_text(picture, text));
}
void write_tiff_file(OutputFile& file, const Picture& picture, const std::string& text) {
  write_tiff(file.temporary_path(), picture, text);
}

constexpr std::array<FileKind, 7> kKinds{{
    {".png", true, false, 0, write_png},
    {".tif", true, true, 0, write_tiff_file},
    {".tiff", true, true, 0, write_tiff_file},
    {".ppm", true, false, 3, write_netpbm},
    {".pgm", true, false, 1, write_netpbm},
    {".pnm", true, false, 0, write_netpbm},
    {".pfm", false, true, 0, write_netpbm},
}};

const FileKind* find_kind(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  const auto found = std::find_if(kKinds.begin(), kKinds.end(),
                                  [&](const FileKind& kind) { return extension == kind.extension; });
  return found == kKinds.end() ? nullptr : &*found;
}

const FileKind& kind_of(const std::filesystem::path& path) {
  if (const FileKind* kind = find_kind(path)) return *kind;
  throw UsageError(format("{}: pictures are written as .png, .tif, .ppm, .pgm or .pfm, not as '{}'",
                          path.string(), path.extension().string()));
}

}  // namespace

Depth parse_depth(std::string_view text) {
  if (text == "8") return Depth::bits8;
  if (text == "16") return Depth::bits16;
  if (text == "float") return Depth::floating;
  throw UsageError(format("depth '{}' is not known; choose 8, 16 or float", text));
}

ValueType value_type_for(const std::filesystem::path& path, std::optional<Depth> wish, ValueType usual,
                         std::uint32_t channels) {
  const FileKind& kind = kind_of(path);
  if (kind.only_channels != 0 && kind.only_channels != channels) {
    throw UsageError(format("{} holds {} pictures only and this one {}; write a .png or .tif", path.string(),
                            channels == 1 ? "colour" : "grey", channels == 1 ? "is grey" : "has colour"));
  }
  const bool light = wish ? *wish == Depth::floating : !kind.holds_codes;
  if (light && !kind.holds_light) {
    throw UsageError(format("{} cannot hold floating point; write a .tif or .pfm", path.string()));
  }
  if (!light && !kind.holds_codes) {
    throw UsageError(format("{} holds floating point only; write a .png, .tif or .ppm", path.string()));
  }
  if (light) return ValueType::light32;
  if (!wish) return usual;
  return *wish == Depth::bits8 ? ValueType::code8 : ValueType::code16;
}

bool is_picture_name(const std::filesystem::path& path) { return find_kind(path) != nullptr; }

void write_picture(const std::filesystem::path& path, const Picture& picture, const std::string& text) {
  const FileKind& kind = kind_of(path);
  OutputFile file(path);
  kind.write(file, picture, text);
  file.commit();
}

}  // namespace nutik
