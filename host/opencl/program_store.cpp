#include "opencl/program_store.hpp"

#include <algorithm>
#include <cstring>
#include <sstream>
#include <string_view>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"
#include "opencl/cache_folder.hpp"
#include "opencl/kernel_sources.hpp"
#include "system/checksum.hpp"

namespace nutik {
namespace {

// The first line of a verdict's file, which counts the scenes: what they hold is part of what was tested.
constexpr std::string_view kVerdictMagic = "nutik-cl self-test 1\n";
constexpr std::string_view kPrefix = "self-test-";  // of its name

std::string verdict_line(Precision precision, const Verdict& verdict) {
  return format("{} {} {:.17g} {:.17g} {} {}\n", to_text(precision), verdict.is_right ? "right" : "wrong",
                verdict.light_error, verdict.allowed_error, verdict.wrong_codes, verdict.codes);
}

struct KeptVerdict {
  Precision precision;
  Verdict verdict;
};

// What the last line of a file says; none if it is damaged.
std::optional<KeptVerdict> parse_verdict(const std::string& line) {
  std::istringstream words(line);
  std::string precision, is_right, light, most;  // errors may be infinite, which streams do not read
  Verdict verdict;
  if (!(words >> precision >> is_right >> light >> most >> verdict.wrong_codes >> verdict.codes))
    return {};
  const auto error = parsed<double>(light), allowed = parsed<double>(most);
  if (!error || !allowed || (is_right != "right" && is_right != "wrong")) return {};
  verdict.is_right = is_right == "right";
  verdict.light_error = *error;
  verdict.allowed_error = *allowed;
  try {
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

constexpr std::string_view kProgramMagic = "nutik-cl program 2\n";

// How often a driver is asked to build a kernel before it is taken at its word.
constexpr int kAttempts = 4;

void append_number(std::string& to, std::uint64_t number) {
  to.append(reinterpret_cast<const char*>(&number), sizeof number);
}

bool take_number(std::string_view& from, std::uint64_t& number) {
  if (from.size() < sizeof number) return false;
  std::memcpy(&number, from.data(), sizeof number);
  from.remove_prefix(sizeof number);
  return true;
}

// A device with its driver, in lines: what a binary was built for.
std::string identity_of(const cl::Device& device) {
  const cl::Platform platform(device.getInfo<CL_DEVICE_PLATFORM>());
  std::string identity;
  for (const std::string& part : {device.getInfo<CL_DEVICE_NAME>(), device.getInfo<CL_DEVICE_VENDOR>(),
                                  device.getInfo<CL_DEVICE_VERSION>(), device.getInfo<CL_DRIVER_VERSION>(),
                                  platform.getInfo<CL_PLATFORM_VERSION>()}) {
    identity += part + '\n';
  }
  return identity;
}

}  // namespace

VerdictStore::VerdictStore(const cl::Device& device, std::filesystem::path folder)
    : device_key_(format("{}{}{:016x} {:016x} {:016x}\n", kVerdictMagic, identity_of(device),
                         checksum(kernel_source("expose")), checksum(kernel_source("combine")),
                         checksum(kernel_source("develop")))),
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

ProgramStore::ProgramStore(cl::Context context, cl::Device device, std::filesystem::path cache_folder,
                           Announce announce)
    : context_(std::move(context)),
      device_(std::move(device)),
      cache_folder_(std::move(cache_folder)),
      announce_(std::move(announce)),
      device_key_(identity_of(device_)) {}

std::filesystem::path ProgramStore::file_for(const std::string& name, const std::string& key) const {
  return cache_folder_ / format("{}-{:016x}.bin", name, checksum(key));
}

// magic, key length, key, binary length, hash of the binary, binary
bool ProgramStore::load(const std::string& name, const std::string& key, const std::string& options,
                        cl::Program& program) const {
  if (cache_folder_.empty()) return false;
  const std::string bytes = read_from_cache(file_for(name, key));
  std::string_view rest = bytes;
  std::uint64_t key_bytes = 0, binary_bytes = 0, hash = 0;
  if (!rest.starts_with(kProgramMagic)) return false;
  rest.remove_prefix(kProgramMagic.size());
  if (!take_number(rest, key_bytes) || rest.substr(0, key_bytes) != key) return false;
  rest.remove_prefix(key.size());
  if (!take_number(rest, binary_bytes) || !take_number(rest, hash)) return false;
  if (rest.size() != binary_bytes || checksum(rest) != hash) return false;
  try {
    const std::vector<unsigned char> binary(rest.begin(), rest.end());
    program = cl::Program(context_, {device_}, {binary});
    program.build({device_}, options.c_str());
    return true;
  } catch (const cl::Error&) {
    return false;  // the driver no longer takes it
  }
}

cl::Program ProgramStore::build(const std::string& name, const std::string& source,
                                const std::string& options) const {
  // PoCL's own cache is shared by all programs of a user; where several build at once, one may find a file of it
  // unfinished, and fails (pocl/pocl#1480). It succeeds a moment later.
  for (int attempts_left = kAttempts - 1;; --attempts_left) {
    cl::Program program;
    try {
      program = cl::Program(context_, source);
      program.build({device_}, options.c_str());
      return program;
    } catch (const cl::Error& error) {
      if (attempts_left > 0 && error.err() == CL_BUILD_PROGRAM_FAILURE) continue;
      std::string log = "\n";
      if (program() != nullptr) log += program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device_);
      while (log.ends_with('\n')) log.pop_back();
      throw DeviceError(format("{}\n  options: {}\n  device: {}{}",
                               describe(error, format("kernels/{}.cl does not build", name)), options,
                               device_.getInfo<CL_DEVICE_NAME>(), log),
                        Advice{"\nuse another device or the reference (`renderer`)"});
    }
  }
}

cl::Program ProgramStore::get(const std::string& name, const std::string& source,
                              const std::string& options) {
  const std::string key = format("{}\n{}\n{}{}", name, options, device_key_, source);
  if (const auto found = entries_.find(key); found != entries_.end()) return found->second.program;

  cl::Program program;
  const bool was_built = !load(name, key, options, program);
  if (was_built) {
    if (announce_) announce_(name);
    program = build(name, source, options);
  }
  entries_.emplace(key, Entry{program, name, options, was_built, !was_built});
  return program;
}

bool ProgramStore::was_built(const std::string& name, const std::string& options) const {
  return std::ranges::any_of(entries_, [&](const auto& entry) {
    return entry.second.name == name && entry.second.options == options && entry.second.was_built;
  });
}

void ProgramStore::save_new_binaries() {
  if (cache_folder_.empty()) return;
  for (auto& [key, entry] : entries_) {
    if (entry.is_saved) continue;
    entry.is_saved = true;
    // A cache that cannot be written costs a second next time; the picture is unharmed.
    try {
      const auto binaries = entry.program.getInfo<CL_PROGRAM_BINARIES>();
      if (binaries.empty() || binaries.front().empty()) continue;
      const std::string_view binary(reinterpret_cast<const char*>(binaries.front().data()),
                                    binaries.front().size());
      std::string bytes(kProgramMagic);
      append_number(bytes, key.size());
      bytes += key;
      append_number(bytes, binary.size());
      append_number(bytes, checksum(binary));
      bytes += binary;
      write_to_cache(file_for(entry.name, key), bytes);
    } catch (const std::exception&) {
      continue;
    }
  }
}

}  // namespace nutik
