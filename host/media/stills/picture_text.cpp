#include "media/stills/picture_text.hpp"

#include <libdeflate.h>

#include <array>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"
#include "media/formats/input_kinds.hpp"
#include "system/checksum.hpp"
#include "system/mapped_file.hpp"
#include "system/output_file.hpp"

namespace nutik {
namespace {

constexpr std::string_view kPngText = "tEXt";
constexpr std::size_t kPngSumBytes = 4;

// Where in a file the value of the field `file` begins; in a PNG also where its chunk's type does, and that's checksum.
struct Seal {
  std::size_t value = 0, chunk = 0, chunk_sum = 0;

  [[nodiscard]] bool is_in_chunk() const { return chunk != 0; }
  [[nodiscard]] std::string wanted(std::span<const std::byte> file) const {
    Checksum sum;
    sum.add(file.first(value));
    auto rest = file.subspan(value + kUnsealed.size());
    if (is_in_chunk()) {
      const std::size_t before = chunk_sum - value - kUnsealed.size();
      sum.add(rest.first(before));
      rest = rest.subspan(before + kPngSumBytes);
    }
    sum.add(rest);
    return format("xxh3-64:{:016x}", sum.value());
  }
};

std::optional<Seal> find_seal(std::string_view file) {
  constexpr std::string_view kField = "\"file\":\"";
  constexpr std::size_t kLongestVersion = 64;
  const std::size_t text = file.find(kPictureTextStart);
  if (text == std::string_view::npos) return std::nullopt;
  const std::size_t name = file.substr(text, kPictureTextStart.size() + kLongestVersion).find(kField);
  Seal seal{text + name + kField.size()};
  if (name == std::string_view::npos || file.size() - seal.value < kUnsealed.size()) return std::nullopt;
  if (!inputs::kPng.begins(file)) return seal;
  const std::string begin = format("{}{}{}", kPngText, kPictureTextKeyword, '\0');
  if (!file.substr(0, text).ends_with(begin)) return std::nullopt;
  seal.chunk = text - begin.size();
  const std::uint64_t end = seal.chunk + kPngText.size() + big_endian(file, seal.chunk - 4, 4);
  if (end < seal.value + kUnsealed.size() || end + kPngSumBytes > file.size()) return std::nullopt;
  seal.chunk_sum = end;
  return seal;
}

}  // namespace

std::optional<std::string> read_picture_text(const std::filesystem::path& path) {
  const MappedFile file(path);
  if (inputs::kPfm.begins(as_text(file.bytes()))) return std::nullopt;
  std::vector<std::string_view> carriers;
  for (const inputs::InputKind* kind : inputs::kStills) {
    if (kind->text == nullptr) continue;
    carriers.push_back(kind->name);
    if (!kind->begins(as_text(file.bytes()))) continue;
    std::optional<std::string> text = kind->text(file.bytes(), path);
    if (text && !text->starts_with(kPictureTextStart)) text.reset();
    return text;
  }
  throw InputError(format("{} is no {}: it can carry no recipe", path.string(), joined(carriers)));
}

void seal_picture(OutputFile& file) {
  std::optional<Seal> seal;
  std::string value, chunk;
  {
    const MappedFile written(file.temporary_path());
    seal = find_seal(as_text(written.bytes()));
    if (!seal) return;
    value = seal->wanted(written.bytes());
    if (seal->is_in_chunk()) chunk = as_text(written.bytes()).substr(seal->chunk, seal->chunk_sum - seal->chunk);
  }
  file.replace(seal->value, std::as_bytes(std::span(value)));
  if (!seal->is_in_chunk()) return;
  chunk.replace(seal->value - seal->chunk, value.size(), value);
  const std::uint32_t sum = libdeflate_crc32(0, chunk.data(), chunk.size());
  std::array<std::byte, kPngSumBytes> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(sum >> (24 - 8 * i));
  file.replace(seal->chunk_sum, bytes);
}

bool is_as_sealed(const std::filesystem::path& path) {
  const MappedFile file(path);
  const auto seal = find_seal(as_text(file.bytes()));
  return seal && as_text(file.bytes()).substr(seal->value, kUnsealed.size()) == seal->wanted(file.bytes());
}

}  // namespace nutik
