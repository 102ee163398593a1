// What lies beside the program: in the folder that it was installed or unpacked into.
#pragma once

#include <filesystem>
#include <vector>

namespace nutik {

// Where parts of the program are looked for, in this order: beside the program or library that this code was linked
// into, and in the installed place of modules as seen from there.
[[nodiscard]] std::vector<std::filesystem::path> own_folders();

// Where the system knows no fonts (no /etc/fonts/fonts.conf), those that lie beside the program, if any do. To be
// called before threads are started: it sets FONTCONFIG_FILE, unless that is set.
void use_own_fonts();

}  // namespace nutik
