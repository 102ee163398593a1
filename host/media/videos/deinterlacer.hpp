// Whole pictures from interlaced ones, by FFmpeg's bwdif: lines that a field lacks follow from its neighbours in place
// and in time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "media/clip.hpp"
#include "media/videos/filters.hpp"

namespace nutik::videos {

enum class FieldOrder { top_first, bottom_first };
[[nodiscard]] std::string_view to_text(FieldOrder order);
// What a stream says of its fields; none of progressive video, and where it does not say.
[[nodiscard]] std::optional<FieldOrder> field_order(AVFieldOrder order);
// The order in which an interlaced picture's fields were filmed.
[[nodiscard]] FieldOrder order_of(const AVFrame& frame);

// A clip of which every picture becomes two: twice as fast, the second half-way to the next picture.
[[nodiscard]] ClipInfo of_fields(ClipInfo&& info);

class Deinterlacer {
 public:
  // The one that is worked on, its neighbours in time, and what they become.
  static constexpr std::uint64_t kHeldPictures = 4;

  // For pictures like this one. Throws InputError naming the file where this FFmpeg lacks the filter.
  Deinterlacer(const AVFrame& like, bool of_each_field, const std::string& name);

  void add(AVFrame& frame);
  void end() { filters_.add(nullptr); }
  // The next picture; false where more frames are needed, or none is left.
  bool take(AVFrame& picture) { return filters_.take(picture); }

 private:
  Filters filters_;
  std::int64_t frames_ = 0;
};

}  // namespace nutik::videos
