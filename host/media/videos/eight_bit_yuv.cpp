#include "media/videos/eight_bit_yuv.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

// Compiled for several instruction sets, of which one is chosen when the program starts: with 16 bytes at a time
// converting a picture takes as long as decoding it. Sanitizers are not ready when that choice is made.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define NUTIK_SIMD_CLONES __attribute__((target_clones("avx2", "ssse3", "default"), optimize("O3")))
#else
#define NUTIK_SIMD_CLONES
#endif

namespace nutik::videos {
namespace {

constexpr int kFraction = 14;  // bits of a code behind its point, while it is made

// What a step of luma or chroma adds to a code.
struct Weights {
  std::int32_t luma, red_of_v, green_of_u, green_of_v, blue_of_u;
  std::int32_t black;  // luma's code
};

Weights weights_of(const YuvCoding& coding) {
  const auto [red, blue] = luma_weights(coding.matrix);
  const bool is_full = coding.range == CodeRange::full;
  const double luma = is_full ? 1.0 : 255.0 / 219.0, chroma = is_full ? 1.0 : 255.0 / 224.0;
  const double green = 1.0 - red - blue;
  const double red_of_v = 2.0 * (1.0 - red) * chroma, blue_of_u = 2.0 * (1.0 - blue) * chroma;
  const auto whole = [](double weight) {
    return static_cast<std::int32_t>(std::lround(std::ldexp(weight, kFraction)));
  };
  return {whole(luma),      whole(red_of_v), whole(blue / green * blue_of_u), whole(red / green * red_of_v),
          whole(blue_of_u), is_full ? 0 : 16};
}

inline __attribute__((always_inline)) std::uint8_t code_of(std::int32_t value) {
  return static_cast<std::uint8_t>(std::clamp(value >> kFraction, 0, 255));
}

// A row of pixels, of which 2^kShift share their chroma. The compiler makes vectors of it as long as no pointer may be
// another's.
template <int kShift>
inline __attribute__((always_inline)) void convert_row(const std::uint8_t* __restrict luma,
                                                       const std::uint8_t* __restrict u,
                                                       const std::uint8_t* __restrict v, std::size_t width,
                                                       Weights w, std::uint8_t* __restrict red,
                                                       std::uint8_t* __restrict green,
                                                       std::uint8_t* __restrict blue) {
  constexpr std::int32_t kHalf = 1 << (kFraction - 1);
  constexpr std::size_t kTogether = std::size_t{1} << kShift;
  const std::size_t whole = width / kTogether;
  for (std::size_t group = 0; group < whole; ++group) {
    const std::int32_t from_u = u[group] - 128, from_v = v[group] - 128;
    const std::int32_t to_red = from_v * w.red_of_v + kHalf;
    const std::int32_t to_green = kHalf - from_u * w.green_of_u - from_v * w.green_of_v;
    const std::int32_t to_blue = from_u * w.blue_of_u + kHalf;
#pragma GCC unroll 4
    for (std::size_t i = 0; i < kTogether; ++i) {
      const std::int32_t light = (luma[kTogether * group + i] - w.black) * w.luma;
      red[kTogether * group + i] = code_of(light + to_red);
      green[kTogether * group + i] = code_of(light + to_green);
      blue[kTogether * group + i] = code_of(light + to_blue);
    }
  }
  for (std::size_t x = whole * kTogether; x < width; ++x) {
    const std::int32_t from_u = u[whole] - 128, from_v = v[whole] - 128;
    const std::int32_t light = (luma[x] - w.black) * w.luma + kHalf;
    red[x] = code_of(light + from_v * w.red_of_v);
    green[x] = code_of(light - from_u * w.green_of_u - from_v * w.green_of_v);
    blue[x] = code_of(light + from_u * w.blue_of_u);
  }
}

#define NUTIK_CONVERT_ROW(name, shift)                                                               \
  NUTIK_SIMD_CLONES void name(const std::uint8_t* __restrict luma, const std::uint8_t* __restrict u, \
                              const std::uint8_t* __restrict v, std::size_t width, const Weights& w, \
                              std::uint8_t* __restrict red, std::uint8_t* __restrict green,          \
                              std::uint8_t* __restrict blue) {                                       \
    convert_row<shift>(luma, u, v, width, w, red, green, blue);                                      \
  }
NUTIK_CONVERT_ROW(convert_row_1, 0)
NUTIK_CONVERT_ROW(convert_row_2, 1)
NUTIK_CONVERT_ROW(convert_row_4, 2)
#undef NUTIK_CONVERT_ROW

NUTIK_SIMD_CLONES void interleave(const std::uint8_t* __restrict red, const std::uint8_t* __restrict green,
                                  const std::uint8_t* __restrict blue, std::size_t width,
                                  std::uint8_t* __restrict rgb) {
  for (std::size_t x = 0; x < width; ++x) {
    rgb[3 * x] = red[x];
    rgb[3 * x + 1] = green[x];
    rgb[3 * x + 2] = blue[x];
  }
}

}  // namespace

bool has_byte_planes(AVPixelFormat format) {
  const AVPixFmtDescriptor& pixels = *av_pix_fmt_desc_get(format);
  for (int component = 0; component < 3; ++component) {
    const AVComponentDescriptor& place = pixels.comp[component];
    if (place.plane != component || place.step != 1 || place.depth != 8 || place.offset != 0) return false;
  }
  return pixels.log2_chroma_w <= 2;
}

AVPixelFormat with_byte_planes(AVPixelFormat format) {
  const AVPixFmtDescriptor& pixels = *av_pix_fmt_desc_get(format);
  const int across = pixels.log2_chroma_w, down = pixels.log2_chroma_h;
  if (across == 0) return down == 0 ? AV_PIX_FMT_YUV444P : AV_PIX_FMT_YUV440P;
  if (across == 1) return down == 0 ? AV_PIX_FMT_YUV422P : AV_PIX_FMT_YUV420P;
  return down == 0 ? AV_PIX_FMT_YUV411P : AV_PIX_FMT_YUV410P;
}

void eight_bit_rgb(const AVFrame& frame, const YuvCoding& coding, std::uint8_t* rgb, std::ptrdiff_t stride) {
  const AVPixFmtDescriptor& pixels = *av_pix_fmt_desc_get(static_cast<AVPixelFormat>(frame.format));
  const auto convert = pixels.log2_chroma_w == 0   ? convert_row_1
                       : pixels.log2_chroma_w == 1 ? convert_row_2
                                                   : convert_row_4;
  const Weights weights = weights_of(coding);
  const auto width = static_cast<std::size_t>(frame.width);
  std::vector<std::uint8_t> codes(3 * width);
  std::uint8_t *const red = codes.data(), *const green = red + width, *const blue = green + width;
  for (int y = 0; y < frame.height; ++y) {
    const auto row = [&](int plane) {
      const int at = plane == 0 ? y : y >> pixels.log2_chroma_h;
      return frame.data[plane] + static_cast<std::ptrdiff_t>(at) * frame.linesize[plane];
    };
    convert(row(0), row(1), row(2), width, weights, red, green, blue);
    interleave(red, green, blue, width, rgb + y * stride);
  }
}

}  // namespace nutik::videos
