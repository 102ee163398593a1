#include "media/still_sequence.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <string>
#include <string_view>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 8> kExtensions{".png", ".tif",  ".tiff", ".pgm",
                                                      ".ppm", ".pnm", ".jpg",  ".jpeg"};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_still_name(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

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
  return a.size() - i < b.size() - j;
}

// * and ? as shells have them.
bool matches(std::string_view pattern, std::string_view name) {
  if (pattern.empty()) return name.empty();
  if (pattern[0] == '*') {
    for (std::size_t skip = 0; skip <= name.size(); ++skip) {
      if (matches(pattern.substr(1), name.substr(skip))) return true;
    }
    return false;
  }
  return !name.empty() && (pattern[0] == '?' || pattern[0] == name[0]) &&
         matches(pattern.substr(1), name.substr(1));
}

template <typename Accept>
std::vector<fs::path> files_in(const fs::path& folder, Accept accept) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder.empty() ? fs::path(".") : folder, error)) {
    if (entry.is_regular_file(error) && accept(entry.path())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return counts_before(a.filename().string(), b.filename().string());
  });
  return files;
}

// A name around its `%d` or `%04d`.
struct NumberedName {
  std::string before;
  std::string after;
};

std::optional<NumberedName> parse_numbered(const std::string& name) {
  const auto percent = name.find('%');
  if (percent == std::string::npos) return std::nullopt;
  std::size_t end = percent + 1;
  while (end < name.size() && is_digit(name[end])) ++end;
  if (end >= name.size() || name[end] != 'd') return std::nullopt;
  return NumberedName{name.substr(0, percent), name.substr(end + 1)};
}

std::vector<fs::path> numbered_files(const fs::path& path, const NumberedName& name) {
  std::map<unsigned long, fs::path> by_number;
  for (const fs::path& file : files_in(path.parent_path(), [](const fs::path&) { return true; })) {
    const std::string text = file.filename().string();
    if (text.size() <= name.before.size() + name.after.size() || !text.starts_with(name.before) ||
        !text.ends_with(name.after)) {
      continue;
    }
    const std::string digits =
        text.substr(name.before.size(), text.size() - name.before.size() - name.after.size());
    if (digits.size() > 18 || !std::all_of(digits.begin(), digits.end(), is_digit)) continue;
    by_number.emplace(std::stoul(digits), file);
  }
  if (by_number.empty()) throw InputError(format("{}: no file of that kind of name", path.string()));
  std::vector<fs::path> files;
  unsigned long expected = by_number.begin()->first;
  for (const auto& [number, file] : by_number) {
    if (number != expected) {
      throw InputError(format("{}: number {} is missing between {} and {}", path.string(), expected,
                              by_number.begin()->first, by_number.rbegin()->first));
    }
    files.push_back(file);
    ++expected;
  }
  return files;
}

}  // namespace

std::optional<std::vector<fs::path>> list_stills(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    std::vector<fs::path> files = files_in(path, is_still_name);
    if (files.empty()) {
      throw InputError(format("{}: the folder holds no picture (.png, .tif, .pgm, .ppm, .jpg)", path.string()));
    }
    return files;
  }
  if (fs::exists(path, error)) {
    if (is_still_name(path)) return std::vector<fs::path>{path};
    return std::nullopt;
  }
  const std::string name = path.filename().string();
  if (const auto numbered = parse_numbered(name)) return numbered_files(path, *numbered);
  if (name.find_first_of("*?") != std::string::npos) {
    std::vector<fs::path> files = files_in(
        path.parent_path(), [&](const fs::path& file) { return matches(name, file.filename().string()); });
    if (files.empty()) throw InputError(format("{}: no file matches", path.string()));
    return files;
  }
  return std::nullopt;
}

}  // namespace nutik
