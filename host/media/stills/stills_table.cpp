#include "media/stills/stills_table.hpp"

#include <fstream>
#include <string_view>
#include <system_error>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/rational.hpp"
#include "capture/text.hpp"
#include "media/formats/input_kinds.hpp"
#include "system/input_bytes.hpp"

namespace nutik {
namespace {

constexpr std::int64_t kLongestNs = std::int64_t{1} << 62;      // of a timeline

constexpr std::string_view kColumns[] = {"file", "start_ns", "exposure_ns"};

[[noreturn]] void fail(const std::filesystem::path& table, std::size_t line, const std::string& why,
                       std::vector<Setting> settings = {}) {
  throw InputError(format("{}:{}: {}", table.string(), line, why), std::move(settings));
}

std::string_view trimmed_field(std::string_view text) { return trimmed(text, " \t"); }

// The fields of a row. Empty where a quote is not closed.
std::optional<std::vector<std::string>> fields_of(std::string_view row) {
  std::vector<std::string> fields(1);
  bool quoted = false, was_quoted = false;
  const auto end_field = [&] {
    if (!was_quoted) fields.back() = trimmed_field(fields.back());
    was_quoted = false;
  };
  for (std::size_t i = 0; i < row.size(); ++i) {
    const char c = row[i];
    if (c == '"' && quoted && i + 1 < row.size() && row[i + 1] == '"') {
      fields.back() += row[++i];
    } else if (c == '"' && (quoted || trimmed_field(fields.back()).empty())) {
      if (!quoted) fields.back().clear();
      quoted = !quoted;
      was_quoted = true;
    } else if (c == ',' && !quoted) {
      end_field();
      fields.emplace_back();
    } else if (!was_quoted || quoted) {
      fields.back() += c;
    }
  }
  end_field();
  if (quoted) return std::nullopt;
  return fields;
}

bool is_header(const std::vector<std::string>& fields) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (i >= std::size(kColumns) || fields[i] != kColumns[i]) return false;
  }
  return true;
}

std::optional<std::int64_t> nanoseconds(const std::filesystem::path& table, std::size_t line,
                                        std::string_view column, const std::string& field,
                                        std::int64_t least) {
  if (field.empty()) return std::nullopt;
  const auto value = parsed<std::int64_t>(field);
  if (!value || *value < least || *value > kLargestTimeNs) {
    fail(table, line,
         format("{} '{}' is no whole number of nanoseconds from {} to {}", column, field, least, kLargestTimeNs));
  }
  return value;
}

using Times = std::vector<std::int64_t>;

// One column for all files: from the table where its first row has it, else from EXIF data. Empty where no
// file has it anywhere.
Times column(const std::filesystem::path& table, std::span<const ListedStill> stills,
             std::span<const StillTimes> exif, std::optional<std::int64_t> StillTimes::*time,
             std::string_view name) {
  const bool in_table = (stills.front().times.*time).has_value();
  const bool is_start = time == &StillTimes::start_ns;  // which a rate replaces
  const char* const or_rate = is_start ? ", or a rate" : "";
  const std::vector<Setting> settings(is_start ? 1 : 0, Setting::frame_rate);
  Times values;
  for (std::size_t k = 0; k < stills.size(); ++k) {
    const auto& stated = stills[k].times.*time;
    if (stated.has_value() != in_table) {
      fail(
          table, stills[k].line,
          format("{} has {} {} and {} {}; state it for all files, or for none and it is read from their EXIF "
                 "data",
                 stills[k].file.string(), stated ? format("the {}", name) : format("no {}", name),
                 stated ? format("{}", *stated) : std::string("here"), stills.front().file.string(),
                 in_table ? format("has {}", *(stills.front().times.*time)) : "has none"));
    }
    const auto& value = in_table ? stated : exif[k].*time;
    if (value) values.push_back(*value);
    if (values.empty() || value) continue;
    fail(table, stills[k].line,
         format("{} has no {}, neither here nor in EXIF data (of JPEG and DNG); {} has {}; state it for all files{}",
                stills[k].file.string(), name, stills.front().file.string(), values[0], or_rate),
         settings);
  }
  if (!values.empty() && values.size() != stills.size()) {
    fail(table, stills.front().line,
         format("{} has no {}, neither here nor in EXIF data (of JPEG and DNG); others have; state it for all files{}",
                stills.front().file.string(), name, or_rate),
         settings);
  }
  return values;
}

}  // namespace

bool is_stills_table(const std::filesystem::path& path) {
  std::error_code error;
  return inputs::kTable.is_named(path) && std::filesystem::is_regular_file(path, error);
}

std::vector<ListedStill> read_stills_table(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(format("{} cannot be read", path.string()));
  std::error_code has_none;  // a folder and a pipe have no size
  const std::uintmax_t bytes = std::filesystem::file_size(path, has_none);
  if (!has_none) check_text_bytes(path.string(), bytes);
  std::vector<ListedStill> stills;
  std::string text;
  for (std::size_t line = 1; std::getline(in, text); ++line) {
    std::string_view row = text;
    if (line == 1 && row.starts_with("\xEF\xBB\xBF")) row.remove_prefix(3);
    if (line == 1 && (row.starts_with("\xFF\xFE") || row.starts_with("\xFE\xFF")))
      fail(path, line, "UTF-16; save the table as UTF-8");
    if (row.ends_with('\r')) row.remove_suffix(1);
    if (trimmed_field(row).empty()) continue;
    auto fields = fields_of(row);
    if (!fields) fail(path, line, "a quote is not closed on its line");
    if (stills.empty() && is_header(*fields)) continue;
    if (fields->size() > std::size(kColumns)) {
      fail(path, line,
           format("{} columns, and a table of stills has three: file,start_ns,exposure_ns; a name with a comma "
                  "stands in quotes. Events are read as EVT 3.0 or DAT",
                  fields->size()));
    }
    fields->resize(std::size(kColumns));
    const std::string& name = (*fields)[0];
    if (name.empty()) fail(path, line, "the file's name is missing");
    ListedStill still{path.parent_path() / name, line, {}};
    still.times.start_ns = nanoseconds(path, line, kColumns[1], (*fields)[1], -kLargestTimeNs);
    still.times.exposure_ns = nanoseconds(path, line, kColumns[2], (*fields)[2], 1);
    std::error_code error;
    if (!std::filesystem::is_regular_file(still.file, error)) {
      const bool has_semicolons = (*fields)[1].empty() && name.find(';') != name.npos;
      fail(path, line,
           format("{} is no file{}", still.file.string(), has_semicolons ? "; columns are separated by commas" : ""));
    }
    stills.push_back(std::move(still));
  }
  if (in.bad()) throw InputError(format("{} cannot be read to its end", path.string()));
  if (stills.empty()) throw InputError(format("{} lists no picture", path.string()));
  return stills;
}

ClipTiming timing_of(const std::filesystem::path& table, std::span<const ListedStill> stills,
                     std::span<const StillTimes> exif) {
  const Times starts = column(table, stills, exif, &StillTimes::start_ns, "start_ns");
  const Times exposures = column(table, stills, exif, &StillTimes::exposure_ns, "exposure_ns");
  if (starts.empty()) {
    fail(table, stills.front().line,
         format("{} has no start_ns, neither here nor in EXIF data (of JPEG and DNG); state it, or a rate",
                stills.front().file.string()),
         {Setting::frame_rate});
  }
  const bool from_exif = !stills.front().times.start_ns;
  ClipTiming timing;
  timing.rate_from = from_exif ? "EXIF data" : "the table";
  for (std::size_t k = 0; k < stills.size(); ++k) {
    const std::int64_t start_ns = starts[k] - starts[0];
    const int128 reached_ns = static_cast<int128>(start_ns) + (exposures.empty() ? 0 : exposures[k]);
    if (start_ns > kLongestNs || reached_ns > kLongestNs) {
      fail(table, stills[k].line,
           format("{} starts {} ns after the first picture{}; a clip lasts {} ns (146 years) at most",
                  stills[k].file.string(), start_ns,
                  exposures.empty() ? "" : format(" and is exposed for {} ns", exposures[k]), kLongestNs));
    }
    const auto end_ns = static_cast<std::int64_t>(reached_ns);
    if (k > 0) {
      const std::int64_t free_ns =
          exposures.empty() ? timing.starts_ns.back() + 1 : timing.exposures.back().end_ns;
      if (start_ns < free_ns) {
        const char* const why =
            !from_exif ? ""
            : starts[k] < starts[k - 1]
                ? "; these are EXIF times, which run back where a clock was set or files are in another order; state "
                  "start_ns, or a rate"
                : "; these are EXIF times, which often have whole seconds only; state start_ns, or a rate";
        fail(
            table, stills[k].line,
            format("{} starts at {} ns, {} {} {} ({} ns from the first start){}", stills[k].file.string(),
                   starts[k], exposures.empty() ? "not after" : "before the end of",
                   stills[k - 1].file.string(),
                   format("at {} ns", exposures.empty() ? starts[k - 1] : starts[k - 1] + exposures[k - 1]),
                   start_ns, why),
            from_exif ? std::vector{Setting::frame_rate} : std::vector<Setting>());
      }
    }
    if (exposures.empty()) {
      timing.starts_ns.push_back(start_ns);
    } else {
      timing.exposures.push_back({start_ns, end_ns});
    }
  }
  return timing;
}

}  // namespace nutik
