// Where built kernels and verdicts on them are kept.
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

// A file's bytes; none where there is no file of this user's alone.
[[nodiscard]] std::string read_from_cache(const std::filesystem::path& path);

// Whole or not at all, into a folder that is made for this user alone; what cannot be written is no error.
void write_to_cache(const std::filesystem::path& path, std::string_view bytes);

}  // namespace nutik
