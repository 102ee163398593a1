#include "media/stills/picture_files.hpp"

#include <libdeflate.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"
#include "media/clip.hpp"
#include "media/formats/coding_points.hpp"
#include "media/formats/colour_profile.hpp"
#include "media/formats/input_kinds.hpp"
#include "media/stills/picture_text.hpp"
#include "system/interruption.hpp"
#include "system/output_file.hpp"

namespace nutik {
namespace {

// libpng reports errors through a callback that must not return. Throwing through its C frames is what
// it leaves to C++ programs; it holds no resources there that its own structures do not own.
[[noreturn]] void throw_input(png_structp png, png_const_charp message) {
  throw InputError(
      format("{} cannot be read: {}", *static_cast<std::string*>(png_get_error_ptr(png)), message));
}
[[noreturn]] void throw_output(png_structp, png_const_charp message) {
  throw OutputError(format("the PNG cannot be written: {}", message));
}
void ignore_warning(png_structp, png_const_charp) {}

// libpng passes over a text that is too long or damaged, with a warning that starts with the chunk's name.
void refuse_lost_text(png_structp png, png_const_charp message) {
  const std::string_view text = message;
  if (!text.starts_with("tEXt") && !text.starts_with("zTXt")) return;
  throw InputError(format("{}: a text in it cannot be read ({}); it may have {} MiB at most",
                          *static_cast<std::string*>(png_get_error_ptr(png)), message,
                          kMaxPictureTextBytes >> 20));
}

struct ByteReader {
  std::span<const std::byte> rest;
};

void read_bytes(png_structp png, png_bytep to, png_size_t bytes) {
  auto* reader = static_cast<ByteReader*>(png_get_io_ptr(png));
  if (bytes > reader->rest.size()) png_error(png, "it was cut off");
  std::memcpy(to, reader->rest.data(), bytes);
  reader->rest = reader->rest.subspan(bytes);
}

struct ReadStructure {
  png_structp png;
  png_infop info;
  explicit ReadStructure(std::string& name, png_error_ptr warn = ignore_warning)
      : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &name, throw_input, warn)),
        info(png_create_info_struct(png)) {}
  ~ReadStructure() { png_destroy_read_struct(&png, &info, nullptr); }
};

struct WriteStructure {
  png_structp png;
  png_infop info;
  WriteStructure()
      : png(png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, throw_output, ignore_warning)),
        info(png_create_info_struct(png)) {}
  ~WriteStructure() { png_destroy_write_struct(&png, &info); }
};

const char* colour_name(int colour_type) {
  switch (colour_type) {
    case PNG_COLOR_TYPE_GRAY: return "grey";
    case PNG_COLOR_TYPE_GRAY_ALPHA: return "grey with transparency";
    case PNG_COLOR_TYPE_PALETTE: return "palette";
    case PNG_COLOR_TYPE_RGB: return "RGB";
    default: return "RGB with transparency";
  }
}

// Fast rather than small: a picture is written and looked at many times while a function is adjusted.
constexpr int kDeflateLevel = 1, kZlibLevel = 2;
// Larger pictures are compressed row by row, which takes several times as long, and next to no memory.
constexpr std::uint64_t kMostAtOnce = 64 << 20;

// What cICP names it by, whose primaries go before those of other chunks.
std::optional<std::uint8_t> named_transfer(const Picture& picture) {
  const bool are_named = picture.shape.channels == 1 || coding_point(picture.primaries) != kUnnamedPrimaries;
  return picture.transfer && are_named ? coding_point(*picture.transfer) : std::nullopt;
}

// What codes stand for: in cICP, which this libpng has no function for, and in older chunks or a profile.
void set_meaning(png_structp png, png_infop info, const Picture& picture) {
  if (picture.pixel_aspect != Rational{1, 1}) {
    // Pixels for the same length, of no unit: the wider a pixel, the fewer.
    png_set_pHYs(png, info, static_cast<png_uint_32>(picture.pixel_aspect.denominator),
                 static_cast<png_uint_32>(picture.pixel_aspect.numerator), PNG_RESOLUTION_UNKNOWN);
  }
  if (!picture.transfer) return;
  const Transfer& transfer = *picture.transfer;
  if (transfer == Transfer::srgb() && picture.primaries == Primaries::bt709) {
    png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  } else if (transfer.is_linear() || transfer.kind() == Transfer::Kind::gamma) {
    png_set_gAMA(png, info, std::log(transfer.fraction_of(0.5)) / std::log(0.5));
    const auto& xy = chromaticities(picture.primaries);
    const auto is_seen = [](const auto& at) { return at[0] >= 0 && at[1] >= 0 && at[0] + at[1] <= 1; };
    // Libpng refuses others.
    if (std::ranges::all_of(xy, is_seen))
      png_set_cHRM(png, info, xy[3][0], xy[3][1], xy[0][0], xy[0][1], xy[1][0], xy[1][1], xy[2][0], xy[2][1]);
  }
  const bool has_older_chunks = png_get_valid(png, info, PNG_INFO_cHRM) != 0;
  if (named_transfer(picture) && has_older_chunks) return;
  const std::vector<std::byte> profile = colour_profile(picture);
  png_set_iCCP(png, info, "ICC", PNG_COMPRESSION_TYPE_BASE, reinterpret_cast<png_const_bytep>(profile.data()),
               static_cast<png_uint_32>(profile.size()));
}

void write_coding_points(png_structp png, const Picture& picture) {
  const auto transfer = named_transfer(picture);
  if (!transfer) return;
  constexpr png_byte kRgb = 0, kFullRange = 1;
  const std::array<png_byte, 4> points{coding_point(picture.primaries), *transfer, kRgb, kFullRange};
  constexpr png_byte kName[]{'c', 'I', 'C', 'P'};
  png_write_chunk(png, kName, points.data(), points.size());
}

constexpr std::uint64_t kMaxExpansion = 1032;  // of Deflate

void set_text(png_structp png, png_infop info, const std::string& text) {
  std::string keyword = kPictureTextKeyword, value = text;  // libpng takes what it might write to
  png_text entry{};
  entry.compression = PNG_TEXT_COMPRESSION_NONE;
  entry.key = keyword.data();
  entry.text = value.data();
  entry.text_length = value.size();
  png_set_text(png, info, &entry, 1);
}

// Throws where a pixel is not opaque: what it shows is not in the file.
void leave_out_alpha(std::span<const std::byte> with_alpha, Picture& picture, const std::string& name) {
  constexpr std::byte kOpaque{255};
  const Shape& shape = picture.shape;
  for (std::uint64_t i = 0; i < shape.pixel_count(); ++i) {
    const auto pixel = with_alpha.subspan(i * (shape.channels + 1), shape.channels + 1);
    if (pixel.back() != kOpaque) {
      throw InputError(
          format("{} is transparent, and its pixel {},{} has alpha {} of 255; save it without transparency",
                 name, i % shape.width, i / shape.width, std::to_integer<int>(pixel.back())));
    }
    std::ranges::copy(pixel.first(shape.channels),
                      picture.bytes.begin() + static_cast<std::ptrdiff_t>(i * shape.channels));
  }
}

// What the palette has for each number. Decoders show one that it has not as black.
Picture in_colours(const ReadStructure& read, const Picture& numbers, const std::string& name) {
  png_colorp palette = nullptr;
  int count = 0;
  png_get_PLTE(read.png, read.info, &palette, &count);
  const int largest = std::to_integer<int>(*std::ranges::max_element(numbers.bytes));
  if (largest >= count) {
    throw InputError(format("{} cannot be read: it is damaged: a pixel has colour {}, and its palette {}, from 0 on",
                            name, largest, count));
  }
  Picture picture({numbers.shape.width, numbers.shape.height, 3}, ValueType::code8, 255);
  png_byte* to = picture.values<png_byte>().data();
  for (const std::byte number : numbers.bytes) {
    const png_color& colour = palette[std::to_integer<int>(number)];
    for (const png_byte code : {colour.red, colour.green, colour.blue}) *to++ = code;
  }
  return picture;
}

// Each row behind the number of its filter: differences from the value of the pixel before. Numbers of 16 bits have the
// high byte first.
void filter_rows(const Picture& picture, std::size_t row, png_byte* to) {
  const std::size_t bytes = value_bytes(picture.type), pixel = bytes * picture.shape.channels;
  std::vector<png_byte> swapped(bytes == 2 ? row : 0);
  for (std::uint32_t y = 0; y < picture.shape.height; ++y, to += row) {
    const auto* from = reinterpret_cast<const png_byte*>(picture.bytes.data()) + y * row;
    for (std::size_t i = 0; i + 1 < swapped.size(); i += 2) swapped[i] = from[i + 1], swapped[i + 1] = from[i];
    if (bytes == 2) from = swapped.data();
    *to++ = PNG_FILTER_VALUE_SUB;
    std::copy_n(from, pixel, to);
    for (std::size_t i = pixel; i < row; ++i) to[i] = static_cast<png_byte>(from[i] - from[i - pixel]);
  }
}

// Writes the picture's rows and the file's end. libpng compresses with zlib, which takes more than twice as long for a
// larger file.
void write_at_once(png_structp png, const Picture& picture, std::size_t row) {
  const std::size_t size = (row + 1) * picture.shape.height;
  const auto filtered = std::make_unique_for_overwrite<png_byte[]>(size);
  filter_rows(picture, row, filtered.get());
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(kDeflateLevel), libdeflate_free_compressor);
  if (!compressor) throw std::bad_alloc();
  const std::size_t room = libdeflate_zlib_compress_bound(compressor.get(), size);
  const auto packed = std::make_unique_for_overwrite<png_byte[]>(room);
  const std::size_t packed_size = libdeflate_zlib_compress(compressor.get(), filtered.get(), size, packed.get(), room);
  constexpr png_byte kRows[]{'I', 'D', 'A', 'T'}, kEnd[]{'I', 'E', 'N', 'D'};
  png_write_chunk(png, kRows, packed.get(), packed_size);
  png_write_chunk(png, kEnd, nullptr, 0);
}

void read_info(const ReadStructure& read, ByteReader& reader) {
  png_set_read_fn(read.png, &reader, read_bytes);
  // libpng's own limit is less than function files, and more than a small file can hold.
  png_set_chunk_malloc_max(read.png,
                           std::min<std::uint64_t>(kMaxPictureTextBytes, reader.rest.size() * kMaxExpansion));
  // It takes the memory that eXIf claims, whatever the limit; png_orientation() reads it.
  png_set_keep_unknown_chunks(read.png, PNG_HANDLE_CHUNK_NEVER, reinterpret_cast<png_const_bytep>("eXIf"), 1);
  png_read_info(read.png, read.info);
}

}  // namespace

FilePicture read_png(std::span<const std::byte> file, const std::string& name, PngUse use,
                     const std::function<void(std::uint32_t, std::uint32_t)>& check_size) {
  constexpr std::uint64_t kMostPixels = 1 << 30;
  std::string error_name = name;
  ReadStructure read(error_name);
  ByteReader reader{file};
  read_info(read, reader);
  const int colour = png_get_color_type(read.png, read.info), bits = png_get_bit_depth(read.png, read.info);
  const bool is_indexed = colour == PNG_COLOR_TYPE_PALETTE, is_colour = (colour & PNG_COLOR_MASK_COLOR) != 0;
  if (use == PngUse::mask && (is_indexed || bits != 8)) {
    throw InputError(
        format("{} is a PNG of {} bits, {}; it must be 8 bits, grey", name, bits, colour_name(colour)));
  }
  const bool is_clear =
      (colour & PNG_COLOR_MASK_ALPHA) != 0 || png_get_valid(read.png, read.info, PNG_INFO_tRNS) != 0;
  const Shape shape{png_get_image_width(read.png, read.info), png_get_image_height(read.png, read.info),
                    is_colour && !is_indexed ? 3u : 1u};
  if (check_size) check_size(shape.width, shape.height);
  check_stated_size(name, shape.width, shape.height, file.size());
  if (shape.pixel_count() > kMostPixels)
    throw InputError(format("{} cannot be read: it has {} x {} pixels, more than {}", name, shape.width,
                            shape.height, kMostPixels));
  const bool has_alpha = is_clear && use == PngUse::mask;
  // A tRNS names one code that is transparent.
  has_alpha ? png_set_tRNS_to_alpha(read.png) : png_set_strip_alpha(read.png);
  is_indexed ? png_set_packing(read.png) : png_set_expand_gray_1_2_4_to_8(read.png);
  if (bits == 16) png_set_swap(read.png);  // PNG has the high byte first
  const int passes = png_set_interlace_handling(read.png);
  png_read_update_info(read.png, read.info);
  Picture picture(shape, bits == 16 ? ValueType::code16 : ValueType::code8, bits == 16 ? 65'535 : 255);
  const std::size_t row_bytes = png_get_rowbytes(read.png, read.info);
  std::vector<std::byte> with_alpha(has_alpha ? shape.height * row_bytes : 0);
  auto* const first = reinterpret_cast<png_bytep>((has_alpha ? with_alpha : picture.bytes).data());
  for (int pass = 0; pass < passes; ++pass) {
    for (std::uint32_t y = 0; y < shape.height; ++y) {
      check_interruption();
      png_read_row(read.png, first + y * row_bytes, nullptr);
    }
  }
  png_read_end(read.png, nullptr);
  if (has_alpha) leave_out_alpha(with_alpha, picture, name);
  if (is_indexed) picture = in_colours(read, picture, name);
  png_charp title = nullptr;
  png_bytep profile = nullptr;
  png_uint_32 size = 0;
  int compression = 0;
  png_get_iCCP(read.png, read.info, &title, &compression, &profile, &size);
  const auto* const bytes = reinterpret_cast<const std::byte*>(profile);
  return {.picture = std::move(picture),
          .profile = {bytes, bytes + size},
          .left_out = is_clear && !has_alpha ? kTransparency : ""};
}

// Chunks: u32 length, four letters, so many bytes, a checksum. EXIF is a TIFF: its first directory is looked at.
unsigned png_orientation(std::span<const std::byte> file) {
  const std::string_view bytes = as_text(file);
  constexpr std::size_t kSignature = 8, kFrame = 12, kData = 8, kEntry = 12;
  std::string_view exif;
  for (std::size_t at = kSignature; at + kFrame <= bytes.size();) {
    const std::uint64_t length = big_endian(bytes, at, 4);
    if (length > bytes.size() - at - kFrame) break;
    if (bytes.substr(at + 4, 4) == "eXIf") exif = bytes.substr(at + kData, length);
    at += kFrame + length;
  }
  const bool is_little = exif.starts_with("II*");
  const auto number = [&](std::size_t at, std::size_t count) {
    std::string digits(exif.substr(std::min(at, exif.size()), count));
    digits.resize(count);
    if (is_little) std::ranges::reverse(digits);
    return big_endian(digits, 0, count);
  };
  const std::uint64_t directory = number(4, 4), entries = number(directory, 2);
  for (std::uint64_t i = 0, at = directory + 2; i < entries && at < exif.size(); ++i, at += kEntry) {
    constexpr std::uint64_t kOrientation = 0x112, kShort = 3;
    if (number(at, 2) != kOrientation || number(at + 2, 2) != kShort) continue;
    const auto orientation = static_cast<unsigned>(number(at + 8, 2));
    return orientation >= 1 && orientation <= 8 ? orientation : 1;
  }
  return 1;
}

namespace {

// In Latin-1.
std::optional<std::string> read_text(std::span<const std::byte> file, const std::filesystem::path& path) {
  std::string error_name = path.string();
  ReadStructure read(error_name, refuse_lost_text);
  ByteReader reader{file};
  read_info(read, reader);
  png_textp texts = nullptr;
  const int count = png_get_text(read.png, read.info, &texts, nullptr);
  for (int i = 0; i < count; ++i) {
    if (std::strcmp(texts[i].key, kPictureTextKeyword) == 0) return std::string(texts[i].text, texts[i].text_length);
  }
  return std::nullopt;
}

// What codes mean in the chunks cICP, sRGB or gAMA and cHRM, and in iCCP what cICP has no number for; pixels that are
// not square in pHYs. `text` is kept as picture_text.hpp says; none where it is empty.
void write_png(OutputFile& file, const Picture& picture, const std::string& text, const FileWishes&) {
  const Shape& shape = picture.shape;
  const std::size_t bytes = value_bytes(picture.type);
  WriteStructure write;
  png_set_write_fn(
      write.png, &file,
      [](png_structp png, png_bytep from, png_size_t count) {
        static_cast<OutputFile*>(png_get_io_ptr(png))
            ->write({reinterpret_cast<const std::byte*>(from), count});
      },
      nullptr);
  png_set_IHDR(write.png, write.info, shape.width, shape.height, static_cast<int>(bytes * 8),
               shape.channels == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(write.png, kZlibLevel);
  png_set_filter(write.png, 0, PNG_FILTER_SUB);
  png_set_compression_buffer_size(write.png, 1 << 16);
  set_meaning(write.png, write.info, picture);
  if (!text.empty()) set_text(write.png, write.info, text);
  png_write_info_before_PLTE(write.png, write.info);  // where cICP has its place
  write_coding_points(write.png, picture);
  png_write_info(write.png, write.info);
  const std::size_t row_bytes = std::size_t{shape.width} * shape.channels * bytes;
  if (picture.bytes.size() <= kMostAtOnce) return write_at_once(write.png, picture, row_bytes);
  if (bytes == 2) png_set_swap(write.png);  // PNG has the high byte first
  for (std::uint32_t y = 0; y < shape.height; ++y) {
    png_write_row(write.png, reinterpret_cast<png_const_bytep>(picture.bytes.data() + y * row_bytes));
  }
  png_write_end(write.png, nullptr);
}

}  // namespace

constinit const inputs::InputKind inputs::kPng{
    .name = "PNG", .starts = {"\x89PNG\r\n\x1a\n"}, .extensions = " .png ",
    .said = {"none", "none", "as stored, white 255, or 65535 with a note", "EXIF", "left out",
             "one picture"},
    .text = read_text,
    .written = {{.extension = ".png", .code_bits = 16, .is_for_eyes = true, .write = write_png}}};

}  // namespace nutik
