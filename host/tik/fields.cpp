#include "tik/fields.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <stdexcept>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "imev/block.hpp"
#include "system/checksum.hpp"

namespace nutik::tik {
namespace {

constexpr char kMagic[8] = {'T', 'I', 'K', 'f', 'i', 'e', 'l', 'd'};
constexpr std::uint64_t kFieldAlignment = 8;
constexpr std::uint32_t kMustBeUnderstood = 1;

struct ListHeader {
  char magic[8];
  std::uint64_t bytes;
  std::uint32_t count;
  std::uint32_t reserved;
};
static_assert(sizeof(ListHeader) == 24);

struct FieldHeader {
  char tag[4];
  std::uint32_t flags;
  std::uint64_t bytes;
};
static_assert(sizeof(FieldHeader) == 16);

template <typename T>
void append(std::vector<std::byte>& bytes, const T& value) {
  const auto added = std::as_bytes(std::span(&value, 1));
  bytes.insert(bytes.end(), added.begin(), added.end());
}

template <typename T>
T value_at(std::span<const std::byte> bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

}  // namespace

std::vector<std::byte> packed_fields(std::span<const Field> fields) {
  std::vector<std::byte> bytes(sizeof(ListHeader));
  for (const Field& field : fields) {
    FieldHeader header{};
    if (field.tag.size() != sizeof header.tag) throw std::logic_error("a field's tag has four characters");
    std::memcpy(header.tag, field.tag.data(), sizeof header.tag);
    header.flags = field.must_be_understood ? kMustBeUnderstood : 0;
    header.bytes = field.data.size();
    append(bytes, header);
    const auto data = std::as_bytes(std::span(field.data));
    bytes.insert(bytes.end(), data.begin(), data.end());
    bytes.resize(align_up(bytes.size(), kFieldAlignment));
  }
  ListHeader header{};
  std::memcpy(header.magic, kMagic, sizeof header.magic);
  header.bytes = bytes.size() + sizeof(std::uint64_t);
  header.count = static_cast<std::uint32_t>(fields.size());
  std::memcpy(bytes.data(), &header, sizeof header);
  append(bytes, checksum(bytes));
  return bytes;
}

ReadFields read_fields(std::span<const std::byte> bytes, const std::string& name) {
  const auto damaged = [&] {
    return InputError(
        format("{}: the list of fields that says what its samples are is damaged; encode the clip "
               "again",
               name));
  };
  if (bytes.size() < sizeof(ListHeader) + sizeof(std::uint64_t)) throw damaged();
  const auto header = value_at<ListHeader>(bytes, 0);
  if (std::memcmp(header.magic, kMagic, sizeof header.magic) != 0)
    throw InputError(
        format("{}: there is no list of fields where it should begin; it is damaged, or what wrote it left "
               "the list out",
               name));
  if (header.bytes > bytes.size() || header.bytes < sizeof(ListHeader) + sizeof(std::uint64_t)) throw damaged();
  const auto list = bytes.first(header.bytes - sizeof(std::uint64_t));
  if (value_at<std::uint64_t>(bytes, list.size()) != checksum(list)) throw damaged();
  ReadFields read{{}, header.bytes};
  std::size_t at = sizeof header;
  for (std::uint32_t i = 0; i < header.count; ++i) {
    if (list.size() - at < sizeof(FieldHeader)) throw damaged();
    const auto field = value_at<FieldHeader>(list, at);
    at += sizeof field;
    if (field.bytes > list.size() - at) throw damaged();
    read.fields.push_back({std::string(field.tag, sizeof field.tag), (field.flags & kMustBeUnderstood) != 0,
                           std::string(reinterpret_cast<const char*>(list.data()) + at, field.bytes)});
    at = std::min<std::size_t>(align_up(at + field.bytes, kFieldAlignment), list.size());
  }
  return read;
}

}  // namespace nutik::tik
