// What Vision Research's .cine files (Phantom cameras) tell of their pictures and FFmpeg does not
// hand on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace nutik::videos {

struct CineHeader {
  std::vector<std::int64_t> starts_ns;     // of each picture, by the camera's clock; the first is 0
  std::optional<std::int64_t> exposed_ns;  // of each picture, where all were exposed alike
  bool is_packed_12 = false;               // two pixels in three bytes
  std::uint32_t black_code = 0;            // the code of a picture without light
};

// Empty where the file is no .cine. Lists are empty where the file holds none, or not one for each
// picture.
[[nodiscard]] std::optional<CineHeader> read_cine_header(const std::filesystem::path& path);

}  // namespace nutik::videos
