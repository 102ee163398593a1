#include "features/film/key_frames.hpp"

#include <algorithm>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/key_frame_values.hpp"
#include "session/text/number_text.hpp"

namespace nutik {
namespace {

// The key that holds at a moment, or comes before it, and how far it is to the next one.
struct Place {
  std::size_t key;
  KeyShare share;
};

template <typename Key>
Place place_of(const std::vector<Key>& keys, std::int64_t film_ns) {
  const auto next = std::ranges::upper_bound(keys, film_ns, {}, &Key::film_ns);
  if (next == keys.begin()) return {0, {}};
  const auto before = next - 1;
  const auto key = static_cast<std::size_t>(before - keys.begin());
  if (next == keys.end()) return {key, {}};
  return {key, {film_ns - before->film_ns, next->film_ns - before->film_ns}};
}

template <typename Key>
void check_order(const std::vector<Key>& keys, const char* of_what, const char* way_out) {
  if (keys.size() == 1) {
    throw UsageError(format("{} is the only key of {}; two or more make them change, {}", keys.front().name,
                            of_what, way_out));
  }
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (keys[i - 1].film_ns < keys[i].film_ns) continue;
    throw UsageError(format("the key {} at {} is not after {} at {}; keys are in order of time", keys[i].name,
                            duration_text(keys[i].film_ns), keys[i - 1].name,
                            duration_text(keys[i - 1].film_ns)));
  }
}

void require_regions(const FunctionKey& has, const FunctionKey& lacks) {
  for (const auto& [tag, function] : *has.functions) {
    if (lacks.functions->contains(tag)) continue;
    throw InputError(format("{} has a function M{} and {} has none; keys have functions for the same mask values",
                            has.name, tag, lacks.name));
  }
}

}  // namespace

void KeyFrames::check() const {
  check_order(functions, "functions", "and one alone is a file of functions for the whole film");
  check_order(masks, "masks", "and one alone is a mask for the whole film");
  for (std::size_t i = 1; i < functions.size(); ++i) {
    require_regions(functions[0], functions[i]);
    require_regions(functions[i], functions[0]);
  }
  for (std::size_t i = 1; i < masks.size(); ++i) {
    static_cast<void>(
        mask_between(*masks[i - 1].mask, masks[i - 1].name, *masks[i].mask, masks[i].name, blend, 0));
  }
}

FunctionSet KeyFrames::functions_at(std::int64_t film_ns) const {
  const auto [key, share] = place_of(functions, film_ns);
  if (share.passed == 0) return *functions[key].functions;
  FunctionSet between;
  for (const auto& [tag, function] : *functions[key].functions) {
    between.emplace(tag, function_between(function, functions[key + 1].functions->at(tag), share));
  }
  return between;
}

MaskMoment KeyFrames::mask_moment(std::int64_t film_ns) const {
  const auto [key, share] = place_of(masks, film_ns);
  const auto way = static_cast<std::uint32_t>(time_between(0, kWholeWay, share));
  if (way == kWholeWay) return {key + 1, 0};  // rounded up
  return {key, way};
}

Mask KeyFrames::mask_at(std::int64_t film_ns) const {
  const auto [key, way] = mask_moment(film_ns);
  const MaskKey& from = masks[key];
  const MaskKey& to = way > 0 ? masks[key + 1] : from;
  return blended_mask(*from.mask, from.name, *to.mask, to.name, blend, way, feather);
}

ExposureRequest KeyFrames::exposure_at(std::int64_t film_ns, const ExposureRequest& exposure) const {
  ExposureRequest own = exposure;
  if (!functions.empty()) own.gains = Shared(functions_at(film_ns));
  if (!masks.empty()) own.mask = Shared(MaskWithRegions(mask_at(film_ns)));
  return own;
}

Mask blended_mask(const Mask& a, const std::string& a_name, const Mask& b, const std::string& b_name,
                  MaskBlend blend, std::uint32_t way, const std::optional<Feather>& feather) {
  if (!feather) return mask_between(a, a_name, b, b_name, blend, way);
  if (way == 0) return feathered(a, *feather);
  if (blend == MaskBlend::distance) return feathered(mask_between(a, a_name, b, b_name, blend, way), *feather);
  return mask_between(feathered(a, *feather), a_name, feathered(b, *feather), b_name, blend, way);
}

std::int64_t film_moment_ns(const StatedTime& time, const std::string& what, const FrameTimes& film) {
  if (time.number.numerator < 0) {
    throw UsageError(format("{} {} lies before the film, which begins at 0s", what, time.text()));
  }
  if (!time.counts_samples()) return time.nanoseconds();
  constexpr std::int64_t kMaxFrames = 1'000'000'000;
  if (time.number.denominator != 1 || time.number.numerator > kMaxFrames) {
    throw UsageError(format("{} {} is no frame of a film; frames have whole numbers up to {}", what,
                            time.text(), kMaxFrames));
  }
  return film.start_ns(static_cast<std::uint64_t>(time.number.numerator));
}

}  // namespace nutik
