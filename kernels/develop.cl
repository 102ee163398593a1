// Develops a picture: sums to codes, tiles to rows of pixels.
//
//   in:    sums [tile][channel][plane][64] of expose.cl; with NUTIK_BLENDS a tile that functions share has sums for
//          each of them, and what share of each pixel they have, of 65535
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

#ifndef NUTIK_BLENDS
#error "NUTIK_BLENDS is not set: 1 where functions share pixels, else 0"
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
NUTIK_INLINE uints codes_of(const Lights light, global const Threshold* thresholds,
                            global const uint* guesses, const uint guess_count) {
  const reals root = sqrt(share_of_white(light, thresholds[0]));
  const uints step = min(NUTIK_TO_UINTS(root * guess_count), (uints)(guess_count - 1));
  const uints guess = NUTIK_GATHER_UINTS(guesses, step);
  return guess + one_where_reached(thresholds, guess + 1, light);
}

NUTIK_INLINE void make_codes(const Lights* lights, global const Threshold* thresholds, global const uint* guesses,
                             const uint guess_count, uint codes[NUTIK_CHANNELS][NUTIK_LANES]) {
#pragma unroll
  for (uint channel = 0; channel < NUTIK_CHANNELS; ++channel) {
    NUTIK_STORE(codes_of(lights[channel], thresholds, guesses, guess_count), codes[channel]);
  }
}

NUTIK_INLINE void write_codes(const Pixels* pixels, uint codes[NUTIK_CHANNELS][NUTIK_LANES],
                              global raster_code* raster) {
  for (uint i = 0; i < pixels->count; ++i) {
#pragma unroll
    for (uint channel = 0; channel < NUTIK_CHANNELS; ++channel) {
      raster[(pixels->raster + i) * NUTIK_CHANNELS + channel] = (raster_code)codes[channel][i];
    }
  }
}

NUTIK_INLINE uints functions_of(global const function_index* function_of_lane, const size_t tile,
                                const uint lane) {
  return NUTIK_TO_UINTS(NUTIK_LOAD(function_of_lane + tile * NUTIK_TILE_PIXELS + lane));
}

// Light of a tile's sums, by channel, between 0 and white.
NUTIK_INLINE void develop_tile(const size_t tile, const uint lane, global const Sum* sums,
                               global const LightScale* scales, global const function_index* function_of_lane,
                               const Threshold white, Lights* lights) {
  const uints functions = functions_of(function_of_lane, tile, lane);
#pragma unroll
  for (uint channel = 0; channel < NUTIK_CHANNELS; ++channel) {
    const Sums sum = load_sums(sums + sums_at(tile, NUTIK_CHANNELS, channel, lane));
    lights[channel] = developed(sum, scales, functions, white);
  }
}

// raster: [pixel][channel][plane]
NUTIK_INLINE void write_sums(const Pixels* pixels, global const Sum* sums, global Sum* raster) {
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

#if NUTIK_BLENDS
// The same of the sums of the tiles `first` to `last`, each one function's: Σ share · light.
NUTIK_INLINE void blend_tiles(const size_t first, const size_t last, const uint lane, global const Sum* sums,
                              global const LightScale* blend_scales,
                              global const function_index* function_of_lane, global const ushort* shares,
                              const uint blend_shift, const Threshold white, Lights* lights) {
#pragma unroll
  for (uint channel = 0; channel < NUTIK_CHANNELS; ++channel) {
    Sums blend = zero();
    for (size_t tile = first; tile < last; ++tile) {
      const Weights share = share_weights(NUTIK_TO_UINTS(NUTIK_LOAD(shares + tile * NUTIK_TILE_PIXELS + lane)));
      const Sums sum = load_sums(sums + sums_at(tile, NUTIK_CHANNELS, channel, lane));
      blend = add_product(share, unbounded(sum, blend_scales, functions_of(function_of_lane, tile, lane)), blend);
    }
    lights[channel] = blended(blend, blend_shift, white);
  }
}

// Codes of pixels that one function of a shared tile has alone are made of its light as it is: where lights are blended
// they are coarser, in `fixed` by as much as another function's gain asks for.
NUTIK_INLINE void make_lone_codes(const size_t first, const size_t last, const uint lane, global const Sum* sums,
                                  global const LightScale* scales, global const function_index* function_of_lane,
                                  global const ushort* shares, global const Threshold* thresholds,
                                  global const uint* guesses, const uint guess_count,
                                  uint codes[NUTIK_CHANNELS][NUTIK_LANES]) {
  for (size_t tile = first; tile < last; ++tile) {
    bool any = false;
    for (uint i = 0; i < NUTIK_LANES; ++i) any |= shares[tile * NUTIK_TILE_PIXELS + lane + i] == 65535;
    if (!any) continue;
    Lights own_lights[NUTIK_CHANNELS];
    uint own_codes[NUTIK_CHANNELS][NUTIK_LANES];
    develop_tile(tile, lane, sums, scales, function_of_lane, thresholds[0], own_lights);
    make_codes(own_lights, thresholds, guesses, guess_count, own_codes);
    for (uint i = 0; i < NUTIK_LANES; ++i) {
      if (shares[tile * NUTIK_TILE_PIXELS + lane + i] != 65535) continue;
      for (uint channel = 0; channel < NUTIK_CHANNELS; ++channel) codes[channel][i] = own_codes[channel][i];
    }
  }
}

// first_tiles: of each tile of the band, and one more, where its sums begin.
kernel void blend_codes(global const Sum* restrict sums, global const LightScale* restrict scales,
                        global const LightScale* restrict blend_scales,
                        global const function_index* restrict function_of_lane, global const uint* restrict first_tiles,
                        global const ushort* restrict shares, const uint blend_shift, const uint width,
                        const uint height, const ulong tile_count, global const Threshold* restrict thresholds,
                        global const uint* restrict guesses, const uint guess_count,
                        global raster_code* restrict raster) {
  const Item item = item_of(get_global_id(0), tile_count);
  for (size_t tile = item.first_tile; tile < item.last_tile; ++tile) {
    const size_t first = first_tiles[tile], last = first_tiles[tile + 1];
    for (uint lane = item.lane; lane < item.lane + NUTIK_ITEM_PIXELS; lane += NUTIK_LANES) {
      const Pixels pixels = pixels_at(tile, lane, width, height);
      Lights lights[NUTIK_CHANNELS];
      uint codes[NUTIK_CHANNELS][NUTIK_LANES];
      if (last == first + 1) {
        develop_tile(first, lane, sums, scales, function_of_lane, thresholds[0], lights);
      } else {
        blend_tiles(first, last, lane, sums, blend_scales, function_of_lane, shares, blend_shift, thresholds[0],
                    lights);
      }
      make_codes(lights, thresholds, guesses, guess_count, codes);
      if (last > first + 1) {
        make_lone_codes(first, last, lane, sums, scales, function_of_lane, shares, thresholds, guesses, guess_count,
                        codes);
      }
      write_codes(&pixels, codes, raster);
    }
  }
}
#else
kernel void develop_codes(global const Sum* restrict sums, global const LightScale* restrict scales,
                          global const function_index* restrict function_of_lane, const uint width,
                          const uint height, const ulong tile_count,
                          global const Threshold* restrict thresholds, global const uint* restrict guesses,
                          const uint guess_count, global raster_code* restrict raster) {
  const Item item = item_of(get_global_id(0), tile_count);
  for (size_t tile = item.first_tile; tile < item.last_tile; ++tile) {
    for (uint lane = item.lane; lane < item.lane + NUTIK_ITEM_PIXELS; lane += NUTIK_LANES) {
      const Pixels pixels = pixels_at(tile, lane, width, height);
      Lights lights[NUTIK_CHANNELS];
      uint codes[NUTIK_CHANNELS][NUTIK_LANES];
      develop_tile(tile, lane, sums, scales, function_of_lane, thresholds[0], lights);
      make_codes(lights, thresholds, guesses, guess_count, codes);
      write_codes(&pixels, codes, raster);
    }
  }
}

// Adds to counts[0] the pixels of a part of the picture that have a channel below limits[0], to counts[1] those with
// one from limits[1] on: lights, on the scale on which they are blended, that have no code.
kernel void count_saturated(global const Sum* restrict sums, global const LightScale* restrict blend_scales,
                            global const function_index* restrict function_of_lane, const uint width, const uint height,
                            const ulong tile_count, const uint left, const uint top, const uint right,
                            const uint bottom, global const Threshold* restrict limits,
                            global uint* restrict counts) {
  const Item item = item_of(get_global_id(0), tile_count);
  uint below = 0, above = 0;
  for (size_t tile = item.first_tile; tile < item.last_tile; ++tile) {
    for (uint lane = item.lane; lane < item.lane + NUTIK_ITEM_PIXELS; lane += NUTIK_LANES) {
      const Pixels pixels = pixels_at(tile, lane, width, height);
      const uints functions = functions_of(function_of_lane, tile, lane);
      uints are_below = (uints)(0), are_above = (uints)(0);
#pragma unroll
      for (uint channel = 0; channel < NUTIK_CHANNELS; ++channel) {
        const Sums sum = load_sums(sums + sums_at(tile, NUTIK_CHANNELS, channel, lane));
        const Lights light = unbounded(sum, blend_scales, functions);
        are_below |= one_where_less(light, limits[0]);
        are_above |= (uints)(1) - one_where_less(light, limits[1]);
      }
      uint is_below[NUTIK_LANES], is_above[NUTIK_LANES];
      NUTIK_STORE(are_below, is_below);
      NUTIK_STORE(are_above, is_above);
      const uint x = (uint)(pixels.raster % width), y = (uint)(pixels.raster / width);
      if (y < top || y >= bottom) continue;
      for (uint i = 0; i < pixels.count; ++i) {
        if (x + i < left || x + i >= right) continue;
        below += is_below[i];
        above += is_above[i];
      }
    }
  }
  if (below > 0) atomic_add(counts, below);
  if (above > 0) atomic_add(counts + 1, above);
}
#endif
