// What a summary says of one exposure, or of many.
#pragma once

#include <string>

#include "session/exposed_picture.hpp"

namespace nutik::app {

class ExposureTally {
 public:
  void add(const ExposedPicture& exposed);

  // Of all pictures together.
  [[nodiscard]] const Saturation& saturation() const { return saturation_; }
  // Of the last one: its arithmetic, by the name that asks for it, and what rendering it did and took, in lines.
  [[nodiscard]] const std::string& precision() const { return precision_; }
  [[nodiscard]] const std::string& report() const { return report_; }

 private:
  Saturation saturation_;
  std::string precision_, report_;
};

}  // namespace nutik::app
