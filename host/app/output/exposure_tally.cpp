#include "app/output/exposure_tally.hpp"

#include "session/exposed_picture.hpp"

namespace nutik::app {

void ExposureTally::add(const ExposedPicture& exposed) {
  saturation_ += exposed.saturation;
  precision_ = to_text(exposed.precision);
  report_ = rendering_report(exposed, exposed.output);
}

}  // namespace nutik::app
