#pragma once

#include <memory>

#include "align/flow.hpp"

namespace nutik::motion {

[[nodiscard]] std::unique_ptr<FlowFinder> open_dense_flow();

}  // namespace nutik::motion
