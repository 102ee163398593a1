// Pictures of a camera's sensor (DNG), developed by LibRaw to linear light in BT.709's primaries, 16 bits a channel.
#pragma once

#include <filesystem>
#include <memory>

#include "capture/picture.hpp"

namespace nutik::stills {

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
