#include "app/output/output_name.hpp"

#include <string_view>

#include "app/command_line/option_table.hpp"
#include "app/input/standard_input.hpp"
#include "session/capture.hpp"
#include "session/error.hpp"
#include "session/format.hpp"
#include "session/pictures.hpp"
#include "system/mapped_file.hpp"

namespace nutik::app {
namespace {

bool is_tik_content(const std::string& bytes) { return tik::looks_like_tik(std::as_bytes(std::span(bytes))); }

bool is_picture_content(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG") || bytes.starts_with(std::string_view("II*\0", 4)) ||
      bytes.starts_with(std::string_view("MM\0*", 4)) || bytes.starts_with("II+")) {
    return true;
  }
  return bytes.size() > 2 && bytes[0] == 'P' &&
         std::string_view("123456fF").find(bytes[1]) != std::string_view::npos &&
         !is_tik_content(std::string(bytes));
}

// Text with a comma in its first line.
bool is_table_content(std::string_view bytes) {
  const std::string_view line = bytes.substr(0, bytes.find('\n'));
  return line.find(',') != std::string_view::npos && line.find('\0') == std::string_view::npos;
}

bool is_video_content(std::string_view bytes) {
  const bool is_matroska = bytes.starts_with("\x1A\x45\xDF\xA3");
  const bool is_mp4 = bytes.size() >= 8 && bytes.substr(4, 4) == "ftyp";
  const bool is_avi = bytes.size() >= 12 && bytes.starts_with("RIFF") && bytes.substr(8, 4) == "AVI ";
  return is_matroska || is_mp4 || is_avi;
}

bool is_content_of(OutputKind kind, const std::string& bytes) {
  switch (kind) {
    case OutputKind::tik: return is_tik_content(bytes);
    case OutputKind::picture: return is_picture_content(bytes);
    case OutputKind::table: return is_table_content(bytes);
    case OutputKind::video: return is_video_content(bytes);
    case OutputKind::noise: return bytes.starts_with("nutik noise");
  }
  return false;
}

const char* name_of(OutputKind kind) {
  switch (kind) {
    case OutputKind::tik: return ".tik file";
    case OutputKind::picture: return "picture";
    case OutputKind::table: return "table";
    case OutputKind::video: return "video";
    case OutputKind::noise: return "noise file";
  }
  return "";
}

bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code error;
  if (std::filesystem::equivalent(a, b, error)) return true;
  return std::filesystem::absolute(a).lexically_normal() == std::filesystem::absolute(b).lexically_normal();
}

}  // namespace

std::optional<std::filesystem::path> stated_output(const std::optional<std::string>& option,
                                                   std::span<const std::string> operands,
                                                   const std::string& command) {
  if (operands.empty()) throw UsageError(format("an input is missing; see nutik-cl {} --help", command));
  if (operands.size() > 2) {
    throw UsageError(
        format("'{}' is one file too many; a sequence of stills is one operand: its folder, or a "
               "pattern in quotes such as 'frames/*.png'. See nutik-cl {} --help",
               operands[2], command));
  }
  if (option && operands.size() == 2) {
    throw UsageError(format("two outputs: -o {} and {}; leave one out", *option, operands[1]));
  }
  for (const auto* name : {option ? &*option : nullptr, operands.size() == 2 ? &operands[1] : nullptr}) {
    if (name == nullptr) continue;
    if (name->empty()) throw UsageError("the output's name is empty");
    return *name;
  }
  return std::nullopt;
}

void check_output(const std::filesystem::path& output, OutputKind kind, std::span<const std::string> inputs) {
  const std::string name = output.string();
  for (const std::string& input : inputs) {
    if (is_same_file(output, input)) {
      throw UsageError(format("the output {} is also an input; choose another name", name));
    }
  }
  if (kind == OutputKind::tik && output.extension() != ".tik") {
    throw UsageError(
        format("{} is no name for a capture: encode writes .tik files (nutik-cl CLIP "
               "CAPTURE.tik)",
               name));
  }
  if (kind == OutputKind::noise && (output.extension() == ".tik" || is_picture_name(output))) {
    throw UsageError(format("{} is no name for a text: a camera's noise is written as .noise", name));
  }
  if (kind == OutputKind::picture && !is_picture_name(output)) {
    throw UsageError(format("{}: pictures are written as .png, .tif, .ppm, .pgm or .pfm", name));
  }
  if (kind == OutputKind::table && output.extension() != ".csv") {
    throw UsageError(format("{}: tables are written as .csv, or as - to standard output", name));
  }
  std::error_code error;
  if (!std::filesystem::exists(output, error)) return;
  if (std::filesystem::is_directory(output, error)) {
    throw UsageError(format("{} is a folder; name a file in it", name));
  }
  const std::string bytes = first_bytes(output);
  if (!bytes.empty() && !is_content_of(kind, bytes)) {
    throw UsageError(
        format("{} exists and is no {}; it is not replaced. Choose another name", name, name_of(kind)));
  }
}

std::filesystem::path picture_name(const std::string& input, const std::string& label) {
  return sequence_name(input) + "-" + label + ".png";
}

std::vector<std::string> input_files(const Options& options) {
  std::vector<std::string> inputs(options.operands.begin(),
                                  options.operands.begin() + !options.operands.empty());
  if (!inputs.empty() && !options.raw) {
    // Each still of a sequence is an input that the picture must not replace.
    for (const auto& still : list_stills(inputs.front()).value_or(std::vector<std::filesystem::path>{})) {
      inputs.push_back(still.string());
    }
  }
  for (const Option& option : app::options()) {
    const std::string* name = option.reads_file() ? option.stated(options) : nullptr;
    if (name != nullptr && !is_standard_input(*name) && !option.knows(*name)) inputs.push_back(*name);
  }
  return inputs;
}

}  // namespace nutik::app
