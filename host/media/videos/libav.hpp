// The parts of FFmpeg that are used here, with owners for what it hands out.
#pragma once

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wpedantic"
extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
#include <libavutil/dovi_meta.h>
#include <libavutil/imgutils.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}
#pragma GCC diagnostic pop

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/clip.hpp"
#include "media/videos/damage_log.hpp"
#include "media/writers/video_writer.hpp"
#include "system/input_bytes.hpp"

namespace nutik::videos {

struct FreeFormat {
  void operator()(AVFormatContext* context) const {
    AVIOContext* bytes = context->pb;  // which was opened here
    avformat_close_input(&context);
    avio_closep(&bytes);
  }
};
// By FFmpeg's function, which takes where the pointer is.
template <auto kFree>
struct Free {
  void operator()(auto* owned) const { kFree(&owned); }
};
struct FreeScaler {
  void operator()(SwsContext* context) const { sws_freeContext(context); }
};

using FormatPointer = std::unique_ptr<AVFormatContext, FreeFormat>;
using CodecPointer = std::unique_ptr<AVCodecContext, Free<avcodec_free_context>>;
using PacketPointer = std::unique_ptr<AVPacket, Free<av_packet_free>>;
using FramePointer = std::unique_ptr<AVFrame, Free<av_frame_free>>;
using ScalerPointer = std::unique_ptr<SwsContext, FreeScaler>;

// What FFmpeg is told to take where a stream does not say how fast its pictures follow each other: nobody films so.
inline constexpr AVRational kUnstatedRate{104'729, 3571};
inline constexpr int kUnstatedDelay = 997;  // hundredths of a second, of a GIF

// What FFmpeg 6.1 says in another way than those before it, whose way ends with 7 and 8.
#ifdef AV_FRAME_FLAG_INTERLACED
inline bool is_interlaced(const AVFrame& frame) { return (frame.flags & AV_FRAME_FLAG_INTERLACED) != 0; }
inline bool is_top_field_first(const AVFrame& frame) { return (frame.flags & AV_FRAME_FLAG_TOP_FIELD_FIRST) != 0; }
inline void set_interlaced(AVFrame& frame, bool is_top_first) {
  frame.flags |= AV_FRAME_FLAG_INTERLACED;
  frame.flags &= ~AV_FRAME_FLAG_TOP_FIELD_FIRST;
  if (is_top_first) frame.flags |= AV_FRAME_FLAG_TOP_FIELD_FIRST;
}
inline std::int64_t duration_of(const AVFrame& frame) { return frame.duration; }
inline std::span<const std::uint8_t> side_data(const AVStream& stream, AVPacketSideDataType type) {
  const AVCodecParameters& codec = *stream.codecpar;
  const AVPacketSideData* data =
      av_packet_side_data_get(codec.coded_side_data, codec.nb_coded_side_data, type);
  return data == nullptr ? std::span<const std::uint8_t>() : std::span(data->data, data->size);
}
inline std::uint8_t* new_side_data(AVStream& stream, AVPacketSideDataType type, std::size_t bytes) {
  AVCodecParameters& codec = *stream.codecpar;
  const AVPacketSideData* const data =
      av_packet_side_data_new(&codec.coded_side_data, &codec.nb_coded_side_data, type, bytes, 0);
  return data == nullptr ? nullptr : data->data;
}
// Without a container, a stream's avg_frame_rate is what FFmpeg was told, and r_frame_rate may count fields or ticks.
inline void set_rates_of_header(AVStream& stream) {
  if (av_cmp_q(stream.avg_frame_rate, kUnstatedRate) != 0) return;
  const AVRational in_header = stream.codecpar->framerate;
  stream.r_frame_rate = in_header.num > 0 && in_header.den > 0 ? in_header : kUnstatedRate;
  stream.avg_frame_rate = stream.r_frame_rate;
}
#else
inline void set_rates_of_header(AVStream& /*stream*/) {}
inline bool is_interlaced(const AVFrame& frame) { return frame.interlaced_frame != 0; }
inline bool is_top_field_first(const AVFrame& frame) { return frame.top_field_first != 0; }
inline void set_interlaced(AVFrame& frame, bool is_top_first) {
  frame.interlaced_frame = 1;
  frame.top_field_first = is_top_first ? 1 : 0;
}
inline std::int64_t duration_of(const AVFrame& frame) { return frame.pkt_duration; }
inline std::span<const std::uint8_t> side_data(const AVStream& stream, AVPacketSideDataType type) {
  std::size_t bytes = 0;
  const std::uint8_t* data = av_stream_get_side_data(&stream, type, &bytes);
  return data == nullptr ? std::span<const std::uint8_t>() : std::span(data, bytes);
}
inline std::uint8_t* new_side_data(AVStream& stream, AVPacketSideDataType type, std::size_t bytes) {
  return av_stream_new_side_data(&stream, type, bytes);
}
#endif

inline std::string error_text(int code) {
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(code, text, sizeof text);
  return text;
}

// What an allocation handed out. Throws std::bad_alloc where that is nothing.
template <typename Pointer>
Pointer allocated(Pointer pointer) {
  if (pointer == nullptr) throw std::bad_alloc();
  return pointer;
}

// A picture with room behind its rows for the whole vectors that libswscale writes.
inline FramePointer new_frame(AVPixelFormat pixels, int width, int height) {
  FramePointer frame(allocated(av_frame_alloc()));
  frame->format = pixels;
  frame->width = width;
  frame->height = height;
  if (av_frame_get_buffer(frame.get(), 0) < 0) throw std::bad_alloc();
  return frame;
}

// A number as the file has it, of what FFmpeg has an enumeration for: it keeps numbers that are none of its own, which
// must not be read as such.
template <typename Enumeration>
[[nodiscard]] unsigned number_of(const Enumeration& value) {
  unsigned number;
  static_assert(sizeof value == sizeof number);
  std::memcpy(&number, &value, sizeof number);
  return number;
}

// Memory is counted for pictures of the size that the container tells; a decoder that finds a larger one in its own
// data makes room for that. The limit is rough, since decoders round up to blocks and hold other buffers to it, too:
// those of MPEG-4 have 280 rows, whatever the picture has. Nothing where the container tells of no size.
inline std::optional<std::int64_t> most_pixels(const AVCodecParameters& told) {
  if (told.width <= 0 || told.height <= 0) return {};
  return (2 * std::int64_t{told.width} + 256) * (std::int64_t{told.height} + 320);
}

// What is named of pictures' colours, by the numbers of H.273.
struct ColourNumbers {
  unsigned range = AVCOL_RANGE_UNSPECIFIED, matrix = AVCOL_SPC_UNSPECIFIED, curve = AVCOL_TRC_UNSPECIFIED,
           primaries = AVCOL_PRI_UNSPECIFIED;
};
// In ProRes a matrix of 0, which is RGB's elsewhere, is unknown (SMPTE RDD 36).
inline ColourNumbers colours_of(const AVCodecParameters& codec) {
  unsigned matrix = number_of(codec.color_space);
  if (codec.codec_id == AV_CODEC_ID_PRORES && matrix == AVCOL_SPC_RGB) matrix = AVCOL_SPC_UNSPECIFIED;
  return {number_of(codec.color_range), matrix, number_of(codec.color_trc), number_of(codec.color_primaries)};
}

// An opened file and the index of its picture stream, whose parameters name the colours that its pictures do.
struct OpenedVideo {
  std::unique_ptr<DamageLog> log = std::make_unique<DamageLog>();  // of its reader; outlives it
  FormatPointer format = nullptr;
  int stream = 0;
  ColourNumbers container = {};  // what that names
};

// The name's own file, whatever the name looks like: FFmpeg takes what stands before a colon for a protocol.
inline std::string url_of(const std::filesystem::path& path) { return "file:" + path.string(); }

// Opens that file and nothing else. Throws InputError where it is none that is read (media/videos/containers.hpp).
[[nodiscard]] OpenedVideo open_video(const std::filesystem::path& path, const std::optional<RawVideo>& raw);

// Writes into containers.
[[nodiscard]] std::unique_ptr<VideoWriter> open_libav_writer(const std::filesystem::path& path,
                                                             const VideoFormat& format, const VideoCodec& codec);

}  // namespace nutik::videos
