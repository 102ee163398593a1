// What several files hold beside a picture, or in place of one: grey pictures of light, all of one size, each with a name.
#pragma once

#include <string>

#include "capture/picture.hpp"

namespace nutik {

struct PictureLayer {
  std::string name;
  std::string text;  // what its values are
  Picture values;
};

}  // namespace nutik
