// Pictures through FFmpeg's filters.
#pragma once

#include <functional>
#include <string>

#include "media/videos/libav.hpp"

namespace nutik::videos {

class Filters {
 public:
  // What ends the work where FFmpeg refuses something; throws.
  using Fail = std::function<void(int code)>;

  // `chain` as in `ffmpeg -vf`, of pictures like this one. Times are halves of a second, which nothing but bwdif minds.
  Filters(const AVFrame& like, const std::string& chain, Fail fail);

  // Takes over what the frame refers to. Null: no frame follows.
  void add(AVFrame* frame);
  // The next picture; false where more frames are needed, or none is left.
  bool take(AVFrame& picture);
  [[nodiscard]] AVPixelFormat pixels() const;  // of what is taken

 private:
  void check(int code) const {
    if (code < 0) fail_(code);
  }

  Fail fail_;
  GraphPointer graph_;
  AVFilterContext* source_ = nullptr;
  AVFilterContext* sink_ = nullptr;
};

}  // namespace nutik::videos
