// Videos through libavformat and libavcodec, the libraries that OpenCV's writer stands on. That one rounds
// the rate to thousandths, in which 30000/1001 drifts, and takes 8 bits of BGR only.
//
//   codes in   8 or 16 bits, grey or RGB, over the full range
//   pixels     ffv1: as they are; gif: up to 256 colours, chosen for each frame; the others: YUV as the codec's row
//              says, by the matrix that the primaries of BT.2020 have or that is usual for so many lines, and that the
//              file names; mjpeg and webp: BT.601's, which JPEG and WebP always have
#include <algorithm>
#include <cstring>
#include <optional>

#include "media/formats/coding_points.hpp"
#include "media/videos/filters.hpp"
#include "media/videos/picture_decoder.hpp"
#include "media/videos/pixels.hpp"
#include "media/videos/sound.hpp"
#include "system/output_file.hpp"

namespace nutik::videos {
namespace {

constexpr std::int64_t kMostReordered = 64;  // frames, by any encoder

struct FreeOutput {
  void operator()(AVFormatContext* context) const {
    avio_closep(&context->pb);
    avformat_free_context(context);
  }
};
using OutputPointer = std::unique_ptr<AVFormatContext, FreeOutput>;

AVPixelFormat source_pixels(const VideoFormat& format) {
  const bool deep = format.type == ValueType::code16;
  if (format.shape.channels == 1) return deep ? AV_PIX_FMT_GRAY16 : AV_PIX_FMT_GRAY8;
  return deep ? AV_PIX_FMT_RGB48 : AV_PIX_FMT_RGB24;
}

AVPixelFormat encoded_pixels(const VideoFormat& format, const VideoCodec& codec) {
  if (!codec.pixels.empty()) return av_get_pix_fmt(std::string(codec.pixels).c_str());
  const AVPixelFormat source = source_pixels(format);
  if (source == AV_PIX_FMT_RGB24) return AV_PIX_FMT_BGR0;
  return source == AV_PIX_FMT_RGB48 ? AV_PIX_FMT_GBRP16 : source;
}

// What an encoder is told by name.
class Settings {
 public:
  // `level=3:slicecrc=1`
  explicit Settings(std::string_view pairs) {
    if (av_dict_parse_string(&entries_, std::string(pairs).c_str(), "=", ":", 0) < 0) throw std::bad_alloc();
  }
  ~Settings() { av_dict_free(&entries_); }
  Settings(const Settings&) = delete;
  Settings& operator=(const Settings&) = delete;

  void set(const char* name, const char* value) {
    if (av_dict_set(&entries_, name, value, 0) < 0) throw std::bad_alloc();
  }
  AVDictionary** get() { return &entries_; }
  // The first of those that are left.
  [[nodiscard]] std::optional<std::string> first_name() const {
    const AVDictionaryEntry* entry = av_dict_get(entries_, "", nullptr, AV_DICT_IGNORE_SUFFIX);
    return entry == nullptr ? std::nullopt : std::optional<std::string>(entry->key);
  }

 private:
  AVDictionary* entries_ = nullptr;
};

class LibavVideoWriter final : public VideoWriter {
 public:
  LibavVideoWriter(const std::filesystem::path& path, const VideoFormat& video, const VideoCodec& codec)
      : name_(path.string()),
        video_(video),
        file_(path, OutputFile::Lasting::recoverable),
        packet_(allocated(av_packet_alloc())) {
    const auto padded = [&](std::uint32_t side) {
      return static_cast<int>(codec.pairs_pixels ? side + side % 2 : side);
    };
    width_ = padded(video.shape.width);
    height_ = padded(video.shape.height);
    if (width_ != static_cast<int>(video.shape.width) || height_ != static_cast<int>(video.shape.height)) {
      notes_.push_back(
          format("{} keeps one colour for two pixels: {} x {} became {} x {} by repeating the "
                 "last row or column; ffv1 keeps the size",
                 codec.name, video.shape.width, video.shape.height, width_, height_));
    }
    open_muxer(path);
    open_encoder(codec);
    picture_ = new_frame(source_pixels(video), width_, height_);
    const auto pixels = encoder_->pix_fmt;
    if (pixels == AV_PIX_FMT_PAL8) {
      encoded_ = FramePointer(allocated(av_frame_alloc()));
      colours_.emplace(*picture_, "split[all],palettegen=stats_mode=single:reserve_transparent=0[colours],"
                                   "[all][colours]paletteuse=new=1",
                       [this](int code) { check(code); });
    } else if (pixels != source_pixels(video)) {
      encoded_ = new_frame(pixels, width_, height_);
      open_scaler();
    }
    note_rounded_pixels();
    if (!video.graded.empty()) copy_screen();
    note_what_is_not_named();
    note_rounded_rate();
    if (video.transfer.reference_white() < 1 && !codec.holds_16_bits)
      notes_.push_back(format("{} has 8 bits, in which {} shows bands; those of 10 do not: h265-10, prores", codec.name,
                              video.transfer.text()));
    if (video.sound) add_sound(*video.sound);
    check(avio_open(&muxer_->pb, url_of(file_.temporary_path()).c_str(), AVIO_FLAG_WRITE));
    const int begun = avformat_write_header(muxer_.get(), nullptr);
    if (begun == AVERROR(EINVAL) && is_in("mxf")) {
      constexpr Rational kRates[] = {{24'000, 1001}, {24, 1}, {25, 1}, {30'000, 1001}, {30, 1}, {48, 1}, {50, 1},
                                     {60'000, 1001}, {60, 1}, {100, 1}, {120, 1}};
      const Rational& nearest = *std::ranges::min_element(
          kRates, {}, [&](const Rational& rate) { return std::abs(rate.value() - video_.rate.value()); });
      throw UsageError(format("{} cannot be written: a .mxf has 24, 25, 30, 48, 50, 60, 100 or 120 frames a second, "
                              "24000/1001, 30000/1001 or the like, and not {}",
                              name_, video_.rate.text()),
                       Advice{format("; state one of these (`out-fps {}`)", nearest.text())});
    }
    check_taken(begun, format("a {} file", path.extension().string()));
  }

  void write(const Picture& picture) override {
    // An encoder may still hold the frame before.
    check(av_frame_make_writable(picture_.get()));
    copy(picture);
    AVFrame* frame = picture_.get();
    if (colours_) {
      frame->pts = frames_written_++;
      const FramePointer given(allocated(av_frame_clone(frame)));
      colours_->add(given.get());
      return encode_coloured();
    }
    if (scaler_) {
      frame = encoded_.get();
      check(av_frame_make_writable(frame));
      const int rows = sws_scale(scaler_.get(), picture_->data, picture_->linesize, 0, height_, frame->data,
                                 frame->linesize);
      check(rows);
      if (rows != height_) {
        throw OutputError(format("{} cannot be written: FFmpeg converted {} of {} rows of frame {}", name_,
                                 rows, height_, frames_written_));
      }
    }
    // ProRes keeps in each frame what the encoder was told once.
    frame->colorspace = encoder_->colorspace;
    frame->color_range = encoder_->color_range;
    frame->chroma_location = encoder_->chroma_sample_location;
    frame->quality = encoder_->global_quality;
    frame->color_primaries = encoder_->color_primaries;
    frame->color_trc = encoder_->color_trc;
    if (sound_) sound_->write_to(static_cast<double>(frames_written_) / video_.rate.value());
    frame->pts = frames_written_++;
    encode(frame);
  }

  void finish() override {
    if (colours_) {
      colours_->add(nullptr);
      encode_coloured();
    }
    encode(nullptr);
    if (sound_) sound_->write_to(static_cast<double>(frames_written_) / video_.rate.value());
    if (sound_ && !has_sound()) notes_.emplace_back("the clip's sound is left out: there is none while the film lasts");
    check(av_write_trailer(muxer_.get()));
    check(avio_closep(&muxer_->pb));
    file_.commit();
  }

  [[nodiscard]] bool has_sound() const override { return sound_ != nullptr && sound_->is_heard; }
  [[nodiscard]] std::vector<std::string> notes() const override { return notes_; }

 private:
  void check(int code) const {
    if (code >= 0) return;
    throw OutputError(format("{} cannot be written: {}", name_, error_text(code)));
  }

  // The same where an encoder or a container refuses these frames.
  void check_taken(int code, std::string_view what, std::string_view why = {}) const {
    if (code != AVERROR(EINVAL)) return check(code);
    throw OutputError(format("{} cannot be written: {} takes no frames of {} x {} at {} a second{} ({})", name_, what,
                             width_, height_, video_.rate.text(), why, error_text(code)),
                      {Setting::video_codec});
  }

  void open_muxer(const std::filesystem::path& path) {
    AVFormatContext* context = nullptr;
    // The name chooses the container; the file itself has a temporary one.
    check(avformat_alloc_output_context2(&context, nullptr, nullptr, path.filename().c_str()));
    muxer_.reset(context);
    stream_ = allocated(avformat_new_stream(context, nullptr));
  }

  void open_encoder(const VideoCodec& codec) {
    const AVCodec* encoder = avcodec_find_encoder_by_name(std::string(codec.encoder).c_str());
    if (encoder == nullptr) {
      std::string has;
      for (const VideoCodec& each : video_codecs()) {
        if (avcodec_find_encoder_by_name(std::string(each.encoder).c_str()) == nullptr) continue;
        has += format("{}{}", has.empty() ? "" : ", ", each.name);
      }
      throw OutputError(
          format("{} cannot be written: the FFmpeg here has no encoder {} for {}; it has those for: {}", name_,
                 codec.encoder, codec.name, has),
          {Setting::video_codec});
    }
    encoder_.reset(allocated(avcodec_alloc_context3(encoder)));
    AVCodecContext& context = *encoder_;
    context.width = width_;
    context.height = height_;
    context.pix_fmt = encoded_pixels(video_, codec);
    context.sample_aspect_ratio = {static_cast<int>(video_.pixel_aspect.numerator),
                                   static_cast<int>(video_.pixel_aspect.denominator)};
    context.framerate = {static_cast<int>(video_.rate.numerator), static_cast<int>(video_.rate.denominator)};
    context.time_base = av_inv_q(context.framerate);
    context.thread_count = 0;  // as many as there are cores
    const AVPixFmtDescriptor& pixels = *av_pix_fmt_desc_get(context.pix_fmt);
    const bool is_coded_yuv = is_yuv(context.pix_fmt);
    const bool is_still_kin = codec.name == "mjpeg" || codec.name == "webp";
    const bool is_bt709 = usual_matrix(static_cast<std::uint32_t>(height_)) == YuvMatrix::bt709;
    const AVColorSpace matrix = is_still_kin                              ? AVCOL_SPC_SMPTE170M
                                : codec.encoder == "dnxhd"                ? AVCOL_SPC_BT709  // as its decoders take it
                                : video_.primaries == Primaries::bt2020 ? AVCOL_SPC_BT2020_NCL
                                : is_bt709                                ? AVCOL_SPC_BT709
                                                                          : AVCOL_SPC_SMPTE170M;
    context.colorspace = is_coded_yuv                ? matrix
                         : pixels.nb_components == 1 ? AVCOL_SPC_UNSPECIFIED
                                                     : AVCOL_SPC_RGB;
    context.color_range =
        is_coded_yuv && context.pix_fmt != AV_PIX_FMT_YUVJ420P ? AVCOL_RANGE_MPEG : AVCOL_RANGE_JPEG;
    // Left is usual. Chroma of 8 bits is read as if it lay in the centre (docs/explanation/model.md), so it is put
    // there, or colour would move with each film of a film. What a clip of 8 bits had goes back to its place; DNxHR has
    // no tag for another place than the left.
    const bool is_left =
        !is_still_kin && (video_.repeats_chroma || pixels.comp[0].depth > 8 || codec.encoder == "dnxhd");
    if (is_coded_yuv && shares_chroma(context.pix_fmt))
      context.chroma_sample_location = is_left ? AVCHROMA_LOC_LEFT : AVCHROMA_LOC_CENTER;
    context.color_primaries = static_cast<AVColorPrimaries>(coding_point(video_.primaries));
    context.color_trc = static_cast<AVColorTransferCharacteristic>(
        coding_point(video_.transfer).value_or(AVCOL_TRC_UNSPECIFIED));
    // FFmpeg would write it as that of gamma 2.2.
    if (is_in("mxf") && context.color_trc == AVCOL_TRC_GAMMA28) context.color_trc = AVCOL_TRC_UNSPECIFIED;
    if ((muxer_->oformat->flags & AVFMT_GLOBALHEADER) != 0) context.flags |= AV_CODEC_FLAG_GLOBAL_HEADER;

    const int quality = video_.codec_setting.value_or(codec.scale.usual);
    Settings settings(codec.settings);
    if (codec.name == "ffv1") {
      context.gop_size = 1;
      // FFmpeg's slices of level 3 come back as other pixels where there are so few.
      if (std::min(width_, height_) < 3) {
        settings.set("level", "1");
        settings.set("slicecrc", "0");
      }
    }
    if (codec.scale.key == "qscale") {
      context.flags |= AV_CODEC_FLAG_QSCALE;
      context.global_quality = quality * FF_QP2LAMBDA;
    } else if (!codec.scale.key.empty()) {
      settings.set(codec.scale.key.data(), std::to_string(quality).c_str());
      if (codec.scale.key == "crf" && codec.name.starts_with("av1")) context.bit_rate = 0;
    }
    if (muxer_->oformat->audio_codec == AV_CODEC_ID_NONE) av_opt_set(muxer_->priv_data, "loop", "0", 0);  // for ever
    check_taken(avcodec_open2(&context, encoder, settings.get()), codec.name,
                codec.encoder == "dnxhd" && (width_ < 256 || height_ < 120) ? ": 256 x 120 is its smallest" : "");
    // What an encoder does not know it leaves: the video would be another one than was asked for.
    if (const auto left = settings.first_name()) {
      throw OutputError(
          format("{} cannot be written: the FFmpeg here has an encoder {} that does not know the setting {}; "
                 "choose another codec",
                 name_, codec.encoder, *left),
          {Setting::video_codec});
    }
    check(avcodec_parameters_from_context(stream_->codecpar, &context));
    stream_->time_base = context.time_base;
    stream_->sample_aspect_ratio = context.sample_aspect_ratio;
    stream_->avg_frame_rate = context.framerate;
    // What Apple's players know H.265 by.
    if (codec.name.starts_with("h265") && !is_in("matroska")) {
      stream_->codecpar->codec_tag = MKTAG('h', 'v', 'c', '1');
    }
  }

  void add_sound(const FilmSound& sound) {
    muxer_->max_interleave_delta = AV_TIME_BASE;  // pictures that wait for a late sound, or for one that has ended
    try {
      sound_ = open_sound(sound, *muxer_, name_);
      if (!sound_->note.empty()) notes_.push_back(sound_->note);
    } catch (const Error& error) {
      if (sound.is_asked || !is_refusal(error)) throw;
      notes_.push_back(format("the clip's sound is left out: {}", error.what()));
    }
  }

  [[nodiscard]] bool is_in(std::string_view container) const { return muxer_->oformat->name == container; }

  // What the clip says of the screen that it was graded on, and of its brightest light. Its container says it, or its
  // first picture.
  void copy_screen() {
    try {
      PictureDecoder clip(open_video(video_.graded, std::nullopt), name_, PictureDecoder::Wanted::times, {}, 1);
      const FramePointer first(allocated(av_frame_alloc()));
      static_cast<void>(clip.next(*first));
      for (const auto& [type, of_picture] :
           {std::pair{AV_PKT_DATA_MASTERING_DISPLAY_METADATA, AV_FRAME_DATA_MASTERING_DISPLAY_METADATA},
            {AV_PKT_DATA_CONTENT_LIGHT_LEVEL, AV_FRAME_DATA_CONTENT_LIGHT_LEVEL}}) {
        auto said = side_data(clip.stream(), type);
        const AVFrameSideData* const shown = av_frame_get_side_data(first.get(), of_picture);
        if (said.empty() && shown != nullptr) said = {shown->data, shown->size};
        if (!said.empty()) std::ranges::copy(said, allocated(new_side_data(*stream_, type, said.size())));
      }
    } catch (const InputError&) {  // stills
    }
  }

  // What a reader has to be told. FFmpeg names primaries in a .mov only beside a curve; most codecs name them, too.
  void note_what_is_not_named() {
    const bool names_any = !is_in("avi") && !is_in("gif") && !is_in("webp");
    const bool names_curve = names_any && encoder_->color_trc != AVCOL_TRC_UNSPECIFIED;
    const auto usual = video_.transfer.usual_primaries();
    const bool names_primaries = names_any && encoder_->color_primaries != AVCOL_PRI_UNSPECIFIED && !usual &&
                                 (names_curve || !is_in("mov") || encoder_->codec_id != AV_CODEC_ID_DNXHD);
    if (name_apple_log()) return;
    std::string left;
    // Deep frames of FFV1 are taken for linear.
    if (!names_curve && video_.transfer != (video_.type == ValueType::code16 ? Transfer::linear() : Transfer::srgb()))
      left = "the transfer function " + video_.transfer.text();
    if (!names_primaries && video_.shape.channels == 3 && video_.primaries != usual.value_or(Primaries::bt709))
      left += format("{}the primaries {}", left.empty() ? "" : " and ", to_text(video_.primaries));
    if (!left.empty()) notes_.push_back(format("the film does not name {}: state that when it is read", left));
  }

  // As Apple's programs do, which have a key for what H.273 has no number for.
  bool name_apple_log() {
    if (!is_in("mov") || !video_.transfer.text().starts_with("applelog")) return false;
    const bool is_bt2020 = video_.primaries == Primaries::bt2020;
    if (!is_bt2020 && video_.primaries != Primaries::apple_wide_gamut) return false;
    check(av_dict_set(&muxer_->metadata, "com.apple.proapps.customgamma",
                      is_bt2020 ? "com.apple.rec2020.apple-log" : "com.apple.apple-wide-gamut.apple-log", 0));
    check(av_opt_set(muxer_->priv_data, "movflags", "+use_metadata_tags", 0));
    return true;
  }

  void note_rounded_rate() {
    for (const std::int64_t nominal : {24, 30, 48, 60, 120}) {
      const Rational meant = Rational::of(nominal * 1000, 1001);
      if (video_.rate == meant || std::abs(video_.rate.value() - meant.value()) > 0.005) continue;
      notes_.push_back(format("the film has {} frames a second, as stated; editors mean {} by that, which can be had",
                              video_.rate.text(), meant.text()));
    }
  }

  // A .webm tells players how many whole pixels wide its frames are shown, and no pixel aspect.
  void note_rounded_pixels() {
    const auto& [across, down] = video_.pixel_aspect;
    if (is_in("mxf") && across != down) {
      notes_.push_back(format("a .mxf does not tell that pixels are {}:{}: they are shown square; a .mov keeps that",
                              across, down));
    }
    if (!is_in("webm")) return;
    const std::int64_t shown_width = av_rescale(width_, across, down);
    const Rational shown = Rational::of(shown_width, width_);
    if (shown == video_.pixel_aspect) return;
    notes_.push_back(format(
        "a .webm tells players a size in whole pixels, {} x {} for frames of {} x {}: pixels are shown "
        "{}:{} in the place of {}:{}; other containers keep that",
        shown_width, height_, width_, height_, shown.numerator, shown.denominator, across, down));
  }

  void open_scaler() {
    scaler_.reset(allocated(sws_alloc_context()));
    const auto set = [&](const char* option, std::int64_t value) { av_opt_set_int(scaler_.get(), option, value, 0); };
    for (const char* const side : {"srcw", "dstw"}) set(side, width_);
    for (const char* const side : {"srch", "dsth"}) set(side, height_);
    set("src_format", picture_->format);
    set("dst_format", encoder_->pix_fmt);
    set("sws_flags", SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INP);
    // Chroma that a reader gave to both pixels that share it is their mean again.
    if (encoder_->chroma_sample_location == AVCHROMA_LOC_LEFT && !video_.repeats_chroma) set("dst_h_chr_pos", 0);
    check(sws_init_context(scaler_.get(), nullptr, nullptr));
    constexpr int kOne = 1 << 16;  // contrast and saturation
    const int* const matrix = sws_getCoefficients(encoder_->colorspace);  // SWS_CS_ has H.273's numbers, too
    is_white_less_ = video_.type == ValueType::code16 && is_yuv(encoder_->pix_fmt);
    check(sws_setColorspaceDetails(scaler_.get(), matrix, 1, matrix,
                                   encoder_->color_range == AVCOL_RANGE_JPEG ? 1 : 0, 0, kOne, kOne));
  }

  // Into picture_, whose sides may be one longer.
  void copy(const Picture& picture) {
    const Shape& shape = picture.shape;
    const std::size_t pixel_bytes = shape.channels * value_bytes(picture.type);
    const std::size_t row_bytes = shape.width * pixel_bytes;
    for (int y = 0; y < height_; ++y) {
      const auto row = std::min<std::size_t>(static_cast<std::size_t>(y), shape.height - 1);
      std::uint8_t* to = picture_->data[0] + static_cast<std::ptrdiff_t>(y) * picture_->linesize[0];
      std::memcpy(to, picture.bytes.data() + row * row_bytes, row_bytes);
      if (width_ > static_cast<int>(shape.width))
        std::memcpy(to + row_bytes, to + row_bytes - pixel_bytes, pixel_bytes);
      if (!is_white_less_) continue;
      auto* codes = reinterpret_cast<std::uint16_t*>(to);
      for (std::size_t i = 0; i < std::size_t(width_) * shape.channels; ++i)
        codes[i] = static_cast<std::uint16_t>((codes[i] * 65280u + 32767u) / 65535u);
    }
  }

  void encode_coloured() {
    while (colours_->take(*encoded_)) encode(encoded_.get());
  }

  // Null: no frame follows.
  void encode(const AVFrame* frame) {
    check(avcodec_send_frame(encoder_.get(), frame));
    for (;;) {
      const int code = avcodec_receive_packet(encoder_.get(), packet_.get());
      if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return;
      check(code);
      packet_->duration = 1;
      // libx265 leaves it undefined in films of fewer frames than it looks ahead; it reorders them by two at most.
      if (packet_->dts > packet_->pts || packet_->dts < packet_->pts - kMostReordered) packet_->dts = packets_ - 2;
      ++packets_;
      av_packet_rescale_ts(packet_.get(), encoder_->time_base, stream_->time_base);
      packet_->stream_index = stream_->index;
      check(av_interleaved_write_frame(muxer_.get(), packet_.get()));
    }
  }

  std::string name_;
  VideoFormat video_;
  OutputFile file_;
  std::vector<std::string> notes_;
  int width_ = 0;  // of the frames in the file
  int height_ = 0;
  OutputPointer muxer_;
  AVStream* stream_ = nullptr;
  CodecPointer encoder_;
  ScalerPointer scaler_;
  bool is_white_less_ = false;  // 65280 for 65535, as libswscale has it where 16 bits become YUV
  std::optional<Filters> colours_;  // of a GIF
  FramePointer picture_;
  FramePointer encoded_;
  PacketPointer packet_;
  std::unique_ptr<SoundWriter> sound_;
  std::int64_t frames_written_ = 0;
  std::int64_t packets_ = 0;  // of the encoder
};

}  // namespace

std::unique_ptr<VideoWriter> open_libav_writer(const std::filesystem::path& path, const VideoFormat& format,
                                               const VideoCodec& codec) {
  av_log_set_level(AV_LOG_FATAL);  // what matters is thrown, and said once
  return std::make_unique<LibavVideoWriter>(path, format, codec);
}

}  // namespace nutik::videos
