// The kernels' sources, embedded at build time from kernels/*.cl.
#pragma once

namespace nutik {

extern const char* const kExposeSource;
extern const char* const kDevelopSource;
extern const char* const kLayoutProbeSource;

}  // namespace nutik
