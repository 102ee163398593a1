#include "media/stills/raw_file.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <libraw/libraw.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik::stills {
namespace {

constexpr int kExposureTime = 33434, kDateTimeOriginal = 36867, kSubSecTimeOriginal = 37521,
              kFrameRate = 51044;
constexpr int kRational = 5, kSignedRational = 10;

void check(int code, const std::filesystem::path& file) {
  if (code == LIBRAW_SUCCESS) return;
  throw InputError(format("{} cannot be read: LibRaw says: {}", file.string(), libraw_strerror(code)));
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
  if ((tag == kDateTimeOriginal || tag == kSubSecTimeOriginal) && count > 0 && count <= kMaxText) {
    std::string text(static_cast<std::size_t>(count), '\0');
    if (stream.read(text.data(), 1, text.size()) != count) return;
    text.resize(text.find('\0') == std::string::npos ? text.size() : text.find('\0'));
    (tag == kDateTimeOriginal ? found.date : found.fraction) = text;
  }
}

}  // namespace

RawTags read_raw_tags(const std::filesystem::path& file) {
  const auto raw = std::make_unique<LibRaw>();  // too large for a thread's stack
  RawTags tags;
  raw->set_exifparser_handler(&take_tag, &tags);
  check(raw->open_file(file.c_str()), file);
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
  bool is_damaged = false;
  raw->set_dataerror_handler([](void* data, const char*, auto) { *static_cast<bool*>(data) = true; },
                             &is_damaged);
  check(raw->open_file(file.c_str()), file);
  check(raw->unpack(), file);
  if (is_damaged) throw InputError(format("{} cannot be read: it is damaged or was cut off", file.string()));
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
