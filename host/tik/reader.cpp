#include "tik/reader.hpp"

#include <algorithm>
#include <cstring>

#include "capture/fact.hpp"
#include "capture/format.hpp"
#include "capture/seconds_text.hpp"
#include "imev/block_builder.hpp"
#include "system/checksum.hpp"
#include "system/input_bytes.hpp"
#include "system/interruption.hpp"
#include "system/output_file.hpp"
#include "tik/block_headers.hpp"
#include "tik/codec.hpp"
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
  const std::string name = input_title(damaged.string());
  const MappedFile mapped(is_standard_input(damaged.string()) ? standard_input_file() : damaged);
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

Reader::Reader(const std::filesystem::path& path)
    : name_(input_title(path.string())), file_(is_standard_input(path.string()) ? standard_input_file() : path) {
  header_ = parse_header(file_.bytes(), name_).header;
  read_footer();
  check_front();
}

// By the first block whose header is whole: each holds the same checksum.
void Reader::check_front() const {
  for (const IndexEntry& entry : index_) {
    const auto header = load<BlockHeader>(file_.bytes(), entry.offset);
    if (!is_whole(header)) continue;
    if (header.front_checksum != checksum(file_.bytes().first(index_.front().offset))) fail(kDamagedFront);
    return;
  }
}

void Reader::fail(const std::string& why) const {
  file_.check();  // what seems damaged may have changed under our hands
  throw InputError(nutik::format("{}: {}", name_, why));
}

void Reader::read_footer() {
  const std::span<const std::byte> file = file_.bytes();
  const auto fail_with_way_out = [&](const std::string& why) {
    throw Recoverable(nutik::format("{}: {}", name_, why), name_);
  };
  const char* cut_off = "it does not end as a .tik does, so it was cut off";
  if (file.size() < sizeof(Footer)) fail_with_way_out(cut_off);
  const auto footer = load<Footer>(file, file.size() - sizeof(Footer));
  if (std::memcmp(footer.magic, kFooterMagic, sizeof footer.magic) != 0) fail_with_way_out(cut_off);
  const bool intact = footer.checksum == checksum_of(footer, offsetof(Footer, checksum)) &&
                      footer.block_count != 0 && footer.block_count <= file.size() / sizeof(IndexEntry) &&
                      fits(footer.index_offset, footer.block_count * sizeof(IndexEntry), file.size());
  if (!intact) fail_with_way_out("its footer is damaged");
  const auto index_bytes = file.subspan(footer.index_offset, footer.block_count * sizeof(IndexEntry));
  if (footer.index_checksum != checksum(index_bytes)) fail_with_way_out("its index is damaged");
  index_.resize(footer.block_count);
  std::memcpy(index_.data(), index_bytes.data(), index_bytes.size());
  are_right_ = std::vector<std::atomic<bool>>(index_.size());

  if (footer.fields_offset != 0) {
    if (footer.fields_offset > file.size()) fail("its footer contradicts itself");
    refuse_unknown(read_fields(file.subspan(footer.fields_offset), name_).fields, name_);
  }

  std::uint64_t samples = 0;
  for (const IndexEntry& entry : index_) {
    if (entry.first_sample != samples || entry.sample_count == 0 ||
        entry.sample_count > kLargestBlockSamples || entry.payload_bytes > kLargestPayloadBytes ||
        !fits(entry.offset, sizeof(BlockHeader), file.size())) {
      fail("its index contradicts itself");
    }
    samples += entry.sample_count;
  }
  if (samples != footer.sample_count || samples == 0) fail("its index contradicts its sample count");
  const std::string told_made = header_.made ? header_.made->text() : "";
  if (header_.made && !header_.made->cut_to(samples)) fail("its made samples contradict its sample count");
  // A capture that was cut off tells what was to be.
  const std::uint64_t pictures = header_.made ? header_.made->after.size() : samples;
  for (std::string& fact : header_.facts) {
    if (header_.part && tells_part(fact)) restate(fact, header_.part->text(header_.part->first + pictures));
    if (header_.made && fact.starts_with(told_made)) restate(fact, header_.made->text());
  }

  if (header_.rate) {
    timeline_ = timeline_of(header_, samples, {}, {}, name_);
    return;
  }
  if (samples > file.size() / sizeof(Exposure) ||
      !fits(footer.exposures_offset, samples * sizeof(Exposure), file.size())) {
    fail("its list of exposures is damaged");
  }
  const auto exposure_bytes = file.subspan(footer.exposures_offset, samples * sizeof(Exposure));
  if (footer.exposures_checksum != checksum(exposure_bytes))
    fail_with_way_out("its list of exposures is damaged");
  timeline_ = timeline_of(header_, samples, load_exposures(exposure_bytes), footer.duration_ns, name_);
}

std::uint64_t Reader::content_checksum() const {
  const std::span<const std::byte> file = file_.bytes();
  const std::span<const std::byte> footer = file.last(sizeof(Footer));
  if (load<Footer>(footer, 0).headers_checksum != 0) return checksum(footer);
  std::vector<std::byte> summary;
  const auto append = [&](std::span<const std::byte> bytes) {
    summary.insert(summary.end(), bytes.begin(), bytes.end());
  };
  for (const IndexEntry& entry : index_) append(file.subspan(entry.offset, sizeof(BlockHeader)));
  append(footer);
  return checksum(summary);
}

BlockHeader Reader::block_header(std::uint64_t block) const {
  const std::span<const std::byte> file = file_.bytes();
  const IndexEntry& entry = index_[block];
  const auto header = load<BlockHeader>(file, entry.offset);
  if (!is_whole(header)) fail_block(block, "its header is damaged");
  const HeaderPlace place{entry.offset, block, entry.first_sample, header_.rate.has_value()};
  if (const std::string flaw = flaw_of(header, place, file.size()); !flaw.empty()) fail_block(block, flaw);
  if (header.sample_count != entry.sample_count || header.stored_bytes != entry.stored_bytes ||
      header.payload_bytes != entry.payload_bytes || header.codec != entry.codec) {
    fail_block(block, "its header contradicts the index");
  }
  return header;
}

std::uint64_t Reader::mapped_offset(std::uint64_t block, const BlockHeader& header) const {
  return payload_offset(index_[block].offset, header);
}

std::span<const std::byte> Reader::stored_payload(std::uint64_t block, const BlockHeader& header) const {
  return file_.bytes().subspan(mapped_offset(block, header), header.stored_bytes);
}

std::span<const std::byte> Reader::whole_payload(std::uint64_t block, const BlockHeader& header) const {
  const std::span<const std::byte> payload = stored_payload(block, header);
  if (checksum(payload) != header.payload_checksum) fail_block(block, "its checksum does not match");
  return payload;
}

Reader::StoredBlock Reader::stored(std::uint64_t block) const {
  const BlockHeader header = block_header(block);
  return {header, whole_payload(block, header)};
}

std::span<const std::byte> Reader::first_sample() const {
  const ParsedHeader parsed = parse_header(file_.bytes(), name_);
  return file_.bytes().subspan(parsed.raster_offset, raster_bytes(header_.capture));
}

void Reader::fail_block(std::uint64_t block, const std::string& why) const {
  file_.check();
  const SampleRange samples = block_extent(block).range();
  throw InputError(
      nutik::format("{}: the block of samples {} to {} ({} to {}) is damaged: {}; other times of the "
                    "capture can still be exposed",
                    name_, samples.first, samples.last - 1, seconds_text(timeline_.start_ns(samples.first)),
                    seconds_text(timeline_.reach_end_ns(samples.last - 1)), why));
}

void Reader::check(std::uint64_t block, const BlockHeader& header) const {
  check_interruption();
  if (are_right_[block]) return;
  if (is_packed(header) || !is_right(block, header, stored_payload(block, header))) {
    // Again where it is not packed, for the sentence that says what is wrong.
    const std::span<const std::byte> payload = whole_payload(block, header);
    if (!is_packed(header)) check_payload(block, payload);
  }
  are_right_[block] = true;
}

// Sample numbers are looked at while their bytes are in the cache: from memory they would cost about as much as the
// checksum.
bool Reader::is_right(std::uint64_t block, const BlockHeader& header,
                      std::span<const std::byte> payload) const {
  constexpr std::size_t kStripBytes = 256 << 10;
  try {
    const BlockView view(header_.capture, block_extent(block), payload);
    Checksum sum;
    std::optional<std::uint64_t> tile = 0;
    for (std::size_t at = 0; at < payload.size() && tile; at += kStripBytes) {
      const std::size_t bytes = std::min(kStripBytes, payload.size() - at);
      sum.add(payload.subspan(at, bytes));
      tile = view.checked_until(*tile, at + bytes);
    }
    return tile == view.geometry().tile_count && sum.value() == header.payload_checksum;
  } catch (const InputError&) {  // its directory
    return false;
  }
}

void Reader::check_payload(std::uint64_t block, std::span<const std::byte> payload,
                           const std::optional<TileRuns>& unpacked) const {
  try {
    const BlockView view(header_.capture, block_extent(block), payload);
    const TileRuns whole{{0, view.geometry().tile_count}};
    for (const auto& [first, last] : unpacked.value_or(whole)) view.check_samples(first, last);
  } catch (const InputError& error) {
    fail(error.what());
  }
}

BlockLease Reader::lend(std::uint64_t block, const LeaseTerms& terms) {
  file_.check();
  if (BlockLease preloaded = take_preloaded(block); !preloaded.is_empty()) return preloaded;
  const BlockHeader header = block_header(block);
  if (is_packed(header)) return unpacked(block, header, terms);
  check(block, header);
  return BlockLease::within(block_extent(block), file_.bytes(), mapped_offset(block, header),
                            header.payload_bytes);
}

BlockLease Reader::unpacked(std::uint64_t block, const BlockHeader& header, const LeaseTerms& terms) const {
  std::shared_ptr<PageBuffer> own;
  std::span<std::byte> room;
  if (terms.room) {
    room = terms.room(header.payload_bytes);
    if (room.empty()) return {};
  } else {
    own = std::make_shared<PageBuffer>(header.payload_bytes);
    room = {own->data(), own->size()};
  }
  check(block, header);
  const std::span<const std::byte> stored = stored_payload(block, header);
  const std::span<std::byte> payload = room.first(header.payload_bytes);
  std::optional<TileRuns> wanted;
  WantsTiles wants;
  if (terms.wants) {
    wanted.emplace();
    wants = [&](std::uint64_t first, std::uint64_t last) {
      const bool is_wanted = terms.wants(first, last);
      if (is_wanted) wanted->emplace_back(first, last);
      return is_wanted;
    };
  }
  try {
    unpack(static_cast<CodecId>(header.codec), BlockGeometry(header_.capture, header.sample_count), stored,
           payload, wants);
  } catch (const InputError& error) {
    fail_block(block, error.what());
  }
  check_payload(block, payload, wanted);
  file_.release(stored);  // a capture may be larger than memory
  return {block_extent(block), payload, std::move(own)};
}

void Reader::preload(std::uint64_t block) {
  const BlockHeader header = block_header(block);
  if (!is_packed(header)) return check(block, header);
  BlockLease lease = unpacked(block, header, {});
  const std::scoped_lock lock(preloading_);
  preloaded_.insert_or_assign(block, std::move(lease));
}

// Once: whoever wants to have it again later keeps the lease.
BlockLease Reader::take_preloaded(std::uint64_t block) {
  const std::scoped_lock lock(preloading_);
  auto found = preloaded_.extract(block);
  return found.empty() ? BlockLease() : std::move(found.mapped());
}

std::vector<TileEntry> Reader::directory(std::uint64_t block) const {
  const BlockHeader header = block_header(block);
  const BlockGeometry geometry(header_.capture, header.sample_count);
  const std::span<const std::byte> stored = stored_payload(block, header);
  try {
    return unpack_directory(static_cast<CodecId>(header.codec), geometry, stored, header.payload_bytes);
  } catch (const InputError& error) {
    fail_block(block, error.what());
  }
}

}  // namespace nutik::tik
