// The parts of FFmpeg that are used here, with owners for what it hands out.
#pragma once

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wpedantic"
extern "C" {
#include <libavcodec/avcodec.h>
#include <libavfilter/avfilter.h>
#include <libavfilter/buffersink.h>
#include <libavfilter/buffersrc.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
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
#include <string>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/clip.hpp"
#include "system/input_bytes.hpp"

namespace nutik::videos {

struct FreeFormat {
  void operator()(AVFormatContext* context) const { avformat_close_input(&context); }
};
struct FreeCodec {
  void operator()(AVCodecContext* context) const { avcodec_free_context(&context); }
};
struct FreePacket {
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};
struct FreeFrame {
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
};
struct FreeGraph {
  void operator()(AVFilterGraph* graph) const { avfilter_graph_free(&graph); }
};
struct FreeScaler {
  void operator()(SwsContext* context) const { sws_freeContext(context); }
};

using FormatPointer = std::unique_ptr<AVFormatContext, FreeFormat>;
using CodecPointer = std::unique_ptr<AVCodecContext, FreeCodec>;
using PacketPointer = std::unique_ptr<AVPacket, FreePacket>;
using FramePointer = std::unique_ptr<AVFrame, FreeFrame>;
using GraphPointer = std::unique_ptr<AVFilterGraph, FreeGraph>;
using ScalerPointer = std::unique_ptr<SwsContext, FreeScaler>;

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

// Memory is counted for pictures of the size that the container tells; a decoder that finds a larger one in its own data
// makes room for that. The limit is rough, since decoders round up to blocks and hold other buffers to it, too: those of
// MPEG-4 have 280 rows, whatever the picture has. Nothing where the container tells of no size.
inline std::optional<std::int64_t> most_pixels(const AVCodecParameters& told) {
  if (told.width <= 0 || told.height <= 0) return {};
  return (2 * std::int64_t{told.width} + 256) * (std::int64_t{told.height} + 320);
}

// What a file of this size is believed to hold: 7680 x 4320 in any case. Larger pictures need 4 kB and more, which those
// of any camera have. FFmpeg takes no setting above an int.
inline std::int64_t most_pixels(const AVFormatContext& context) {
  constexpr std::int64_t kPixelsAByte = 8256, kSmall = std::int64_t{1} << 25, kMost = INT32_MAX;
  const std::int64_t bytes = avio_size(context.pb);
  return bytes < 0 || bytes > kMost / kPixelsAByte ? kMost : std::max(kSmall, bytes * kPixelsAByte);
}

// Of each stream what is not known before some of its pictures are decoded, which comes before memory is counted.
// Returns FFmpeg's error code. Throws InputError where a stream states too many pixels.
inline int find_stream_info(AVFormatContext& context, const std::string& name) {
  const std::int64_t most = most_pixels(context);
  for (unsigned i = 0; i < context.nb_streams; ++i) {
    const AVCodecParameters& told = *context.streams[i]->codecpar;
    if (std::int64_t{told.width} * told.height <= most) continue;
    const std::int64_t bytes = avio_size(context.pb);
    throw InputError(
        format("{} cannot be read: {} x {} pixels are more than {} can hold; it is damaged, or described wrongly",
               name, told.width, told.height, bytes < 0 ? "a picture" : format("its {} bytes", bytes)));
  }
  std::vector<AVDictionary*> settings(context.nb_streams);
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const auto told = most_pixels(*context.streams[i]->codecpar);
    av_dict_set_int(&settings[i], "max_pixels", std::min(most, told.value_or(most)), 0);
  }
  const int code = avformat_find_stream_info(&context, settings.empty() ? nullptr : settings.data());
  for (AVDictionary*& each : settings) av_dict_free(&each);
  return code;
}

// An opened file and the index of its picture stream.
struct OpenedVideo {
  FormatPointer format;
  int stream = 0;
};

inline OpenedVideo open_video(const std::filesystem::path& path, const std::optional<RawVideo>& raw) {
  AVFormatContext* context = nullptr;
  AVDictionary* settings = nullptr;
  const AVInputFormat* kind = nullptr;
  av_dict_set(&settings, "protocol_whitelist", "file", 0);  // a playlist may name what it likes
  if (raw) {
    if (av_get_pix_fmt(raw->pixel_format.c_str()) == AV_PIX_FMT_NONE) {
      throw UsageError(
          format("raw video: '{}' is no pixel format that FFmpeg knows; examples are "
                 "yuv420p10le and gray16le",
                 raw->pixel_format));
    }
    kind = av_find_input_format("rawvideo");
    av_dict_set(&settings, "video_size", format("{}x{}", raw->width, raw->height).c_str(), 0);
    av_dict_set(&settings, "pixel_format", raw->pixel_format.c_str(), 0);
  }
  int code = avformat_open_input(&context, path.c_str(), kind, &settings);
  av_dict_free(&settings);
  if (code < 0) {
    throw InputError(
        format("{} is no video that can be read: {}; a video without a header has to be described",
               input_title(path.string()), error_text(code)),
        {Setting::raw_layout});
  }
  OpenedVideo opened{FormatPointer(context), 0};
  code = find_stream_info(*context, input_title(path.string()));
  if (code >= 0) code = av_find_best_stream(context, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (code < 0) throw InputError(format("{} has no video stream", input_title(path.string())));
  opened.stream = code;
  return opened;
}

}  // namespace nutik::videos
