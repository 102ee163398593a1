#include "media/videos/pixels.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "capture/turned.hpp"
#include "media/formats/coding_points.hpp"
#include "media/videos/eight_bit_yuv.hpp"
#include "media/videos/phantom_file.hpp"
#include "system/simd_clones.hpp"

namespace nutik::videos {
namespace {

// FFmpeg's format of these components with so many bits, else with 16.
AVPixelFormat with_bits(const std::string& components, std::uint32_t bits) {
  const AVPixelFormat found = av_get_pix_fmt((components + std::to_string(std::min(bits, 16u))).c_str());
  return found == AV_PIX_FMT_NONE ? av_get_pix_fmt((components + "16").c_str()) : found;
}

AVPixelFormat raster_format(const PixelKind& kind) {
  if (!kind.is_grey) return kind.bits <= 8 ? AV_PIX_FMT_RGB24 : AV_PIX_FMT_RGB48;
  return with_bits("gray", kind.bits + kind.padding_bits);
}

bool has_j_name(AVPixelFormat format) {
  const char* name = av_get_pix_fmt_name(format);
  return name != nullptr && std::string_view(name).starts_with("yuvj");
}

// How a row's Y, U and V become RGB over 16 bits, each code the nearest there is.
struct DeepRgb {
  double black, luma_scale, grey, chroma_scale;
  ChromaWeights weights;

  static DeepRgb of(std::uint32_t bits, const YuvCoding& coding) {
    const ChromaWeights weights = chroma_weights(coding.matrix);
    const bool full = coding.range == CodeRange::full;
    const double unit = std::ldexp(1.0, static_cast<int>(bits) - 8);
    const double most = std::ldexp(1.0, static_cast<int>(bits)) - 1;
    return {full ? 0.0 : 16.0 * unit, 65'535.0 / (full ? most : 219.0 * unit), 128.0 * unit,
            65'535.0 / (full ? most : weights.limited_span * unit), weights};
  }
};

constexpr int kPixelsAtOnce = 64;

// Compilers make vectors of the first loop, but of none that also writes codes beside each other.
NUTIK_SIMD_CLONES void row_to_rgb(const std::uint16_t* __restrict y, const std::uint16_t* __restrict u,
                                  const std::uint16_t* __restrict v, int width, const DeepRgb how,
                                  std::uint16_t* __restrict rgb) {
  std::int32_t red[kPixelsAtOnce], green[kPixelsAtOnce], blue[kPixelsAtOnce];
  const auto nearest = [](double value) {
    const double positive = value > 0 ? value : 0;
    return static_cast<std::int32_t>((positive < 65'535.0 ? positive : 65'535.0) + 0.5);
  };
  for (int begin = 0; begin < width; begin += kPixelsAtOnce) {
    const int count = width - begin < kPixelsAtOnce ? width - begin : kPixelsAtOnce;
    for (int x = 0; x < count; ++x) {
      const double luma = (y[begin + x] - how.black) * how.luma_scale;
      const double from_u = (u[begin + x] - how.grey) * how.chroma_scale;
      const double from_v = (v[begin + x] - how.grey) * how.chroma_scale;
      red[x] = nearest(luma + how.weights.red_of_u * from_u + how.weights.red_of_v * from_v);
      green[x] = nearest(luma + how.weights.green_of_u * from_u + how.weights.green_of_v * from_v);
      blue[x] = nearest(luma + how.weights.blue_of_u * from_u + how.weights.blue_of_v * from_v);
    }
    for (int x = 0; x < count; ++x) {
      *rgb++ = static_cast<std::uint16_t>(red[x]);
      *rgb++ = static_cast<std::uint16_t>(green[x]);
      *rgb++ = static_cast<std::uint16_t>(blue[x]);
    }
  }
}

// Planes of Y, U and V become RGB. libswscale would do it, too, but its white is 65280 for limited range and 65472 for
// full range of 10 bits: off by up to 4 codes of the source.
void yuv_to_rgb(const AVFrame& planes, std::uint32_t bits, const YuvCoding& coding, AVFrame& rgb) {
  const DeepRgb how = DeepRgb::of(bits, coding);
  for (int row = 0; row < planes.height; ++row) {
    const auto plane = [row](const AVFrame& frame, int index) {
      return reinterpret_cast<std::uint16_t*>(frame.data[index] +
                                              static_cast<std::ptrdiff_t>(row) * frame.linesize[index]);
    };
    row_to_rgb(plane(planes, 0), plane(planes, 1), plane(planes, 2), planes.width, how, plane(rgb, 0));
  }
}

// The counts of a few codes are codes themselves: so the compiler makes vectors of as many as there are of codes.
template <typename Code>
inline __attribute__((always_inline)) std::uint64_t above(const Code* codes, std::size_t count, Code most) {
  constexpr std::size_t kCodesAtOnce = 192;
  std::uint64_t all = 0;
  for (std::size_t begin = 0; begin < count; begin += kCodesAtOnce) {
    const std::size_t end = std::min(count, begin + kCodesAtOnce);
    Code some = 0;
    for (std::size_t i = begin; i < end; ++i) some = static_cast<Code>(some + (codes[i] > most ? 1 : 0));
    all += some;
  }
  return all;
}

NUTIK_SIMD_CLONES std::uint64_t codes_above(const std::uint8_t* codes, std::size_t count, std::uint8_t most) {
  return above(codes, count, most);
}
NUTIK_SIMD_CLONES std::uint64_t codes_above(const std::uint16_t* codes, std::size_t count, std::uint16_t most) {
  return above(codes, count, most);
}

// As a share of all that there are in `rows` rows of `width` codes.
template <typename Code>
double share_above(const std::uint8_t* first, std::ptrdiff_t stride, std::size_t width, int rows, std::uint16_t most) {
  std::uint64_t found = 0;
  for (int row = 0; row < rows; ++row)
    found += codes_above(reinterpret_cast<const Code*>(first + row * stride), width, static_cast<Code>(most));
  return static_cast<double>(found) / (static_cast<double>(width) * rows);
}

// Whether libswscale may write rows here: it does so in whole vectors.
bool is_aligned(std::span<const std::byte> raster, std::size_t row_bytes) {
  constexpr std::size_t kVectorBytes = 64;
  return reinterpret_cast<std::uintptr_t>(raster.data()) % kVectorBytes == 0 && row_bytes % kVectorBytes == 0;
}

std::optional<ChromaPlace> chroma_place(unsigned location) {
  // Ours have FFmpeg's order.
  static_assert(AVCHROMA_LOC_CENTER - AVCHROMA_LOC_LEFT == static_cast<int>(ChromaPlace::center));
  static_assert(AVCHROMA_LOC_BOTTOM - AVCHROMA_LOC_LEFT == static_cast<int>(ChromaPlace::bottom));
  if (location < AVCHROMA_LOC_LEFT || location > AVCHROMA_LOC_BOTTOM) return std::nullopt;
  return static_cast<ChromaPlace>(location - AVCHROMA_LOC_LEFT);
}

// The format that has the same components, each in a plane of its own.
AVPixelFormat planar_kin(AVPixelFormat format) {
  const AVPixFmtDescriptor& packed = *av_pix_fmt_desc_get(format);
  constexpr std::uint64_t kCompared = AV_PIX_FMT_FLAG_PLANAR | AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_BE;
  const std::uint64_t wanted = AV_PIX_FMT_FLAG_PLANAR | (packed.flags & AV_PIX_FMT_FLAG_RGB);
  const AVPixFmtDescriptor* each = nullptr;
  while ((each = av_pix_fmt_desc_next(each)) != nullptr) {
    if (each->nb_components == 3 && (each->flags & kCompared) == wanted && each->comp[0].shift == 0 &&
        each->comp[0].depth == packed.comp[0].depth && each->comp[1].step == (packed.comp[0].depth + 7) / 8 &&
        each->log2_chroma_w == packed.log2_chroma_w && each->log2_chroma_h == packed.log2_chroma_h) {
      return av_pix_fmt_desc_get_id(each);
    }
  }
  return AV_PIX_FMT_NONE;
}

// Whether libswscale does not read such pixels, or has a white of its own for them. FFmpeg does not tell where the luma
// of uyyvyy411 lies.
bool is_unpacked_here(AVPixelFormat format) {
  const bool is_read = format != AV_PIX_FMT_X2RGB10LE && format != AV_PIX_FMT_X2BGR10LE && sws_isSupportedInput(format);
  return !is_read && format != AV_PIX_FMT_UYYVYY411 && planar_kin(format) != AV_PIX_FMT_NONE;
}

// Null where such pixels cannot be converted.
SwsContext* new_scaler(const AVFrame& frame, AVPixelFormat wanted, ChromaPlace at) {
  ScalerPointer scaler(sws_alloc_context());
  if (!scaler) return nullptr;
  const auto from = static_cast<AVPixelFormat>(frame.format);
  const auto set = [&](const char* option, std::int64_t value) {
    av_opt_set_int(scaler.get(), option, value, 0);
  };
  for (const char* end : {"src", "dst"}) {
    set((end + std::string("w")).c_str(), frame.width);
    set((end + std::string("h")).c_str(), frame.height);
  }
  set("src_format", from);
  set("dst_format", wanted);
  set("sws_flags", SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT);
  // Where samples of chroma lie between those of luma, in 256ths of their distance.
  constexpr int kBetween = 128;
  const AVPixFmtDescriptor& pixels = *av_pix_fmt_desc_get(from);
  const bool is_centred = at == ChromaPlace::center || at == ChromaPlace::top || at == ChromaPlace::bottom;
  const bool is_top = at == ChromaPlace::topleft || at == ChromaPlace::top;
  const bool is_bottom = at == ChromaPlace::bottomleft || at == ChromaPlace::bottom;
  const bool is_interpolated = is_yuv(from) && av_pix_fmt_desc_get(wanted)->log2_chroma_w == 0;
  if (is_interpolated && pixels.log2_chroma_w == 1) set("src_h_chr_pos", is_centred ? kBetween : 0);
  if (is_interpolated && pixels.log2_chroma_h == 1) {
    set("src_v_chr_pos", is_top ? 0 : is_bottom ? 2 * kBetween : kBetween);
  }
  return sws_init_context(scaler.get(), nullptr, nullptr) < 0 ? nullptr : scaler.release();
}

}  // namespace

std::uint32_t PixelKind::white_code() const {
  if (is_grey && !is_limited) return (1u << bits) - 1;
  return bits <= 8 ? 255 : 65'535;
}

PixelKind pixel_kind(const AVCodecParameters& codec, const std::string& name) {
  const AVPixFmtDescriptor* pixels = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(codec.format));
  if (pixels == nullptr || codec.width <= 0 || codec.height <= 0) {
    if (codec.codec_id == AV_CODEC_ID_NONE && codec.codec_tag != 0) {
      char tag[AV_FOURCC_MAX_STRING_SIZE];
      throw InputError(
          format("{}: no decoder here knows its pictures, which the file calls '{}': save them from the camera's "
                 "program as 16-bit TIFFs, or uncompressed under a name that FFmpeg knows (Y800 for grey of 8 bits)",
                 name, av_fourcc_make_string(tag, codec.codec_tag)),
          {Setting::raw_layout});
    }
    throw InputError(
        format("{}: no decoder here knows its pictures; a video without a header has to be described", name),
        {Setting::raw_layout});
  }
  if ((pixels->flags & AV_PIX_FMT_FLAG_FLOAT) != 0) {
    // FFmpeg takes grey in floating point for that of the limited range where it is told nothing.
    throw InputError(format(
        "{} holds floating-point pixels ({}); whole numbers of up to 16 bits are read. ffmpeg -i PICTURE -vf "
        "scale=in_range=full -pix_fmt {} PICTURE.png makes these of its light from black to white",
        name, pixels->name, pixels->nb_components < 3 ? "gray16" : "rgb48"));
  }
  if (codec.format == AV_PIX_FMT_XYZ12LE || codec.format == AV_PIX_FMT_XYZ12BE) {
    throw InputError(
        format("{} holds X'Y'Z' of digital cinema, of which no RGB is made here: ffmpeg -i CLIP -pix_fmt gbrp16le "
               "-color_trc gamma22 -color_primaries bt709 -c:v ffv1 film.mkv makes it",
               name));
  }
  PixelKind kind;
  kind.is_grey =
      pixels->nb_components <= 2 && (pixels->flags & (AV_PIX_FMT_FLAG_PAL | AV_PIX_FMT_FLAG_BAYER)) == 0;
  for (int component = 0; component < pixels->nb_components; ++component) {
    kind.bits = std::max(kind.bits, static_cast<std::uint32_t>(pixels->comp[component].depth));
  }
  // A mosaic's depths are shares of a pixel.
  if (is_mosaic(static_cast<AVPixelFormat>(codec.format))) kind.bits = av_get_bits_per_pixel(pixels) > 8 ? 16 : 8;
  // FFmpeg's decoder of plain pictures moves codes of 9 to 15 bits up to fill 16 (Phantom cameras'
  // files).
  const int stored = is_phantom_packed(codec) ? static_cast<int>(kPhantomBits) : codec.bits_per_coded_sample;
  if (codec.codec_id == AV_CODEC_ID_RAWVIDEO && kind.is_grey && kind.bits == 16 && stored > 8 &&
      stored < 16) {
    kind.bits = static_cast<std::uint32_t>(stored);
    kind.padding_bits = 16 - kind.bits;
  }
  return kind;
}

bool is_mosaic(AVPixelFormat format) {
  return (av_pix_fmt_desc_get(format)->flags & AV_PIX_FMT_FLAG_BAYER) != 0;
}

bool is_seen_as_transparent(const AVCodecParameters& codec) {
  return codec.codec_id == AV_CODEC_ID_GIF || codec.format == AV_PIX_FMT_PAL8;
}

bool is_yuv(AVPixelFormat format) {
  const AVPixFmtDescriptor& pixels = *av_pix_fmt_desc_get(format);
  return pixels.nb_components >= 3 &&
         (pixels.flags & (AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_BAYER | AV_PIX_FMT_FLAG_PAL)) == 0;
}

ChromaWeights chroma_weights(YuvMatrix matrix) {
  // Red and blue weigh so much in luma.
  const auto of_luma = [](double red, double blue) {
    const double red_of_v = 2.0 * (1.0 - red), blue_of_u = 2.0 * (1.0 - blue), green = 1.0 - red - blue;
    return ChromaWeights{0.0, red_of_v, -blue / green * blue_of_u, -red / green * red_of_v, blue_of_u,
                         0.0, 224.0};
  };
  switch (matrix) {
    case YuvMatrix::bt601: return of_luma(0.299, 0.114);
    case YuvMatrix::bt709: return of_luma(0.2126, 0.0722);
    case YuvMatrix::bt2020: return of_luma(0.2627, 0.0593);
    case YuvMatrix::fcc: return of_luma(0.30, 0.11);
    case YuvMatrix::smpte240m: return of_luma(0.212, 0.087);
    case YuvMatrix::p3: return of_luma(0.22897456406974884, 0.079286914093745);
    // H.273 makes it of codes, which have 219 steps from black to white.
    case YuvMatrix::ycgco: return {-1.0, 1.0, 1.0, 0.0, -1.0, -1.0, 219.0};
  }
  return {};
}

YuvMatrix usual_matrix(std::uint32_t lines) {
  constexpr std::uint32_t kLinesOfHighDefinition = 720;
  return lines >= kLinesOfHighDefinition ? YuvMatrix::bt709 : YuvMatrix::bt601;
}

std::optional<YuvMatrix> named_matrix(unsigned space, unsigned primaries) {
  // What these primaries' light weighs in luma.
  if (space == AVCOL_SPC_CHROMA_DERIVED_NCL) {
    switch (primaries) {
      case AVCOL_PRI_BT709: return YuvMatrix::bt709;
      case AVCOL_PRI_BT2020: return YuvMatrix::bt2020;
      case AVCOL_PRI_SMPTE432: return YuvMatrix::p3;
      default: return std::nullopt;
    }
  }
  switch (space) {
    case AVCOL_SPC_BT470BG:
    case AVCOL_SPC_SMPTE170M: return YuvMatrix::bt601;
    case AVCOL_SPC_BT709: return YuvMatrix::bt709;
    case AVCOL_SPC_BT2020_NCL: return YuvMatrix::bt2020;
    case AVCOL_SPC_FCC: return YuvMatrix::fcc;
    case AVCOL_SPC_SMPTE240M: return YuvMatrix::smpte240m;
    case AVCOL_SPC_YCGCO: return YuvMatrix::ycgco;
    default: return std::nullopt;
  }
}

std::string filter_from_matrix(unsigned space, unsigned curve) {
  const std::optional<Transfer> transfer = transfer_of_coding_point(curve);
  switch (space) {
    case AVCOL_SPC_CHROMA_DERIVED_NCL: return "zscale=m=709,format=yuv444p16le";
    // Back from light, zimg takes another curve than to it.
    case AVCOL_SPC_BT2020_CL:
    case AVCOL_SPC_CHROMA_DERIVED_CL:
      return transfer == Transfer::bt709() ? "zscale=t=linear:agamma=0,format=gbrpf32le,format=gbrp16le" : "";
    case AVCOL_SPC_ICTCP: return transfer == Transfer::pq() ? "zscale=m=2020_ncl,format=yuv444p16le" : "";
    default: return {};
  }
}

std::optional<CodeRange> named_range(unsigned range, AVPixelFormat format) {
  if (range == AVCOL_RANGE_MPEG) return CodeRange::limited;
  return range == AVCOL_RANGE_JPEG || has_j_name(format) ? std::optional(CodeRange::full) : std::nullopt;
}

std::optional<ChromaPlace> named_chroma_place(const AVCodecParameters& codec) {
  return chroma_place(number_of(codec.chroma_location));
}

bool shares_chroma(AVPixelFormat format) {
  const AVPixFmtDescriptor& planes = *av_pix_fmt_desc_get(format);
  return planes.log2_chroma_w > 0 || planes.log2_chroma_h > 0;
}

bool interpolates_chroma(AVPixelFormat format, const PixelKind& pixels) {
  return is_yuv(format) && !pixels.is_grey && !pixels.is_everyday() && shares_chroma(format);
}

Upright upright_of(std::span<const std::uint8_t> display_matrix) {
  if (display_matrix.empty()) return {};
  std::int32_t matrix[9];
  if (display_matrix.size() < sizeof matrix) return {.left_out = "makes no sense"};
  std::memcpy(matrix, display_matrix.data(), sizeof matrix);
  // A row for where each axis of the picture goes. Of a mirrored one what is left is a turn once the first is reversed.
  Upright upright;
  upright.is_mirrored = std::int64_t{matrix[0]} * matrix[4] < std::int64_t{matrix[1]} * matrix[3];
  if (upright.is_mirrored) {
    matrix[0] = -std::max(matrix[0], -INT32_MAX);
    matrix[1] = -std::max(matrix[1], -INT32_MAX);
  }
  const double turned = av_display_rotation_get(matrix);  // counter-clockwise
  if (!std::isnan(turned))
    upright.quarter_turns = static_cast<int>((std::lround(-turned / 90.0) % 4 + 4) % 4);
  // Each axis of a turned picture goes along one of the screen's.
  const auto goes_along = [](std::int64_t x, std::int64_t y) {
    constexpr std::int64_t kStraight = 100;  // as good as: about half a degree
    return std::min(std::abs(x), std::abs(y)) <= std::max(std::abs(x), std::abs(y)) / kStraight;
  };
  const double across =
      static_cast<double>(matrix[0]) * matrix[3] + static_cast<double>(matrix[1]) * matrix[4];
  const double lengths = std::hypot(matrix[0], matrix[1]) * std::hypot(matrix[3], matrix[4]);
  if (std::isnan(turned)) {
    upright.left_out = "makes no sense";
  } else if (std::abs(across) > lengths / 100) {
    upright.left_out = "skews its pictures";
  } else if (!goes_along(matrix[0], matrix[1])) {
    upright.left_out = format("turns its pictures clockwise by {:.3g} degrees", -turned);
  }
  return upright;
}

PixelConverter::PixelConverter(PixelKind kind, Upright upright, YuvCoding coding)
    : kind_(kind),
      upright_(upright),
      coding_(coding),
      raster_format_(raster_format(kind)),
      planar_format_(with_bits("yuv444p", kind.bits)) {
  const double white = kind.white_code(), unit = std::ldexp(1.0, static_cast<int>(std::max(kind.bits, 8u)) - 8);
  if (coding.range == CodeRange::limited) white_ = static_cast<std::uint16_t>(235 * unit);
  if (kind.padding_bits == 0 && !kind.is_limited) return;
  code_of_.resize(kind.bits > 8 ? 65'536 : 256);
  // RGB of 9 to 15 bits was spread over 16.
  const double steps = kind.is_grey ? 1 : (256 * unit - 1) / static_cast<double>(code_of_.size() - 1);
  for (std::uint32_t i = 0; i < code_of_.size(); ++i) {
    double code = std::round((i >> kind.padding_bits) * steps);
    if (kind.is_limited && code <= 235 * unit) white_ = static_cast<std::uint16_t>(i);
    if (kind.is_limited) code = std::clamp((code - 16 * unit) / (219 * unit), 0.0, 1.0) * white + 0.5;
    code_of_[i] = static_cast<std::uint16_t>(code);
  }
}

void PixelConverter::scale(const AVFrame& frame, AVPixelFormat wanted, const std::string& name,
                           std::uint8_t* const* planes, const int* strides) {
  const auto from = static_cast<AVPixelFormat>(frame.format);
  const ChromaPlace at =
      coding_.chroma_at.value_or(chroma_place(number_of(frame.chroma_location)).value_or(kDefaultChromaPlace));
  if (!scaler_ || scales_from_ != from || scales_to_ != wanted || chroma_at_ != at) {
    scaler_.reset(new_scaler(frame, wanted, at));
    if (!scaler_) {
      const char* const kin = av_get_pix_fmt_name(planar_kin(from));
      throw InputError(format("{}: pixels of {} cannot be converted{}", name, av_get_pix_fmt_name(from),
                              kin == nullptr ? "" : format("; those of {} can, which has the same in planes", kin)));
    }
    scales_from_ = from;
    scales_to_ = wanted;
    chroma_at_ = at;
  }
  sws_scale(scaler_.get(), frame.data, frame.linesize, 0, frame.height, planes, strides);
}

const AVFrame& PixelConverter::unpacked(const AVFrame& frame) {
  const auto format = static_cast<AVPixelFormat>(frame.format);
  if (!planes_) planes_ = new_frame(planar_kin(format), frame.width, frame.height);
  planes_->chroma_location = frame.chroma_location;
  const AVPixFmtDescriptor& from = *av_pix_fmt_desc_get(format);
  const AVPixFmtDescriptor& to = *av_pix_fmt_desc_get(static_cast<AVPixelFormat>(planes_->format));
  const std::uint8_t* data[] = {frame.data[0], frame.data[1], frame.data[2], frame.data[3]};
  for (int component = 0; component < 3; ++component) {
    const int width = AV_CEIL_RSHIFT(frame.width, component == 0 ? 0 : from.log2_chroma_w);
    const int height = AV_CEIL_RSHIFT(frame.height, component == 0 ? 0 : from.log2_chroma_h);
    const AVComponentDescriptor& place = to.comp[component];
    std::vector<std::uint16_t> row(static_cast<std::size_t>(width));
    for (int y = 0; y < height; ++y) {
      av_read_image_line2(row.data(), data, frame.linesize, &from, 0, y, component, width, 0, 2);
      std::uint8_t* out = planes_->data[place.plane] + static_cast<std::ptrdiff_t>(y) * planes_->linesize[place.plane];
      if (place.step == 2) std::memcpy(out, row.data(), 2 * row.size());
      if (place.step == 1) std::ranges::transform(row, out, [](auto code) { return static_cast<std::uint8_t>(code); });
    }
  }
  return *planes_;
}

const AVFrame& PixelConverter::scaled(const AVFrame& frame, AVPixelFormat wanted, const std::string& name) {
  if (frame.format == wanted) return frame;
  if (!scaled_ || scaled_->format != wanted) scaled_ = new_frame(wanted, frame.width, frame.height);
  scale(frame, wanted, name, scaled_->data, scaled_->linesize);
  return *scaled_;
}

const AVFrame& PixelConverter::byte_planes(const AVFrame& frame, const std::string& name) {
  const auto format = static_cast<AVPixelFormat>(frame.format);
  return has_byte_planes(format) ? frame : scaled(frame, with_byte_planes(format), name);
}

const AVFrame& PixelConverter::looked_at(const AVFrame& planes) {
  if (!white_) return planes;
  share_above_white_ = (kind_.bits > 8 ? share_above<std::uint16_t> : share_above<std::uint8_t>)(
      planes.data[0], planes.linesize[0], static_cast<std::size_t>(planes.width), planes.height, *white_);
  return planes;
}

const AVFrame& PixelConverter::converted(const AVFrame& frame, const std::string& name) {
  if (kind_.is_grey || !is_yuv(static_cast<AVPixelFormat>(frame.format))) {
    return scaled(frame, raster_format_, name);
  }
  if (kind_.is_everyday()) {
    if (!rgb_) rgb_ = new_frame(AV_PIX_FMT_RGB24, frame.width, frame.height);
    eight_bit_rgb(looked_at(byte_planes(frame, name)), coding_, rgb_->data[0], rgb_->linesize[0]);
    return *rgb_;
  }
  // libswscale only gives every pixel its U and V.
  const AVFrame& planes = looked_at(scaled(frame, planar_format_, name));
  if (!rgb_) rgb_ = new_frame(AV_PIX_FMT_RGB48, frame.width, frame.height);
  yuv_to_rgb(planes, kind_.bits, coding_, *rgb_);
  return *rgb_;
}

void PixelConverter::convert(const AVFrame& given, std::span<std::byte> raster, const std::string& name) {
  const bool is_unpacked = is_unpacked_here(static_cast<AVPixelFormat>(given.format));
  const AVFrame& frame = is_unpacked ? unpacked(given) : given;
  const std::size_t pixel_bytes = (kind_.is_grey ? 1u : 3u) * (kind_.bits > 8 ? 2u : 1u);
  const std::size_t row_bytes = static_cast<std::size_t>(frame.width) * pixel_bytes;
  const bool stays = upright_.orientation() == 1;
  auto* row = reinterpret_cast<std::uint8_t*>(raster.data());
  if (kind_.is_everyday() && is_yuv(static_cast<AVPixelFormat>(frame.format)) && stays) {
    eight_bit_rgb(looked_at(byte_planes(frame, name)), coding_, row, static_cast<std::ptrdiff_t>(row_bytes));
    return;
  }
  if (raster_format_ == AV_PIX_FMT_RGB24 && frame.format != raster_format_ && stays && code_of_.empty() &&
      is_aligned(raster, row_bytes)) {
    const int stride = static_cast<int>(row_bytes);
    scale(frame, raster_format_, name, &row, &stride);
    return;
  }
  const AVFrame& picture = converted(frame, name);
  copy_turned(reinterpret_cast<const std::byte*>(picture.data[0]), picture.linesize[0],
              {static_cast<std::uint32_t>(picture.width), static_cast<std::uint32_t>(picture.height), 0}, pixel_bytes,
              upright_.orientation(), raster.data());
  if (code_of_.empty()) return;
  if (white_) {
    share_above_white_ = (kind_.bits > 8 ? share_above<std::uint16_t> : share_above<std::uint8_t>)(
        row, 0, raster.size() / (kind_.bits > 8 ? 2 : 1), 1, *white_);
  }
  if (kind_.bits <= 8) {
    for (std::byte& code : raster) code = static_cast<std::byte>(code_of_[std::to_integer<std::size_t>(code)]);
    return;
  }
  auto* codes = reinterpret_cast<std::uint16_t*>(raster.data());
  for (std::size_t i = 0; i < raster.size() / 2; ++i) codes[i] = code_of_[codes[i]];
}

}  // namespace nutik::videos
