// A slit-scan: strips of a picture side by side, each exposed later than the one before it.
#pragma once

#include <cstdint>
#include <string>

#include "imev/capture_source.hpp"
#include "session/making/study_request.hpp"

namespace nutik {

// As many strips as are wanted, as pictures, or as pixels from side to side, whichever is least, at moments spread over all
// of the time. Throws InputError where that is a single one.
[[nodiscard]] Study slit_study(CaptureSource& capture, const std::string& name, std::uint32_t wanted,
                               SlitFrom from);

}  // namespace nutik
