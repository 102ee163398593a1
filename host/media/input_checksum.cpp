#include "media/input_checksum.hpp"

#include <algorithm>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/clip.hpp"
#include "system/checksum.hpp"
#include "system/input_bytes.hpp"
#include "system/is_absent.hpp"
#include "system/mapped_file.hpp"

namespace nutik {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMinEndBytes = 4 << 10;
constexpr std::uint64_t kMaxEndBytes = 1 << 20;
constexpr std::size_t kPieceBytes = 1 << 20;

void add_size(Checksum& to, std::uint64_t size) {
  std::byte bytes[8];
  for (int i = 0; i < 8; ++i) bytes[i] = static_cast<std::byte>(size >> (8 * i));
  to.add(bytes);
}

std::uint64_t size_of(const fs::path& file) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  if (error) throw InputError(format("{} cannot be read: {}", file.string(), error.message()));
  return size;
}

}  // namespace

std::string input_checksum(const fs::path& name, bool is_raw) {
  const fs::path& path = is_standard_input(name.string()) ? standard_input_file() : name;
  return files_checksum(files_of_clip(path, is_raw));
}

std::string files_checksum(std::span<const fs::path> files) {
  std::uint64_t total = 0;
  for (const fs::path& file : files) total += size_of(file);
  const bool whole = total <= kWholeChecksumBytes;
  const std::uint64_t end_bytes =
      std::clamp<std::uint64_t>(kWholeChecksumBytes / (2 * files.size()), kMinEndBytes, kMaxEndBytes);
  Checksum checksum;
  for (const fs::path& file : files) {
    add_size(checksum, size_of(file));
    if (size_of(file) == 0) continue;
    const MappedFile mapped(file);
    const auto bytes = mapped.bytes();
    if (whole || bytes.size() <= 2 * end_bytes) {
      // Piece by piece: a clip may be larger than the memory that is allowed.
      for (std::size_t at = 0; at < bytes.size(); at += kPieceBytes) {
        const auto piece = bytes.subspan(at, std::min(kPieceBytes, bytes.size() - at));
        checksum.add(piece);
        mapped.release(piece);
      }
    } else {
      checksum.add(bytes.first(end_bytes));
      checksum.add(bytes.last(end_bytes));
    }
  }
  return format("xxh3-64{}:{:016x}", whole ? "" : "-ends", checksum.value());
}

std::string bytes_checksum(std::span<const std::byte> bytes) {
  Checksum checksum;
  add_size(checksum, bytes.size());
  checksum.add(bytes);
  return format("xxh3-64:{:016x}", checksum.value());
}

std::string input_name(const fs::path& path) {
  if (is_standard_input(path.string())) return "standard-input";
  std::error_code error;
  if (!is_absent(path)) {
    const fs::path whole = fs::absolute(path, error).lexically_normal();
    return (whole.filename().empty() ? whole.parent_path() : whole).filename().string();
  }
  const fs::path folder = path.parent_path().filename();
  return (folder == "." || folder == ".." ? path.filename() : folder / path.filename()).string();
}

}  // namespace nutik
