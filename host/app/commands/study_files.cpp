#include "app/commands/study_files.hpp"

#include <algorithm>
#include <utility>

#include "session/below/error.hpp"
#include "session/below/format.hpp"
#include "session/below/pictures.hpp"
#include "session/text/shell_text.hpp"
#include "system/checksum.hpp"
#include "system/input_bytes.hpp"
#include "system/mapped_file.hpp"
#include "system/output_file.hpp"

namespace nutik::app {
namespace {

constexpr std::string_view kAboutCommands = "# What makes the same study by hand.\n";
constexpr std::string_view kAboutFunctions =
    "# The light of each part of the picture: M0, M1 and so on are values of the mask.\n";
constexpr std::string_view kAboutSums =
    "# As the study left them. Another one replaces none of these that was changed.\n";
constexpr std::string_view kBeforeName = "# ";
constexpr std::string_view kPicture = "# the picture ";

std::string content_of(const std::filesystem::path& file) {
  const MappedFile mapped(file);
  return {reinterpret_cast<const char*>(mapped.bytes().data()), mapped.bytes().size()};
}

std::string sum_of(std::string_view content) { return format("{:016x}", checksum(content)); }

std::string name_of(const std::filesystem::path& file) { return shell_word(file.filename().string()); }

// What the commands' text of an earlier study notes.
struct Noted {
  std::string picture;                      // its name
  std::map<std::string, std::string> sums;  // of files, by their names

  // Of nothing where there is no such text.
  explicit Noted(const std::filesystem::path& commands) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(commands, error)) return;
    const std::string text(InputBytes(commands.string()).text());
    const std::size_t notes = text.find(kAboutSums);
    if (!text.starts_with(kAboutCommands) || notes == std::string::npos) return;
    for (std::size_t begin = notes + kAboutSums.size(); begin < text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      const std::string_view line = std::string_view(text).substr(begin, end - begin);
      begin = end + 1;
      const std::size_t space = line.rfind(' ');
      if (line.starts_with(kPicture)) {
        picture = line.substr(kPicture.size());
      } else if (line.starts_with(kBeforeName) && space > kBeforeName.size()) {
        sums.emplace(line.substr(kBeforeName.size(), space - kBeforeName.size()), line.substr(space + 1));
      }
    }
    is_whole_ = sums.contains(name_of(commands)) &&
                sums.at(name_of(commands)) == sum_of(std::string_view(text).substr(0, notes));
  }

  [[nodiscard]] bool knows(const std::filesystem::path& file) const { return sums.contains(name_of(file)); }
  [[nodiscard]] bool is_as_it_was(const std::filesystem::path& file, bool is_commands) const {
    return is_commands ? is_whole_ : sums.at(name_of(file)) == sum_of(content_of(file));
  }

 private:
  bool is_whole_ = false;  // the text itself
};

}  // namespace

StudyFiles::StudyFiles(std::filesystem::path output)
    : picture(std::move(output)),
      mask(beside(".pgm")),
      functions(beside(".fn")),
      commands(beside(".txt")),
      is_alone_(names_standard_output(picture)) {}

std::filesystem::path StudyFiles::beside(const char* extension) const {
  std::filesystem::path path = picture;
  path.replace_extension(extension);
  if (path == picture) path.replace_filename(picture.stem().string() + "-mask" + extension);
  return path;
}

void StudyFiles::check(std::span<const std::string> inputs, Replacing replacing) const {
  check_output(picture, OutputKind::picture, inputs, replacing);
  if (is_alone_) return;
  check_output(mask, OutputKind::mask, inputs);
  const Noted noted(commands);
  std::error_code error;
  for (const std::filesystem::path* file : {&mask, &functions, &commands}) {
    const std::string name = file->string();
    if (std::ranges::find(inputs, name) != inputs.end()) {
      throw UsageError(
          format("{} is also an input; it is not replaced. Choose another name for the picture", name));
    }
    if (replacing == Replacing::all || !std::filesystem::exists(*file, error)) continue;
    if (!std::filesystem::is_regular_file(*file, error) || !noted.knows(*file)) {
      throw UsageError(format(
          "{} exists and is of no study; it is not replaced. Choose another name for the picture", name));
    }
    if (!noted.is_as_it_was(*file, file == &commands)) {
      throw UsageError(
          format("{} was changed since its study was made; it is not replaced. Choose another name for "
                 "the picture, or remove that file",
                 name));
    }
  }
  const std::filesystem::path other = picture.parent_path() / noted.picture;
  if (replacing != Replacing::all && !noted.picture.empty() && noted.picture != name_of(picture) &&
      std::filesystem::exists(other, error)) {
    throw UsageError(
        format("{}, {} and {} are those of {}; they are not replaced. Choose another name for the picture",
               mask.string(), functions.string(), commands.string(), other.string()));
  }
}

void StudyFiles::write_functions(std::string_view text) const {
  write_text(functions, format("{}{}", kAboutFunctions, text));
}

void StudyFiles::write_commands(std::string_view text, bool has_regions) const {
  std::string all = format("{}{}", kAboutCommands, text);
  std::map<std::string, std::string> sums;
  // Those of an earlier study stay known when this one has none.
  if (!has_regions) sums = Noted(commands).sums;
  for (const std::filesystem::path* file : {&mask, &functions}) {
    if (has_regions) sums[name_of(*file)] = sum_of(content_of(*file));
  }
  sums[name_of(commands)] = sum_of(all);
  all += format("{}{}{}\n", kAboutSums, kPicture, name_of(picture));
  for (const auto& [name, sum] : sums) all += format("{}{} {}\n", kBeforeName, name, sum);
  write_text(commands, all);
}

}  // namespace nutik::app
