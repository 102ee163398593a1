// How the file of a capture begins: as a Netpbm picture whose first comment says that there is more behind it.
#pragma once

#include <string_view>

namespace nutik {

inline constexpr std::string_view kCaptureComment = "# TIK ";

// Whether bytes begin as a Netpbm file does, be it one that is read as a still (media/formats/input_kinds.hpp) or not.
[[nodiscard]] inline bool begins_as_netpbm(std::string_view bytes) {
  return bytes.size() > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '7' &&
         (bytes[2] == '\n' || bytes[2] == '\r' || bytes[2] == ' ' || bytes[2] == '\t');
}

// Whether they begin as a .tik of any version does.
[[nodiscard]] inline bool begins_as_capture(std::string_view bytes) {
  return begins_as_netpbm(bytes) && bytes.substr(3).starts_with(kCaptureComment);
}

}  // namespace nutik
