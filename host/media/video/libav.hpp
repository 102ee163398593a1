// The parts of FFmpeg that are used here, with owners for what it hands out.
#pragma once

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wpedantic"
extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}
#pragma GCC diagnostic pop

#include <filesystem>
#include <memory>
#include <string>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik::video {

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
struct FreeScaler {
  void operator()(SwsContext* context) const { sws_freeContext(context); }
};

using FormatPointer = std::unique_ptr<AVFormatContext, FreeFormat>;
using CodecPointer = std::unique_ptr<AVCodecContext, FreeCodec>;
using PacketPointer = std::unique_ptr<AVPacket, FreePacket>;
using FramePointer = std::unique_ptr<AVFrame, FreeFrame>;
using ScalerPointer = std::unique_ptr<SwsContext, FreeScaler>;

inline std::string error_text(int code) {
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(code, text, sizeof text);
  return text;
}

// An opened file and the index of its picture stream.
struct OpenedVideo {
  FormatPointer format;
  int stream = 0;
};

inline OpenedVideo open_video(const std::filesystem::path& path) {
  AVFormatContext* context = nullptr;
  int code = avformat_open_input(&context, path.c_str(), nullptr, nullptr);
  if (code < 0) {
    throw InputError(format("{} is no video that can be read: {}", path.string(), error_text(code)));
  }
  OpenedVideo opened{FormatPointer(context), 0};
  code = avformat_find_stream_info(context, nullptr);
  if (code >= 0) code = av_find_best_stream(context, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (code < 0) throw InputError(format("{} has no video stream", path.string()));
  opened.stream = code;
  return opened;
}

}  // namespace nutik::video
