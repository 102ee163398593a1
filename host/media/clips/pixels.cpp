#include "media/clips/pixels.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace nutik::clips {
namespace {

AVPixelFormat raster_format(const PixelKind& kind) {
  if (!kind.is_grey) return kind.bits <= 8 ? AV_PIX_FMT_RGB24 : AV_PIX_FMT_RGB48;
  switch (kind.bits + kind.padding_bits) {
    case 8:
      return AV_PIX_FMT_GRAY8;
    case 9:
      return AV_PIX_FMT_GRAY9;
    case 10:
      return AV_PIX_FMT_GRAY10;
    case 12:
      return AV_PIX_FMT_GRAY12;
    case 14:
      return AV_PIX_FMT_GRAY14;
    default:
      return AV_PIX_FMT_GRAY16;
  }
}

// libswscale takes every YUV picture for BT.601 with limited range unless it is told otherwise.
void set_colours(SwsContext* scaler, const AVFrame& frame) {
  const AVPixFmtDescriptor* pixels = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(frame.format));
  const bool is_yuv = pixels->nb_components >= 3 &&
                      (pixels->flags & (AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_BAYER)) == 0;
  if (!is_yuv) return;
  const bool full_range =
      frame.color_range == AVCOL_RANGE_JPEG || std::string_view(pixels->name).starts_with("yuvj");
  constexpr int kOne = 1 << 16;  // contrast and saturation
  sws_setColorspaceDetails(scaler, sws_getCoefficients(frame.colorspace), full_range ? 1 : 0,
                           sws_getCoefficients(SWS_CS_DEFAULT), 1, 0, kOne, kOne);
}

// Copies a row-major picture of `height` rows while it is turned.
void copy_turned(const std::uint8_t* from, std::ptrdiff_t stride, std::size_t width,
                 std::size_t height, std::size_t pixel_bytes, int turns,
                 std::span<std::byte> raster) {
  const auto pixel = [&](std::size_t x, std::size_t y) {
    return from + static_cast<std::ptrdiff_t>(y) * stride +
           static_cast<std::ptrdiff_t>(x * pixel_bytes);
  };
  if (turns == 0) {
    for (std::size_t y = 0; y < height; ++y) {
      std::memcpy(raster.data() + y * width * pixel_bytes, pixel(0, y), width * pixel_bytes);
    }
    return;
  }
  std::byte* to = raster.data();
  const std::size_t columns = turns == 2 ? width : height, rows = turns == 2 ? height : width;
  for (std::size_t y = 0; y < rows; ++y) {
    for (std::size_t x = 0; x < columns; ++x, to += pixel_bytes) {
      const std::uint8_t* source = turns == 1   ? pixel(y, height - 1 - x)
                                   : turns == 2 ? pixel(width - 1 - x, height - 1 - y)
                                                : pixel(width - 1 - y, x);
      std::memcpy(to, source, pixel_bytes);
    }
  }
}

}  // namespace

std::uint32_t PixelKind::white_code() const {
  if (is_grey) return (1u << bits) - 1;
  return bits <= 8 ? 255 : 65'535;
}

PixelKind pixel_kind(const AVCodecParameters& codec, const std::string& name) {
  const AVPixFmtDescriptor* pixels = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(codec.format));
  if (pixels == nullptr || codec.width <= 0 || codec.height <= 0) {
    throw InputError(format(
        "{}: no decoder here knows its pictures; a video without a header is described with --raw",
        name));
  }
  if ((pixels->flags & AV_PIX_FMT_FLAG_FLOAT) != 0) {
    throw InputError(
        format("{} holds floating-point pixels ({}); whole numbers of up to 16 bits are read. "
               "Convert it, for example with ffmpeg -pix_fmt gray16le",
               name, pixels->name));
  }
  PixelKind kind;
  const bool is_mosaic = (pixels->flags & AV_PIX_FMT_FLAG_BAYER) != 0;
  kind.is_grey = pixels->nb_components <= 2 &&
                 (pixels->flags & (AV_PIX_FMT_FLAG_PAL | AV_PIX_FMT_FLAG_BAYER)) == 0;
  for (int component = 0; component < pixels->nb_components; ++component) {
    kind.bits = std::max(kind.bits, static_cast<std::uint32_t>(pixels->comp[component].depth));
  }
  // A mosaic's depths are shares of a pixel.
  if (is_mosaic) kind.bits = av_get_bits_per_pixel(pixels) > 8 ? 16 : 8;
  // FFmpeg's decoder of plain pictures moves codes of 9 to 15 bits up to fill 16 (Phantom cameras'
  // files).
  const int stored = codec.bits_per_coded_sample;
  if (codec.codec_id == AV_CODEC_ID_RAWVIDEO && kind.is_grey && kind.bits == 16 && stored > 8 &&
      stored < 16) {
    kind.bits = static_cast<std::uint32_t>(stored);
    kind.padding_bits = 16 - kind.bits;
  }
  return kind;
}

int quarter_turns(const AVStream& stream) {
  const auto* matrix = reinterpret_cast<const std::int32_t*>(
      av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, nullptr));
  if (matrix == nullptr) return 0;
  const double turned = av_display_rotation_get(matrix);  // counter-clockwise
  if (std::isnan(turned)) return 0;
  return static_cast<int>((std::lround(-turned / 90.0) % 4 + 4) % 4);
}

const AVFrame& PixelConverter::converted(const AVFrame& frame, const std::string& name) {
  const AVPixelFormat wanted = raster_format(kind_);
  const auto from = static_cast<AVPixelFormat>(frame.format);
  if (from == wanted) return frame;
  if (!target_ || target_->width != frame.width || target_->height != frame.height) {
    // libswscale may write whole vectors beyond a row's end, for which a raster has no room.
    target_.reset(av_frame_alloc());
    target_->format = wanted;
    target_->width = frame.width;
    target_->height = frame.height;
    if (av_frame_get_buffer(target_.get(), 0) < 0) throw std::bad_alloc();
  }
  scaler_.reset(sws_getCachedContext(
      scaler_.release(), frame.width, frame.height, from, frame.width, frame.height, wanted,
      SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT, nullptr, nullptr, nullptr));
  if (!scaler_) {
    throw InputError(
        format("{}: pixels of {} cannot be converted", name, av_get_pix_fmt_name(from)));
  }
  set_colours(scaler_.get(), frame);
  sws_scale(scaler_.get(), frame.data, frame.linesize, 0, frame.height, target_->data,
            target_->linesize);
  return *target_;
}

void PixelConverter::convert(const AVFrame& frame, std::span<std::byte> raster,
                             const std::string& name) {
  const AVFrame& picture = converted(frame, name);
  const std::size_t pixel_bytes = (kind_.is_grey ? 1u : 3u) * (kind_.bits > 8 ? 2u : 1u);
  copy_turned(picture.data[0], picture.linesize[0], static_cast<std::size_t>(picture.width),
              static_cast<std::size_t>(picture.height), pixel_bytes, turns_, raster);
  if (kind_.padding_bits == 0) return;
  auto* codes = reinterpret_cast<std::uint16_t*>(raster.data());
  for (std::size_t i = 0; i < raster.size() / 2; ++i) {
    codes[i] = static_cast<std::uint16_t>(codes[i] >> kind_.padding_bits);
  }
}

}  // namespace nutik::clips
