// The kernels' sources, embedded at build time from kernels/*.cl.
#pragma once

namespace nutik {

extern const char* const k_expose_source;
extern const char* const k_develop_source;
extern const char* const k_layout_probe_source;

}  // namespace nutik
