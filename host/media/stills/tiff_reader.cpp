#include "media/stills/tiff_reader.hpp"

#include <tiffio.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <new>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/clip.hpp"
#include "system/input_bytes.hpp"
#include "system/interruption.hpp"

namespace nutik {
namespace {

constexpr std::uint64_t kLargestPageSide = 1u << 20;
constexpr std::uint64_t kLargestPage = std::uint64_t{16} << 30;  // bytes

// What a page may take that lies in a file of so many bytes. LZW, which packs most of what photographs are kept in,
// makes 2558 bytes of one at most; blank fax pages, of which more can be made, are small.
std::uint64_t max_page_bytes(std::uint64_t file_bytes) {
  constexpr std::uint64_t kMaxExpansion = 2560, kSmallPage = 64 << 20;
  return std::min(kLargestPage, std::max(kSmallPage, file_bytes * kMaxExpansion));
}

// One page of an open file.
class PageReader {
 public:
  PageReader(TIFF* file, std::string name)
      : file_(file), name_(std::move(name)), file_bytes_(TIFFGetSizeProc(file)(TIFFClientdata(file))) {}

  // Whether its values are codes as they stand, which others of its kind may follow without a directory.
  bool holds_codes_as_they_stand() {
    read_layout();
    return is_plain();
  }

  // Where a page has no directory of its own, its bytes lie so many behind the first one's.
  FilePicture read(std::uint64_t bytes_behind = 0) {
    bytes_behind_ = bytes_behind;
    read_layout();
    FilePicture page;
    if (is_plain()) {
      page.maximum = stated_maximum();
      page.picture = Picture(shape_, value_type(), is_light_ ? 0 : (1u << std::max<std::uint32_t>(bits_, 8)) - 1);
      for (std::uint16_t plane = 0; plane < (separate_ ? shape_.channels : 1); ++plane) {
        TIFFIsTiled(file_) ? read_tiles(page.picture, plane) : read_rows(page.picture, plane);
      }
    } else {
      page.picture = read_shown();
      page.has_palette = photometric_ == PHOTOMETRIC_PALETTE;
    }
    page.density = resolution();
    page.profile = profile();
    page.orientation = orientation();
    page.left_out = left_out_;
    return page;
  }

 private:
  [[noreturn]] void fail(const std::string& why, std::vector<Setting> settings = {}) const {
    throw InputError(format("{} cannot be read: {}", name_, why), std::move(settings));
  }

  template <typename T>
  [[nodiscard]] T field(std::uint32_t tag, T missing) const {
    T value = missing;
    return TIFFGetFieldDefaulted(file_, tag, &value) == 1 ? value : missing;
  }

  void read_layout() {
    shape_.width = field<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0);
    shape_.height = field<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
    samples_ = shape_.channels = field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
    bits_ = field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
    photometric_ = field<std::uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    separate_ = field<std::uint16_t>(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == PLANARCONFIG_SEPARATE;
    if (shape_.width == 0 || shape_.height == 0 || shape_.width > kLargestPageSide ||
        shape_.height > kLargestPageSide) {
      fail(format("it states {} x {} pixels", shape_.width, shape_.height));
    }
    // Before anything is allocated.
    const std::uint64_t stored_bytes = (shape_.value_count() * bits_ + 7) / 8;
    const auto packing = field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    const bool is_packed = packing != COMPRESSION_NONE;
    if (stored_bytes > (is_packed ? max_page_bytes(file_bytes_) : file_bytes_)) {
      fail(format("it states {} x {} pixels, which its {} bytes do not hold; it is damaged or was cut off",
                  shape_.width, shape_.height, file_bytes_));
    }
    if (TIFFIsCODECConfigured(packing) == 0) {
      const TIFFCodec* const named = TIFFFindCODEC(packing);
      fail(format("its compression, {}, is none that is read here; save it without one, or with LZW (in Fiji: File, "
                  "Save As, Tiff)",
                  named != nullptr ? named->name : format("number {}", packing)));
    }
    const bool is_lab = photometric_ == PHOTOMETRIC_CIELAB || photometric_ == PHOTOMETRIC_ICCLAB ||
                        photometric_ == PHOTOMETRIC_ITULAB;
    if (is_lab || photometric_ == PHOTOMETRIC_SEPARATED) {
      fail(format("its colours are {}; grey and RGB are read: magick IN.tif -colorspace sRGB OUT.tif makes these, and "
                  "then state that their transfer function is srgb",
                  is_lab ? "L*a*b*" : "CMYK"),
           {Setting::transfer});
    }
    leave_channels_out();
    if (is_grey() && shape_.channels > 1) {
      fail(format("its {} samples a pixel are channels of grey, not colour (photometric interpretation MinIsBlack); "
                  "save one of them, or three as RGB",
                  shape_.channels));
    }
    if (shape_.channels != 1 && shape_.channels != 3)
      fail(format("it has {} channels; grey (1) and colour (3) are read: save it as RGB", shape_.channels));
    auto sample_format = field<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    if (sample_format == SAMPLEFORMAT_VOID) sample_format = SAMPLEFORMAT_UINT;  // undefined, as if there were no tag
    is_light_ = sample_format == SAMPLEFORMAT_IEEEFP && (bits_ == 32 || bits_ == 64);
    if (!is_light_ && (bits_ > 16 || sample_format != SAMPLEFORMAT_UINT)) {
      fail(format("it has {}-bit {} values; whole numbers without sign of up to 16 bits are read, and floating point "
                  "of 32 and 64: save it as that of 32 (in Fiji: Image, Type, 32-bit)",
                  bits_,
                  sample_format == SAMPLEFORMAT_INT          ? "signed"
                  : sample_format == SAMPLEFORMAT_IEEEFP     ? "floating-point"
                  : sample_format >= SAMPLEFORMAT_COMPLEXINT ? "complex"
                                                             : "unsigned"));
    }
    if (is_light_ && (photometric_ == PHOTOMETRIC_MINISWHITE || !is_plain())) {
      fail(format("its floating-point values are no light (photometric interpretation {})", photometric_));
    }
  }

  // All beside RGB, transparency beside grey: what else there is beside grey is grey, too.
  void leave_channels_out() {
    std::uint16_t count = 0;
    const std::uint16_t* kinds = nullptr;
    const bool is_clear = TIFFGetFieldDefaulted(file_, TIFFTAG_EXTRASAMPLES, &count, &kinds) == 1 && count == 1 &&
                          kinds[0] != EXTRASAMPLE_UNSPECIFIED;
    const bool is_rgb = photometric_ == PHOTOMETRIC_RGB;
    const std::uint32_t colours = is_rgb ? 3 : 1;
    left_out_.clear();
    if (samples_ <= colours || !(is_rgb || (is_grey() && is_clear))) return;
    shape_.channels = colours;
    left_out_ = is_clear                  ? kTransparency
                : samples_ == colours + 1 ? "channel 4"
                                          : format("channels 4 to {}", samples_);
  }

  // Whether the values are codes as they stand, rather than indices of a palette, YCbCr or single
  // bits.
  [[nodiscard]] bool is_plain() const {
    if (is_grey()) return shape_.channels == 1 && (bits_ >= 8 || bits_ == 1 || bits_ == 2 || bits_ == 4);
    return bits_ >= 8 && photometric_ == PHOTOMETRIC_RGB && shape_.channels == 3;
  }
  [[nodiscard]] bool is_grey() const {
    return photometric_ == PHOTOMETRIC_MINISBLACK || photometric_ == PHOTOMETRIC_MINISWHITE;
  }

  [[nodiscard]] std::uint16_t orientation() const {
    const auto stated = field<std::uint16_t>(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    return stated >= ORIENTATION_TOPLEFT && stated <= ORIENTATION_LEFTBOT ? stated : ORIENTATION_TOPLEFT;
  }

  [[nodiscard]] std::optional<std::pair<double, double>> resolution() const {
    float across = 0, down = 0;
    if (TIFFGetField(file_, TIFFTAG_XRESOLUTION, &across) != 1 ||
        TIFFGetField(file_, TIFFTAG_YRESOLUTION, &down) != 1 || !(across > 0 && down > 0)) {
      return std::nullopt;
    }
    return std::pair(double{across}, double{down});
  }

  [[nodiscard]] std::vector<std::byte> profile() const {
    std::uint32_t size = 0;
    const std::byte* bytes = nullptr;
    if (TIFFGetField(file_, TIFFTAG_ICCPROFILE, &size, &bytes) != 1 || bytes == nullptr) return {};
    return {bytes, bytes + size};
  }

  [[nodiscard]] std::optional<std::uint32_t> stated_maximum() const {
    if (is_light_) return std::nullopt;
    const std::uint32_t full = (1u << bits_) - 1;
    if (bits_ != 16) return bits_ <= 8 ? std::nullopt : std::optional(full);
    std::uint16_t stated = 0;
    if (TIFFGetField(file_, TIFFTAG_MAXSAMPLEVALUE, &stated) != 1) return std::nullopt;
    if (stated <= 255 || (stated & (stated + 1u)) != 0) return std::nullopt;
    return stated;
  }

  [[nodiscard]] ValueType value_type() const {
    if (is_light_) return bits_ == 64 ? ValueType::light64 : ValueType::light32;
    return bits_ > 8 ? ValueType::code16 : ValueType::code8;
  }

  // Value i of a row as libtiff hands it out: 8 bits, 16 in the machine's order, or packed, high
  // bits first.
  [[nodiscard]] std::uint32_t value(const std::vector<std::uint8_t>& row, std::size_t offset,
                                    std::size_t i) const {
    const std::uint8_t* bytes = row.data() + offset;
    if (bits_ == 8) return bytes[i];
    if (bits_ == 16) return reinterpret_cast<const std::uint16_t*>(bytes)[i];
    const std::size_t first = i * bits_, last = first + bits_ - 1;
    std::uint32_t window = 0;
    for (std::size_t at = first / 8; at <= last / 8; ++at) window = window << 8 | bytes[at];
    return window >> (7 - last % 8) & ((1u << bits_) - 1);
  }

  // Puts `count` pixels of a row where they belong.
  void place(Picture& picture, const std::vector<std::uint8_t>& row, std::size_t offset, std::uint32_t x,
             std::uint32_t y, std::uint32_t count, std::uint16_t plane) const {
    const std::uint32_t together = separate_ ? 1 : shape_.channels, stored_together = separate_ ? 1 : samples_;
    const std::size_t to = (std::size_t{y} * shape_.width + x) * shape_.channels + plane;
    if (is_light_) {
      const std::size_t value = value_bytes(picture.type), run = value * together;
      for (std::size_t i = 0; i < count; ++i)
        std::memcpy(picture.bytes.data() + (to + i * shape_.channels) * value,
                    row.data() + offset + i * stored_together * value, run);
      return;
    }
    const std::uint32_t full = (1u << bits_) - 1;
    const bool inverted = photometric_ == PHOTOMETRIC_MINISWHITE;
    const std::uint32_t black = stated_maximum().value_or(full);  // if it is inverted
    for (std::size_t i = 0; i < std::size_t{count} * together; ++i) {
      const std::uint32_t stored = value(row, offset, i / together * stored_together + i % together);
      if (inverted && stored > black) fail(format("its value {} is above its MaxSampleValue, {}", stored, black));
      // Fewer than 8 bits are spread over 8, as all programs show them.
      const std::uint32_t code = (inverted ? black - stored : stored) * (bits_ < 8 ? 255 / full : 1);
      const std::size_t at = to + i / together * shape_.channels + i % together;
      if (picture.type == ValueType::code8) {
        picture.bytes[at] = static_cast<std::byte>(code);
      } else {
        picture.values<std::uint16_t>()[at] = static_cast<std::uint16_t>(code);
      }
    }
  }

  void read_rows(Picture& picture, std::uint16_t plane) const {
    const std::uint64_t row_bytes = TIFFScanlineSize64(file_);
    const std::uint64_t together = separate_ ? 1 : samples_;
    if (row_bytes < (shape_.width * together * bits_ + 7) / 8 || row_bytes > max_page_bytes(file_bytes_)) {
      fail(format("it states rows of {} bytes", row_bytes));
    }
    std::vector<std::uint8_t> row(row_bytes);
    for (std::uint32_t y = 0; y < shape_.height; ++y) {
      check_interruption();
      const bool is_there =
          bytes_behind_ > 0 ? read_behind(row, y) : TIFFReadScanline(file_, row.data(), y, plane) >= 0;
      if (!is_there) {
        fail(format("it is damaged or was cut off at row {} of {}", y, shape_.height));
      }
      place(picture, row, 0, 0, y, shape_.width, plane);
    }
  }

  // A row of what lies behind the first page.
  bool read_behind(std::vector<std::uint8_t>& row, std::uint32_t y) const {
    const std::uint64_t* offsets = nullptr;
    if (TIFFGetField(file_, TIFFTAG_STRIPOFFSETS, &offsets) != 1 || offsets == nullptr) return false;
    const auto stream = TIFFClientdata(file_);
    const std::uint64_t at = offsets[0] + bytes_behind_ + y * std::uint64_t{row.size()};
    if (TIFFGetSeekProc(file_)(stream, at, SEEK_SET) != at) return false;
    if (TIFFGetReadProc(file_)(stream, row.data(), static_cast<tmsize_t>(row.size())) !=
        static_cast<tmsize_t>(row.size()))
      return false;
    if (TIFFIsByteSwapped(file_)) {
      const auto values = static_cast<tmsize_t>(row.size() / (bits_ / 8u));
      if (bits_ == 16) TIFFSwabArrayOfShort(reinterpret_cast<std::uint16_t*>(row.data()), values);
      if (bits_ == 32) TIFFSwabArrayOfLong(reinterpret_cast<std::uint32_t*>(row.data()), values);
      if (bits_ == 64) TIFFSwabArrayOfLong8(reinterpret_cast<std::uint64_t*>(row.data()), values);
    }
    return true;
  }

  void read_tiles(Picture& picture, std::uint16_t plane) const {
    const auto width = field<std::uint32_t>(TIFFTAG_TILEWIDTH, 0);
    const auto height = field<std::uint32_t>(TIFFTAG_TILELENGTH, 0);
    const std::uint64_t row_bytes = TIFFTileRowSize64(file_), tile_bytes = TIFFTileSize64(file_);
    const std::uint64_t together = separate_ ? 1 : samples_;
    if (width == 0 || height == 0 || width > kLargestPageSide || height > kLargestPageSide ||
        row_bytes < (width * together * bits_ + 7) / 8 || tile_bytes < row_bytes * height ||
        tile_bytes > max_page_bytes(file_bytes_)) {
      fail(format("it states tiles of {} x {} pixels", width, height));
    }
    std::vector<std::uint8_t> tile(tile_bytes);
    for (std::uint32_t y = 0; y < shape_.height; y += height) {
      for (std::uint32_t x = 0; x < shape_.width; x += width) {
        check_interruption();
        if (TIFFReadTile(file_, tile.data(), x, y, 0, plane) < 0) {
          fail(format("it is damaged or was cut off at row {} of {}", y, shape_.height));
        }
        for (std::uint32_t row = 0; row < std::min(height, shape_.height - y); ++row) {
          place(picture, tile, row * row_bytes, x, y + row, std::min(width, shape_.width - x), plane);
        }
      }
    }
  }

  // Any other kind, as libtiff would show it: 8 bits.
  Picture read_shown() {
    char why[1024] = {};
    const bool is_shallow_colour = bits_ < 8 && shape_.channels == 3;  // which libtiff says that it shows
    if (bits_ > 8 || is_shallow_colour || TIFFRGBAImageOK(file_, why) == 0) {
      const bool is_rgb = photometric_ == PHOTOMETRIC_RGB;
      fail(format("it is of a kind that is not read ({}, {} bits)",
                  is_rgb ? "RGB" : format("photometric interpretation {}", photometric_), bits_));
    }
    std::vector<std::uint32_t> pixels(shape_.pixel_count());
    // As it is stored, as all other kinds are.
    if (TIFFReadRGBAImageOriented(file_, shape_.width, shape_.height, pixels.data(), orientation(), 1) == 0) {
      fail("it is damaged or was cut off");
    }
    shape_.channels = is_grey() ? 1 : 3;
    Picture picture(shape_, ValueType::code8, 255);
    std::size_t at = 0;
    for (const std::uint32_t pixel : pixels) {
      picture.bytes[at++] = static_cast<std::byte>(TIFFGetR(pixel));
      if (is_grey()) continue;
      picture.bytes[at++] = static_cast<std::byte>(TIFFGetG(pixel));
      picture.bytes[at++] = static_cast<std::byte>(TIFFGetB(pixel));
    }
    return picture;
  }

  TIFF* file_;
  std::string name_;
  std::uint64_t file_bytes_;
  Shape shape_;
  std::uint32_t samples_ = 0;  // of a pixel as it is stored
  std::string left_out_;       // of these (media/clip.hpp)
  std::uint16_t bits_ = 0;
  std::uint16_t photometric_ = 0;
  bool separate_ = false;
  bool is_light_ = false;  // floating point
  std::uint64_t bytes_behind_ = 0;
};

// The bytes of a page whose codes lie in one piece as they are; 0 for any other.
std::uint64_t bytes_in_one_piece(TIFF* file) {
  std::uint16_t bits = 0, compression = 0, plane = 0;
  TIFFGetFieldDefaulted(file, TIFFTAG_BITSPERSAMPLE, &bits);
  TIFFGetFieldDefaulted(file, TIFFTAG_COMPRESSION, &compression);
  TIFFGetFieldDefaulted(file, TIFFTAG_PLANARCONFIG, &plane);
  const bool has_bytes = bits == 8 || bits == 16 || bits == 32 || bits == 64;
  const bool is_plain = has_bytes && compression == COMPRESSION_NONE && plane == PLANARCONFIG_CONTIG;
  std::uint32_t height = 0;
  const std::uint64_t* offsets = nullptr;
  if (!is_plain || TIFFIsTiled(file) || TIFFGetField(file, TIFFTAG_IMAGELENGTH, &height) != 1 ||
      TIFFGetField(file, TIFFTAG_STRIPOFFSETS, &offsets) != 1 || offsets == nullptr) {
    return 0;
  }
  const std::uint64_t row_bytes = TIFFScanlineSize64(file), strip_bytes = TIFFStripSize64(file);
  for (std::uint32_t strip = 1; strip < TIFFNumberOfStrips(file); ++strip) {
    if (offsets[strip] != offsets[0] + strip * strip_bytes) return 0;
  }
  return row_bytes * height;
}

// How many pages like its only one lie in a file, of which only that has a directory; 0 where that is not sure.
std::uint64_t pages_in_one(TIFF* file) {
  const std::uint64_t page_bytes = bytes_in_one_piece(file), file_bytes = TIFFGetSizeProc(file)(TIFFClientdata(file));
  const std::uint64_t* offsets = nullptr;
  const bool has_offsets = TIFFGetField(file, TIFFTAG_STRIPOFFSETS, &offsets) == 1 && offsets != nullptr;
  return has_offsets && page_bytes > 0 && offsets[0] < file_bytes ? (file_bytes - offsets[0]) / page_bytes : 0;
}

}  // namespace

struct TiffReader::File {
  explicit File(const std::filesystem::path& path) {
    struct FreeOptions {
      void operator()(TIFFOpenOptions* options) const { TIFFOpenOptionsFree(options); }
    };
    const std::unique_ptr<TIFFOpenOptions, FreeOptions> options(TIFFOpenOptionsAlloc());
    if (!options) throw std::bad_alloc();
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), note_trouble, this);
    TIFFOpenOptionsSetWarningHandlerExtR(
        options.get(), [](auto...) { return 1; }, nullptr);
    std::error_code error;
    const std::uint64_t file_bytes = std::filesystem::file_size(path, error);
    if (!error) {
      TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), static_cast<tmsize_t>(max_page_bytes(file_bytes)));
    }
    handle.reset(
        TIFFOpenExt(path.c_str(), "rm", options.get()));  // m: not mapped, so that it may become shorter
  }

  // In several places libtiff only reports damage, and returns what it could make of it.
  static int note_trouble(TIFF*, void* user, const char*, const char* form, va_list values) {
    auto& trouble = static_cast<File*>(user)->trouble;
    char text[512];
    if (trouble.empty() && std::vsnprintf(text, sizeof text, form, values) > 0) trouble = text;
    return 1;  // libtiff is to say it nowhere else
  }

  struct Close {
    void operator()(TIFF* file) const { TIFFClose(file); }
  };
  std::string trouble;  // the first of it
  std::unique_ptr<TIFF, Close> handle;
};

TiffReader::TiffReader(const std::filesystem::path& path, bool ends_at_damage)
    : name_(input_title(path.string())), file_(std::make_unique<File>(path)) {
  if (!file_->handle) throw InputError(format("{} cannot be read: it is damaged or no TIFF", name_));
  page_count_ = TIFFNumberOfDirectories(file_->handle.get());
  const bool is_broken = !file_->trouble.empty();
  if (page_count_ == 0 || (is_broken && !ends_at_damage)) {
    const bool is_stack = page_count_ > 1;
    throw InputError(
        format("{} cannot be read: it is damaged or was cut off: its list of pages breaks at page {} ({}){}", name_,
               page_count_ + 1, file_->trouble, is_stack ? "; the pages before it can be taken" : ""),
        is_stack ? std::vector{Setting::end_at_damage} : std::vector<Setting>{});
  }
  leave_copies_out();
  follow_story(path, ends_at_damage);
  if (is_broken && !is_in_one_) story_.pictures = ++page_count_;
}
TiffReader::~TiffReader() = default;

// Smaller copies of another page, and masks of its transparency, are no moments.
void TiffReader::leave_copies_out() {
  TIFF* const handle = file_->handle.get();
  is_moment_.assign(page_count_, true);
  for (std::uint64_t page = 1; page < is_moment_.size() && TIFFReadDirectory(handle) != 0; ++page) {
    std::uint32_t kind = 0;
    TIFFGetFieldDefaulted(handle, TIFFTAG_SUBFILETYPE, &kind);
    is_moment_[page] = (kind & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) == 0;
    page_count_ -= !is_moment_[page];
  }
  if (is_moment_.size() > 1) TIFFSetDirectory(handle, 0);
  file_->trouble.clear();  // a damaged page is told where it is read
}

bool TiffReader::is_dng() const {
  std::uint8_t* version = nullptr;
  return TIFFGetField(file_->handle.get(), TIFFTAG_DNGVERSION, &version) == 1;
}

void TiffReader::follow_story(const std::filesystem::path& path, bool ends_at_damage) {
  TIFF* const handle = file_->handle.get();
  const char* description = nullptr;
  if (TIFFGetField(handle, TIFFTAG_IMAGEDESCRIPTION, &description) == 1 && description != nullptr) {
    Shape shape;
    std::uint16_t channels = 1;
    TIFFGetFieldDefaulted(handle, TIFFTAG_SAMPLESPERPIXEL, &channels);
    shape.channels = std::max<std::uint16_t>(channels, 1);
    story_ = read_tiff_story(description, shape, path.filename().string());
  }
  // Tags of other programs.
  constexpr std::uint32_t kMetaMorphPlanes = 33629, kMicroManager = 51123;
  std::uint32_t count = 0;
  const char* values = nullptr;
  if (TIFFGetField(handle, kMicroManager, &count, &values) == 1 && values != nullptr && !story_.white)
    story_.white = white_of_micro_manager(std::string(values, strnlen(values, count)));
  const bool is_metamorph =
      page_count_ == 1 && TIFFGetField(handle, kMetaMorphPlanes, &count, &values) == 1 && count > 1;
  if (is_metamorph) {
    story_ = {};
    story_.who = "MetaMorph";
    story_.pictures = count;
    story_.notes.emplace_back("MetaMorph's planes are taken for moments, whose times are not read");
  }
  if (!story_.unread.empty()) throw InputError(format("{} {}", name_, story_.unread));
  const std::uint64_t held = page_count_ == 1 && story_.pictures > 1 ? pages_in_one(handle) : 0;
  is_in_one_ = held > 1;  // else it is one page that kept the description of a stack
  if ((page_count_ > 1 || is_in_one_) && !story_.refused.empty())
    throw InputError(format("{} {}", name_, story_.refused));
  if (!is_in_one_ && !is_metamorph) return;
  if (!is_in_one_ || !PageReader(handle, format("page 1 of {}", name_)).holds_codes_as_they_stand()) {
    throw InputError(
        format("{} holds {} pictures behind one another, as its description by {} says, whose values are no codes as "
               "they stand, but {}; save it as grey or RGB (in Fiji: Image, Type, RGB Color)",
               name_, story_.pictures, story_.who, is_in_one_ ? "a palette's for one" : "compressed or scattered"));
  }
  page_count_ = story_.pictures;
  if (held >= story_.pictures) return;
  if (!ends_at_damage) {
    throw InputError(format("{} was cut off: its description by {} says that it holds {} pictures, and {} are there, "
                            "which can be taken",
                            name_, story_.who, story_.pictures, held),
                     {Setting::end_at_damage});
  }
  story_.pictures = page_count_ = held + 1;
}

bool TiffReader::find_next() {
  if (pages_read_ == 0 || is_in_one_) return true;
  TIFF* const handle = file_->handle.get();
  do {
    if (TIFFReadDirectory(handle) == 0) return false;
  } while (!is_moment_[TIFFCurrentDirectory(handle)]);
  return true;
}

void TiffReader::pass_to(std::uint64_t page) {
  for (; pages_read_ + 1 < page; ++pages_read_) find_next();
}

std::optional<FilePicture> TiffReader::next() {
  if (pages_read_ == page_count_) return std::nullopt;
  const std::string page_name = format("page {} of {}", pages_read_ + 1, name_);
  TIFF* const handle = file_->handle.get();
  const bool found = find_next();
  std::optional<FilePicture> page;
  if (found) page = PageReader(handle, page_name).read(is_in_one_ ? pages_read_ * bytes_in_one_piece(handle) : 0);
  if (!found || !file_->trouble.empty()) {
    throw InputError(format("{} cannot be read: it is damaged ({})", page_name, file_->trouble));
  }
  if (page && page->picture.type == ValueType::code16 && !page->maximum) page->maximum = story_.white;
  ++pages_read_;
  return page;
}

}  // namespace nutik
