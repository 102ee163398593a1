#include "media/videos/probe.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <span>
#include <utility>

#include "capture/median.hpp"
#include "media/formats/coding_points.hpp"
#include "media/videos/capture_rate.hpp"
#include "media/videos/libav.hpp"
#include "media/videos/phantom_file.hpp"
#include "media/videos/picture_decoder.hpp"
#include "media/videos/picture_times.hpp"
#include "media/videos/sound.hpp"
#include "system/mapped_file.hpp"

namespace nutik::videos {
namespace {

// What the file calls its transfer function; empty where it names none.
std::string transfer_name(unsigned number) {
  if (number == AVCOL_TRC_UNSPECIFIED || number == AVCOL_TRC_RESERVED0 || number == AVCOL_TRC_RESERVED) {
    return {};
  }
  const char* const name = number < AVCOL_TRC_NB
                               ? av_color_transfer_name(static_cast<AVColorTransferCharacteristic>(number))
                               : nullptr;
  return name == nullptr ? std::to_string(number) : name;
}

// By its number where FFmpeg knows none.
std::string matrix_name(unsigned number) {
  const char* const name = number < AVCOL_SPC_NB ? av_color_space_name(static_cast<AVColorSpace>(number)) : nullptr;
  return name != nullptr ? name : format("number {} of H.273", number);
}
std::string primaries_name(unsigned number) {
  const char* const name =
      number < AVCOL_PRI_NB ? av_color_primaries_name(static_cast<AVColorPrimaries>(number)) : nullptr;
  return name != nullptr ? name : format("number {} of H.273", number);
}

// Those that count: a container's go before those that its pictures name (ISO/IEC 14496-12, 12.1.5), with a note where
// these are others. But programs write the limited range into MP4s of RGB whose pictures name the full one.
ColourNumbers named_colours(const OpenedVideo& opened, const ColourNumbers& coded, std::vector<Note>& notes) {
  using Numbers = const ColourNumbers&;
  const auto pixels = static_cast<AVPixelFormat>(opened.format->streams[opened.stream]->codecpar->format);
  ColourNumbers taken = coded;
  std::string theirs, others;
  std::vector<Setting> settings;
  const auto settle = [&](unsigned ColourNumbers::* number, unsigned none, Setting setting, const auto& text) {
    if (opened.container.*number == none) return;
    taken.*number = opened.container.*number;
    const std::string here = text(opened.container), there = text(coded);
    if (coded.*number == none || here == there) return;
    theirs += (theirs.empty() ? "" : ", ") + here;
    others += (others.empty() ? "" : ", ") + there;
    settings.push_back(setting);
  };
  if (is_yuv(pixels) || coded.range != AVCOL_RANGE_JPEG) {
    settle(&ColourNumbers::range, AVCOL_RANGE_UNSPECIFIED, Setting::range,
           [](Numbers each) { return std::string(each.range == AVCOL_RANGE_JPEG ? "full range" : "limited range"); });
  }
  settle(&ColourNumbers::matrix, AVCOL_SPC_UNSPECIFIED, Setting::matrix, [](Numbers each) {
    const auto known = named_matrix(each.matrix, each.primaries);
    return format("matrix {}", known ? to_text(*known) : matrix_name(each.matrix));
  });
  settle(&ColourNumbers::curve, AVCOL_TRC_UNSPECIFIED, Setting::transfer, [](Numbers each) {
    const auto known = transfer_of_coding_point(each.curve);
    return "transfer " + (known ? known->text() : transfer_name(each.curve));
  });
  settle(&ColourNumbers::primaries, AVCOL_PRI_UNSPECIFIED, Setting::primaries, [](Numbers each) {
    const auto known = primaries_of_coding_point(each.primaries);
    return "primaries " + (known ? std::string(to_text(*known)) : primaries_name(each.primaries));
  });
  if (!settings.empty()) {
    notes.emplace_back(
        format("the container names {}, and by its pictures it would be {}: the container's count; state others if "
               "these are wrong",
               theirs, others),
        std::move(settings));
  }
  return taken;
}

std::optional<Rational> pixel_aspect(AVFormatContext* format, AVStream& stream, const Upright& upright) {
  const AVRational stored = av_guess_sample_aspect_ratio(format, &stream, nullptr);
  if (stored.num <= 0 || stored.den <= 0) return std::nullopt;
  return upright.quarter_turns % 2 == 0 ? Rational::of(stored.num, stored.den) : Rational::of(stored.den, stored.num);
}

// The first picture whose time cannot be meant: not after the one before, or so long after it that
// the clock was set in between. 0 where all can. Real files end with such a time.
std::size_t first_senseless(const std::vector<std::int64_t>& starts_ns) {
  constexpr std::int64_t kLongestPause = 1000;  // usual periods
  std::vector<std::int64_t> periods;
  for (std::size_t k = 1; k < starts_ns.size(); ++k) periods.push_back(starts_ns[k] - starts_ns[k - 1]);
  const std::int64_t usual = median(periods);
  for (std::size_t k = 1; k < starts_ns.size(); ++k) {
    if (periods[k - 1] <= 0 || periods[k - 1] / kLongestPause > usual) return k;
  }
  return 0;
}

// Where a camera's own times are not those of the rate that it states. Cameras count periods in whole ticks of their
// clock, too: 90 000 a second are 311 ticks of 28 MHz, which are 90 032 a second.
std::optional<Note> other_rate_note(const Rational& stated, const ClipTiming& timing) {
  if (timing.rate == stated) return {};
  std::string found;
  if (timing.rate) {
    const double taken = timing.rate->value(), times = std::round(stated.value() / taken);
    found = format("has {:.6g}", taken);
    if (times >= 2.0) found += format(", one in {:.0f} of {:.6g}", times, taken * times);
  } else {
    const std::vector<std::int64_t>& starts = timing.starts_ns;
    std::int64_t least = INT64_MAX, most = 0;
    for (std::size_t k = 1; k < starts.size(); ++k) {
      least = std::min(least, starts[k] - starts[k - 1]);
      most = std::max(most, starts[k] - starts[k - 1]);
    }
    found = format("has them {} to {} ns apart", least, most);
  }
  return Note(
      format("the camera states {} pictures a second, and by the times that it wrote down the file {}. These "
             "times are taken; state a rate if they are wrong",
             stated.text(), found),
      {Setting::frame_rate});
}

// The demuxer numbers the pictures of a .cine and knows the camera's nominal rate. When they were
// taken the camera wrote down, too: a file may hold every tenth picture only.
void add_cine_header(const CineHeader& header, const OpenedVideo& opened, const std::string& name,
                     Probe& result) {
  const std::vector<std::int64_t>& starts = header.starts_ns;
  if (starts.size() > 1 && starts.size() == result.sample_count) {
    const std::size_t senseless = first_senseless(starts);
    if (senseless == 0) {
      const AVStream& stream = *opened.format->streams[opened.stream];
      const std::vector<KnownRate> stated = announced_rates(*opened.format, stream);
      result.timing = timing_of(starts, {1, kSecondNs}, stated, name);
      result.timing.rate_from = "the camera's times in the file";
      auto note = stated.empty() ? std::nullopt : other_rate_note(stated.front().rate, result.timing);
      if (note) result.notes.push_back(std::move(*note));
    } else {
      result.notes.emplace_back(
          format("the camera's times are not used: picture {} is stamped {} ns after the one "
                 "before it. The nominal rate is taken",
                 senseless, starts[senseless] - starts[senseless - 1]));
    }
  }
  result.timing.exposed_ns = header.exposed_ns;
  if (header.black_code > 0) {
    result.notes.emplace_back(
        format("the camera's black is code {} of {}, and stays so: what is dark comes out a little lighter "
               "than it was",
               header.black_code, result.pixels.white_code()));
  }
}

// How long a file says that its pictures last, in seconds; nothing where it does not, or may mean its sound.
std::optional<double> announced_seconds(const AVFormatContext& file, const AVStream& stream) {
  if (stream.duration != AV_NOPTS_VALUE && stream.duration > 0) {
    return static_cast<double>(stream.duration) * av_q2d(stream.time_base);
  }
  const bool is_estimated = file.duration_estimation_method == AVFMT_DURATION_FROM_BITRATE;
  if (file.nb_streams != 1 || is_estimated || file.duration == AV_NOPTS_VALUE || file.duration <= 0)
    return {};
  return static_cast<double>(file.duration) / AV_TIME_BASE;
}

// A container that was cut off is often read to its end without a word, which comes too early; and where its start
// `is_damaged`, from the first picture that is found. Segments of a film begin late, too.
std::optional<std::string> missing_part_note(const AVFormatContext& file, const AVStream& stream,
                                             std::int64_t last_end, std::size_t pictures, bool is_damaged) {
  const auto announced = announced_seconds(file, stream);
  if (!announced || last_end == INT64_MIN || pictures < 2) return {};
  const std::int64_t start = stream.start_time == AV_NOPTS_VALUE ? 0 : stream.start_time;
  const double found =
      (static_cast<double>(last_end) - static_cast<double>(start)) * av_q2d(stream.time_base);
  constexpr double kPeriods = 2.5;  // that containers may be off by
  const double max_off = kPeriods * found / static_cast<double>(pictures);
  if (*announced - found <= max_off) return {};
  const double first = static_cast<double>(start) * av_q2d(stream.time_base);
  if (*announced - first - found <= max_off) {
    if (!is_damaged) return {};
    return format(
        "the file lasts {:.4g} s from its start on, and its first picture comes after {:.4g} s: those before "
        "it "
        "were cut off, or cannot be read. Time 0 is that of the first that can",
        *announced, first);
  }
  return format(
      "the file says that it lasts {:.4g} s, and its pictures end after {:.4g} s: it was cut off, or damaged "
      "so that some are missing",
      *announced, found);
}

// What a Matroska file lacks by what it says of its elements: each has a name and a length, of as many bytes as the
// zero bits in front of them tell, and so many bytes. One that was streamed does not tell the length of its segment,
// nor of a cluster: what is in them follows as if it were beside them.
std::optional<std::string> matroska_cut_note(std::span<const std::byte> bytes) {
  constexpr std::uint64_t kSegment = 0x18538067, kCluster = 0x1F43B675;
  std::uint64_t at = 0;
  const auto take_number = [&](bool with_mark) -> std::optional<std::uint64_t> {
    if (at >= bytes.size()) return {};
    const auto first = std::to_integer<unsigned char>(bytes[at]);
    const auto count = static_cast<std::uint64_t>(std::countl_zero(first)) + 1;
    if (count > 8 || at + count > bytes.size()) return {};
    std::uint64_t number = with_mark ? first : first & (0xFFu >> count);
    for (std::uint64_t i = 1; i < count; ++i) number = number << 8 | std::to_integer<std::uint64_t>(bytes[at + i]);
    at += count;
    return !with_mark && number == (std::uint64_t{1} << (7 * count)) - 1 ? UINT64_MAX : number;
  };
  while (at < bytes.size()) {
    const std::uint64_t start = at;
    const auto name = take_number(true), length = take_number(false);
    const bool is_open = length == UINT64_MAX && (name == kSegment || name == kCluster);
    if (is_open) continue;
    if (name == kSegment && length) {
      if (at + *length <= bytes.size()) return {};
      return format("the file was cut off: {} of its {} bytes are there", bytes.size(), at + *length);
    }
    if (!name || !length || *length > bytes.size() - at)
      return format("the file was cut off or damaged behind its first {} bytes", start);
    at += *length;
  }
  return {};
}

// With its buffer, which it may have replaced.
struct FreeReader {
  void operator()(AVIOContext* reader) const {
    av_freep(&reader->buffer);
    avio_context_free(&reader);
  }
};

// Whether a NUT file without an index, whose last picture ends with the file, has all of that picture: what reads more
// than there is would take a byte that is added to it.
bool has_all_of_last(const AVInputFormat& kind, std::span<const std::byte> bytes) {
  struct Longer {
    std::span<const std::byte> bytes;
    std::size_t at = 0;
  } longer{bytes};
  const auto read = [](void* user, std::uint8_t* to, int most) {
    auto& [all, at] = *static_cast<Longer*>(user);
    if (at > all.size()) return AVERROR_EOF;
    const std::size_t count = std::min(static_cast<std::size_t>(most), all.size() - at);
    std::memcpy(to, all.data() + at, count);
    if (count == 0) *to = 0;
    at += std::max<std::size_t>(count, 1);
    return static_cast<int>(std::max<std::size_t>(count, 1));
  };
  constexpr int kBufferBytes = 1 << 16;
  std::unique_ptr<void, decltype(&av_free)> buffer(allocated(av_malloc(kBufferBytes)), av_free);
  const std::unique_ptr<AVIOContext, FreeReader> reader(allocated(avio_alloc_context(
      static_cast<unsigned char*>(buffer.get()), kBufferBytes, 0, &longer, read, nullptr, nullptr)));
  static_cast<void>(buffer.release());
  const PacketPointer packet(allocated(av_packet_alloc()));
  AVFormatContext* context = allocated(avformat_alloc_context());
  context->pb = reader.get();
  std::int64_t end = 0;
  if (avformat_open_input(&context, "", &kind, nullptr) == 0) {
    for (; av_read_frame(context, packet.get()) >= 0; av_packet_unref(packet.get())) end = packet->pos + packet->size;
    avformat_close_input(&context);
  }
  return end == static_cast<std::int64_t>(bytes.size());
}

// A video without an index is read as far as there are whole pictures: what it lacks is told by its last bytes.
std::optional<std::string> cut_picture_note(const AVFormatContext& file, std::span<const std::byte> bytes,
                                            std::int64_t pictures_end, std::size_t pictures) {
  const std::string_view kind = file.iformat->name;
  const auto size = static_cast<std::int64_t>(bytes.size());
  if (kind == "yuv4mpegpipe" && size > pictures_end) {
    return format("it was cut off within picture {}: {} bytes behind the last whole one are left out", pictures,
                  size - pictures_end);
  }
  if (kind == "gif" && !bytes.empty() && bytes.back() != std::byte{0x3B})
    return "the file was cut off: a GIF's last byte is missing, and pictures may be";
  if (kind == "matroska,webm") return matroska_cut_note(bytes);
  // Packets stand alone, with a clock before each, as on discs, or with a checksum behind each.
  const bool is_whole = size % 188 == 0 || size % 192 == 0 || size % 204 == 0;
  if (kind == "mpegts" && !is_whole)
    return "the file was cut off within one of its packets, and pictures may be missing";
  return {};
}

// Whether the file has all of the packet that was the last to be read. Broadcasts and discs say it in their own way.
bool is_whole(const AVFormatContext& file, const AVPacket& packet, std::int64_t file_bytes) {
  if ((file.iformat->flags & AVFMT_TS_DISCONT) != 0) return true;
  const std::string_view kind = file.iformat->name;
  // Each of a tape's pictures has as many bytes, and what is missing of the last would be the one before it.
  if (kind == "dv") return packet.pos + packet.size <= file_bytes;
  if (kind == "nut") return packet.pos + packet.size < file_bytes;  // which ends with an index
  return (packet.flags & AV_PKT_FLAG_CORRUPT) == 0;
}

// How many pictures the file holds. A size or format that is wrong would cut them at the wrong places.
std::uint64_t count_raw_pictures(const std::filesystem::path& path, const RawVideo& raw) {
  const int bytes = av_image_get_buffer_size(av_get_pix_fmt(raw.pixel_format.c_str()),
                                             static_cast<int>(raw.width), static_cast<int>(raw.height), 1);
  const std::uint64_t file_bytes = std::filesystem::file_size(path);
  if (bytes > 0 && file_bytes > 0 && file_bytes % static_cast<std::uint64_t>(bytes) == 0) {
    return file_bytes / static_cast<std::uint64_t>(bytes);
  }
  throw InputError(
      format("{} has {} bytes, which is no whole number of pictures of {} bytes ({} x {}, {}); "
             "check its size and pixel format",
             input_title(path.string()), file_bytes, bytes, raw.width, raw.height, raw.pixel_format),
      {Setting::raw_layout});
}

// When pictures are shown that a decoder hands out: those that it holds at the end, and for which no packet comes that
// tells, as long after each other as they are said to last.
std::vector<std::int64_t> decoded_times(const std::filesystem::path& path,
                                        const PictureDecoder::Packets& packets) {
  PictureDecoder decoder(open_video(path, std::nullopt), input_title(path.string()),
                         PictureDecoder::Wanted::times, packets, 1);
  const FramePointer picture(allocated(av_frame_alloc()));
  std::vector<std::int64_t> times;
  while (decoder.next(*picture)) {
    std::int64_t time = picture->best_effort_timestamp;
    if (time == AV_NOPTS_VALUE && !times.empty() && times.back() != AV_NOPTS_VALUE) {
      const std::int64_t duration = std::max<std::int64_t>(duration_of(*picture), 1);
      time = std::min(times.back(), INT64_MAX - duration) + duration;
    }
    times.push_back(time);
  }
  return times;
}

// When pictures are shown, and what that tells of those that are not. A stream for broadcasts or discs can be cut
// anywhere.
std::vector<std::int64_t> picture_times(const std::filesystem::path& path, const OpenedVideo& opened,
                                        const std::vector<PacketTimes>& packets, Probe& result) {
  if ((opened.format->iformat->flags & AVFMT_TS_DISCONT) != 0) result.packets.first = packets_before_key(packets);
  if (result.packets.first == 0 && !must_be_decoded(packets)) {
    return shown_times(packets, opened.format->streams[opened.stream]->codecpar->video_delay);
  }
  std::vector<std::int64_t> times = decoded_times(path, result.packets);
  result.sample_count = times.size();
  if (times.size() < packets.size()) {
    result.notes.emplace_back(
        format("{} of the file's {} packets give no picture, as where it was cut in its middle and its first "
               "pictures refer to others that are gone: time 0 is that of the first that can be decoded",
               packets.size() - times.size(), packets.size()));
  }
  if (!times.empty() && times.front() == AV_NOPTS_VALUE) times.clear();
  return times;
}

// How pictures come to stand upright that say it themselves: of H.264 or HEVC, from a stream's first packet.
Upright upright_of_first(const AVPacket& packet, const AVCodecParameters& codec) {
  if (codec.codec_id != AV_CODEC_ID_H264 && codec.codec_id != AV_CODEC_ID_HEVC) return {};
  const CodecPointer decoder(allocated(avcodec_alloc_context3(avcodec_find_decoder(codec.codec_id))));
  const FramePointer picture(allocated(av_frame_alloc()));
  avcodec_parameters_to_context(decoder.get(), &codec);
  decoder->skip_loop_filter = decoder->skip_idct = AVDISCARD_ALL;
  decoder->max_pixels = most_pixels(codec).value_or(decoder->max_pixels);
  if (avcodec_open2(decoder.get(), nullptr, nullptr) < 0) return {};
  avcodec_send_packet(decoder.get(), &packet);
  avcodec_send_packet(decoder.get(), nullptr);
  if (avcodec_receive_frame(decoder.get(), picture.get()) < 0) return {};
  const AVFrameSideData* const data = av_frame_get_side_data(picture.get(), AV_FRAME_DATA_DISPLAYMATRIX);
  return data == nullptr ? Upright{} : upright_of(std::span(data->data, data->size));
}

void name_colours(const OpenedVideo& opened, const std::filesystem::path& path, bool is_raw, Probe& result) {
  const AVCodecParameters& codec = *opened.format->streams[opened.stream]->codecpar;
  const auto& [range, matrix, curve, primaries] = named_colours(opened, colours_of(codec), result.notes);
  result.transfer = is_phantom_packed(codec) ? Transfer::linear() : transfer_of_coding_point(curve);
  result.transfer_name = transfer_name(curve);
  result.matrix = named_matrix(matrix, primaries);
  result.range = named_range(range, result.pixel_format);
  result.chroma_at = named_chroma_place(codec);
  result.primaries = primaries_of_coding_point(primaries);
  if (const auto named = is_raw ? std::nullopt : named_curve(*opened.format, path, result.notes)) {
    result.transfer = named->transfer;
    result.primaries = named->primaries;
    result.curve_from = named->from;
  }
  if (result.primaries == Primaries::bt709 && primaries != AVCOL_PRI_BT709)
    result.near_primaries = primaries_name(primaries);
  const auto note_unknown = [&](bool is_known, const char* what, const std::string& name, Setting setting) {
    if (is_known || name.empty()) return;
    result.notes.emplace_back(
        format("the file's {}, {}, is not known here and another is taken; state which", what, name),
        std::vector{setting});
  };
  note_unknown(result.transfer.has_value(), "transfer function", result.transfer_name, Setting::transfer);
  if (matrix != AVCOL_SPC_UNSPECIFIED && matrix != AVCOL_SPC_RESERVED && is_yuv(result.pixel_format) &&
      !result.pixels.is_grey && !result.matrix) {
    result.unread_matrix = matrix_name(matrix);
    result.matrix_filter = filter_from_matrix(matrix, curve);
  }
  if (primaries != AVCOL_PRI_UNSPECIFIED && primaries != AVCOL_PRI_RESERVED &&
      primaries != AVCOL_PRI_RESERVED0 && !(result.transfer && result.transfer->usual_primaries())) {
    note_unknown(result.primaries.has_value(), "set of primaries", primaries_name(primaries), Setting::primaries);
  }
  AVDOVIDecoderConfigurationRecord vision;
  const auto dolby = side_data(*opened.format->streams[opened.stream], AV_PKT_DATA_DOVI_CONF);
  if (dolby.size() < sizeof vision) return;
  std::memcpy(&vision, dolby.data(), sizeof vision);
  if (vision.dv_profile == 5 || (vision.dv_profile == 10 && vision.dv_bl_signal_compatibility_id == 0)) {
    result.unread_matrix = format("IPT of Dolby Vision's profile {}", vision.dv_profile);
    result.matrix_filter = "libplacebo=colorspace=bt709:color_primaries=bt709:color_trc=bt709:format=yuv420p10";
  }
}

// How many of the file's first streams hold this.
int count_streams(const OpenedVideo& opened, AVMediaType type, std::size_t first) {
  return static_cast<int>(std::ranges::count(std::span(opened.format->streams, first), type,
                                             [](const AVStream* each) { return each->codecpar->codec_type; }));
}

// Edits, other streams and transparency.
void note_left_out(const OpenedVideo& opened, const std::filesystem::path& path, bool is_raw, Probe& result) {
  const AVStream& stream = *opened.format->streams[opened.stream];
  if (!is_raw && has_edits(path)) {
    result.notes.emplace_back(
        "the file's edit list plays parts of it again, in another order, or at another speed: its pictures are taken "
        "once each, in the order and at the times in which they were filmed");
  }
  if (const int films = count_streams(opened, AVMEDIA_TYPE_VIDEO, opened.format->nb_streams); films > 1) {
    result.notes.emplace_back(
        format("the file has {} streams of pictures, and stream {} is taken: ffmpeg -i CLIP -map 0:N -c copy film.mkv "
               "makes a clip of another",
               films, opened.stream));
  }
  // No VP9 is decoded with transparency.
  const bool has_alpha = (av_pix_fmt_desc_get(result.pixel_format)->flags & AV_PIX_FMT_FLAG_ALPHA) != 0;
  const AVDictionaryEntry* const mode = av_dict_get(stream.metadata, "alpha_mode", nullptr, 0);
  const bool says_so = mode != nullptr && mode->value == std::string_view("1");
  if ((has_alpha && !is_seen_as_transparent(*stream.codecpar)) || says_so)
    result.notes.emplace_back(left_out_note(kTransparency));
}

// Packets of the stream of pictures, up to the file's end or to where it cannot be read.
struct ReadPackets {
  std::vector<PacketTimes> shown;
  std::uint64_t count = 0;  // those that are not shown, too
  std::int64_t last_end = INT64_MIN, last_byte = 0;
  bool is_last_whole = true, has_damaged_start = false;
  int end = 0;  // FFmpeg's code
};

ReadPackets read_packets(const OpenedVideo& opened, const std::filesystem::path& path, bool tells_upright,
                         Upright& upright) {
  ReadPackets read;
  const auto file_bytes = static_cast<std::int64_t>(std::filesystem::file_size(path));
  const PacketPointer packet(allocated(av_packet_alloc()));
  while ((read.end = av_read_frame(opened.format.get(), packet.get())) >= 0) {
    if (read.shown.empty()) {
      read.has_damaged_start = opened.log->said().has_value();
      opened.log->forget();
    }
    if (packet->stream_index == opened.stream) {
      ++read.count;
      read.is_last_whole = is_whole(*opened.format, *packet, file_bytes);
    }
    if (packet->stream_index == opened.stream && (packet->flags & AV_PKT_FLAG_DISCARD) == 0) {
      if (read.shown.empty() && !tells_upright)
        upright = upright_of_first(*packet, *opened.format->streams[opened.stream]->codecpar);
      read.shown.push_back({packet->pts, packet->dts, packet->duration, (packet->flags & AV_PKT_FLAG_KEY) != 0});
      read.last_byte = packet->pos + packet->size;
      const std::int64_t time = packet->pts != AV_NOPTS_VALUE ? packet->pts : packet->dts;
      if (time != AV_NOPTS_VALUE && time < INT64_MAX - packet->duration)
        read.last_end = std::max(read.last_end, time + packet->duration);
    }
    av_packet_unref(packet.get());
  }
  if (!read.is_last_whole && opened.format->iformat == av_find_input_format("nut"))
    read.is_last_whole = has_all_of_last(*opened.format->iformat, MappedFile(path).bytes());
  return read;
}

// Leaves out a last picture that is not whole, and tells of what is missing.
void note_damage(const OpenedVideo& opened, const std::filesystem::path& path, ReadPackets& packets, Probe& result) {
  std::vector<PacketTimes>& shown = packets.shown;
  if (packets.end != AVERROR_EOF) {
    result.notes.push_back(warning_of(
        format("the file is damaged or was cut off behind picture {}: {}", shown.size(), error_text(packets.end))));
  }
  if (!packets.is_last_whole && shown.size() == 1)
    throw InputError(format("{} was cut off within its first picture", input_title(path.string())));
  if (!packets.is_last_whole && !shown.empty()) {
    result.packets.end = packets.count - 1;
    shown.pop_back();
    result.notes.push_back(
        warning_of(format("the file was cut off within picture {}, which is left out", shown.size())));
  }
  auto cut = cut_picture_note(*opened.format, MappedFile(path).bytes(), packets.last_byte, shown.size());
  auto lost = missing_part_note(*opened.format, *opened.format->streams[opened.stream], packets.last_end, shown.size(),
                                cut || packets.has_damaged_start);
  if (!lost) lost = std::move(cut);
  if (!lost && opened.log->said()) {
    lost = format("the file was cut off, or is damaged so that pictures may be missing (FFmpeg says: {})",
                  *opened.log->said());
  }
  if (lost) result.notes.push_back(warning_of(std::move(*lost)));
}

std::optional<ClipSound> sound_beside(const OpenedVideo& opened, const std::vector<std::int64_t>& times) {
  const int stream = best_sound(*opened.format);
  if (times.size() < 2 || stream < 0) return std::nullopt;
  const double tick_s = av_q2d(opened.format->streams[opened.stream]->time_base);
  ClipSound sound{static_cast<double>(times.front()) * tick_s, static_cast<double>(times.back()) * tick_s,
                  0.0, avcodec_get_name(opened.format->streams[stream]->codecpar->codec_id),
                  count_streams(opened, AVMEDIA_TYPE_AUDIO, static_cast<std::size_t>(stream) + 1),
                  count_streams(opened, AVMEDIA_TYPE_AUDIO, opened.format->nb_streams)};
  const double period_s = (sound.last_s - sound.first_s) / static_cast<double>(times.size() - 1);
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double even_s = sound.first_s + static_cast<double>(k) * period_s;
    sound.uneven_s = std::max(sound.uneven_s, std::abs(static_cast<double>(times[k]) * tick_s - even_s));
  }
  return sound;
}

ClipTiming timing_beside(const OpenedVideo& opened, const std::filesystem::path& path,
                         const std::vector<PacketTimes>& packets, const std::vector<std::int64_t>& times) {
  const AVStream& stream = *opened.format->streams[opened.stream];
  auto doubt = doubt_about_rate(*opened.format, stream, MappedFile(path).bytes());
  ClipTiming timing = doubt ? ClipTiming() : timing_of(*opened.format, stream, times, input_title(path.string()));
  if (doubt) timing.rate_doubt = std::move(*doubt);
  const auto back = std::ranges::adjacent_find(packets, [](const PacketTimes& one, const PacketTimes& next) {
    return next.is_key && next.decoded != AV_NOPTS_VALUE && next.decoded < one.decoded;
  });
  const auto& starts = timing.starts_ns;
  if (back == packets.end() || std::ranges::adjacent_find(starts, std::greater_equal<>()) == starts.end())
    return timing;
  timing = {};
  timing.rate_doubt = format("its times run back at picture {}, as if it were two clips, one behind the other",
                             back + 1 - packets.begin());
  return timing;
}

}  // namespace

Probe probe(const std::filesystem::path& path, const std::optional<RawVideo>& raw) {
  const auto cine = raw ? std::nullopt : read_cine_header(path);
  if (cine && cine->is_packed_12) {
    throw InputError(
        format("{} holds Phantom's codes of 12 bits, packed two in three bytes, which are not read: save the "
               "recording with 10 bits packed, or with 16 bits a pixel",
               input_title(path.string())));
  }
  const OpenedVideo opened = open_video(path, raw);
  AVStream& stream = *opened.format->streams[opened.stream];
  const AVCodecParameters& codec = *stream.codecpar;
  Probe result;
  result.stream = opened.stream;
  result.shape = {static_cast<std::uint32_t>(codec.width), static_cast<std::uint32_t>(codec.height), 3};
  result.pixels = pixel_kind(codec, input_title(path.string()));
  if (!raw && is_mosaic(static_cast<AVPixelFormat>(codec.format))) {
    throw InputError(
        format("{} holds the mosaic of a colour sensor, whose black, white and colours are not known here: save what "
               "the camera's program makes of it, 16-bit TIFFs for example, or DNGs, which are developed",
               input_title(path.string())));
  }
  result.pixel_format = static_cast<AVPixelFormat>(codec.format);
  name_colours(opened, path, raw.has_value(), result);
  note_left_out(opened, path, raw.has_value(), result);
  const auto display_matrix = side_data(stream, AV_PKT_DATA_DISPLAYMATRIX);
  result.upright = upright_of(display_matrix);
  if (raw) {
    result.sample_count = count_raw_pictures(path, *raw);
    return result;
  }

  ReadPackets packets = read_packets(opened, path, !display_matrix.empty(), result.upright);
  result.pixel_aspect = pixel_aspect(opened.format.get(), stream, result.upright);
  if (!result.upright.left_out.empty()) {
    result.notes.emplace_back(
        format("the file's display matrix {}, and only quarter turns are made: they are turned by {} degrees",
               result.upright.left_out, 90 * result.upright.quarter_turns));
  }
  note_damage(opened, path, packets, result);
  result.sample_count = packets.shown.size();
  const std::vector<std::int64_t> times = picture_times(path, opened, packets.shown, result);
  result.sound = sound_beside(opened, times);
  result.timing = timing_beside(opened, path, packets.shown, times);
  if (cine) add_cine_header(*cine, opened, input_title(path.string()), result);
  if (const auto filmed = capture_rate(*opened.format, path, result.notes)) {
    apply_capture_rate(*filmed, result.timing, result.notes);
  } else if (has_slow_parts(path)) {
    result.notes.emplace_back(
        "Samsung's camera names parts of the file that are slow motion: they may have been filmed faster than the file "
        "plays; state the rate of the part that you use",
        std::vector{Setting::frame_rate});
  }
  return result;
}

}  // namespace nutik::videos
