#include "media/videos/deinterlacer.hpp"

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
    : name_(name), graph_(allocated(avfilter_graph_alloc())) {
  graph_->nb_threads = 1;  // decoding has the others
  const std::string pictures = format("video_size={}x{}:pix_fmt={}:time_base=1/2:pixel_aspect=1/1",
                                      like.width, like.height, like.format);
  const std::string how =
      format("mode={}:parity=auto:deint=all", of_each_field ? "send_field" : "send_frame");
  const auto make = [&](AVFilterContext*& filter, const char* kind, const char* arguments) {
    const int code = avfilter_graph_create_filter(&filter, avfilter_get_by_name(kind), kind, arguments,
                                                  nullptr, graph_.get());
    if (code < 0) fail(code);
  };
  AVFilterContext* filter = nullptr;
  make(source_, "buffer", pictures.c_str());
  make(filter, "bwdif", how.c_str());
  make(sink_, "buffersink", nullptr);
  for (const auto& [from, to] : {std::pair(source_, filter), std::pair(filter, sink_)}) {
    if (const int code = avfilter_link(from, 0, to, 0); code < 0) fail(code);
  }
  if (const int code = avfilter_graph_config(graph_.get(), nullptr); code < 0) fail(code);
  if (!is_alike(static_cast<AVPixelFormat>(like.format),
                static_cast<AVPixelFormat>(av_buffersink_get_format(sink_)))) {
    throw InputError(
        format("{}: pixels of {} are not deinterlaced; convert them with ffmpeg -pix_fmt {}", name_,
               av_get_pix_fmt_name(static_cast<AVPixelFormat>(like.format)),
               av_get_pix_fmt_name(static_cast<AVPixelFormat>(av_buffersink_get_format(sink_)))));
  }
}

void Deinterlacer::fail(int code) const {
  throw InputError(format("{}: it cannot be deinterlaced: {}", name_, error_text(code)));
}

void Deinterlacer::add(AVFrame& frame) {
  frame.pts = 2 * frames_++;
  if (const int code = av_buffersrc_add_frame(source_, &frame); code < 0) fail(code);
}

void Deinterlacer::end() {
  if (const int code = av_buffersrc_add_frame(source_, nullptr); code < 0) fail(code);
}

bool Deinterlacer::take(AVFrame& picture) {
  av_frame_unref(&picture);
  const int code = av_buffersink_get_frame(sink_, &picture);
  if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return false;
  if (code < 0) fail(code);
  return true;
}

}  // namespace nutik::videos
