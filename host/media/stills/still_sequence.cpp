#include "media/stills/still_sequence.hpp"

#include <glob.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <regex>
#include <string>
#include <string_view>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/formats/file_kinds.hpp"
#include "media/formats/numbered_name.hpp"
#include "media/formats/input_kinds.hpp"
#include "media/stills/stills_table.hpp"
#include "system/input_bytes.hpp"
#include "system/is_absent.hpp"

namespace nutik {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Whether a comes before b as a person counts: runs of digits compare as numbers.
bool counts_before(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const auto run = [](const std::string& text, std::size_t& at) {
        while (at + 1 < text.size() && text[at] == '0' && is_digit(text[at + 1])) ++at;
        const std::size_t start = at;
        while (at < text.size() && is_digit(text[at])) ++at;
        return std::string_view(text).substr(start, at - start);
      };
      const std::string_view x = run(a, i), y = run(b, j);
      if (x != y) return x.size() != y.size() ? x.size() < y.size() : x < y;
    } else if (a[i] != b[j]) {
      return a[i] < b[j];
    } else {
      ++i;
      ++j;
    }
  }
  if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
  return a < b;
}

void sort_by_count(std::vector<fs::path>& files) {
  std::sort(files.begin(), files.end(),
            [](const fs::path& a, const fs::path& b) { return counts_before(a.string(), b.string()); });
}

// The files of a folder that are not hidden: a `._frame1.png`, which some systems leave beside a
// frame1.png, is no picture.
std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder.empty() ? fs::path(".") : folder, error)) {
    const bool hidden = entry.path().filename().string().starts_with('.');
    if (!hidden && entry.is_regular_file(error)) files.push_back(entry.path());
  }
  sort_by_count(files);
  return files;
}

// A file's name round its last number, and that number.
struct CountedName {
  std::string before, digits, after;
  std::uint64_t number = 0;
};

// Empty where the name has no number, or none of 64 bits.
std::optional<CountedName> counted_name(const fs::path& file) {
  constexpr const char* kDigits = "0123456789";
  constexpr std::size_t kMaxDigits = 18;
  const std::string stem = file.stem().string();
  const auto last = stem.find_last_of(kDigits);
  if (last == std::string::npos) return std::nullopt;
  const auto other = stem.find_last_not_of(kDigits, last);
  const std::size_t first = other == std::string::npos ? 0 : other + 1;
  if (last + 1 - first > kMaxDigits) return std::nullopt;
  CountedName name{stem.substr(0, first), stem.substr(first, last + 1 - first),
                   stem.substr(last + 1) + file.extension().string()};
  name.number = std::stoul(name.digits);
  return name;
}

// Whether the number ends with a time of day behind its date, 20260812_223055 or 20260812223055123: no minute has a
// second 60.
bool is_clock(const CountedName& name) {
  static const std::regex clock(
      R"((19|20)\d\d(0[1-9]|1[0-2])(0[1-9]|[12]\d|3[01])\D?([01]\d|2[0-3])[0-5]\d[0-5]\d(\d{3})?$)");
  return std::regex_search(name.before + name.digits, clock);
}

// Its name with a mark in the place of each number: files of one sequence have the same, and copies, dark pictures or
// another camera's have others.
std::string name_without_numbers(const fs::path& file) {
  std::string text;
  for (const char c : file.stem().string()) {
    if (!is_digit(c)) text += c;
    if (is_digit(c) && !text.ends_with('#')) text += '#';
  }
  return text;
}

// The pictures of the sequence that most of them belong to, or all, where there is none. Throws where there are two.
std::vector<fs::path> main_sequence(const fs::path& folder, const std::vector<fs::path>& files) {
  std::map<std::string, std::vector<fs::path>> by_name;
  for (const fs::path& file : files) by_name[name_without_numbers(file)].push_back(file);
  const std::vector<fs::path>* main = nullptr;
  for (const auto& [name, group] : by_name) {
    if (group.size() < 2 || name.find('#') == std::string::npos) continue;
    if (main == nullptr) {
      main = &group;
      continue;
    }
    const auto pattern = [&](const fs::path& file) {
      const CountedName counted = counted_name(file).value_or(CountedName{"", "", file.extension().string()});
      return "'" + (folder / (counted.before + "*" + counted.after)).string() + "'";
    };
    throw InputError(
        format("{}: the folder holds two sequences, of {} ({} pictures) and of {} ({}): name one: {} or {}; '{}' "
               "takes all",
               folder.string(), main->front().filename().string(), main->size(), group.front().filename().string(),
               group.size(), pattern(main->front()), pattern(group.front()),
               (folder / ("*" + files.front().extension().string())).string()));
  }
  return main != nullptr && 2 * main->size() > files.size() ? *main : files;
}

std::vector<fs::path> all_pictures_in(const fs::path& folder) {
  std::vector<fs::path> files = files_in(folder);
  std::erase_if(files, [](const fs::path& file) { return kind_named_by(file) == nullptr; });
  return files;
}

std::vector<fs::path> pictures_in(const fs::path& folder) {
  const std::vector<fs::path> files = all_pictures_in(folder);
  if (files.empty()) {
    for (const fs::path& file : files_in(folder)) {
      if (const auto kind = unsupported_kind_text(file)) throw InputError(*kind);
    }
    throw InputError(format("{}: the folder holds no picture ({})", folder.string(), still_kinds_text()));
  }
  // Two kinds are two sequences, or a sequence and something else: neither may be guessed at.
  for (const fs::path& file : files) {
    if (kind_named_by(file) == kind_named_by(files.front())) continue;
    throw InputError(format("{}: the folder holds {} files ({}) and {} files ({}); name one kind: '{}'",
                            folder.string(), kind_named_by(files.front())->name, files.front().filename().string(),
                            kind_named_by(file)->name, file.filename().string(),
                            (folder / ("*" + files.front().extension().string())).string()));
  }
  return main_sequence(folder, files);
}

std::vector<fs::path> matching_files(const fs::path& pattern) {
  glob_t found{};
  std::error_code error;
  // A folder that has such a name is meant by it.
  std::string text;
  if (fs::is_directory(pattern.parent_path(), error)) {
    for (const char c : pattern.parent_path().string()) text += std::string(std::strchr("*?[]\\", c) ? "\\" : "") + c;
    text = fs::path(text) / pattern.filename();
  } else {
    text = pattern;
  }
  const int status = glob(text.c_str(), GLOB_NOSORT, nullptr, &found);
  std::vector<fs::path> files;
  for (std::size_t i = 0; status == 0 && i < found.gl_pathc; ++i) {
    if (fs::is_regular_file(found.gl_pathv[i], error)) files.emplace_back(found.gl_pathv[i]);
  }
  globfree(&found);
  if (files.empty()) throw FileMissing(pattern, format("{}: no file matches", pattern.string()));
  sort_by_count(files);
  return files;
}

// The number of a file of this kind of name, however its zeros are written, as digits without them.
std::optional<std::string> number_of(const fs::path& file, const NumberedName& name) {
  const std::string text = file.filename().string();
  if (text.size() <= name.before.size() + name.after.size() || !text.starts_with(name.before) ||
      !text.ends_with(name.after)) {
    return std::nullopt;
  }
  std::string digits = text.substr(name.before.size(), text.size() - name.before.size() - name.after.size());
  digits.erase(0, digits.find_first_not_of(' '));
  if (digits.empty() || !std::all_of(digits.begin(), digits.end(), is_digit)) return std::nullopt;
  digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size() - 1));
  constexpr std::size_t kMaxDigits = 18;  // fit 64 bits
  if (digits.size() > kMaxDigits) return std::nullopt;
  return digits;
}

std::vector<fs::path> numbered_files(const fs::path& path, const NumberedName& name) {
  std::map<unsigned long, fs::path> by_number;
  std::string other;  // a file whose number is written differently
  for (const fs::path& file : files_in(path.parent_path())) {
    const auto digits = number_of(file, name);
    if (!digits) continue;
    if (file.filename().string() == name.with(*digits)) {
      by_number.emplace(std::stoul(*digits), file);
    } else {
      other = file.filename().string();
    }
  }
  if (by_number.empty()) {
    throw FileMissing(
        path, format("{}: no file has such a name, {} for one{}", path.string(), name.with("1"),
                     other.empty() ? "" : format("; {} is there: its zeros are written %0{}d", other,
                                                 other.size() - name.before.size() - name.after.size())));
  }
  std::vector<fs::path> files;
  for (const auto& [number, file] : by_number) {
    const unsigned long expected = by_number.begin()->first + files.size();
    if (number != expected) {
      throw InputError(
          format("{}: {} is missing between {} and {}; to take the files that are there in "
                 "their order: '{}'",
                 path.string(), name.with(std::to_string(expected)), files.back().filename().string(),
                 file.filename().string(), (path.parent_path() / (name.before + "*" + name.after)).string()));
    }
    files.push_back(file);
  }
  return files;
}

bool is_glob(const std::string& path) { return path.find_first_of("*?[") != std::string::npos; }

}  // namespace

std::optional<std::vector<fs::path>> list_stills(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return pictures_in(path);
  if (is_stills_table(path)) {
    std::vector<fs::path> files;
    for (const ListedStill& still : read_stills_table(path)) files.push_back(still.file);
    return files;
  }
  if (!is_absent(path)) {
    if (holds_several_pictures(path)) return std::nullopt;
    if (still_kind(path) != nullptr) return std::vector<fs::path>{path};
    return std::nullopt;
  }
  if (const auto numbered = NumberedName::parse(path.filename().string())) {
    return numbered_files(path, *numbered);
  }
  if (is_glob(path.string())) return matching_files(path);
  return std::nullopt;
}

std::optional<std::string> missing_still_note(const fs::path& folder, std::span<const fs::path> files) {
  std::vector<CountedName> names;
  for (const fs::path& file : files) {
    auto name = counted_name(file);
    if (!name) return std::nullopt;
    if (!names.empty() && (name->before != names.front().before || name->after != names.front().after ||
                           name->number <= names.back().number)) {
      return std::nullopt;
    }
    names.push_back(std::move(*name));
  }
  if (std::ranges::all_of(names, is_clock)) return std::nullopt;
  // Where pictures are counted in tens, 20 after 10 is no hole.
  std::uint64_t step = std::numeric_limits<std::uint64_t>::max();
  for (std::size_t i = 1; i < names.size(); ++i) step = std::min(step, names[i].number - names[i - 1].number);
  std::uint64_t missing = 0;
  std::size_t hole = 0;  // the first, before this picture
  for (std::size_t i = 1; i < names.size(); ++i) {
    const std::uint64_t distance = names[i].number - names[i - 1].number;
    if (distance % step != 0) return std::nullopt;  // times, say
    if (distance == step) continue;
    missing += distance / step - 1;
    if (hole == 0) hole = i;
  }
  if (hole == 0) return std::nullopt;
  const CountedName& before = names[hole - 1];
  const NumberedName pattern{before.before, before.after, before.digits.size(), '0'};
  return format(
      "{}: {} is missing between {} and {}{}; pictures behind a hole get the times of earlier ones. A table "
      "of stills (.csv) gives each its own time; if nothing was lost: '{}'",
      folder.string(), pattern.with(before.number + step), files[hole - 1].filename().string(),
      files[hole].filename().string(), missing > 1 ? format(", and {} more", missing - 1) : "",
      (folder / ("*" + files.front().extension().string())).string());
}

std::optional<std::string> mixed_note(const fs::path& pattern, std::span<const fs::path> files) {
  std::map<std::string, std::size_t> kinds;
  for (const fs::path& file : files) ++kinds[name_without_numbers(file)];
  const auto& [main, count] = *std::ranges::max_element(kinds, {}, &std::pair<const std::string, std::size_t>::second);
  if (2 * count <= files.size() || count == files.size() || main.find('#') == std::string::npos) return std::nullopt;
  std::string names;
  for (std::size_t k = 0, shown = 0; k < files.size() && shown < 3; ++k) {
    if (name_without_numbers(files[k]) != main) names += (++shown == 1 ? "" : ", ") + files[k].filename().string();
  }
  return format("{}: {} of {} pictures have names of another kind than the others: {}; were they made of these?",
                pattern.string(), files.size() - count, files.size(), names);
}

std::optional<std::string> left_out_note(const fs::path& folder, std::span<const fs::path> files) {
  std::string names;
  std::size_t count = 0;
  for (const fs::path& file : all_pictures_in(folder)) {
    if (std::ranges::find(files, file) != files.end()) continue;
    if (++count <= 3) names += (count == 1 ? "" : ", ") + file.filename().string();
  }
  if (count == 0) return std::nullopt;
  return format("{}: not taken along, because their names are of another kind than {}: {}{}; '{}' takes all",
                folder.string(), files.front().filename().string(), names,
                count > 3 ? format(" and {} more", count - 3) : "",
                (folder / ("*" + files.front().extension().string())).string());
}

bool joins_stills(const fs::path& folder, const fs::path& file) {
  std::vector<fs::path> files = all_pictures_in(folder);
  const inputs::InputKind* const kind = kind_named_by(file);
  if (kind == nullptr || files.empty()) return false;
  if (kind_named_by(files.front()) != kind) return true;
  files.insert(files.end(), 2, file);  // where names are numbered, more will come
  try {
    return std::ranges::count(main_sequence(folder, files), file) > 0;
  } catch (const InputError&) {  // there would be two
    return true;
  }
}

std::string sequence_name(const fs::path& path) {
  if (is_standard_input(path.string())) return "standard-input";
  std::error_code error;
  // `frames/` and `.` name a folder, too.
  fs::path whole = fs::absolute(path, error).lexically_normal();
  if (whole.filename().empty()) whole = whole.parent_path();
  if (fs::is_directory(path, error)) return whole.filename().string();
  std::string name = path.stem().string();
  if (!is_absent(path)) return name;
  if (const auto numbered = NumberedName::parse(path.filename().string())) {
    name = numbered->before;
  } else if (is_glob(name)) {
    name.erase(name.find_first_of("*?["));
  }
  while (!name.empty() && std::string_view("_-. ").find(name.back()) != std::string_view::npos)
    name.pop_back();
  if (name.empty()) name = whole.parent_path().filename().string();
  return name.empty() || is_glob(name) ? "clip" : name;
}

}  // namespace nutik
