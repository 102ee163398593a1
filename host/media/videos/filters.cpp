#include "media/videos/filters.hpp"

#include <utility>

namespace nutik::videos {

Filters::Filters(const AVFrame& like, const std::string& chain, Fail fail)
    : fail_(std::move(fail)), graph_(allocated(module<FilterModule>().graph_alloc())) {
  graph_->nb_threads = 1;  // decoding and encoding have the others
  AVFilterInOut *in = nullptr, *out = nullptr;  // none is left open
  const std::string all =
      format("buffer@in=video_size={}x{}:pix_fmt={}:time_base=1/2:pixel_aspect=1/1,{},buffersink@out", like.width,
             like.height, like.format, chain);
  check(module<FilterModule>().graph_parse(graph_.get(), all.c_str(), &in, &out));
  check(module<FilterModule>().graph_config(graph_.get(), nullptr));
  source_ = allocated(module<FilterModule>().graph_get_filter(graph_.get(), "buffer@in"));
  sink_ = allocated(module<FilterModule>().graph_get_filter(graph_.get(), "buffersink@out"));
}

void Filters::add(AVFrame* frame) { check(module<FilterModule>().add_frame(source_, frame)); }

bool Filters::take(AVFrame& picture) {
  av_frame_unref(&picture);
  const int code = module<FilterModule>().get_frame(sink_, &picture);
  if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return false;
  check(code);
  return true;
}

AVPixelFormat Filters::pixels() const { return static_cast<AVPixelFormat>(module<FilterModule>().get_format(sink_)); }

}  // namespace nutik::videos
