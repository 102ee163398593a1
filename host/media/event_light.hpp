// Light from the events of a contrast-detecting camera.
//
// Each event is a step of the logarithm of light at its pixel, up or down, from a light at the start:
//
//     light(t) = start · exp(up · n_up(t) − down · n_down(t))
//
// The logarithm is kept as it is; only the code that stands for light ends at white, so light that was above white comes
// back as it went. A code is that whose light is next: 16 bits, linear unless another transfer function is stated.
#pragma once

#include <string>
#include <vector>

#include "media/camera_events.hpp"
#include "media/changed_samples.hpp"
#include "media/clip.hpp"

namespace nutik {

struct EventLight {
  std::vector<std::uint16_t> start;  // codes before the first event
  ChangedSamples samples;
  std::int64_t end_ns = 0;
};

// A header of a few bytes may name a picture of gigabytes. Throws InputError if it has far more values than the file has
// events.
void check_picture_size(const Shape& shape, std::uint64_t events, const std::string& name);

// `info` is given the codes' format, facts and notes. `name` is the recording's.
[[nodiscard]] EventLight light_of_events(const CameraEvents& recording, const std::string& name,
                                         const ClipOptions& options, ClipInfo& info);

}  // namespace nutik
