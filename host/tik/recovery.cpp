#include "tik/recovery.hpp"

#include <algorithm>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "system/checksum.hpp"
#include "system/interruption.hpp"
#include "system/output_file.hpp"
#include "tik/block_headers.hpp"
#include "tik/reader.hpp"
#include "tik/writer.hpp"

namespace nutik::tik {
namespace {

bool is_readable(const std::filesystem::path& path) {
  try {
    Reader reader(path);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

Recovery recover(const std::filesystem::path& damaged, const std::filesystem::path& whole) {
  const std::string name = damaged.string();
  const MappedFile mapped(damaged);
  const std::span<const std::byte> file = mapped.bytes();
  const ParsedHeader parsed = parse_header(file, name);
  if (is_readable(damaged)) {
    throw InputError(nutik::format(
        "{}: it was not cut off: expose from it as it is; a damaged block costs its own times only", name));
  }
  Recovery recovery;
  std::vector<IndexEntry> index;
  Checksum headers;
  std::vector<Exposure> exposures;
  std::uint64_t offset = parsed.first_block_offset;
  const std::uint64_t front_checksum = checksum(file.first(std::min<std::uint64_t>(offset, file.size())));
  while (fits(offset, sizeof(BlockHeader), file.size())) {
    check_interruption();
    const auto header = load<BlockHeader>(file, offset);
    const HeaderPlace place{offset, recovery.block_count, recovery.sample_count,
                            parsed.header.rate.has_value()};
    if (!is_whole(header) || !flaw_of(header, place, file.size()).empty()) break;
    if (header.front_checksum != front_checksum) {
      throw InputError(nutik::format("{}: {}", name, kDamagedFront));
    }
    const auto exposure_bytes = file.subspan(exposures_offset(offset), header.exposure_bytes);
    const std::uint64_t payload = payload_offset(offset, header);
    if (!fits(payload, header.stored_bytes, file.size())) break;
    if (checksum(file.subspan(payload, header.stored_bytes)) != header.payload_checksum) break;
    if (header.exposure_bytes != 0 && checksum(exposure_bytes) != header.exposures_checksum) break;
    const std::vector<Exposure> block_exposures = load_exposures(exposure_bytes);
    exposures.insert(exposures.end(), block_exposures.begin(), block_exposures.end());
    index.push_back({offset, header.first_sample, header.sample_count, header.codec, header.stored_bytes,
                     header.payload_bytes, header.record_count});
    headers.add(file.subspan(offset, sizeof header));
    recovery.sample_count += header.sample_count;
    ++recovery.block_count;
    offset = align_up(payload + header.stored_bytes, kAlignment);
  }
  if (index.empty()) {
    throw InputError(
        nutik::format("{}: its first block is not whole, and blocks are saved from the front", name));
  }
  const std::uint64_t kept = std::min<std::uint64_t>(offset, file.size());
  recovery.lost_bytes = file.size() - kept;

  const Timeline timeline = timeline_of(parsed.header, recovery.sample_count, exposures, {}, name);
  OutputFile out(whole, OutputFile::Lasting::recoverable);
  out.write(file.first(kept));
  finish_file(out, index, headers.value(), timeline);
  return recovery;
}

}  // namespace nutik::tik
