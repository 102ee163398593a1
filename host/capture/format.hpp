// format(): the standard library's where it has one, else fmt's. The core builds with nothing but a
// C++20 compiler and OpenCL where <format> exists, and with Debian 12's GCC 12, which lacks it, through
// fmt. Only the syntax that both share is used.
#pragma once

#if __has_include(<format>)
#include <format>
#endif

#ifdef __cpp_lib_format
namespace nutik {
using std::format;
}
#else
#include <fmt/format.h>
namespace nutik {
using fmt::format;
}
#endif
