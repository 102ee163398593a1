#include "media/writers/picture_writer.hpp"

#include <algorithm>
#include <iterator>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"
#include "media/formats/extension.hpp"
#include "media/formats/input_kinds.hpp"
#include "media/module.hpp"
#include "media/stills/picture_text.hpp"
#include "system/output_file.hpp"
#include "system/temporary_folder.hpp"

namespace nutik {
namespace {

constexpr std::string_view kStandardOutput = "-", kBehindKind = ":-";

// Null where no kind has it.
const WrittenFormat* format_with(const inputs::InputKind& kind, std::string_view extension) {
  const auto* const found = std::ranges::find_if(kind.written, [&](const WrittenFormat& each) {
    return !extension.empty() && (extension == each.extension || extension == each.also);
  });
  return found == std::end(kind.written) ? nullptr : found;
}

const WrittenFormat* find_format(const std::filesystem::path& path) {
  const std::string extension = picture_extension(path);
  for (const inputs::InputKind* kind : inputs::kWritten)
    if (const WrittenFormat* const found = format_with(*kind, extension)) return found;
  return nullptr;
}

const WrittenFormat& written_format_of(const std::filesystem::path& path) {
  if (const WrittenFormat* kind = find_format(path)) return *kind;
  throw UsageError(format("{}: pictures are written as {}, not as '{}'", path.string(), picture_extensions(),
                          path.extension().string()));
}

// The extensions of those that are wanted.
template <typename Wanted>
std::vector<std::string> names_of(Wanted wanted) {
  std::vector<std::string> names;
  for (const inputs::InputKind* kind : inputs::kWritten)
    for (const WrittenFormat& each : kind->written)
      if (!each.extension.empty() && wanted(each)) names.emplace_back(each.extension);
  return names;
}
// `.tif, .exr or .pfm`
template <typename Wanted>
std::string extensions_of(Wanted wanted) {
  return alternatives(names_of(wanted));
}

void check_channels(const WrittenFormat& kind, const std::filesystem::path& path, std::uint32_t channels) {
  if (kind.only_channels == 0 || kind.only_channels == channels) return;
  throw UsageError(format("{} holds {} pictures only and this one {}; write a .png or .tif", path.string(),
                          channels == 1 ? "colour" : "grey", channels == 1 ? "is grey" : "has colour"));
}

}  // namespace

ValueType value_type_for(const std::filesystem::path& path, std::optional<Depth> wish, ValueType usual,
                         std::uint32_t channels) {
  const WrittenFormat& kind = written_format_of(path);
  check_channels(kind, path, channels);
  const bool light = wish ? *wish != Depth::bits8 && *wish != Depth::bits16 : kind.code_bits == 0;
  if (light && !kind.holds_light) {
    throw UsageError(format("{} cannot hold floating point; write a {}", path.string(),
                            extensions_of([](const WrittenFormat& other) { return other.holds_light; })));
  }
  if (wish == Depth::half && !kind.holds_half) {
    throw UsageError(format("{} holds floating point of 32 bits, not of 16; write a {}", path.string(),
                            extensions_of([](const WrittenFormat& other) { return other.holds_half; })));
  }
  if (wish == Depth::doubled && !kind.holds_double) {
    throw UsageError(format("{} holds no floating point of 64 bits; write a {}", path.string(),
                            extensions_of([](const WrittenFormat& other) { return other.holds_double; })));
  }
  if (!light && kind.code_bits == 0) {
    throw UsageError(format("{} holds floating point only; write a .png, .tif or .ppm", path.string()));
  }
  if (light) return wish == Depth::doubled ? ValueType::light64 : ValueType::light32;
  if (wish == Depth::bits16 && kind.code_bits < 16) {
    throw UsageError(format("{} holds 8 bits only; write a {}", path.string(),
                            extensions_of([](const WrittenFormat& other) { return other.code_bits == 16; })));
  }
  if (!wish) return kind.code_bits == 8 ? ValueType::code8 : usual;
  return *wish == Depth::bits8 ? ValueType::code8 : ValueType::code16;
}

bool names_standard_output(const std::filesystem::path& path) {
  const std::string name = path.string();
  return name == kStandardOutput || (name.ends_with(kBehindKind) && find_format(path) != nullptr);
}

std::string picture_extension(const std::filesystem::path& path) {
  const std::string name = path.string();
  if (name == kStandardOutput) return ".png";
  if (name.ends_with(kBehindKind))
    return extension_of("of." + name.substr(0, name.size() - kBehindKind.size()));
  return extension_of(path);
}

bool is_picture_name(const std::filesystem::path& path) { return find_format(path) != nullptr; }

bool is_lossy_name(const std::filesystem::path& path) {
  const WrittenFormat* kind = find_format(path);
  return kind != nullptr && kind->is_lossy;
}

bool is_silent_name(const std::filesystem::path& path) {
  const WrittenFormat* kind = find_format(path);
  return kind != nullptr && kind->is_silent;
}

bool has_text_by_name(const std::filesystem::path& path) {
  const std::string extension = picture_extension(path);
  return std::ranges::any_of(inputs::kWritten, [&](const inputs::InputKind* kind) {
    return kind->text != nullptr && format_with(*kind, extension) != nullptr;
  });
}

std::string picture_extensions() {
  return extensions_of([](const WrittenFormat&) { return true; });
}

std::string picture_patterns() {
  return "*" + joined(names_of([](const WrittenFormat&) { return true; }), " *");
}

Shape written_shape(const std::filesystem::path& path, const Shape& shape, const Rational& aspect,
                    const FileWishes& wishes) {
  const Shape square = in_square_pixels(shape, aspect);
  const bool is_squared = wishes.square_pixels && written_format_of(path).is_for_eyes &&
                          std::max(square.width, square.height) <= kLargestSquaredSide;
  return is_squared ? square : shape;
}

Picture in_square_pixels(const Picture& picture, const Shape& shape) {
  return shape == picture.shape ? picture : still_module().enlarge(picture, shape);
}

void write_picture(const std::filesystem::path& path, const Picture& picture, const std::string& text,
                   const FileWishes& wishes) {
  const Shape shape = written_shape(path, picture.shape, picture.pixel_aspect, wishes);
  if (shape != picture.shape) return write_picture(path, in_square_pixels(picture, shape), text, wishes);
  const WrittenFormat& kind = written_format_of(path);
  check_channels(kind, path, shape.channels);
  const bool fits = holds_codes(picture.type) ? value_bytes(picture.type) * 8 <= kind.code_bits
                    : picture.type == ValueType::light64 ? kind.holds_double
                                                         : kind.holds_light;
  if (!fits) throw UsageError(format("{} cannot hold the values of this picture", path.string()));
  if (names_standard_output(path)) {
    // Made whole before anything is sent; some of it is written by libraries that go back in their file.
    const NamelessFile nameless;
    OutputFile file(nameless.path(), OutputFile::Lasting::no);
    file.check_by(wishes.check);
    kind.write(file, picture, text, wishes);
    seal_picture(file);
    file.send_to_standard_output();
    return;
  }
  OutputFile file(path);
  file.check_by(wishes.check);
  kind.write(file, picture, text, wishes);
  seal_picture(file);
  file.commit();
}

void write_layers(const std::filesystem::path& path, std::span<const PictureLayer> layers) {
  const WrittenFormat& kind = written_format_of(path);
  if (kind.write_layers == nullptr) return write_picture(path, layers.front().values);
  OutputFile file(path);
  file.check_by(check_interruption);
  kind.write_layers(file, layers);
  file.commit();
}

// Read and written by a module.
constinit const inputs::InputKind inputs::kExr{
    .name = "OpenEXR", .starts = {"\x76\x2F\x31\x01"}, .extensions = " .exr ",
    .said = {"none", "none", "floating-point light, over 16 bits by the white that you state", "as it lies",
             "left out",
             "one picture"},
    .has_tags = true,
    .text = [](Bytes, const auto& path) { return still_module().read_exr_text(path, kPictureTextKeyword); },
    .written = {{.extension = ".exr", .holds_light = true, .holds_half = true,
                 .write = [](auto& file, auto& picture, auto& text, auto& wishes) {
                   still_module().write_exr(file, picture, text, wishes.as_half);
                 },
                 .write_layers = [](auto& file, auto layers) { still_module().write_exr_layers(file, layers); }}}};

}  // namespace nutik
