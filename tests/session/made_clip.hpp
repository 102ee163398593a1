// A clip that a test makes, of dark pictures.
#pragma once

#include <algorithm>

#include "media/clip.hpp"

namespace nutik::test {

class MadeClip : public Clip {
 public:
  // Holds so many pictures, and announces as many or others.
  MadeClip(std::uint64_t pictures, std::uint64_t announced, Shape shape = {16, 8, 1}) : pictures_(pictures) {
    info_.format.shape = shape;
    info_.timing.rate = Rational{100, 1};
    info_.sample_count = announced;
  }
  [[nodiscard]] const ClipInfo& info() const override { return info_; }
  bool read(std::span<std::byte> raster) override {
    if (read_ == pictures_) return false;
    std::ranges::fill(raster, static_cast<std::byte>(read_++));
    return true;
  }

 protected:
  ClipInfo info_;

 private:
  std::uint64_t pictures_;
  std::uint64_t read_ = 0;
};

}  // namespace nutik::test
