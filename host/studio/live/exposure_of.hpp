// What a document asks the engine for.
#pragma once

#include "session/requests/exposure_request.hpp"
#include "studio/document/document.hpp"

namespace nutik::studio {

// `mask` stands in place of the document's: the same, feathered. The exposure that the command line is given by
// command_line() (window/project_file.hpp).
[[nodiscard]] ExposureRequest exposure_of(const DocumentState& state,
                                          const std::optional<Shared<MaskWithRegions>>& mask);

}  // namespace nutik::studio
