#include "media/videos/sound.hpp"

#include <cmath>
#include <cstdio>
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
  const char *deep_name = name, *deep_samples = samples;  // of sound with more than 16 bits
  int only_rate = 0;                                      // samples a second, of what is encoded; 0: the clip's own
};

constexpr SoundEncoder kEncoders[] = {{"avi", "pcm_s16le", "s16", "pcm_s24le", "s32"},
                                      {"matroska", "flac", "s16", "flac", "s32"},
                                      {"mov", "pcm_s24le", "s32"},
                                      {"mxf", "pcm_s16le", "s16", "pcm_s24le", "s32", 48'000},
                                      {.container = "webm", .name = "libopus", .samples = "flt", .only_rate = 48'000},
                                      {.container = "", .name = "aac", .samples = "fltp", .only_rate = 48'000}};

// These writers of Matroska delayed all streams by what Opus begins with and players drop, but for the Opus.
constexpr unsigned kMovesOpus = AV_VERSION_INT(59, 30, 100);

// How much too early the file has that stream of sound, whose pictures it delayed.
double early_s(const AVFormatContext& file, const AVStream& sound, const AVStream& pictures) {
  const AVDictionaryEntry* const writer = av_dict_get(file.metadata, "encoder", nullptr, 0);
  unsigned major = 0, minor = 0, micro = 0;
  if (sound.codecpar->codec_id != AV_CODEC_ID_OPUS || file.iformat->name != std::string_view("matroska,webm") ||
      writer == nullptr || std::sscanf(writer->value, "Lavf%u.%u.%u", &major, &minor, &micro) != 3 ||
      AV_VERSION_INT(major, minor, micro) > kMovesOpus)
    return 0;
  const double delay_s = static_cast<double>(sound.codecpar->initial_padding) / 48'000, rounding_s = 0.001;
  const double start_s = static_cast<double>(pictures.start_time) * av_q2d(pictures.time_base);
  return start_s > delay_s - rounding_s ? delay_s : 0;
}

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
    sound_.start_s -= early_s(*clip_.format, *from_, *clip_.format->streams[clip_.stream]);
    const AVCodecParameters& codec = *from_->codecpar;
    const AVCodecID id = codec.codec_id;
    // An .avi does not say when sound begins: silence in front of it has to be encoded. FFmpeg 5 moves Opus by its
    // delay each time that a stream is copied. Packets without losses may be longer than frames, but for those of
    // discs.
    const bool moves = std::string_view(film.oformat->name) == "avi" || id == AV_CODEC_ID_OPUS;
    const bool is_long = is_lossless() && id != AV_CODEC_ID_TRUEHD && id != AV_CODEC_ID_DTS;
    is_copied_ = sound_.speed == 1.0 && !sound_.is_cut && !is_pcm() && !is_long && !moves && holds(id);
    if (!is_copied_) {
      open_decoder();
      open_encoder();
      open_graph();
    }
    to_ = allocated(avformat_new_stream(&film_, nullptr));  // last, since a film has no stream of a sound that fails
    for (const char* const key : {"language", "title"}) {
      const AVDictionaryEntry* const told = av_dict_get(from_->metadata, key, nullptr, 0);
      if (told != nullptr) check(av_dict_set(&to_->metadata, key, told->value, 0));
    }
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
  [[noreturn]] void refuse(const std::string& why) const {
    throw OutputError(format("{} cannot be written with sound: {}; leave it out", name_, why), {Setting::sound});
  }

  [[nodiscard]] bool is_mxf() const { return std::string_view(film_.oformat->name) == "mxf"; }
  [[nodiscard]] bool is_pcm() const { return av_get_exact_bits_per_sample(from_->codecpar->codec_id) != 0; }
  [[nodiscard]] bool is_lossless() const {
    const AVCodecDescriptor* const codec = avcodec_descriptor_get(from_->codecpar->codec_id);
    return codec != nullptr && (codec->props & AV_CODEC_PROP_LOSSLESS) != 0;
  }

  [[nodiscard]] bool holds(AVCodecID codec) const {
    const std::string_view container = film_.oformat->name;
    // FFmpeg does not write all that a container has a tag for, and few players know PCM in an .mp4.
    if (codec == AV_CODEC_ID_TRUEHD || codec == AV_CODEC_ID_FLAC) return container == "matroska";
    if (is_mxf()) return codec == AV_CODEC_ID_PCM_S16LE || codec == AV_CODEC_ID_PCM_S24LE;
    if (container == "mp4" && av_get_exact_bits_per_sample(codec) != 0) return false;
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
    if (decoder_->ch_layout.order == AV_CHANNEL_ORDER_UNSPEC)
      refuse(format("nothing says where its {} channels are heard", decoder_->ch_layout.nb_channels));
  }

  // PCM and ALAC stay what they are, where the container holds them.
  void open_encoder() {
    const std::string_view container = film_.oformat->name;
    const AVCodecID own = from_->codecpar->codec_id;
    kind_ = *std::ranges::find_if(kEncoders, [&](const SoundEncoder& each) {
      return each.container == container || each.container.empty();
    });
    const bool is_deep = is_lossless() && av_get_bytes_per_sample(decoder_->sample_fmt) > 2;
    const char* name = is_deep ? kind_.deep_name : kind_.name;
    AVSampleFormat samples = av_get_sample_fmt(is_deep ? kind_.deep_samples : kind_.samples);
    const bool is_kept = (is_pcm() || own == AV_CODEC_ID_ALAC) && holds(own) && avcodec_find_encoder(own) != nullptr;
    const AVCodec* const codec = is_kept ? avcodec_find_encoder(own) : avcodec_find_encoder_by_name(name);
    if (is_kept) samples = decoder_->sample_fmt;
    if (codec == nullptr || !holds(codec->id))
      refuse(format("the FFmpeg here does not encode {} for {}", name, container));
    const AVChannelLayout& heard = decoder_->ch_layout;
    AVChannelLayout layout = heard;  // which is mixed down to what the encoder takes
    for (int channels = heard.nb_channels; !opens(*codec, samples, layout); --channels) {
      if (channels == 0)
        refuse(format("{} does not encode its {} channels at {} Hz", codec->name, heard.nb_channels,
                      encoder_->sample_rate));
      layout = {};
      av_channel_layout_default(&layout, channels);
    }
    if (layout.nb_channels < heard.nb_channels)
      note = format("the sound's {} channels are mixed down to {}, as {} does not encode them", heard.nb_channels,
                    layout.nb_channels, codec->name);
  }

  [[nodiscard]] bool opens(const AVCodec& codec, AVSampleFormat samples, const AVChannelLayout& layout) {
    encoder_.reset(allocated(avcodec_alloc_context3(&codec)));
    encoder_->sample_fmt = samples;
    if (av_get_packed_sample_fmt(samples) == AV_SAMPLE_FMT_S32 && av_get_exact_bits_per_sample(codec.id) == 0)
      encoder_->bits_per_raw_sample = 24;
    const bool is_own = codec.id == from_->codecpar->codec_id && codec.id != AV_CODEC_ID_OPUS && !is_mxf();
    encoder_->sample_rate = kind_.only_rate != 0 && !is_own ? kind_.only_rate : decoder_->sample_rate;
    check(av_channel_layout_copy(&encoder_->ch_layout, &layout));
    encoder_->time_base = {1, encoder_->sample_rate};
    constexpr std::int64_t kBitsPerChannel = 96'000;
    encoder_->bit_rate = kBitsPerChannel * encoder_->ch_layout.nb_channels;
    if ((film_.oformat->flags & AVFMT_GLOBALHEADER) != 0) encoder_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    if (avcodec_open2(encoder_.get(), &codec, nullptr) < 0) return false;
    if (codec.id == AV_CODEC_ID_OPUS && avformat_version() <= kMovesOpus) {
      film_.avoid_negative_ts = AVFMT_AVOID_NEG_TS_DISABLED;
      delay_ = encoder_->initial_padding;
    }
    return true;
  }

  // Cuts the part out, fills gaps with silence, plays slower or faster, converts. A filter that keeps pitch (atempo)
  // would move sounds by more than a frame.
  void open_graph() {
    graph_.reset(allocated(module<FilterModule>().graph_alloc()));
    graph_->nb_threads = 1;
    char layout[64] = {};
    check(av_channel_layout_describe(&decoder_->ch_layout, layout, sizeof layout));
    std::string filters = format("abuffer=time_base=1/{}:sample_rate={}:sample_fmt={}:channel_layout={},",
                                 decoder_->sample_rate, decoder_->sample_rate,
                                 av_get_sample_fmt_name(decoder_->sample_fmt), layout);
    // By default it fills only gaps of 0.1 s and more.
    filters += format("aresample=async=1:min_comp=0.0001:min_hard_comp=0.01:first_pts=0,atrim=end={:.9f}",
                      sound_.seconds * sound_.speed);
    if (sound_.speed != 1.0) {
      // Rates are whole numbers, and a rounded one would drift: a ratio of two that are as large as aresample takes. It
      // is given so much at once as makes a few thousand samples.
      constexpr int kLargestRate = 1'000'000, kSamples = 4096;
      const AVRational tape = av_d2q(decoder_->sample_rate * sound_.speed / encoder_->sample_rate, kLargestRate);
      filters += format(",asetnsamples=n={}:p=0,asetrate={},aresample={},asetrate={}",
                        std::clamp<std::int64_t>(std::llround(kSamples * sound_.speed), 1, kSamples),
                        tape.num, tape.den, encoder_->sample_rate);
    }
    char encoded[64] = {};
    check(av_channel_layout_describe(&encoder_->ch_layout, encoded, sizeof encoded));
    // FFmpeg ends a .mxf where its sound ends.
    filters += format(",aresample,aformat=sample_fmts={}:sample_rates={}:channel_layouts={}{},atrim=end={:.9f}",
                      av_get_sample_fmt_name(encoder_->sample_fmt), encoder_->sample_rate, encoded,
                      is_mxf() ? ",apad" : "", sound_.seconds);
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
    const double end = at + static_cast<double>(packet_->duration) * av_q2d(from_->time_base);
    if (at >= sound_.seconds || end > sound_.seconds + 1.0 / av_q2d(film_.streams[0]->avg_frame_rate)) {
      is_at_end_ = true;
      return;
    }
    is_heard = true;
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
      if (at + length > 0) {
        is_heard = is_heard || at < sound_.seconds * sound_.speed;
        if (module<FilterModule>().add_frame(source_, frame_.get()) < 0) av_frame_unref(frame_.get());
      }
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
    while (avcodec_receive_packet(encoder_.get(), packet.get()) >= 0) {
      packet->pts += delay_;
      packet->dts += delay_;
      write(*packet, encoder_->time_base);
    }
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
  std::int64_t delay_ = 0;  // of packets, in samples
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
