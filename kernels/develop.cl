// Develops a picture: sums to light, light to codes, tiles to rows of pixels.
//
//   in:    sums [tile][channel][64] of expose.cl
//   out:   an interleaved raster of width × height pixels
//   items: one pixel each, in tile order; those in a tile's padding do nothing
#include "arithmetic.clh"
#include "layout.clh"

#ifndef NUTIK_CHANNELS
#error "NUTIK_CHANNELS is not set: 1 or 3"
#endif

#ifndef NUTIK_RASTER_BYTES
#error "NUTIK_RASTER_BYTES is not set: bytes of a code in the picture, 1 or 2"
#endif

#define NUTIK_TILE_SIDE 8

#if NUTIK_RASTER_BYTES == 1
typedef uchar raster_code;
#else
typedef ushort raster_code;
#endif

// What turns the sums of one function into light: light = sum · first · second. Two factors, because
// 2^exponent alone may be outside single precision where the product with the sum is not.
typedef struct {
  real first;
  real second;
} LightScale;

typedef struct {
  bool is_inside;
  size_t pixel;  // in the raster
  size_t sum;    // index of its first channel's sum; the others follow at steps of 64
} Pixel;

NUTIK_INLINE Pixel pixel_of(const size_t item, const uint width, const uint height) {
  const size_t columns = (width + NUTIK_TILE_SIDE - 1) / NUTIK_TILE_SIDE;
  const size_t tile = item / NUTIK_TILE_PIXELS;
  const uint lane = (uint)(item % NUTIK_TILE_PIXELS);
  const size_t x = tile % columns * NUTIK_TILE_SIDE + lane % NUTIK_TILE_SIDE;
  const size_t y = tile / columns * NUTIK_TILE_SIDE + lane / NUTIK_TILE_SIDE;
  Pixel pixel;
  pixel.is_inside = x < width && y < height;
  pixel.pixel = y * width + x;
  pixel.sum = tile * NUTIK_CHANNELS * NUTIK_TILE_PIXELS + lane;
  return pixel;
}

NUTIK_INLINE real light_at(global const real* restrict sums, const size_t at, const LightScale scale) {
  return sums[at] * scale.first * scale.second;
}

// The code whose interval of light holds `light`: the largest c with thresholds[c] <= light. Saturates
// at 0 and at the white code. `guesses` holds a code near that for each of guess_count equal steps of
// the square root of light, which spaces codes evenly enough that few steps remain.
NUTIK_INLINE uint code_of(const real light, global const real* restrict thresholds, const uint white_code,
                    global const ushort* restrict guesses, const uint guess_count) {
  if (!(light > 0)) return 0;
  if (light >= 1) return white_code;
  uint c = guesses[min((uint)(sqrt(light) * guess_count), guess_count - 1)];
  while (c < white_code && thresholds[c + 1] <= light) ++c;
  while (c > 0 && thresholds[c] > light) --c;
  return c;
}

kernel void develop_light(global const real* restrict sums, global const LightScale* restrict scales,
                          global const uchar* restrict function_of_lane, const uint width,
                          const uint height, global real* restrict raster) {
  const size_t item = get_global_id(0);
  const Pixel pixel = pixel_of(item, width, height);
  if (!pixel.is_inside) return;
  const LightScale scale = scales[function_of_lane[item]];
  for (uint channel = 0; channel < NUTIK_CHANNELS; ++channel) {
    raster[pixel.pixel * NUTIK_CHANNELS + channel] =
        light_at(sums, pixel.sum + channel * NUTIK_TILE_PIXELS, scale);
  }
}

kernel void develop_codes(global const real* restrict sums, global const LightScale* restrict scales,
                          global const uchar* restrict function_of_lane, const uint width,
                          const uint height, global const real* restrict thresholds,
                          const uint white_code, global const ushort* restrict guesses,
                          const uint guess_count, global raster_code* restrict raster) {
  const size_t item = get_global_id(0);
  const Pixel pixel = pixel_of(item, width, height);
  if (!pixel.is_inside) return;
  const LightScale scale = scales[function_of_lane[item]];
  for (uint channel = 0; channel < NUTIK_CHANNELS; ++channel) {
    const real light = light_at(sums, pixel.sum + channel * NUTIK_TILE_PIXELS, scale);
    raster[pixel.pixel * NUTIK_CHANNELS + channel] =
        (raster_code)code_of(light, thresholds, white_code, guesses, guess_count);
  }
}
