// Functions and masks that change along a film: what they are at key frames, and between them.
//
//   in:      keys, in nanoseconds of the film from its first frame on
//   out:     the functions and the mask of any moment of the film
//   always:  before the first key and after the last the nearest one holds. A moment's functions and mask follow from
//            that moment alone, so that every frame is an exposure of its own
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "capture/frame_times.hpp"
#include "mask/feather.hpp"
#include "mask/mask_between.hpp"
#include "session/requests/exposure_request.hpp"

namespace nutik {

struct FunctionKey {
  std::int64_t film_ns = 0;
  std::string name;  // of the file, for messages
  Shared<FunctionSet> functions;
};

struct MaskKey {
  std::int64_t film_ns = 0;
  std::string name;
  std::string checksum;  // as recipes know it
  Shared<Mask> mask;     // without a feather
};

// Between masks[key] and the next, `way` of kWholeWay from the first.
struct MaskMoment {
  std::size_t key = 0;
  std::uint32_t way = 0;  // below kWholeWay
};

struct KeyFrames {
  std::vector<FunctionKey> functions;  // none: those of the exposure
  std::vector<MaskKey> masks;          // none: that of the exposure
  MaskBlend blend = MaskBlend::distance;
  std::optional<Feather> feather;  // of all masks

  [[nodiscard]] bool empty() const { return functions.empty() && masks.empty(); }

  // Throws UsageError where there is only one key of a kind, or one is not after the one before it or before the film;
  // InputError where functions are for other mask values than those of the first key, or masks do not blend.
  void check() const;

  [[nodiscard]] FunctionSet functions_at(std::int64_t film_ns) const;
  [[nodiscard]] MaskMoment mask_moment(std::int64_t film_ns) const;
  [[nodiscard]] Mask mask_at(std::int64_t film_ns) const;

  // `exposure` with the functions and the mask of a moment, where there are keys of them.
  [[nodiscard]] ExposureRequest exposure_at(std::int64_t film_ns, const ExposureRequest& exposure) const;
};

// The mask between two, with its edges blended: by distance after the edges moved, by alpha before one fades into the
// other. Throws what mask_between() and feathered() do.
[[nodiscard]] Mask blended_mask(const Mask& a, const std::string& a_name, const Mask& b,
                                const std::string& b_name, MaskBlend blend, std::uint32_t way,
                                const std::optional<Feather>& feather);

// A moment of a film: in seconds, or by the number of a frame, whose start it is. Throws UsageError naming `what` where
// that is before the film.
[[nodiscard]] std::int64_t film_moment_ns(const StatedTime& time, const std::string& what,
                                          const FrameTimes& film);

}  // namespace nutik
