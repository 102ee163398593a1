#include "media/stills/picture_files.hpp"

#include <cstdio>  // which jpeglib.h needs and does not include

#include <jpeglib.h>

#include <jerror.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <string_view>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/formats/colour_profile.hpp"
#include "media/formats/input_kinds.hpp"
#include "system/output_file.hpp"

namespace nutik {
namespace {

// A segment's length, which counts its own two bytes, has 16 bits.
constexpr std::size_t kMaxCommentBytes = 65'533;

std::string message_of(j_common_ptr jpeg) {
  std::array<char, JMSG_LENGTH_MAX> text{};
  jpeg->err->format_message(jpeg, text.data());
  return text.data();
}

// libjpeg reports errors through a callback that must not return. Its C frames hold nothing that the structure does
// not own, so that an exception may pass through them.
template <typename Failure>
jpeg_error_mgr* errors_as(jpeg_error_mgr& manager) {
  jpeg_std_error(&manager);
  manager.error_exit = [](j_common_ptr jpeg) {
    throw Failure(format("{}: {}", *static_cast<const std::string*>(jpeg->client_data), message_of(jpeg)));
  };
  manager.output_message = [](j_common_ptr) {};
  return &manager;
}

// Hands what libjpeg has coded to a file.
struct FileDestination : jpeg_destination_mgr {
  explicit FileDestination(OutputFile& output) : file(output) {
    init_destination = [](j_compress_ptr jpeg) { of(jpeg).restart(); };
    empty_output_buffer = [](j_compress_ptr jpeg) -> boolean {
      of(jpeg).flush(of(jpeg).buffer.size());  // all of it, whatever free_in_buffer says
      return TRUE;
    };
    term_destination = [](j_compress_ptr jpeg) {
      of(jpeg).flush(of(jpeg).buffer.size() - of(jpeg).free_in_buffer);
    };
  }
  static FileDestination& of(j_compress_ptr jpeg) { return *static_cast<FileDestination*>(jpeg->dest); }
  void restart() {
    next_output_byte = buffer.data();
    free_in_buffer = buffer.size();
  }
  void flush(std::size_t bytes) {
    file.write(std::as_bytes(std::span(buffer).first(bytes)));
    restart();
  }

  OutputFile& file;
  std::array<JOCTET, 1 << 16> buffer;
};

struct Compressor : jpeg_compress_struct {
  explicit Compressor(std::string& name) {
    err = errors_as<OutputError>(errors);
    client_data = &name;
    jpeg_create_compress(this);
  }
  ~Compressor() { jpeg_destroy_compress(this); }
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;
  jpeg_error_mgr errors{};
};

struct Decompressor : jpeg_decompress_struct {
  explicit Decompressor(std::string& name) {
    err = errors_as<InputError>(errors);
    client_data = &name;
    jpeg_create_decompress(this);
  }
  ~Decompressor() { jpeg_destroy_decompress(this); }
  Decompressor(const Decompressor&) = delete;
  Decompressor& operator=(const Decompressor&) = delete;
  jpeg_error_mgr errors{};
};

// Pixels for the same length, of no unit: the wider a pixel, the fewer. Each has 16 bits.
void set_density(jpeg_compress_struct& jpeg, const Rational& aspect) {
  constexpr std::int64_t kMax = 65'535;
  const std::int64_t part = 1 + (std::max(aspect.numerator, aspect.denominator) - 1) / kMax;
  const auto density = [&](std::int64_t of) {
    return static_cast<UINT16>(std::max<std::int64_t>(round_half_up(of, part), 1));
  };
  jpeg.density_unit = 0;
  jpeg.X_density = density(aspect.denominator);
  jpeg.Y_density = density(aspect.numerator);
}

}  // namespace

void check_stated_size(const std::string& name, std::uint64_t width, std::uint64_t height, std::uint64_t file_bytes) {
  constexpr std::uint64_t kMaxPixelsAByte = 1032 * 8, kSmallPixels = 16 << 20;
  if (width * height <= std::max(kSmallPixels, file_bytes * kMaxPixelsAByte)) return;
  throw InputError(format("{} cannot be read: it states {} x {} pixels, which its {} bytes do not hold; it is damaged",
                          name, width, height, file_bytes));
}

namespace {

// 8-bit codes in full colour resolution. What they stand for is in an ICC profile, their pixel aspect in the density of
// the JFIF header, `text` in comments.
void write_jpeg(OutputFile& file, const Picture& picture, const std::string& text, const FileWishes& wishes) {
  const Shape& shape = picture.shape;
  if (std::max(shape.width, shape.height) > JPEG_MAX_DIMENSION) {
    throw UsageError(
        format("a .jpg has at most {0} x {0} pixels, and the picture has {1} x {2}; write a .png or .tif",
               JPEG_MAX_DIMENSION, shape.width, shape.height));
  }
  std::string name = "the JPEG cannot be written";
  Compressor jpeg(name);
  FileDestination destination(file);
  jpeg.dest = &destination;
  jpeg.image_width = shape.width;
  jpeg.image_height = shape.height;
  jpeg.input_components = static_cast<int>(shape.channels);
  jpeg.in_color_space = shape.channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, wishes.quality, TRUE);
  jpeg.optimize_coding = TRUE;
  for (int component = 0; component < jpeg.num_components; ++component) {
    jpeg.comp_info[component].h_samp_factor = jpeg.comp_info[component].v_samp_factor = 1;
  }
  set_density(jpeg, picture.pixel_aspect);
  jpeg_start_compress(&jpeg, TRUE);
  const std::vector<std::byte> profile = colour_profile(picture);
  if (!profile.empty()) {
    jpeg_write_icc_profile(&jpeg, reinterpret_cast<const JOCTET*>(profile.data()),
                           static_cast<unsigned>(profile.size()));
  }
  for (std::size_t at = 0; at < text.size(); at += kMaxCommentBytes) {
    const std::string_view part = std::string_view(text).substr(at, kMaxCommentBytes);
    jpeg_write_marker(&jpeg, JPEG_COM, reinterpret_cast<const JOCTET*>(part.data()),
                      static_cast<unsigned>(part.size()));
  }
  const std::size_t row_bytes = std::size_t{shape.width} * shape.channels;
  for (std::uint32_t y = 0; y < shape.height; ++y) {
    // libjpeg only reads it.
    auto* row = const_cast<JSAMPLE*>(reinterpret_cast<const JSAMPLE*>(picture.bytes.data() + y * row_bytes));
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
}

// The comments before the picture, one behind the other.
std::optional<std::string> read_comments(std::span<const std::byte> file, const std::filesystem::path& path) {
  std::string title = format("{} cannot be read", path.string());
  Decompressor jpeg(title);
  jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(file.data()), file.size());
  jpeg_save_markers(&jpeg, JPEG_COM, 0xFFFF);
  jpeg_read_header(&jpeg, TRUE);
  std::optional<std::string> text;
  for (const jpeg_marker_struct* marker = jpeg.marker_list; marker != nullptr; marker = marker->next) {
    if (!text) text.emplace();
    text->append(reinterpret_cast<const char*>(marker->data), marker->data_length);
  }
  return text;
}

}  // namespace

FilePicture read_jpeg(std::span<const std::byte> file, const std::string& name) {
  std::string title = format("{} cannot be read: it is damaged or no picture", name);
  Decompressor jpeg(title);
  // libjpeg goes on behind damage, with whatever comes: in front of a picture, also behind bytes of no segment.
  jpeg.err->emit_message = [](j_common_ptr of, int) {
    constexpr std::array kDamage{JWRN_ARITH_BAD_CODE, JWRN_HIT_MARKER, JWRN_HUFF_BAD_CODE, JWRN_JPEG_EOF,
                                 JWRN_MUST_RESYNC};
    if (of->err->msg_code == JWRN_EXTRANEOUS_DATA) ++of->err->num_warnings;
    if (std::ranges::count(kDamage, of->err->msg_code) > 0) of->err->error_exit(of);
  };
  jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(file.data()), file.size());
  jpeg_save_markers(&jpeg, JPEG_APP0 + 2, 0xFFFF);
  jpeg_read_header(&jpeg, TRUE);
  if (jpeg.err->num_warnings > 0) throw InputError(title);
  check_stated_size(name, jpeg.image_width, jpeg.image_height, file.size());
  if (jpeg.num_components != 1 && jpeg.num_components != 3) {
    throw InputError(format("{} cannot be read: its colours are {}; grey and RGB are read", name,
                            jpeg.num_components == 4 ? "CMYK" : "of no known kind"));
  }
  FilePicture read;
  if (jpeg.saw_JFIF_marker) read.density = {jpeg.X_density, jpeg.Y_density};
  JOCTET* profile = nullptr;
  unsigned profile_bytes = 0;
  if (jpeg_read_icc_profile(&jpeg, &profile, &profile_bytes)) {
    const std::unique_ptr<JOCTET, decltype(&std::free)> owned(profile, &std::free);
    const auto bytes = std::as_bytes(std::span(profile, profile_bytes));
    read.profile.assign(bytes.begin(), bytes.end());
  }
  jpeg.out_color_space = jpeg.num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
  jpeg_start_decompress(&jpeg);
  Picture& picture = read.picture;
  picture = Picture({jpeg.output_width, jpeg.output_height, static_cast<std::uint32_t>(jpeg.num_components)},
                  ValueType::code8, 255);
  const std::size_t row_bytes = std::size_t{picture.shape.width} * picture.shape.channels;
  while (jpeg.output_scanline < jpeg.output_height) {
    auto* row = reinterpret_cast<JSAMPLE*>(picture.bytes.data() + jpeg.output_scanline * row_bytes);
    jpeg_read_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_decompress(&jpeg);
  return read;
}

constinit const inputs::InputKind inputs::kJpeg{
    .name = "JPEG", .starts = {"\xFF\xD8\xFF"}, .extensions = " .jpg .jpeg ",
    .said = {"EXIF, in a table", "EXIF, in a table", "as stored, white 255", "EXIF", "none", "one picture"},
    .text = read_comments,
    .written = {{.extension = ".jpg", .also = ".jpeg", .code_bits = 8, .is_lossy = true, .is_for_eyes = true,
                 .write = write_jpeg}}};

}  // namespace nutik
