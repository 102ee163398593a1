#include "media/videos/eight_bit_yuv.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

// Compiled for several instruction sets, of which one is chosen when the program starts: with what all processors have
// converting a picture takes three times as long. Sanitizers are not ready when that choice is made.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define NUTIK_BYTE_CLONES \
  __attribute__((target_clones("arch=x86-64-v4", "avx2", "ssse3", "default"), optimize("O3")))
#else
#define NUTIK_BYTE_CLONES
#endif

namespace nutik::videos {
namespace {

// A code is made in 64ths, less half of its range: so it fits 16 bits whatever luma and chroma come to (at most 279 and
// 299 codes either way), of which processors add and multiply twice as many at once as of 32.
//
// How far it may be off: half a code by its own rounding, half a 64th each by luma's part and chroma's, 239 * 2^-15 by
// luma's weight and 2 * 128 * 2^-17 by chroma's: kMostOff.
constexpr int kFraction = 6;         // bits of a code behind its point, while it is made
constexpr int kLumaFraction = 14;    // those of luma's weight
constexpr int kChromaFraction = 16;  // those of chroma's weights, and of what is added up of them
constexpr int kHalfRange = 128 << kFraction;

// What a step of luma or chroma adds to a code, and what does not depend on them.
struct Weights {
  std::uint16_t luma;
  std::int32_t red_of_u, red_of_v, green_of_u, green_of_v, blue_of_u, blue_of_v;
  std::int32_t red, green, blue;

  [[nodiscard]] bool are_crossed() const { return red_of_u != 0 || blue_of_v != 0; }
};

Weights weights_of(const YuvCoding& coding) {
  const ChromaWeights chroma = chroma_weights(coding.matrix);
  const bool is_full = coding.range == CodeRange::full;
  const double luma = is_full ? 1.0 : 255.0 / 219.0, scale = is_full ? 1.0 : 255.0 / chroma.limited_span;
  const auto whole = [](double weight, int fraction) {
    return static_cast<std::int32_t>(std::lround(std::ldexp(weight, fraction)));
  };
  const auto of_chroma = [&](double weight) { return whole(weight * scale, kChromaFraction); };
  Weights weights{static_cast<std::uint16_t>(whole(luma, kLumaFraction)),
                  of_chroma(chroma.red_of_u),
                  of_chroma(chroma.red_of_v),
                  of_chroma(chroma.green_of_u),
                  of_chroma(chroma.green_of_v),
                  of_chroma(chroma.blue_of_u),
                  of_chroma(chroma.blue_of_v),
                  0,
                  0,
                  0};
  // Half a code, and half a 64th for each of the two parts: all of them are cut off below.
  constexpr std::int32_t kCode = 1 << kChromaFraction, k64th = kCode >> kFraction;
  const std::int32_t black = is_full ? 0 : 16 * weights.luma << (kChromaFraction - kLumaFraction);
  const std::int32_t constant = kCode / 2 - 128 * kCode + 2 * (k64th / 2) - black;
  weights.red = constant - 128 * (weights.red_of_u + weights.red_of_v);
  weights.green = constant - 128 * (weights.green_of_u + weights.green_of_v);
  weights.blue = constant - 128 * (weights.blue_of_u + weights.blue_of_v);
  return weights;
}

// What `count` samples of chroma add to the codes of 2^kShift pixels each. The compiler makes vectors of these loops as
// long as no pointer may be another's.
template <int kShift, bool kAreCrossed>
inline __attribute__((always_inline)) void add_chroma(const std::uint8_t* __restrict u,
                                                      const std::uint8_t* __restrict v, std::size_t count,
                                                      Weights w, std::int16_t* __restrict red,
                                                      std::int16_t* __restrict green,
                                                      std::int16_t* __restrict blue) {
  constexpr std::size_t kTogether = std::size_t{1} << kShift;
  constexpr int kCut = kChromaFraction - kFraction;
  for (std::size_t i = 0; i < count; ++i) {
    const std::int32_t from_u = u[i], from_v = v[i];
    const auto to_red = static_cast<std::int16_t>(
        (w.red + from_v * w.red_of_v + (kAreCrossed ? from_u * w.red_of_u : 0)) >> kCut);
    const auto to_green =
        static_cast<std::int16_t>((w.green + from_u * w.green_of_u + from_v * w.green_of_v) >> kCut);
    const auto to_blue = static_cast<std::int16_t>(
        (w.blue + from_u * w.blue_of_u + (kAreCrossed ? from_v * w.blue_of_v : 0)) >> kCut);
#pragma GCC unroll 4
    for (std::size_t k = 0; k < kTogether; ++k) {
      red[kTogether * i + k] = to_red;
      green[kTogether * i + k] = to_green;
      blue[kTogether * i + k] = to_blue;
    }
  }
}

#define NUTIK_ADD_CHROMA(name, shift)                                                             \
  NUTIK_BYTE_CLONES void name(const std::uint8_t* __restrict u, const std::uint8_t* __restrict v, \
                              std::size_t count, const Weights& w, std::int16_t* __restrict red,  \
                              std::int16_t* __restrict green, std::int16_t* __restrict blue) {    \
    add_chroma<shift, false>(u, v, count, w, red, green, blue);                                   \
  }
NUTIK_ADD_CHROMA(add_chroma_1, 0)
NUTIK_ADD_CHROMA(add_chroma_2, 1)
NUTIK_ADD_CHROMA(add_chroma_4, 2)
#undef NUTIK_ADD_CHROMA

// Where either of them changes all channels, which is rare enough for one instruction set.
template <int kShift>
void add_crossed_chroma(const std::uint8_t* u, const std::uint8_t* v, std::size_t count, const Weights& w,
                        std::int16_t* red, std::int16_t* green, std::int16_t* blue) {
  add_chroma<kShift, true>(u, v, count, w, red, green, blue);
}

using AddChroma = decltype(&add_chroma_1);
AddChroma chroma_adder(int shift, const Weights& weights) {
  constexpr AddChroma kDefault[] = {&add_chroma_1, &add_chroma_2, &add_chroma_4};
  constexpr AddChroma kCrossed[] = {&add_crossed_chroma<0>, &add_crossed_chroma<1>, &add_crossed_chroma<2>};
  return (weights.are_crossed() ? kCrossed : kDefault)[shift];
}

// A channel's code from luma's part and chroma's. Their sum, as 16 bits have it, is right.
inline __attribute__((always_inline)) std::uint8_t code_of(std::uint16_t luma_part,
                                                           std::int16_t chroma_part) {
  const auto sum = static_cast<std::int16_t>(luma_part + chroma_part);
  const std::int16_t limited =
      std::min<std::int16_t>(std::max<std::int16_t>(sum, -kHalfRange), kHalfRange - 1);
  return static_cast<std::uint8_t>((limited >> kFraction) + 128);
}

// 16 pixels of three bytes each from their planes: each of three vectors is picked first from red and green, then with
// blue between them. -1 is a place for blue.
inline __attribute__((always_inline)) void interleave(const std::uint8_t* red, const std::uint8_t* green,
                                                      const std::uint8_t* blue, std::uint8_t* rgb) {
  using Bytes = std::uint8_t __attribute__((vector_size(16)));
  Bytes r, g, b;
  std::memcpy(&r, red, 16);
  std::memcpy(&g, green, 16);
  std::memcpy(&b, blue, 16);
  Bytes first = __builtin_shufflevector(r, g, 0, 16, -1, 1, 17, -1, 2, 18, -1, 3, 19, -1, 4, 20, -1, 5);
  Bytes middle = __builtin_shufflevector(r, g, 21, -1, 6, 22, -1, 7, 23, -1, 8, 24, -1, 9, 25, -1, 10, 26);
  Bytes last = __builtin_shufflevector(r, g, -1, 11, 27, -1, 12, 28, -1, 13, 29, -1, 14, 30, -1, 15, 31, -1);
  first = __builtin_shufflevector(first, b, 0, 1, 16, 3, 4, 17, 6, 7, 18, 9, 10, 19, 12, 13, 20, 15);
  middle = __builtin_shufflevector(middle, b, 0, 21, 2, 3, 22, 5, 6, 23, 8, 9, 24, 11, 12, 25, 14, 15);
  last = __builtin_shufflevector(last, b, 26, 1, 2, 27, 4, 5, 28, 7, 8, 29, 10, 11, 30, 13, 14, 31);
  std::memcpy(rgb, &first, 16);
  std::memcpy(rgb + 16, &middle, 16);
  std::memcpy(rgb + 32, &last, 16);
}

// A row's pixels, some at a time: their codes stay close by until they are written, and memory is not left waiting
// while a whole row is computed (15 % of the time).
NUTIK_BYTE_CLONES void add_luma(const std::uint8_t* __restrict luma, std::size_t width, std::uint16_t weight,
                                const std::int16_t* __restrict red_part,
                                const std::int16_t* __restrict green_part,
                                const std::int16_t* __restrict blue_part, std::uint8_t* __restrict rgb) {
  constexpr std::size_t kChunk = 256;
  // The upper half of a product of 16 bits, which is one instruction.
  static_assert(8 + kLumaFraction - 16 == kFraction);
  std::uint8_t red[kChunk], green[kChunk], blue[kChunk];
  for (std::size_t x = 0; x < width; x += kChunk) {
    const std::size_t count = std::min(kChunk, width - x);
    for (std::size_t i = 0; i < count; ++i) {
      const auto high = static_cast<std::uint16_t>(luma[x + i] << 8);
      const auto part = static_cast<std::uint16_t>(std::uint32_t{high} * weight >> 16);
      red[i] = code_of(part, red_part[x + i]);
      green[i] = code_of(part, green_part[x + i]);
      blue[i] = code_of(part, blue_part[x + i]);
    }
    std::uint8_t* to = rgb + 3 * x;
    std::size_t i = 0;
    for (; i + 16 <= count; i += 16, to += 48) interleave(red + i, green + i, blue + i, to);
    for (; i < count; ++i, to += 3) {
      to[0] = red[i];
      to[1] = green[i];
      to[2] = blue[i];
    }
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
  const int across = pixels.log2_chroma_w, down = pixels.log2_chroma_h;
  const Weights weights = weights_of(coding);
  const AddChroma add_chroma = chroma_adder(across, weights);
  const auto width = static_cast<std::size_t>(frame.width);
  const std::size_t chroma_width = ((width - 1) >> across) + 1;
  const std::size_t part_count = chroma_width << across;
  std::vector<std::int16_t> parts(3 * part_count);
  std::int16_t *const red = parts.data(), *const green = red + part_count, *const blue = green + part_count;
  const auto line = [&](int plane, int y) {
    return frame.data[plane] + static_cast<std::ptrdiff_t>(y) * frame.linesize[plane];
  };
  for (int y = 0; y < frame.height; ++y) {
    if (y % (1 << down) == 0) {
      add_chroma(line(1, y >> down), line(2, y >> down), chroma_width, weights, red, green, blue);
    }
    add_luma(line(0, y), width, weights.luma, red, green, blue, rgb + y * stride);
  }
}

}  // namespace nutik::videos
