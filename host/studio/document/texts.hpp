// Parts of a document as files and command lines have them.
#pragma once

#include <string>

#include "studio/document/document.hpp"

namespace nutik::studio {

// `2px`, `2px,M128=6px`, `M128=6px`; of none `0px`.
[[nodiscard]] std::string feather_text(const Feather& feather);
// A function file.
[[nodiscard]] std::string functions_text(const FunctionSet& functions);

}  // namespace nutik::studio
