// Where pictures differ whose exposures differ in their masks alone.
#pragma once

#include <QRect>
#include <optional>

#include "session/below/regions.hpp"
#include "session/requests/exposure_request.hpp"
#include "session/shared.hpp"

namespace nutik::studio {

// The least rectangle that holds all pixels whose tags differ. Everything where one of the masks is soft or missing.
[[nodiscard]] QRect changed_pixels(const std::optional<Shared<MaskWithRegions>>& before,
                                   const std::optional<Shared<MaskWithRegions>>& now, const QRect& everything);

}  // namespace nutik::studio
