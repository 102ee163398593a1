// Develops a picture: sums to light, light to codes, tiles to rows of pixels.
//
//   in:    sums [tile][channel][64] of expose.cl
//   out:   an interleaved raster of width × height pixels
//   items: as in expose.cl; NUTIK_LANES pixels at a time, at most a row of a tile. A tile's padding is not
//          written
#include "items.clh"

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

// Where NUTIK_LANES pixels lie.
typedef struct {
  uint count;        // how many are inside the picture
  size_t raster;     // the first one's place in the raster, in pixels
  size_t tile;
  uint lane;
} Pixels;

NUTIK_INLINE Pixels pixels_at(const size_t tile, const uint lane, const uint width, const uint height) {
  const size_t columns = (width + NUTIK_TILE_SIDE - 1) / NUTIK_TILE_SIDE;
  Pixels pixels;
  pixels.tile = tile;
  pixels.lane = lane;
  const size_t x = tile % columns * NUTIK_TILE_SIDE + lane % NUTIK_TILE_SIDE;
  const size_t y = tile / columns * NUTIK_TILE_SIDE + lane / NUTIK_TILE_SIDE;
  pixels.count = y >= height || x >= width ? 0 : min((uint)NUTIK_LANES, (uint)(width - x));
  pixels.raster = y * width + x;
  return pixels;
}

NUTIK_INLINE reals light_at(global const real* restrict sums, global const LightScale* restrict scales,
                            global const uchar* restrict function_of_lane, const Pixels* pixels,
                            const uint channel) {
  const uints functions = NUTIK_TO_UINTS(
      NUTIK_LOAD(function_of_lane + pixels->tile * NUTIK_TILE_PIXELS + pixels->lane));
  const reals sum =
      NUTIK_LOAD(sums + (pixels->tile * NUTIK_CHANNELS + channel) * NUTIK_TILE_PIXELS + pixels->lane);
  global const real* factors = (global const real*)scales;
  return sum * gather(factors, functions * 2) * gather(factors, functions * 2 + 1);
}

// The codes whose intervals of light hold `light`: the largest c with thresholds[c] <= light. Saturates at
// 0 and at the white code. `guesses` has for each of guess_count equal steps of the square root of light
// the right code or one below it; thresholds[white + 1] is infinite.
NUTIK_INLINE uints codes_of(const reals light, global const real* restrict thresholds,
                            global const uint* restrict guesses, const uint guess_count) {
  const reals inside = clamp(light, (reals)(0), (reals)(1));  // of a NaN: undefined, but within the table
  const uints step = min(NUTIK_JOIN(convert_, NUTIK_VECTOR(uint))(sqrt(inside) * guess_count),
                         (uints)(guess_count - 1));
  const uints guess = gather_uint(guesses, step);
  return guess + NUTIK_ONE_WHERE(gather(thresholds, guess + 1) <= inside);
}

NUTIK_INLINE void write_light(const Pixels* pixels, global const real* restrict sums,
                              global const LightScale* restrict scales,
                              global const uchar* restrict function_of_lane, global real* restrict raster) {
  for (uint channel = 0; channel < NUTIK_CHANNELS; ++channel) {
    real light[NUTIK_LANES];
    NUTIK_STORE(light_at(sums, scales, function_of_lane, pixels, channel), light);
    for (uint i = 0; i < pixels->count; ++i) {
      raster[(pixels->raster + i) * NUTIK_CHANNELS + channel] = light[i];
    }
  }
}

NUTIK_INLINE void write_codes(const Pixels* pixels, global const real* restrict sums,
                              global const LightScale* restrict scales,
                              global const uchar* restrict function_of_lane,
                              global const real* restrict thresholds, global const uint* restrict guesses,
                              const uint guess_count, global raster_code* restrict raster) {
  uint codes[NUTIK_CHANNELS][NUTIK_LANES];
#pragma unroll
  for (uint channel = 0; channel < NUTIK_CHANNELS; ++channel) {
    const reals light = light_at(sums, scales, function_of_lane, pixels, channel);
    NUTIK_STORE(codes_of(light, thresholds, guesses, guess_count), codes[channel]);
  }
  for (uint i = 0; i < pixels->count; ++i) {
#pragma unroll
    for (uint channel = 0; channel < NUTIK_CHANNELS; ++channel) {
      raster[(pixels->raster + i) * NUTIK_CHANNELS + channel] = (raster_code)codes[channel][i];
    }
  }
}

kernel void develop_light(global const real* restrict sums, global const LightScale* restrict scales,
                          global const uchar* restrict function_of_lane, const uint width,
                          const uint height, const ulong tile_count, global real* restrict raster) {
  const Item item = item_of(get_global_id(0), tile_count);
  for (size_t tile = item.first_tile; tile < item.last_tile; ++tile) {
    for (uint lane = item.lane; lane < item.lane + NUTIK_ITEM_PIXELS; lane += NUTIK_LANES) {
      const Pixels pixels = pixels_at(tile, lane, width, height);
      write_light(&pixels, sums, scales, function_of_lane, raster);
    }
  }
}

kernel void develop_codes(global const real* restrict sums, global const LightScale* restrict scales,
                          global const uchar* restrict function_of_lane, const uint width,
                          const uint height, const ulong tile_count,
                          global const real* restrict thresholds, global const uint* restrict guesses,
                          const uint guess_count, global raster_code* restrict raster) {
  const Item item = item_of(get_global_id(0), tile_count);
  for (size_t tile = item.first_tile; tile < item.last_tile; ++tile) {
    for (uint lane = item.lane; lane < item.lane + NUTIK_ITEM_PIXELS; lane += NUTIK_LANES) {
      const Pixels pixels = pixels_at(tile, lane, width, height);
      write_codes(&pixels, sums, scales, function_of_lane, thresholds, guesses, guess_count, raster);
    }
  }
}
