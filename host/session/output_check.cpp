#include "session/output_check.hpp"

#include <unistd.h>

#include <algorithm>
#include <string_view>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"
#include "exposure/function_file.hpp"
#include "media/formats/input_kinds.hpp"
#include "media/stills/picture_text.hpp"
#include "media/stills/still_sequence.hpp"
#include "media/writers/picture_writer.hpp"
#include "media/writers/recipe.hpp"
#include "media/writers/video_writer.hpp"
#include "system/is_absent.hpp"
#include "system/mapped_file.hpp"
#include "tik/header.hpp"

namespace nutik {
std::optional<Recipe> recipe_in(const std::filesystem::path& file) {
  try {
    return is_picture_name(file) ? read_recipe(file) : std::nullopt;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

namespace {

bool is_tik_content(const std::string& bytes) { return tik::looks_like_tik(std::as_bytes(std::span(bytes))); }

bool is_picture_content(const std::string& bytes) {
  const auto begins = [&](const inputs::InputKind* kind) { return kind->begins(bytes); };
  return std::ranges::any_of(inputs::kStills, begins) && !is_tik_content(bytes);
}

// A grey PGM or PNG that does not carry how it was exposed.
bool is_mask_content(const std::filesystem::path& file) {
  constexpr std::size_t kPngColourType = 25;
  const MappedFile mapped(file);
  const std::string_view bytes = as_text(mapped.bytes());
  const bool is_pgm = bytes.starts_with("P2") || bytes.starts_with("P5");
  const bool is_grey_png =
      inputs::kPng.begins(bytes) && bytes.size() > kPngColourType && bytes[kPngColourType] == 0;
  return (is_pgm || is_grey_png) && !recipe_in(file);
}

// Text with a comma in its first line, or a camera's path.
bool is_table_content(std::string_view bytes) {
  if (bytes.starts_with("# nutik camera")) return true;
  const std::string_view line = bytes.substr(0, bytes.find('\n'));
  return line.find(',') != std::string_view::npos && line.find('\0') == std::string_view::npos;
}

bool is_functions_content(const std::filesystem::path& file) {
  const FunctionFile functions = parse_functions(as_text(MappedFile(file).bytes()));
  return !functions.functions.empty() || !functions.broken.empty();
}

bool is_video_content(std::string_view bytes) {
  const bool is_matroska = bytes.starts_with("\x1A\x45\xDF\xA3");
  const bool is_mp4 = bytes.size() >= 8 && bytes.substr(4, 4) == "ftyp";
  const bool is_riff = bytes.size() >= 12 && bytes.starts_with("RIFF");
  const bool is_avi = is_riff && (bytes.substr(8, 4) == "AVI " || bytes.substr(8, 4) == "WEBP");
  const bool is_mxf = bytes.starts_with(std::string_view("\x06\x0E\x2B\x34\x02\x05\x01\x01", 8));
  return is_matroska || is_mp4 || is_avi || is_mxf || bytes.starts_with("GIF8");
}

// What a file begins with; of what is no regular file nothing, as that is never written to. What it is must be known.
std::string beginning_of(const std::filesystem::path& file) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(file, unknown) && !unknown) return {};
  try {
    static_cast<void>(MappedFile(file));
  } catch (const InputError& error) {
    throw OutputError(format("{}; so it is not known what it is, and it is not replaced. Choose another name",
                             error.what()));
  }
  return first_bytes(file);
}

bool is_content_of(OutputKind kind, const std::filesystem::path& file) {
  const std::string bytes = beginning_of(file);
  if (bytes.empty()) return true;
  switch (kind) {
    case OutputKind::tik: return is_tik_content(bytes);
    case OutputKind::picture: return is_picture_content(bytes);
    case OutputKind::mask: return is_mask_content(file);
    case OutputKind::table: return is_table_content(bytes);
    case OutputKind::video: return is_video_content(bytes);
    case OutputKind::noise: return bytes.starts_with("nutik noise");
    case OutputKind::functions: return is_functions_content(file);
  }
  return false;
}

const char* name_of(OutputKind kind) {
  switch (kind) {
    case OutputKind::tik: return ".tik file";
    case OutputKind::picture: return "picture";
    case OutputKind::mask: return "mask";
    case OutputKind::table: return "table";
    case OutputKind::video: return "video";
    case OutputKind::noise: return "noise file";
    case OutputKind::functions: return "function file";
  }
  return "";
}

bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code error;
  if (a.empty() || b.empty()) return a.empty() && b.empty();
  return std::filesystem::equivalent(a, b, error) || led_to(a) == led_to(b);
}

// A picture or a mask that is not there yet joins no stills of a folder, the first input. mixed_note() tells of what
// matches a pattern.
void refuse_among_stills(const std::filesystem::path& output, std::span<const std::string> inputs) {
  const std::filesystem::path folder = output.has_parent_path() ? output.parent_path() : ".";
  std::error_code error;
  if (inputs.empty() || !std::filesystem::is_directory(inputs.front(), error)) return;
  if (!is_same_file(folder, inputs.front()) || !joins_stills(inputs.front(), folder / output.filename())) return;
  throw UsageError(
      format("{} would lie among the stills of {}, and be taken for one or keep them from being read; choose another "
             "folder",
             output.string(), inputs.front()));
}

}  // namespace

void check_output(const std::filesystem::path& output, OutputKind kind, std::span<const std::string> inputs,
                  Replacing replacing) {
  const std::string name = output.string();
  const bool is_picture = kind == OutputKind::picture || kind == OutputKind::mask;
  if (is_picture && names_standard_output(output)) {
    if (isatty(STDOUT_FILENO) == 1) {
      throw UsageError(format(
          "{} is standard output, which is a terminal; send it on to a program or a file, or name a file",
          name));
    }
    return;
  }
  for (const std::string& input : inputs) {
    if (is_same_file(output, input)) {
      throw UsageError(format("the output {} is also an input or another output; choose another name", name));
    }
  }
  if (kind == OutputKind::tik && output.extension() != ".tik") {
    throw UsageError(
        format("{} is no name for a capture, which ends in .tik", name),
        Advice{is_picture_name(output)
                   ? "; for a picture say of when: nutik-cl expose `start 0.4s` `exposure 10ms`; nutik-cl study finds "
                     "what moves"
                   : "; nutik-cl video makes films"});
  }
  if (kind == OutputKind::noise && (output.extension() == ".tik" || is_picture_name(output))) {
    throw UsageError(format("{} is no name for a text: a camera's noise is written as .noise", name));
  }
  if (kind == OutputKind::functions && output.extension() != ".fn") {
    throw UsageError(format("{}: gain functions are written as .fn", name));
  }
  if (is_picture && !is_picture_name(output)) {
    const std::string kind = format(" {} ", output.extension().string());
    const bool is_film = std::ranges::any_of(video_codecs(), [&](const VideoCodec& codec) {
      return codec.containers.find(kind) != std::string_view::npos;
    });
    throw UsageError(format("{}: pictures are written as {}", name, picture_extensions()),
                     Advice{output.extension() == ".tik" ? "; nutik-cl encode makes captures of clips"
                            : is_film                    ? "; nutik-cl video makes films"
                                                         : ""});
  }
  if (kind == OutputKind::table && output.extension() != ".csv") {
    throw UsageError(format("{}: tables are written as .csv", name), Advice{", or as - to standard output"});
  }
  if (replacing != Replacing::all) expect_as_it_is(output);
  std::error_code error;
  if (is_absent(output)) {
    if (is_picture) refuse_among_stills(output, inputs);
    return check_folder_of(output);
  }
  if (std::filesystem::is_directory(output, error)) {
    throw UsageError(format("{} is a folder; name a file in it", name));
  }
  if (!is_content_of(kind, output)) {
    throw UsageError(
        format("{} exists and is no {}; it is not replaced. Choose another name", name, name_of(kind)));
  }
  if (!std::filesystem::is_regular_file(output, error)) return;
  check_folder_of(output);
  if (replacing == Replacing::all) return;
  if (std::filesystem::file_size(output, error) == 0) return;
  const auto recipe = recipe_in(output);
  if (recipe && is_as_sealed(output)) return;
  throw UsageError(format("{} is there already and is not replaced{}", name,
                          !recipe                ? ""
                          : recipe->file.empty() ? ": an earlier version wrote it, and its recipe does not tell "
                                                   "whether it was changed since"
                                                 : ": its recipe does not know it as it is now, so it was changed "
                                                   "since"),
                   Advice{"; choose another name, or replace it with `overwrite`"});
}

void note_later(std::vector<std::string>& notes, const std::function<std::filesystem::path(std::uint64_t)>& picture,
                std::uint64_t count) {
  std::error_code unknown;
  std::uint64_t end = count;
  while (std::filesystem::exists(picture(end), unknown)) ++end;
  if (end == count) return;
  notes.push_back(format("{} … {} were there before and are no part of this series; delete them, or whoever reads its "
                         "numbers on takes them for it",
                         picture(count).string(), picture(end - 1).filename().string()));
}

bool is_mask_name(const std::filesystem::path& path) {
  const std::string extension = picture_extension(path);
  return extension == ".pgm" || extension == ".png";
}

void check_mask_output(const std::filesystem::path& output, std::span<const std::string> inputs,
                       Replacing replacing) {
  if (!is_mask_name(output)) {
    throw UsageError(format("{}: masks are written as .pgm or .png, which keep every tag", output.string()));
  }
  check_output(output, OutputKind::mask, inputs, replacing);
}

void check_picture_output(const std::filesystem::path& output, std::uint32_t channels,
                          std::span<const std::string> inputs, Replacing replacing) {
  check_output(output, OutputKind::picture, inputs, replacing);
  static_cast<void>(value_type_for(output, Depth::bits8, ValueType::code8, channels));
}

}  // namespace nutik
