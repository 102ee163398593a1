// Where files lie that nobody keeps.
#pragma once

#include <filesystem>

namespace nutik {

// The one that TMPDIR names, else /tmp. Throws OutputError where that is no folder.
[[nodiscard]] std::filesystem::path temporary_folder();

}  // namespace nutik
