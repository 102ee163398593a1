#include "studio/live/exposure_of.hpp"

#include <cmath>

namespace nutik::studio {

ExposureRequest exposure_of(const DocumentState& state, const std::optional<Shared<MaskWithRegions>>& mask) {
  ExposureRequest request;
  request.gain = std::exp2(state.brightness_ev);
  request.normalization = state.normalization;
  if (state.mode == ExposureMode::boxcar) {
    request.start = StatedTime::of_nanoseconds(state.boxcar.start_ns);
    request.gains = PlainInterval{StatedTime::of_nanoseconds(state.boxcar.length_ns), Shutter()};
    return request;
  }
  request.gains = Shared(FunctionSet(state.functions));
  request.mask = mask;
  return request;
}

}  // namespace nutik::studio
