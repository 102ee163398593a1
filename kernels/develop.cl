// Develops a picture: sums to codes, tiles to rows of pixels.
//
//   in:    sums [tile][channel][plane][64] of expose.cl
//   out:   an interleaved raster of width × height pixels: codes, or the sums as they are, which the host turns
//          into light
//   items: as in expose.cl; NUTIK_LANES pixels at a time, at most a row of a tile. A tile's padding is not
//          written
#include "arithmetic.clh"
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

// The codes whose intervals of light hold `light`: the largest c with thresholds[c] <= light. Saturates at
// 0 and at the white code. thresholds[0], which nothing is compared with, holds what white is on the scale of
// the others; thresholds[white code + 1] is beyond all light. `guesses` has for each of guess_count equal steps
// of the square root of light the right code or one below it.
NUTIK_INLINE uints codes_of(const Lights light, global const Threshold* restrict thresholds,
                            global const uint* restrict guesses, const uint guess_count) {
  const reals root = sqrt(share_of_white(light, thresholds[0]));
  const uints step = min(NUTIK_TO_UINTS(root * guess_count), (uints)(guess_count - 1));
  const uints guess = gather_uint(guesses, step);
  return guess + one_where_reached(thresholds, guess + 1, light);
}

NUTIK_INLINE void write_codes(const Pixels* pixels, global const Sum* restrict sums,
                              global const LightScale* restrict scales,
                              global const uchar* restrict function_of_lane,
                              global const Threshold* restrict thresholds, global const uint* restrict guesses,
                              const uint guess_count, global raster_code* restrict raster) {
  const uints functions = NUTIK_TO_UINTS(
      NUTIK_LOAD(function_of_lane + pixels->tile * NUTIK_TILE_PIXELS + pixels->lane));
  uint codes[NUTIK_CHANNELS][NUTIK_LANES];
#pragma unroll
  for (uint channel = 0; channel < NUTIK_CHANNELS; ++channel) {
    const Sums sum = load_sums(sums + sums_at(pixels->tile, NUTIK_CHANNELS, channel, pixels->lane));
    const Lights light = developed(sum, scales, functions, thresholds[0]);
    NUTIK_STORE(codes_of(light, thresholds, guesses, guess_count), codes[channel]);
  }
  for (uint i = 0; i < pixels->count; ++i) {
#pragma unroll
    for (uint channel = 0; channel < NUTIK_CHANNELS; ++channel) {
      raster[(pixels->raster + i) * NUTIK_CHANNELS + channel] = (raster_code)codes[channel][i];
    }
  }
}

// raster: [pixel][channel][plane]
NUTIK_INLINE void write_sums(const Pixels* pixels, global const Sum* restrict sums, global Sum* restrict raster) {
  for (uint channel = 0; channel < NUTIK_CHANNELS; ++channel) {
    for (uint plane = 0; plane < NUTIK_SUM_PLANES; ++plane) {
      global const Sum* from = sums + sums_at(pixels->tile, NUTIK_CHANNELS, channel, pixels->lane) +
                               plane * NUTIK_TILE_PIXELS;
      for (uint i = 0; i < pixels->count; ++i) {
        raster[((pixels->raster + i) * NUTIK_CHANNELS + channel) * NUTIK_SUM_PLANES + plane] = from[i];
      }
    }
  }
}

kernel void develop_sums(global const Sum* restrict sums, const uint width, const uint height,
                         const ulong tile_count, global Sum* restrict raster) {
  const Item item = item_of(get_global_id(0), tile_count);
  for (size_t tile = item.first_tile; tile < item.last_tile; ++tile) {
    for (uint lane = item.lane; lane < item.lane + NUTIK_ITEM_PIXELS; lane += NUTIK_LANES) {
      const Pixels pixels = pixels_at(tile, lane, width, height);
      write_sums(&pixels, sums, raster);
    }
  }
}

kernel void develop_codes(global const Sum* restrict sums, global const LightScale* restrict scales,
                          global const uchar* restrict function_of_lane, const uint width,
                          const uint height, const ulong tile_count,
                          global const Threshold* restrict thresholds, global const uint* restrict guesses,
                          const uint guess_count, global raster_code* restrict raster) {
  const Item item = item_of(get_global_id(0), tile_count);
  for (size_t tile = item.first_tile; tile < item.last_tile; ++tile) {
    for (uint lane = item.lane; lane < item.lane + NUTIK_ITEM_PIXELS; lane += NUTIK_LANES) {
      const Pixels pixels = pixels_at(tile, lane, width, height);
      write_codes(&pixels, sums, scales, function_of_lane, thresholds, guesses, guess_count, raster);
    }
  }
}
