#include "media/videos/filters.hpp"

#include <utility>

namespace nutik::videos {
namespace {

// Whether pixels are the same but for where their components lie.
bool is_alike(AVPixelFormat a, AVPixelFormat b) {
  const AVPixFmtDescriptor &x = *av_pix_fmt_desc_get(a), &y = *av_pix_fmt_desc_get(b);
  return x.comp[0].depth == y.comp[0].depth && x.log2_chroma_w == y.log2_chroma_w &&
         x.log2_chroma_h == y.log2_chroma_h && (x.nb_components >= 3) == (y.nb_components >= 3) &&
         (x.flags & AV_PIX_FMT_FLAG_RGB) == (y.flags & AV_PIX_FMT_FLAG_RGB);
}

}  // namespace

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

std::string_view to_text(FieldOrder order) {
  return order == FieldOrder::top_first ? "top field first" : "bottom field first";
}

std::optional<FieldOrder> field_order(AVFieldOrder order) {
  // By its definition the second letter is the field that is shown first. But files whose frames hold both fields, line
  // by line, have TB where the top field is shown first, and FFmpeg's own decoder of plain pictures reads it so.
  switch (order) {
    case AV_FIELD_TT:
    case AV_FIELD_TB: return FieldOrder::top_first;
    case AV_FIELD_BB:
    case AV_FIELD_BT: return FieldOrder::bottom_first;
    default: return std::nullopt;
  }
}

FieldOrder order_of(const AVFrame& frame) {
  return is_top_field_first(frame) ? FieldOrder::top_first : FieldOrder::bottom_first;
}

ClipInfo of_fields(ClipInfo&& info) {
  ClipTiming& timing = info.timing;
  if (timing.rate) timing.rate = Rational::of(2 * timing.rate->numerator, timing.rate->denominator);
  const std::vector<std::int64_t> frames = std::exchange(timing.starts_ns, {});
  for (std::size_t k = 0; k < frames.size(); ++k) {
    timing.starts_ns.push_back(frames[k]);
    const bool is_last = k + 1 == frames.size();
    const std::int64_t period_ns =
        is_last ? (k > 0 ? frames[k] - frames[k - 1] : 2) : frames[k + 1] - frames[k];
    timing.starts_ns.push_back(frames[k] + period_ns / 2);
  }
  if (info.sound && info.sample_count > 1) {
    ClipSound& sound = *info.sound;
    sound.last_s += (sound.last_s - sound.first_s) / static_cast<double>(info.sample_count - 1) / 2;
  }
  info.sample_count *= 2;
  return std::move(info);
}

Deinterlacer::Deinterlacer(const AVFrame& like, bool of_each_field, const std::string& name)
    : filters_(like, format("bwdif=mode={}:parity=auto:deint=all", of_each_field ? "send_field" : "send_frame"),
               [name](int code) {
                 throw InputError(format("{}: it cannot be deinterlaced: {}", name, error_text(code)));
               }) {
  if (!is_alike(static_cast<AVPixelFormat>(like.format), filters_.pixels())) {
    throw InputError(format("{}: pixels of {} are not deinterlaced; convert them with ffmpeg -pix_fmt {}", name,
                            av_get_pix_fmt_name(static_cast<AVPixelFormat>(like.format)),
                            av_get_pix_fmt_name(filters_.pixels())));
  }
}

void Deinterlacer::add(AVFrame& frame) {
  frame.pts = 2 * frames_++;
  filters_.add(&frame);
}

}  // namespace nutik::videos
