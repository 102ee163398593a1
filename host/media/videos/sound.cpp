#include "media/videos/sound.hpp"

#include <cmath>
#include <utility>

#include "capture/rational.hpp"
#include "media/videos/filters.hpp"

namespace nutik::videos {
namespace {

// By what sound is encoded anew: lossless where files are large anyway, else by what players know.
struct SoundEncoder {
  std::string_view container;  // as FFmpeg calls it; empty: any other
  const char* name;
  const char* samples;
  int only_rate = 0;  // samples a second; 0: the clip's own
};

constexpr SoundEncoder kEncoders[] = {{"avi", "pcm_s16le", "s16"},
                                      {"matroska", "flac", "s16"},
                                      {"mov", "pcm_s24le", "s32"},
                                      {"webm", "libopus", "flt", 48'000},
                                      {"", "aac", "fltp", 48'000}};

class LibavSoundWriter final : public SoundWriter {
 public:
  LibavSoundWriter(const FilmSound& sound, AVFormatContext& film, const std::string& name)
      : sound_(sound),
        film_(film),
        name_(name),
        clip_(open_video(sound.clip, std::nullopt)),
        packet_(allocated(av_packet_alloc())),
        frame_(allocated(av_frame_alloc())) {
    const int found = best_sound(*clip_.format);
    check(found);
    from_ = clip_.format->streams[found];
    const AVCodecParameters& codec = *from_->codecpar;
    const bool is_compressed = av_get_exact_bits_per_sample(codec.codec_id) == 0;
    // An .avi does not say when sound begins: silence in front of it has to be encoded. FFmpeg 5 moves Opus by its delay
    // each time that a stream is copied.
    const bool moves = std::string_view(film.oformat->name) == "avi" || codec.codec_id == AV_CODEC_ID_OPUS;
    is_copied_ = sound_.speed == 1.0 && is_compressed && !moves && holds(codec.codec_id);
    if (!is_copied_) {
      open_decoder();
      open_encoder();
      open_graph();
    }
    to_ = allocated(avformat_new_stream(&film_, nullptr));  // last, since a film has no stream of a sound that fails
    if (is_copied_) {
      check(avcodec_parameters_copy(to_->codecpar, &codec));
      to_->codecpar->codec_tag = 0;
      to_->time_base = from_->time_base;
      return;
    }
    check(avcodec_parameters_from_context(to_->codecpar, encoder_.get()));
    to_->time_base = encoder_->time_base;
  }

  void write_to(double film_s) override {
    while (!is_at_end_ && written_s_ < film_s) read_packet();
  }

 private:
  void check(int code) const {
    if (code < 0)
      throw OutputError(format("{} cannot be written, for its sound: {}", name_, error_text(code)));
  }

  [[nodiscard]] bool holds(AVCodecID codec) const {
    // FFmpeg does not write all that a container has a tag for.
    if (codec == AV_CODEC_ID_TRUEHD || codec == AV_CODEC_ID_FLAC)
      return film_.oformat->name == std::string_view("matroska");
    return avformat_query_codec(film_.oformat, codec, FF_COMPLIANCE_NORMAL) == 1;
  }

  void open_decoder() {
    const AVCodec* codec = avcodec_find_decoder(from_->codecpar->codec_id);
    if (codec == nullptr) check(AVERROR_DECODER_NOT_FOUND);
    decoder_.reset(allocated(avcodec_alloc_context3(codec)));
    check(avcodec_parameters_to_context(decoder_.get(), from_->codecpar));
    decoder_->pkt_timebase = from_->time_base;
    check(avcodec_open2(decoder_.get(), codec, nullptr));
    if (decoder_->sample_fmt == AV_SAMPLE_FMT_NONE || decoder_->sample_rate <= 0) check(AVERROR_INVALIDDATA);
    if (decoder_->ch_layout.order == AV_CHANNEL_ORDER_UNSPEC)
      av_channel_layout_default(&decoder_->ch_layout, decoder_->ch_layout.nb_channels);
  }

  void open_encoder() {
    const std::string_view container = film_.oformat->name;
    kind_ = *std::ranges::find_if(kEncoders, [&](const SoundEncoder& each) {
      return each.container == container || each.container.empty();
    });
    const AVCodec* codec = avcodec_find_encoder_by_name(kind_.name);
    if (codec == nullptr || !holds(codec->id)) {
      throw OutputError(
          format("{} cannot be written with sound: the FFmpeg here does not encode {} for {}; leave it out", name_,
                 kind_.name, container),
          {Setting::sound});
    }
    encoder_.reset(allocated(avcodec_alloc_context3(codec)));
    encoder_->sample_fmt = av_get_sample_fmt(kind_.samples);
    encoder_->sample_rate = kind_.only_rate != 0 ? kind_.only_rate : decoder_->sample_rate;
    check(av_channel_layout_copy(&encoder_->ch_layout, &decoder_->ch_layout));
    encoder_->time_base = {1, encoder_->sample_rate};
    constexpr std::int64_t kBitsPerChannel = 96'000;
    encoder_->bit_rate = kBitsPerChannel * encoder_->ch_layout.nb_channels;
    if ((film_.oformat->flags & AVFMT_GLOBALHEADER) != 0) encoder_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    check(avcodec_open2(encoder_.get(), codec, nullptr));
  }

  // Cuts the part out, fills gaps with silence, plays slower or faster, converts. A filter that keeps pitch (atempo) would
  // move sounds by more than a frame.
  void open_graph() {
    graph_.reset(allocated(module<FilterModule>().graph_alloc()));
    graph_->nb_threads = 1;
    char layout[64] = {};
    check(av_channel_layout_describe(&decoder_->ch_layout, layout, sizeof layout));
    std::string filters = format("abuffer=time_base=1/{}:sample_rate={}:sample_fmt={}:channel_layout={},",
                                 decoder_->sample_rate, decoder_->sample_rate,
                                 av_get_sample_fmt_name(decoder_->sample_fmt), layout);
    filters += format("aresample=async=1:first_pts=0,atrim=end={:.9f}", sound_.seconds * sound_.speed);
    if (sound_.speed != 1.0) filters += format(",asetrate={}", std::llround(decoder_->sample_rate * sound_.speed));
    filters += format(",aresample,aformat=sample_fmts={}:sample_rates={}:channel_layouts={}", kind_.samples,
                      encoder_->sample_rate, layout);
    if (encoder_->frame_size > 0) filters += format(",asetnsamples=n={}:p=0", encoder_->frame_size);
    filters += ",abuffersink";
    AVFilterInOut *in = nullptr, *out = nullptr;
    check(module<FilterModule>().graph_parse(graph_.get(), filters.c_str(), &in, &out));
    check(module<FilterModule>().graph_config(graph_.get(), nullptr));
    source_ = graph_->filters[0];
    for (unsigned i = 0; i < graph_->nb_filters; ++i) {
      if (std::string_view(graph_->filters[i]->filter->name) == "abuffersink") sink_ = graph_->filters[i];
    }
  }

  // When sound of the clip is heard, in seconds of the file behind the film's first picture.
  [[nodiscard]] double file_time(std::int64_t time, AVRational base) const {
    return static_cast<double>(time) * av_q2d(base) - sound_.start_s;
  }

  void read_packet() {
    if (av_read_frame(clip_.format.get(), packet_.get()) < 0) {
      end();
      return;
    }
    if (packet_->stream_index == from_->index && packet_->pts != AV_NOPTS_VALUE) {
      if (is_copied_)
        copy_packet();
      else
        decode(packet_.get());
    }
    av_packet_unref(packet_.get());
  }

  void copy_packet() {
    const double at = file_time(packet_->pts, from_->time_base);
    if (at < 0) return;
    written_s_ = at;
    if (at >= sound_.seconds) {
      is_at_end_ = true;
      return;
    }
    const auto shift = static_cast<std::int64_t>(std::llround(sound_.start_s / av_q2d(from_->time_base)));
    packet_->pts -= shift;
    packet_->dts = packet_->pts;
    write(*packet_, from_->time_base);
  }

  // Null: none follows.
  void decode(const AVPacket* packet) {
    if (packet != nullptr && file_time(packet->pts, from_->time_base) > sound_.seconds * sound_.speed + 1.0) {
      end();
      return;
    }
    // A packet that cannot be decoded is silence.
    if (avcodec_send_packet(decoder_.get(), packet) < 0) return;
    while (avcodec_receive_frame(decoder_.get(), frame_.get()) >= 0) {
      const double at = file_time(frame_->best_effort_timestamp, from_->time_base);
      const double length = static_cast<double>(frame_->nb_samples) / decoder_->sample_rate;
      frame_->pts = static_cast<std::int64_t>(std::llround(at * decoder_->sample_rate));
      if (frame_->ch_layout.order == AV_CHANNEL_ORDER_UNSPEC)
        check(av_channel_layout_copy(&frame_->ch_layout, &decoder_->ch_layout));
      // What has another form than the sound began with is silence; behind the film's end some versions take no more.
      if (at + length > 0 && module<FilterModule>().add_frame(source_, frame_.get()) < 0) av_frame_unref(frame_.get());
      av_frame_unref(frame_.get());
    }
    encode_all();
  }

  void encode_all() {
    while (module<FilterModule>().get_frame(sink_, frame_.get()) >= 0) {
      frame_->pts = av_rescale_q(frame_->pts, module<FilterModule>().get_time_base(sink_), encoder_->time_base);
      encode(frame_.get());
      av_frame_unref(frame_.get());
    }
  }

  void encode(const AVFrame* frame) {
    if (frame != nullptr) written_s_ = static_cast<double>(frame->pts) / encoder_->sample_rate;
    check(avcodec_send_frame(encoder_.get(), frame));
    const PacketPointer packet(allocated(av_packet_alloc()));
    while (avcodec_receive_packet(encoder_.get(), packet.get()) >= 0) write(*packet, encoder_->time_base);
  }

  void write(AVPacket& packet, AVRational base) const {
    av_packet_rescale_ts(&packet, base, to_->time_base);
    packet.stream_index = to_->index;
    packet.pos = -1;
    check(av_interleaved_write_frame(&film_, &packet));
  }

  void end() {
    if (std::exchange(is_at_end_, true) || is_copied_) return;
    decode(nullptr);
    if (const int ended = module<FilterModule>().add_frame(source_, nullptr); ended != AVERROR_EOF) check(ended);
    encode_all();
    encode(nullptr);
  }

  FilmSound sound_;
  AVFormatContext& film_;
  std::string name_;
  OpenedVideo clip_;
  AVStream *from_ = nullptr, *to_ = nullptr;
  bool is_copied_ = false, is_at_end_ = false;
  double written_s_ = -1.0;
  SoundEncoder kind_{};
  CodecPointer decoder_, encoder_;
  GraphPointer graph_;
  AVFilterContext *source_ = nullptr, *sink_ = nullptr;
  PacketPointer packet_;
  FramePointer frame_;
};

}  // namespace

int best_sound(const AVFormatContext& file) {
  return av_find_best_stream(const_cast<AVFormatContext*>(&file), AVMEDIA_TYPE_AUDIO, -1, -1, nullptr, 0);
}

std::unique_ptr<SoundWriter> open_sound(const FilmSound& sound, AVFormatContext& film, const std::string& name) {
  return std::make_unique<LibavSoundWriter>(sound, film, name);
}

}  // namespace nutik::videos
