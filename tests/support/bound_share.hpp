// How much of its bound a picture of any format uses up.
#pragma once

#include "render/error_bound.hpp"
#include "render/render_plan.hpp"
#include "support/rendering.hpp"

namespace nutik::test {

// The largest share over all values: how far each is from what `light`, the reference's light64, asks for, beyond the
// format's own rounding, in what error_bound() of this output allows its function. At most 1.
//
//   codes    beyond half a code, from where the light lies on the output's scale of codes
//   light32  beyond half of the last place
[[nodiscard]] Difference share_of_bound(const RenderPlan& plan, const ErrorBound& bound,
                                        const OutputFormat& output, const Picture& picture,
                                        const Picture& light);

}  // namespace nutik::test
