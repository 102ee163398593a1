// The kernels' sources, embedded at build time from kernels/*.cl.
#pragma once

#include <string_view>

namespace nutik {

// The source of kernels/<name>.cl, what it includes in place; null if there is no such kernel.
[[nodiscard]] const char* kernel_source(std::string_view name);

}  // namespace nutik
