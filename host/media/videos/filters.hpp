// Pictures and sound through FFmpeg's filters.
#pragma once

#include "media/videos/libav.hpp"  // FFmpeg's headers ask for <cstdint> before them

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wpedantic"
extern "C" {
#include <libavfilter/avfilter.h>
#include <libavfilter/buffersink.h>
#include <libavfilter/buffersrc.h>
}
#pragma GCC diagnostic pop

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "media/clip.hpp"
#include "media/module.hpp"

namespace nutik::videos {

// What nutik-filters.so gives: libavfilter, which with all that it needs takes as long to load as FFmpeg's decoders.
struct FilterModule {
  static constexpr const char* kFile = "nutik-filters.so";
  static constexpr const char* kSymbol = "nutik_filter_module";
  static constexpr const char* kWithout = "nothing can be deinterlaced, and neither GIF nor sound can be written";

  void (*use_shared_state)(SharedState& of_program);  // first
  decltype(&avfilter_graph_alloc) graph_alloc;
  decltype(&avfilter_graph_free) graph_free;
  decltype(&avfilter_graph_parse2) graph_parse;
  decltype(&avfilter_graph_config) graph_config;
  decltype(&avfilter_graph_get_filter) graph_get_filter;
  decltype(&av_buffersrc_add_frame) add_frame;
  decltype(&av_buffersink_get_frame) get_frame;
  decltype(&av_buffersink_get_format) get_format;
  decltype(&av_buffersink_get_time_base) get_time_base;
};

struct FreeGraph {
  void operator()(AVFilterGraph* graph) const { module<FilterModule>().graph_free(&graph); }
};
using GraphPointer = std::unique_ptr<AVFilterGraph, FreeGraph>;

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

enum class FieldOrder { top_first, bottom_first };
[[nodiscard]] std::string_view to_text(FieldOrder order);
// What a stream says of its fields; none of progressive video, and where it does not say.
[[nodiscard]] std::optional<FieldOrder> field_order(AVFieldOrder order);
// The order in which an interlaced picture's fields were filmed.
[[nodiscard]] FieldOrder order_of(const AVFrame& frame);

// A clip of which every picture becomes two: twice as fast, the second half-way to the next picture.
[[nodiscard]] ClipInfo of_fields(ClipInfo&& info);

// Whole pictures from interlaced ones, by FFmpeg's bwdif: lines that a field lacks follow from its neighbours in place
// and in time.
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
