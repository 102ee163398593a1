// Scenes that no cut parts: one fades into another, or is wiped away.
#pragma once

#include <vector>

#include "imev/capture_source.hpp"
#include "session/requests/source_request.hpp"

namespace nutik {

// The pictures of a shot that each show one scene, apart from each other, the longest and those half as long or more.
// None where all of the shot shows one, too little of it has texture, or all are short. `shot` counts the clip's
// pictures.
[[nodiscard]] std::vector<SampleRange> scenes_of(const SourceRequest& source, SampleRange shot);

}  // namespace nutik
