// Where built kernels and verdicts on them are kept, and where PoCL keeps what it builds.
//
//   always:  what is read from there was written by this user: native code is loaded, so nobody else may put it there.
//            A folder or a file that cannot be used costs time, and no picture
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace nutik {

// $XDG_CACHE_HOME/nutik-cl, or ~/.cache/nutik-cl; empty where neither is known.
[[nodiscard]] std::filesystem::path default_cache_folder();

// Why a folder is not used, a whole sentence with the way out: another user owns it, or may write to it. Empty where
// it can be used, or made.
[[nodiscard]] std::string flaw_of_cache(const std::filesystem::path& folder);

// Whether files can be written there, once the folder is made; an empty path is none.
[[nodiscard]] bool can_be_kept_in(const std::filesystem::path& folder);

// PoCL keeps code, too: in $XDG_CACHE_HOME/pocl/kcache, ~/.cache/pocl/kcache, else /tmp/pocl/kcache, where anybody may
// have put theirs. Where the first two are not this user's alone, cannot be written or have no room, POCL_CACHE_DIR is
// set to a folder of this user's among the temporary files. What the variable says already stays.
void choose_cache_of_pocl();
// Where it keeps it then.
[[nodiscard]] std::filesystem::path cache_of_pocl();
// Why the folder in POCL_CACHE_DIR is not to be used, a clause; empty where it can. Makes the one that was chosen
// above.
[[nodiscard]] std::string flaw_of_pocl_cache();

// A file's bytes; none where there is no file of this user's alone, or one too large to be ours.
[[nodiscard]] std::string read_from_cache(const std::filesystem::path& path);

// Whole or not at all, into a folder that is made for this user alone; what cannot be written is no error.
void write_to_cache(const std::filesystem::path& path, std::string_view bytes);

}  // namespace nutik
