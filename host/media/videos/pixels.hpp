// How FFmpeg's pictures become rasters of codes.
//
//   grey      as stored: 8, 9, 10, 12, 14 or 16 bits, code for code; of the limited range as luma of YUV, as is RGB
//   colour    8 bits as 8-bit RGB, deeper as RGB over the full 16-bit range, YUV by a matrix and a range
// Transparency is left out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "media/videos/libav.hpp"

namespace nutik::videos {

struct PixelKind {
  bool is_grey = false;
  std::uint32_t bits = 8;  // of a component, of which 1 to 8 are read as 8
  // Empty low bits that the decoder puts below the codes of the file, to fill 16 bits.
  std::uint32_t padding_bits = 0;
  bool is_limited = false;  // grey or RGB whose codes are scaled to the full range

  // 8-bit colour, as players show it.
  [[nodiscard]] bool is_everyday() const { return !is_grey && bits <= 8; }
  // The largest code of the rasters.
  [[nodiscard]] std::uint32_t white_code() const;
};

// Throws InputError naming the file where its pixels are of no kind that is read.
[[nodiscard]] PixelKind pixel_kind(const AVCodecParameters& codec, const std::string& name);

// How a stream's pictures come to stand upright: first mirrored, left for right, then turned clockwise.
struct Upright {
  bool is_mirrored = false;
  int quarter_turns = 0;      // 0 … 3
  std::string left_out = {};  // what else the stream's matrix does, for people

  // How its pictures lie, as EXIF numbers it.
  [[nodiscard]] unsigned orientation() const { return (is_mirrored ? "\2\7\4\5" : "\1\6\3\10")[quarter_turns]; }
};
// What a display matrix says, which is nine numbers of 32 bits as a stream carries them; empty where it has none.
[[nodiscard]] Upright upright_of(std::span<const std::uint8_t> display_matrix);

// Where nothing says it: to the left, and between two lines, as in H.264 and most that came after it.
constexpr ChromaPlace kDefaultChromaPlace = ChromaPlace::left;

// How YUV becomes RGB.
struct YuvCoding {
  YuvMatrix matrix = YuvMatrix::bt601;
  CodeRange range = CodeRange::limited;
  std::optional<ChromaPlace> chroma_at = std::nullopt;  // else where each picture says
};
// What is added to luma for each channel, of U and V as shares of their span: how many steps of 8 bits that has in the
// limited range. Luma has 219.
struct ChromaWeights {
  double red_of_u, red_of_v, green_of_u, green_of_v, blue_of_u, blue_of_v;
  double limited_span;
};
[[nodiscard]] ChromaWeights chroma_weights(YuvMatrix matrix);
// For pictures of so many lines, where nothing names another, and in films that are written: BT.709's from 720 on, as
// most programs have it, else BT.601's.
[[nodiscard]] YuvMatrix usual_matrix(std::uint32_t lines);
// Whether the pixels of a stream are YUV of three components.
[[nodiscard]] bool is_yuv(AVPixelFormat format);

// Whether each pixel has one of the colours.
[[nodiscard]] bool is_mosaic(AVPixelFormat format);
// Whether its decoder names a format with transparency whatever its pictures have: their pixels tell.
[[nodiscard]] bool is_seen_as_transparent(const AVCodecParameters& codec);
// The filter of FFmpeg that makes YUV or RGB that is known here of what names another matrix, with light right to
// within a hundredth of white. Empty: none is known.
[[nodiscard]] std::string filter_from_matrix(unsigned space, unsigned curve);
// What a stream says of its YUV; none where it does not, or names what is not known here.
[[nodiscard]] std::optional<YuvMatrix> named_matrix(unsigned space, unsigned primaries);
[[nodiscard]] std::optional<CodeRange> named_range(unsigned range, AVPixelFormat format);
[[nodiscard]] std::optional<ChromaPlace> named_chroma_place(const AVCodecParameters& codec);
// Whether several pixels have one sample of chroma.
[[nodiscard]] bool shares_chroma(AVPixelFormat format);
// Whether each pixel's chroma is made of samples that lie between pixels; that of everyday pixels is what they share.
[[nodiscard]] bool interpolates_chroma(AVPixelFormat format, const PixelKind& pixels);

class PixelConverter {
 public:
  PixelConverter(PixelKind kind, Upright upright, YuvCoding coding);

  // Writes `frame`, turned upright, as a raster of width x height x (1 or 3) codes of 1 or 2 bytes.
  // All frames must have one size. Throws InputError naming the file where FFmpeg cannot convert
  // it.
  void convert(const AVFrame& frame, std::span<std::byte> raster, const std::string& name);

  // How much of the last picture's luma (of grey and RGB: of its codes) lies above the limited range's white, which all
  // of it becomes. 0: its range is the full one.
  [[nodiscard]] double share_above_white() const { return share_above_white_; }

 private:
  // An everyday picture of YUV with a plane for each component.
  const AVFrame& byte_planes(const AVFrame& frame, const std::string& name);
  const AVFrame& converted(const AVFrame& frame, const std::string& name);
  // Looks at its luma; returns the same.
  const AVFrame& looked_at(const AVFrame& planes);
  void scale(const AVFrame& frame, AVPixelFormat wanted, const std::string& name, std::uint8_t* const* planes,
             const int* strides);
  const AVFrame& unpacked(const AVFrame& frame);
  const AVFrame& scaled(const AVFrame& frame, AVPixelFormat wanted, const std::string& name);

  PixelKind kind_;
  Upright upright_;
  YuvCoding coding_;
  AVPixelFormat raster_format_;
  AVPixelFormat planar_format_;         // of YUV, before it is RGB
  std::vector<std::uint16_t> code_of_;  // what becomes of each code of grey or RGB; empty: it stays
  std::optional<std::uint16_t> white_;  // the largest code of luma, or of grey or RGB, that is not above white
  double share_above_white_ = 0;
  ScalerPointer scaler_;
  AVPixelFormat scales_from_ = AV_PIX_FMT_NONE, scales_to_ = AV_PIX_FMT_NONE;
  ChromaPlace chroma_at_ = kDefaultChromaPlace;
  FramePointer planes_;
  FramePointer scaled_;
  FramePointer rgb_;
};

}  // namespace nutik::videos
