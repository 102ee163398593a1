// Parts of a document as files and command lines have them.
#pragma once

#include <string>

#include "studio/document/document.hpp"

namespace nutik::studio {

// `2px`, of hundredths of a pixel.
[[nodiscard]] std::string feather_text(int feather);
// A function file.
[[nodiscard]] std::string functions_text(const FunctionSet& functions);

}  // namespace nutik::studio
