#include "media/stills/raw_file.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <libraw/libraw.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <span>
#include <string>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"
#include "media/stills/picture_files.hpp"
#include "system/mapped_file.hpp"

namespace nutik::stills {
namespace {

constexpr int kExposureTime = 33434, kDateTimeOriginal = 36867, kOffsetTimeOriginal = 36881,
              kSubSecTimeOriginal = 37521, kFrameRate = 51044;
constexpr int kRational = 5, kSignedRational = 10;

void check(int code, const std::filesystem::path& file) {
  if (code == LIBRAW_SUCCESS) return;
  throw InputError(format("{} cannot be read: LibRaw says: {}", file.string(), libraw_strerror(code)));
}

// LibRaw reads a thousand kinds of files, whatever their names; only DNG is meant here.
void open_dng(LibRaw& raw, const std::filesystem::path& file) {
  const std::string start = first_bytes(file).substr(0, 4);
  const bool is_tiff = start == std::string("II*\0", 4) || start == std::string("MM\0*", 4);
  if (is_tiff) check(raw.open_file(file.c_str()), file);
  if (!is_tiff || raw.imgdata.idata.dng_version == 0) {
    throw InputError(format("{} cannot be read: it is damaged or no DNG", file.string()));
  }
  const auto& sizes = raw.imgdata.sizes;
  const std::uint64_t bytes = std::filesystem::file_size(file);
  check_stated_size(file.string(), sizes.raw_width, sizes.raw_height, bytes);
  check_stated_size(file.string(), sizes.width, sizes.height, bytes);
}

// What a JPEG that begins there announces before its first scan; nothing where none begins.
struct JpegFront {
  std::uint64_t samples = 0;  // of a frame without loss
  bool is_lossy = false;
};
JpegFront jpeg_front(std::string_view bytes, std::uint64_t at) {
  constexpr std::uint64_t kStart = 0xFFD8, kFirstFrame = 0xFFC0, kLastLossy = 0xFFC2, kFrame = 0xFFC3, kTables = 0xFFC4,
                          kScan = 0xFFDA;
  if (big_endian(bytes, at, 2) != kStart) return {};
  JpegFront front;
  bool has_tables = false, has_scan = false;
  for (at += 2; !has_scan && big_endian(bytes, at, 1) == 0xFF; at += 2 + big_endian(bytes, at + 2, 2)) {
    const std::uint64_t marker = big_endian(bytes, at, 2);
    has_scan = marker == kScan;
    has_tables |= marker == kTables;
    if (marker >= kFirstFrame && marker <= kLastLossy) return {0, true};
    if (marker == kFrame)
      front.samples = big_endian(bytes, at + 5, 2) * big_endian(bytes, at + 7, 2) * big_endian(bytes, at + 9, 1);
  }
  if (!has_scan || !has_tables) front.samples = 0;
  return front;
}

// Where tile `number` begins, as offsets that stand there tell.
std::uint64_t tile_at(std::string_view bytes, std::uint64_t offsets, std::uint64_t number, bool big_end_first) {
  const std::uint64_t at = big_endian(bytes, offsets + 4 * number, 4);
  return big_end_first ? at : __builtin_bswap32(static_cast<std::uint32_t>(at));
}

// Where a JPEG does not begin, LibRaw leaves its part of the picture black and says nothing; where rows have another
// length than the picture's, it goes on in the next.
bool is_of_size(std::uint64_t samples, std::uint64_t width, std::uint64_t height) {
  return width > 0 && samples >= width * height && samples % width == 0;
}

bool lacks_a_jpeg(LibRaw& raw, const std::filesystem::path& file) {
  constexpr unsigned kJpeg = 7, kBigEnd = 0x4D4D;
  const auto& unpacker = raw.get_internal_data_pointer()->unpacker_data;
  const auto& sizes = raw.imgdata.sizes;
  if (unpacker.tiff_compress != kJpeg || sizes.raw_width == 0 || sizes.raw_height == 0) return false;
  const MappedFile mapped(file);
  const std::string_view bytes = as_text(mapped.bytes());
  const auto begin = static_cast<std::uint64_t>(unpacker.data_offset);
  if (unpacker.tile_length >= std::numeric_limits<int>::max()) {
    return !is_of_size(jpeg_front(bytes, begin).samples, sizes.raw_width, sizes.raw_height);
  }
  if (unpacker.tile_width == 0 || unpacker.tile_length == 0) return true;
  const std::uint64_t across = (sizes.raw_width - 1) / unpacker.tile_width + 1;
  const std::uint64_t tiles = across * ((sizes.raw_height - 1) / unpacker.tile_length + 1);
  for (std::uint64_t tile = 0; tile < tiles; ++tile) {
    const bool big_end_first = static_cast<unsigned short>(unpacker.order) == kBigEnd;
    const std::uint64_t at = tile_at(bytes, begin, tile, big_end_first);
    if (!is_of_size(jpeg_front(bytes, at).samples, unpacker.tile_width, unpacker.tile_length)) return true;
  }
  return false;
}

// Whether its first picture is a JPEG of the kind that loses something, which DNG has two numbers for.
bool is_lossy(LibRaw& raw, const std::filesystem::path& file) {
  constexpr unsigned kJpeg = 7, kLossyJpeg = 34'892, kBigEnd = 0x4D4D;
  const auto& unpacker = raw.get_internal_data_pointer()->unpacker_data;
  if (unpacker.tiff_compress == kLossyJpeg) return true;
  if (unpacker.tiff_compress != kJpeg) return false;
  const MappedFile mapped(file);
  auto at = static_cast<std::uint64_t>(unpacker.data_offset);
  if (unpacker.tile_length < std::numeric_limits<int>::max()) {
    at = tile_at(as_text(mapped.bytes()), at, 0, static_cast<unsigned short>(unpacker.order) == kBigEnd);
  }
  return jpeg_front(as_text(mapped.bytes()), at).is_lossy;
}

// A number of four bytes; 0 where the file ends before.
std::int32_t read_word(LibRaw_abstract_datastream& stream, unsigned order) {
  constexpr unsigned kLittleEndian = 0x4949;
  std::array<unsigned char, 4> bytes{};
  if (stream.read(bytes.data(), 1, bytes.size()) != static_cast<int>(bytes.size())) return 0;
  if (order == kLittleEndian) std::ranges::reverse(bytes);
  std::uint32_t word = 0;
  for (const unsigned char byte : bytes) word = word << 8 | byte;
  return static_cast<std::int32_t>(word);
}

// LibRaw hands every tag on, the stream at its value. The upper bits of `tag` tell directories from makers' own notes.
void take_tag(void* tags, int tag, int type, int count, unsigned order, void* stream_data, INT64) {
  constexpr int kMaxText = 64;
  constexpr int kNumber = 0xFFFF, kNotes = 0xF0000;
  if ((tag & kNotes) != 0) return;
  auto& found = *static_cast<RawTags*>(tags);
  auto& stream = *static_cast<LibRaw_abstract_datastream*>(stream_data);
  tag &= kNumber;
  const bool is_fraction = count == 1 && (type == kRational || type == kSignedRational);
  if ((tag == kExposureTime || tag == kFrameRate) && is_fraction) {
    const std::int64_t numerator = read_word(stream, order), denominator = read_word(stream, order);
    if (numerator <= 0 || denominator <= 0) return;
    if (tag == kFrameRate) found.rate = Rational::of(numerator, denominator);
    if (tag == kExposureTime) {
      found.exposure_ns =
          std::max<std::int64_t>(round_half_up(int128{numerator} * kSecondNs, denominator), 1);
    }
  }
  std::string* const said = tag == kDateTimeOriginal     ? &found.date
                            : tag == kSubSecTimeOriginal ? &found.fraction
                            : tag == kOffsetTimeOriginal ? &found.zone
                                                         : nullptr;
  if (said != nullptr && count > 0 && count <= kMaxText) {
    std::string text(static_cast<std::size_t>(count), '\0');
    if (stream.read(text.data(), 1, text.size()) != count) return;
    text.resize(text.find('\0') == std::string::npos ? text.size() : text.find('\0'));
    *said = text;
  }
}

}  // namespace

RawTags read_raw_tags(const std::filesystem::path& file) {
  const auto raw = std::make_unique<LibRaw>();  // too large for a thread's stack
  RawTags tags;
  raw->set_exifparser_handler(&take_tag, &tags);
  open_dng(*raw, file);
  return tags;
}

// What LibRaw develops by.
struct RawDeveloper::Levels {
  explicit Levels(const libraw_colordata_t& color) : black(color.black), maximum(color.maximum) {
    std::ranges::copy(color.cblack, pattern);
    std::ranges::copy(color.cam_mul, balance);
    std::ranges::copy(color.pre_mul, daylight);
    std::memcpy(matrix, color.rgb_cam, sizeof matrix);
  }
  void put(libraw_colordata_t& color) const {
    color.black = black;
    color.maximum = maximum;
    std::ranges::copy(pattern, color.cblack);
    std::ranges::copy(balance, color.cam_mul);
    std::ranges::copy(daylight, color.pre_mul);
    std::memcpy(color.rgb_cam, matrix, sizeof matrix);
  }

  decltype(libraw_colordata_t::black) black;
  decltype(libraw_colordata_t::maximum) maximum;
  decltype(libraw_colordata_t::cblack) pattern;
  decltype(libraw_colordata_t::cam_mul) balance;
  decltype(libraw_colordata_t::pre_mul) daylight;
  decltype(libraw_colordata_t::rgb_cam) matrix;
};

RawDeveloper::RawDeveloper() = default;
RawDeveloper::~RawDeveloper() = default;

Picture RawDeveloper::develop(const std::filesystem::path& file) {
  const auto raw = std::make_unique<LibRaw>();  // too large for a thread's stack
  libraw_output_params_t& wishes = raw->imgdata.params;
  wishes.output_bps = 16;
  wishes.output_color = 1;  // BT.709's primaries
  wishes.gamm[0] = wishes.gamm[1] = 1.0;
  wishes.no_auto_bright = 1;
  wishes.use_camera_wb = 1;
  wishes.adjust_maximum_thr = 0.0F;  // else white follows the brightest pixel
  // LibRaw itself goes on with what it has, and prints a line.
  struct Damage {
    LibRaw& raw;
    bool is_found = false;
  } damage{*raw};
  raw->set_dataerror_handler(
      [](void* data, const char*, auto) {
        static_cast<Damage*>(data)->is_found = true;
        static_cast<Damage*>(data)->raw.setCancelFlag();
      },
      &damage);
  open_dng(*raw, file);
  const int unpacked = raw->unpack();
  if (raw->is_floating_point() != 0) {
    throw InputError(
        format("{} holds floating-point values, and DNGs of whole numbers are read; save it as a DNG of 16 bits, "
               "or develop it to a TIFF",
               file.string()));
  }
  const bool is_failed = damage.is_found || unpacked != LIBRAW_SUCCESS || lacks_a_jpeg(*raw, file);
  if (is_failed && is_lossy(*raw, file)) {
    throw InputError(
        format("{} is a DNG that was packed with loss (JPEG of 8 or 12 bits), which is not read; convert it without "
               "loss, with Adobe's DNG Converter for one, or develop it to a TIFF",
               file.string()));
  }
  if (damage.is_found || lacks_a_jpeg(*raw, file))
    throw InputError(format("{} cannot be read: it is damaged or was cut off", file.string()));
  check(unpacked, file);
  if (first_) {
    first_->put(raw->imgdata.color);
    first_->put(raw->imgdata.rawdata.color);  // what developing starts from
  } else {
    first_ = std::make_unique<Levels>(raw->imgdata.color);
  }
  check(raw->dcraw_process(), file);
  int code = LIBRAW_SUCCESS;
  const std::unique_ptr<libraw_processed_image_t, decltype(&LibRaw::dcraw_clear_mem)> image(
      raw->dcraw_make_mem_image(&code), &LibRaw::dcraw_clear_mem);
  check(code, file);
  const bool is_read = image && image->type == LIBRAW_IMAGE_BITMAP && image->bits == 16 &&
                       (image->colors == 1 || image->colors == 3);
  if (!is_read)
    throw InputError(
        format("{} has {} colours; grey and colour are read", file.string(), image ? image->colors : 0));
  Picture picture({image->width, image->height, image->colors}, ValueType::code16, 65'535);
  std::memcpy(picture.bytes.data(), image->data,
              std::min<std::size_t>(picture.bytes.size(), image->data_size));
  return picture;
}

}  // namespace nutik::stills
