#include <algorithm>
#include <vector>

#include "capture/capture_mark.hpp"
#include "media/formats/file_kinds.hpp"
#include "media/videos/capture_rate.hpp"
#include "media/videos/containers.hpp"
#include "media/videos/libav.hpp"
#include "system/mapped_file.hpp"

namespace nutik::videos {
namespace {

// What a file of this size is believed to hold: 7680 x 4320 in any case. Larger pictures need 4 kB and more, which
// those of any camera have. FFmpeg takes no setting above an int.
std::int64_t most_pixels_in(const AVFormatContext& context) {
  constexpr std::int64_t kPixelsAByte = 8256, kSmall = std::int64_t{1} << 25, kMost = INT32_MAX;
  const std::int64_t bytes = avio_size(context.pb);
  return bytes < 0 || bytes > kMost / kPixelsAByte ? kMost : std::max(kSmall, bytes * kPixelsAByte);
}

// Finds what is not known of each stream before some of its pictures are decoded, which comes before memory is counted.
// Returns FFmpeg's error code. Throws InputError where a stream states too many pixels.
int find_stream_info(AVFormatContext& context, const std::string& name) {
  const std::int64_t most = most_pixels_in(context);
  for (unsigned i = 0; i < context.nb_streams; ++i) {
    const AVCodecParameters& told = *context.streams[i]->codecpar;
    if (std::int64_t{told.width} * told.height <= most) continue;
    const std::int64_t bytes = avio_size(context.pb);
    throw InputError(format(
        "{} cannot be read: {} x {} pixels are more than {} can hold; it is damaged, or described wrongly",
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

// What a file names is never opened for it: a playlist, a reference to another film.
int open_nothing(AVFormatContext*, AVIOContext**, const char*, int, AVDictionary**) { return AVERROR(EPERM); }

// What FFmpeg takes the file for. Throws InputError where that is nothing that is read.
const AVInputFormat& kind_of(AVIOContext& bytes, const std::filesystem::path& path) {
  const std::string title = input_title(path.string());
  const AVInputFormat* kind = nullptr;
  // FFmpeg knows a bitmap only if a new line follows its first letters, and takes others for a sequence by their name.
  const std::string start = first_bytes(path);
  if (begins_as_netpbm(start) && !inputs::kNetpbm.begins(start)) kind = av_find_input_format("pbm_pipe");
  if (kind != nullptr) return *kind;
  // A name of stills would have the next ones read as well.
  const char* const name = holds_several_pictures(path) ? "" : path.c_str();
  const int code = av_probe_input_buffer2(&bytes, &kind, name, nullptr, 0, 0);
  const std::string taken_for =
      code < 0 ? error_text(code) : format("it is taken for {} ({})", kind->name, kind->long_name);
  const Containers* known = code < 0 ? nullptr : containers_with(kind->name);
  if (known != nullptr && !known->refusal.empty())
    throw InputError(
        format("{} is no video that can be read: {}, which {}", title, taken_for, known->refusal));
  if (known != nullptr && kind != av_find_input_format("rawvideo")) return *kind;
  throw InputError(
      format(
          "{} is no video that can be read: {}{}; a video without a header has to be described", title,
          taken_for,
          code < 0 || known != nullptr
              ? ""
              : ", which is not read; if it is a film, ffmpeg -i CLIP -c:v ffv1 film.mkv makes one that is"),
      {Setting::raw_layout});
}

}  // namespace

OpenedVideo open_video(const std::filesystem::path& path, const std::optional<RawVideo>& raw) {
  if (raw && av_get_pix_fmt(raw->pixel_format.c_str()) == AV_PIX_FMT_NONE) {
    throw UsageError(
        format("raw video: '{}' is no pixel format that FFmpeg knows; examples are "
               "yuv420p10le and gray16le",
               raw->pixel_format));
  }
  const std::string title = input_title(path.string());
  OpenedVideo opened;
  opened.format.reset(allocated(avformat_alloc_context()));
  AVFormatContext* context = opened.format.get();
  opened.log->listen_to(context->opaque);
  context->io_open = open_nothing;
  context->flags |= AVFMT_FLAG_CUSTOM_IO;
  int code = avio_open(&context->pb, url_of(path).c_str(), AVIO_FLAG_READ);
  if (code < 0) throw InputError(format("{} cannot be read: {}", title, error_text(code)));
  const AVInputFormat& kind = raw ? *av_find_input_format("rawvideo") : kind_of(*context->pb, path);
  // Settings that a container's reader does not have are left out.
  AVDictionary* settings = nullptr;
  av_dict_set(&settings, "framerate", format("{}/{}", kUnstatedRate.num, kUnstatedRate.den).c_str(), 0);
  if (has_edits(path)) av_dict_set(&settings, "ignore_editlist", "1", 0);
  av_dict_set(&settings, "min_delay", "1", 0);  // hundredths of a second, of a GIF's picture; less is not stated
  av_dict_set_int(&settings, "default_delay", kUnstatedDelay, 0);
  if (raw) {
    av_dict_set(&settings, "video_size", format("{}x{}", raw->width, raw->height).c_str(), 0);
    av_dict_set(&settings, "pixel_format", raw->pixel_format.c_str(), 0);
  }
  AVIOContext* bytes = context->pb;
  static_cast<void>(opened.format.release());  // what cannot be opened is freed there
  code = avformat_open_input(&context, path.c_str(), &kind, &settings);
  av_dict_free(&settings);
  if (code < 0) {
    avio_closep(&bytes);
    const std::string front = first_bytes(path);
    const bool is_mp4 = front.size() >= 8 && (front.substr(4, 4) == "ftyp" || front.substr(4, 4) == "mdat");
    if (is_mp4 && opened.log->said().value_or("").find("moov atom not found") != std::string::npos) {
      throw InputError(
          format("{} cannot be read: its index (moov) is missing, which cameras write when a recording ends; "
                 "programs that repair such files make it anew from another recording of the same camera",
                 title));
    }
    const std::string why = opened.log->said().value_or(error_text(code));
    if (raw) throw InputError(format("{} cannot be read as it is described: {}", title, why), {Setting::raw_layout});
    throw InputError(
        format("{} is no video that can be read: its header, of {} ({}), is damaged or names what FFmpeg does not read "
               "({}); if it plays elsewhere, save it there as another kind of film",
               title, kind.name, kind.long_name, why));
  }
  opened.format.reset(context);
  std::vector<ColourNumbers> named;  // before decoders name others
  for (unsigned i = 0; i < context->nb_streams; ++i) named.push_back(colours_of(*context->streams[i]->codecpar));
  code = find_stream_info(*context, title);
  for (unsigned i = 0; i < context->nb_streams; ++i) {
    AVStream& each = *context->streams[i];
    const bool is_cover = (each.disposition & AV_DISPOSITION_ATTACHED_PIC) != 0;
    if (is_cover) each.codecpar->codec_type = AVMEDIA_TYPE_ATTACHMENT;
  }
  if (code >= 0) code = av_find_best_stream(context, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (code < 0) throw InputError(format("{} has no video stream", title));
  opened.stream = code;
  if (static_cast<std::size_t>(code) < named.size()) opened.container = named[static_cast<std::size_t>(code)];
  set_rates_of_header(*context->streams[code]);
  return opened;
}

}  // namespace nutik::videos
