#include "opencl/verdict_store.hpp"

#include <sstream>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "opencl/cache_folder.hpp"
#include "opencl/kernel_sources.hpp"
#include "opencl/program_store.hpp"
#include "system/checksum.hpp"

namespace nutik {
namespace {

// Counts the scenes: what they hold is part of what was tested.
constexpr std::string_view kVerdictMagic = "nutik-cl self-test 1\n";
constexpr std::string_view kPrefix = "self-test-";

std::string verdict_line(Precision precision, const Verdict& verdict) {
  return format("{} {} {:.17g} {:.17g} {} {}\n", to_text(precision), verdict.is_right ? "right" : "wrong",
                verdict.light_error, verdict.allowed_error, verdict.wrong_codes, verdict.codes);
}

struct KeptVerdict {
  Precision precision;
  Verdict verdict;
};

// Of the last line of a file; none if it is damaged.
std::optional<KeptVerdict> parse_verdict(const std::string& line) {
  std::istringstream words(line);
  std::string precision, is_right, error, allowed;  // errors may be infinite, which streams do not read
  Verdict verdict;
  if (!(words >> precision >> is_right >> error >> allowed >> verdict.wrong_codes >> verdict.codes))
    return {};
  if (is_right != "right" && is_right != "wrong") return {};
  try {
    verdict.is_right = is_right == "right";
    verdict.light_error = std::stod(error);
    verdict.allowed_error = std::stod(allowed);
    return KeptVerdict{parse_precision(precision), verdict};
  } catch (const std::exception&) {
    return {};
  }
}

// What a file says behind `key`.
std::optional<KeptVerdict> read_verdict(const std::filesystem::path& path, std::string_view key) {
  const std::string text = read_from_cache(path);
  if (!text.starts_with(key)) return {};
  const std::size_t end = text.find_last_not_of('\n');
  const std::size_t line = end == std::string::npos ? end : text.rfind('\n', end);
  if (line == std::string::npos) return {};
  return parse_verdict(text.substr(line + 1));
}

bool is_worse(const Verdict& a, const Verdict& b) {
  if (a.is_right != b.is_right) return b.is_right;
  return a.light_error * b.allowed_error > b.light_error * a.allowed_error;
}

}  // namespace

VerdictStore::VerdictStore(const cl::Device& device, std::filesystem::path folder)
    : device_key_(format("{}{}{:016x} {:016x}\n", kVerdictMagic, identity_of(device),
                         checksum(kernel_source("expose")), checksum(kernel_source("develop")))),
      folder_(std::move(folder)) {}

std::string VerdictStore::key_of(const TestedPrograms& programs) const {
  return device_key_ + programs.text();
}

std::optional<Verdict> VerdictStore::find(const TestedPrograms& programs) const {
  if (folder_.empty()) return {};
  const std::string key = key_of(programs);
  const auto kept = read_verdict(folder_ / format("{}{:016x}.txt", kPrefix, checksum(key)), key);
  if (!kept || kept->precision != programs.precision) return {};
  return kept->verdict;
}

void VerdictStore::keep(const TestedPrograms& programs, const Verdict& verdict) const {
  if (folder_.empty()) return;
  const std::string key = key_of(programs);
  write_to_cache(folder_ / format("{}{:016x}.txt", kPrefix, checksum(key)),
                 key + verdict_line(programs.precision, verdict));
}

std::map<Precision, Verdict> VerdictStore::all() const {
  std::map<Precision, Verdict> worst;
  std::error_code error;
  for (const auto& file : std::filesystem::directory_iterator(folder_, error)) {
    if (!file.path().filename().string().starts_with(kPrefix)) continue;
    const auto kept = read_verdict(file.path(), device_key_);
    if (!kept) continue;
    const auto [known, is_first] = worst.emplace(kept->precision, kept->verdict);
    if (!is_first && is_worse(kept->verdict, known->second)) known->second = kept->verdict;
  }
  return worst;
}

}  // namespace nutik
