#include "app/commands/study_files.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"
#include "media/stills/netpbm.hpp"
#include "media/writers/picture_writer.hpp"
#include "session/text/shell_text.hpp"
#include "system/checksum.hpp"
#include "system/input_bytes.hpp"
#include "system/is_absent.hpp"
#include "system/mapped_file.hpp"
#include "system/output_file.hpp"

namespace nutik::app {
namespace {

constexpr std::string_view kAboutCommands = "# What makes the same study by hand.\n";
constexpr std::string_view kAboutFunctions =
    "# The light of each part of the picture: M0, M1 and so on are values of the mask.\n";
constexpr std::string_view kAboutSums =
    "# As the study left them. Another one replaces none of these that was changed.\n";
constexpr std::string_view kUnfinished = "# This study was not finished: run it again.\n";
constexpr std::string_view kBeforeName = "# ";
constexpr std::string_view kPicture = "# the picture ";

std::string content_of(const std::filesystem::path& file) {
  return std::string(as_text(MappedFile(file).bytes()));
}

std::string sum_of(std::string_view content) { return format("{:016x}", checksum(content)); }

std::string name_of(const std::filesystem::path& file) { return shell_word(file.filename().string()); }

// Files' names, and what they may hold: of a study that was ended, as before or as after it.
using Sums = std::set<std::pair<std::string, std::string>>;

std::string notes_text(const Sums& sums, const std::string& picture) {
  std::string text = format("{}{}{}\n", kAboutSums, kPicture, picture);
  for (const auto& [name, sum] : sums) text += format("{}{} {}\n", kBeforeName, name, sum);
  return text;
}

// What the commands' text of an earlier study notes.
struct Noted {
  std::string text;     // of the commands
  std::string picture;  // its name
  Sums sums;

  // Notes nothing where there is no such text.
  explicit Noted(const std::filesystem::path& commands) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(commands, error)) return;
    const std::string all(InputBytes(commands.string()).text());
    const std::size_t notes = all.find(kAboutSums);
    if (!all.starts_with(kAboutCommands) || notes == std::string::npos) return;
    for (std::size_t begin = notes + kAboutSums.size(); begin < all.size();) {
      const std::size_t end = std::min(all.find('\n', begin), all.size());
      const std::string_view line = std::string_view(all).substr(begin, end - begin);
      begin = end + 1;
      const std::size_t space = line.rfind(' ');
      if (line.starts_with(kPicture)) {
        picture = line.substr(kPicture.size());
      } else if (line.starts_with(kBeforeName) && space > kBeforeName.size()) {
        sums.emplace(line.substr(kBeforeName.size(), space - kBeforeName.size()), line.substr(space + 1));
      }
    }
    text = all.substr(0, notes);
    is_whole_ = sums.contains({name_of(commands), sum_of(text)}) && all == text + notes_text(sums, picture);
  }

  [[nodiscard]] bool knows(const std::filesystem::path& file) const {
    const auto found = sums.lower_bound({name_of(file), ""});
    return found != sums.end() && found->first == name_of(file);
  }
  [[nodiscard]] bool is_as_it_was(const std::filesystem::path& file, bool is_commands) const {
    return is_commands ? is_whole_ : sums.contains({name_of(file), sum_of(content_of(file))});
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
  const Noted noted(is_alone_ ? std::filesystem::path() : commands);
  std::error_code error;
  const bool is_own = std::filesystem::is_regular_file(picture, error) && noted.is_as_it_was(picture, false);
  check_output(picture, OutputKind::picture, inputs, is_own ? Replacing::all : replacing);
  if (is_alone_) return;
  check_output(mask, OutputKind::mask, inputs);
  if (replacing == Replacing::all) check_output(functions, OutputKind::functions, {});
  for (const std::filesystem::path* file : {&mask, &functions, &commands}) {
    const std::string name = file->string();
    if (std::ranges::find(inputs, name) != inputs.end()) {
      throw UsageError(
          format("{} is also an input; it is not replaced. Choose another name for the picture", name));
    }
    if (is_absent(*file)) continue;
    if (replacing == Replacing::all && (file != &commands || !noted.text.empty())) continue;
    if (!std::filesystem::is_regular_file(*file, error) || !noted.knows(*file)) {
      throw UsageError(format(
          "{} exists and is of no study; it is not replaced. Choose another name for the picture, or {}", name,
          file == &commands ? "move it away" : "replace all with --overwrite"));
    }
    if (!noted.is_as_it_was(*file, file == &commands)) {
      throw UsageError(
          format("{} was changed since its study was made; it is not replaced. Choose another name for "
                 "the picture, or replace all with --overwrite",
                 name));
    }
  }
  const std::filesystem::path other = picture.parent_path() / noted.picture;
  if (replacing != Replacing::all && !noted.picture.empty() && noted.picture != name_of(picture) &&
      !is_absent(other)) {
    throw UsageError(
        format("{}, {} and {} are those of {}; they are not replaced. Choose another name for the picture, or "
               "replace them with --overwrite",
               mask.string(), functions.string(), commands.string(), other.string()));
  }
}

void StudyFiles::write_regions(const Picture& regions, std::string_view light) {
  const Noted noted(commands);
  const std::string mask_bytes = netpbm_text(regions);
  const std::string function_text = format("{}{}", kAboutFunctions, light);
  sums_ = {{name_of(mask), sum_of(mask_bytes)}, {name_of(functions), sum_of(function_text)}};
  // Known before they are there: whoever ends this in the middle leaves files of the old study or of this one.
  Sums both(sums_.begin(), sums_.end());
  both.insert(noted.sums.begin(), noted.sums.end());
  std::string text = noted.text.empty() ? std::string(kAboutCommands) : noted.text;
  if (!text.ends_with(kUnfinished)) text += kUnfinished;
  both.emplace(name_of(commands), sum_of(text));
  write_text(commands, text + notes_text(both, name_of(picture)));
  write_text(mask, mask_bytes);
  write_text(functions, function_text);
}

void StudyFiles::write_commands(std::string_view text) const {
  const std::string all = format("{}{}", kAboutCommands, text);
  Sums sums(sums_.begin(), sums_.end());
  if (sums.empty()) {  // no regions: those of an earlier study stay known
    sums = Noted(commands).sums;
    std::erase_if(sums, [&](const auto& sum) {
      return sum.first == name_of(commands) || sum.first == name_of(picture);
    });
  }
  sums.emplace(name_of(picture), sum_of(content_of(picture)));
  sums.emplace(name_of(commands), sum_of(all));
  write_text(commands, all + notes_text(sums, name_of(picture)));
}

}  // namespace nutik::app
