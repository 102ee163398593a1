// Grey and deeper video through libavcodec, code for code: grey as it is, colour as 16-bit RGB.
#include <cstring>

#include "media/clips/clips.hpp"
#include "media/clips/libav.hpp"

namespace nutik::clips {
namespace {

class LibavClip final : public Clip {
 public:
  LibavClip(const std::filesystem::path& path, const Probe& probe, const ClipOptions& options)
      : name_(path.string()), opened_(open_video(path, options.raw)), packet_(av_packet_alloc()), frame_(av_frame_alloc()) {
    const AVCodecParameters* parameters = stream().codecpar;
    const AVCodec* decoder = avcodec_find_decoder(parameters->codec_id);
    if (decoder == nullptr) throw InputError(format("{}: no decoder here knows its pictures", name_));
    codec_.reset(avcodec_alloc_context3(decoder));
    codec_->thread_count = 0;  // as many as there are cores
    if (avcodec_parameters_to_context(codec_.get(), parameters) < 0 ||
        avcodec_open2(codec_.get(), decoder, nullptr) < 0) {
      throw InputError(format("{}: its decoder cannot be started", name_));
    }
    CaptureFormat& capture = info_.format;
    capture.shape = probe.shape;
    capture.shape.channels = probe.is_grey ? 1 : 3;
    capture.code_bytes = probe.bits > 8 ? 2 : 1;
    // Grey codes are kept as stored; colour is converted to the full 16-bit range.
    capture.white_code = probe.is_grey ? (1u << probe.bits) - 1 : 65'535;
    if (options.white_code) capture.white_code = *options.white_code;
    // Deep grey pictures come from scientific cameras, which are linear; deep colour from film cameras.
    const bool scientific = probe.is_grey && probe.bits > 8;
    capture.transfer = scientific ? Transfer::linear() : Transfer::srgb();
    if (probe.transfer && !scientific) capture.transfer = *probe.transfer;
    output_format_ = !probe.is_grey     ? AV_PIX_FMT_RGB48LE
                     : probe.bits > 8 ? grey_format(probe.bits)
                                      : AV_PIX_FMT_GRAY8;
    info_.timing = probe.timing;
    info_.sample_count = probe.sample_count;
  }

  [[nodiscard]] const ClipInfo& info() const override { return info_; }

  bool read(std::span<std::byte> raster) override {
    if (!decode_next()) return false;
    const Shape& shape = info_.format.shape;
    if (frame_->width != static_cast<int>(shape.width) || frame_->height != static_cast<int>(shape.height)) {
      throw InputError(format("{}: picture {} has {} x {} pixels, the ones before it {} x {}", name_,
                              frames_read_, frame_->width, frame_->height, shape.width, shape.height));
    }
    convert(raster);
    ++frames_read_;
    return true;
  }

 private:
  [[nodiscard]] const AVStream& stream() const { return *opened_.format->streams[opened_.stream]; }

  static AVPixelFormat grey_format(std::uint32_t bits) {
    switch (bits) {
      case 9: return AV_PIX_FMT_GRAY9LE;
      case 10: return AV_PIX_FMT_GRAY10LE;
      case 12: return AV_PIX_FMT_GRAY12LE;
      case 14: return AV_PIX_FMT_GRAY14LE;
      default: return AV_PIX_FMT_GRAY16LE;
    }
  }

  bool decode_next() {
    for (;;) {
      const int code = avcodec_receive_frame(codec_.get(), frame_.get());
      if (code == 0) return true;
      if (code == AVERROR_EOF) return false;
      if (code != AVERROR(EAGAIN)) fail(code);
      feed();
    }
  }

  void feed() {
    for (;;) {
      if (av_read_frame(opened_.format.get(), packet_.get()) < 0) {
        avcodec_send_packet(codec_.get(), nullptr);
        return;
      }
      const bool wanted = packet_->stream_index == opened_.stream;
      const int code = wanted ? avcodec_send_packet(codec_.get(), packet_.get()) : 0;
      av_packet_unref(packet_.get());
      if (code < 0) fail(code);
      if (wanted) return;
    }
  }

  [[noreturn]] void fail(int code) const {
    throw InputError(format("{}: picture {} cannot be decoded: {}", name_, frames_read_, error_text(code)));
  }

  void convert(std::span<std::byte> raster) {
    const auto from = static_cast<AVPixelFormat>(frame_->format);
    const Shape& shape = info_.format.shape;
    const std::size_t row_bytes = std::size_t{shape.width} * shape.channels * info_.format.code_bytes;
    if (from == output_format_) {
      for (std::size_t y = 0; y < shape.height; ++y) {
        std::memcpy(raster.data() + y * row_bytes,
                    frame_->data[0] + static_cast<std::ptrdiff_t>(y) * frame_->linesize[0], row_bytes);
      }
      return;
    }
    if (!scaler_) {
      scaler_.reset(sws_getContext(frame_->width, frame_->height, from, frame_->width, frame_->height,
                                   output_format_, SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT,
                                   nullptr, nullptr, nullptr));
      if (!scaler_) throw InputError(format("{}: its kind of pictures cannot be converted", name_));
    }
    std::uint8_t* planes[4] = {reinterpret_cast<std::uint8_t*>(raster.data()), nullptr, nullptr, nullptr};
    const int strides[4] = {static_cast<int>(row_bytes), 0, 0, 0};
    sws_scale(scaler_.get(), frame_->data, frame_->linesize, 0, frame_->height, planes, strides);
  }

  std::string name_;
  ClipInfo info_;
  OpenedVideo opened_;
  CodecPointer codec_;
  PacketPointer packet_;
  FramePointer frame_;
  ScalerPointer scaler_;
  AVPixelFormat output_format_ = AV_PIX_FMT_NONE;
  std::uint64_t frames_read_ = 0;
};

}  // namespace

std::unique_ptr<Clip> open_with_libav(const std::filesystem::path& path, const Probe& probe,
                                      const ClipOptions& options) {
  return std::make_unique<LibavClip>(path, probe, options);
}

}  // namespace nutik::clips
