// A slit-scan: columns of a picture, each exposed later than the one to its left.
#pragma once

#include <cstdint>
#include <string>

#include "imev/capture_source.hpp"
#include "session/making/study_request.hpp"

namespace nutik {

// As many columns as are wanted, as pictures, or as pixels in a row, whichever is least, at moments spread over all of the
// time. Throws InputError where that is a single one.
[[nodiscard]] Study slit_study(CaptureSource& capture, const std::string& name, std::uint32_t wanted);

}  // namespace nutik
