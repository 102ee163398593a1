// Pictures of a camera's sensor (DNG), developed by LibRaw to linear light in BT.709's primaries, 16 bits a channel.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "capture/picture.hpp"
#include "capture/rational.hpp"

namespace nutik::stills {

// When a picture was taken, as far as its tags tell.
struct RawTags {
  std::optional<std::int64_t> exposure_ns;  // longer than nothing
  std::optional<Rational> rate;             // pictures a second, of CinemaDNG; above 0
  std::string date, fraction, zone;  // DateTimeOriginal, SubSecTimeOriginal, OffsetTimeOriginal, or empty
};

// Throws InputError where the file is no picture of a sensor.
[[nodiscard]] RawTags read_raw_tags(const std::filesystem::path& file);

// Develops all pictures of a sequence as its first: by its black and white level, white balance and colour matrix, for
// with each picture's own a sequence would flicker. Nothing is brightened.
class RawDeveloper {
 public:
  RawDeveloper();
  ~RawDeveloper();

  // Throws InputError where the file cannot be read.
  [[nodiscard]] Picture develop(const std::filesystem::path& file);

 private:
  struct Levels;
  std::unique_ptr<Levels> first_;
};

}  // namespace nutik::stills
