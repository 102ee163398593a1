// .tik files with right checksums: read, checked, recovered, and exposed by the reference.
#include <cstring>

#include "fuzz/target.hpp"
#include "render/reference_renderer.hpp"
#include "system/checksum.hpp"
#include "tik/reader.hpp"

namespace nutik::fuzz {
namespace {

constexpr std::uint64_t kMaxPixels = 4096;  // what the reference exposes in no time
constexpr std::uint64_t kMaxSamples = 2000;

void expose(tik::Reader& reader) {
  const Shape& shape = reader.format().shape;
  if (shape.pixel_count() > kMaxPixels || reader.timeline().sample_count() > kMaxSamples) return;
  const FunctionSet functions{{0, GainFunction::boxcar(0, reader.timeline().duration_ns())}};
  const RenderPlan plan = make_plan(reader, functions, Mask::uniform(shape.width, shape.height, 0), {});
  static_cast<void>(ReferenceRenderer().render(plan, reader, {ValueType::light64, 0}));
}

void read(Bytes input) {
  const auto path = as_file(input, "input.tik");
  try {
    tik::Reader reader(path);
    static_cast<void>(reader.content_checksum());
    for (std::uint64_t block = 0; block < reader.block_count(); ++block) {
      static_cast<void>(reader.directory(block));
      static_cast<void>(reader.acquire(block));
    }
    expose(reader);
  } catch (const Error&) {
    static_cast<void>(tik::recover(path, path.parent_path() / "recovered.tik"));
  }
}

template <typename Struct>
Struct load(std::span<const std::byte> bytes, std::size_t offset) {
  Struct value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

template <typename Struct>
void store(std::span<std::byte> bytes, std::size_t offset, const Struct& value) {
  std::memcpy(bytes.data() + offset, &value, sizeof value);
}

bool fits(std::uint64_t offset, std::uint64_t bytes, std::uint64_t size) {
  return offset <= size && bytes <= size - offset;
}

// Makes the checksums of a block right whose magic stands at `at`.
void mend_block(std::span<std::byte> file, std::size_t at, std::size_t first_block) {
  auto header = load<tik::BlockHeader>(file, at);
  const std::uint64_t exposures = at + sizeof header;
  if (fits(exposures, header.exposure_bytes, file.size())) {
    const std::uint64_t payload =
        (exposures + header.exposure_bytes + tik::kAlignment - 1) / tik::kAlignment * tik::kAlignment;
    if (header.exposure_bytes != 0) {
      header.exposures_checksum = checksum(file.subspan(exposures, header.exposure_bytes));
    }
    if (fits(payload, header.stored_bytes, file.size())) {
      header.payload_checksum = checksum(file.subspan(payload, header.stored_bytes));
    }
  }
  header.front_checksum = checksum(file.first(first_block));
  header.header_checksum = checksum_of(header, offsetof(tik::BlockHeader, header_checksum));
  store(file, at, header);
}

void mend_footer(std::span<std::byte> file) {
  if (file.size() < sizeof(tik::Footer)) return;
  const std::size_t at = file.size() - sizeof(tik::Footer);
  auto footer = load<tik::Footer>(file, at);
  const std::uint64_t index_bytes = footer.block_count * sizeof(tik::IndexEntry);
  if (footer.block_count <= file.size() && fits(footer.index_offset, index_bytes, file.size())) {
    footer.index_checksum = checksum(file.subspan(footer.index_offset, index_bytes));
  }
  const std::uint64_t exposure_bytes = footer.sample_count * sizeof(Exposure);
  if (footer.sample_count <= file.size() && fits(footer.exposures_offset, exposure_bytes, file.size())) {
    footer.exposures_checksum = checksum(file.subspan(footer.exposures_offset, exposure_bytes));
  }
  footer.checksum = checksum_of(footer, offsetof(tik::Footer, checksum));
  std::memcpy(footer.magic, tik::kFooterMagic, sizeof footer.magic);
  store(file, at, footer);
}

void mend(std::span<std::byte> file) {
  std::size_t first_block = 0;
  for (std::size_t at = 0; at + sizeof(tik::BlockHeader) <= file.size(); at += tik::kAlignment) {
    if (std::memcmp(file.data() + at, tik::kBlockMagic, sizeof tik::kBlockMagic) != 0) continue;
    if (first_block == 0) first_block = at;
    mend_block(file, at, first_block);
  }
  mend_footer(file);
}

}  // namespace

// A block of zeros is packed to a ten-thousandth.
const Target kTarget{{64 << 20, 10'000}, read};

}  // namespace nutik::fuzz

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

// Without this nearly every input would end at its first checksum. One in eight keeps wrong ones.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned seed) {
  const std::size_t mutated = LLVMFuzzerMutate(data, size, most);
  if (seed % 8 != 0) nutik::fuzz::mend({reinterpret_cast<std::byte*>(data), mutated});
  return mutated;
}
