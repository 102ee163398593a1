// Video through libavcodec; pixels.hpp says what its codes become.
#include <algorithm>
#include <string>

#include "media/module.hpp"
#include "media/clip.hpp"
#include "media/formats/coding_points.hpp"
#include "media/settled_fact.hpp"
#include "media/videos/capture_rate.hpp"
#include "media/videos/eight_bit_yuv.hpp"
#include "media/videos/filters.hpp"
#include "media/videos/libav.hpp"
#include "media/videos/phantom_file.hpp"
#include "media/videos/picture_decoder.hpp"
#include "media/videos/pixels.hpp"
#include "media/videos/probe.hpp"
#include "system/mapped_file.hpp"
#include "system/parallel.hpp"

namespace nutik::videos {
namespace {

// What a video's codes are taken for: as stated, else as the file says, else as most such files are.
bool is_colour_yuv(const Probe& probe) { return is_yuv(probe.pixel_format) && !probe.pixels.is_grey; }

// Where no matrix is named it is the usual one; where no range is named it is the limited one, of grey and RGB the full
// one. Throws InputError naming the file where the matrix or range that it names cannot be taken.
YuvCoding yuv_coding(const Probe& probe, const ClipOptions& options, const std::string& name) {
  if (!is_colour_yuv(probe)) {
    ClipOptions rest = options;
    rest.range.reset();
    refuse_yuv_options(rest);
    if (!probe.pixels.is_grey && !options.range && probe.range == CodeRange::limited) {
      throw InputError(format("{} holds RGB and names the limited range, which some encoders write beside codes of the "
                              "full one, too: state the range, limited or full",
                              name),
                       {Setting::range});
    }
  }
  if (options.chroma_at && !interpolates_chroma(probe.pixel_format, probe.pixels)) {
    throw UsageError(format("each pixel of {} has {}: leave the place of chroma out", name,
                            probe.pixels.is_everyday()
                                ? "the chroma of the sample that it shares, as in all video of 8 bits"
                                : "chroma of its own"),
                     {Setting::chroma_place});
  }
  if (!probe.unread_matrix.empty() && !options.matrix) {
    throw InputError(
        format("{} names a matrix by which no RGB is made here, {}: its colours would be wrong. {}, or state the "
               "matrix that it really has",
               name, probe.unread_matrix,
               probe.matrix_filter.empty()
                   ? "No command is known that converts it truly: get it in another"
                   : format("Convert it: ffmpeg -i CLIP -vf {} -c:v ffv1 converted.mkv", probe.matrix_filter)),
        {Setting::matrix});
  }
  return {options.matrix.value_or(probe.matrix.value_or(usual_matrix(probe.shape.height))),
          options.range.value_or(probe.range.value_or(is_colour_yuv(probe) ? CodeRange::limited : CodeRange::full)),
          options.chroma_at};
}

// Transfer function, primaries and pixel aspect of the capture, whose white code is known; facts on all of these, and
// on matrix, range and chroma of YUV.
void describe(ClipInfo& info, const Probe& probe, const ClipOptions& options) {
  const PixelKind& pixels = probe.pixels;
  CaptureFormat& capture = info.format;
  std::vector<Fact>& facts = info.facts;
  if (pixels.is_grey && pixels.bits > 8 && !pixels.is_limited) {
    const bool fills_its_bits = pixels.bits == 16;
    settle_white(info, options.white_code,
                 fills_its_bits ? std::nullopt : std::optional(pixels.white_code()));
  }
  // Deep grey pictures, and those of 16 bits, come from scientific cameras, which are linear; other deep colour from
  // film cameras.
  const bool is_scientific = pixels.bits > 8 && (pixels.is_grey || pixels.bits == 16);
  // Everyday cameras name BT.709's curve whatever theirs is, and players show sRGB's. Others are meant.
  const bool is_meant = !pixels.is_everyday() || probe.transfer != Transfer::bt709();
  const auto named = is_meant ? probe.transfer : std::nullopt;
  capture.transfer =
      settle(facts, options.transfer, named, is_scientific ? Transfer::linear() : Transfer::srgb(),
             Setting::transfer, [](const Transfer& transfer) { return "transfer " + transfer.text(); });
  if (facts.back().origin == Origin::file) facts.back().source = probe.curve_from;
  if (facts.back().origin == Origin::assumed && !probe.transfer_name.empty()) {
    facts.back().remark = format("the file names {}", probe.transfer_name);
  }
  if (is_colour_yuv(probe)) {
    settle(facts, options.matrix, probe.matrix, usual_matrix(probe.shape.height), Setting::matrix,
           [](YuvMatrix matrix) { return format("matrix {}", to_text(matrix)); });
    info.roundings.add(pixels.is_everyday() ? kMostOff : 0.5, 1.0,
                       shares_chroma(probe.pixel_format) ? kSharedChroma : "");
  }
  if (pixels.is_limited) info.roundings.add(0.5, 1.0, "");
  if (is_colour_yuv(probe) || pixels.is_limited || options.range) {
    const CodeRange range = settle(facts, options.range, probe.range, CodeRange::limited, Setting::range,
                                   [](CodeRange each) { return format("{} range", to_text(each)); });
    if (range == CodeRange::limited) capture.transfer = capture.transfer.scaled_from_video();
  }
  if (interpolates_chroma(probe.pixel_format, pixels)) {
    settle(facts, options.chroma_at, probe.chroma_at, kDefaultChromaPlace, Setting::chroma_place,
           [](ChromaPlace place) { return format("chroma at {}", to_text(place)); });
  }
  if (!pixels.is_grey) {
    const bool is_wide =
        options.matrix.value_or(probe.matrix.value_or(usual_matrix(probe.shape.height))) == YuvMatrix::bt2020;
    // What containers name beside a camera's curve are not its primaries, for which they have no number.
    const auto of_curve = capture.transfer.usual_primaries();
    const bool names_curves = of_curve && probe.transfer && probe.transfer->usual_primaries();
    capture.primaries = settle(
        facts, options.primaries, of_curve && !names_curves ? std::nullopt : probe.primaries,
        of_curve.value_or(is_wide ? Primaries::bt2020 : Primaries::bt709), Setting::primaries,
        [](Primaries primaries) { return format("primaries {}", to_text(primaries)); });
    if (facts.back().origin == Origin::file) facts.back().source = probe.curve_from;
    if (facts.back().origin == Origin::file && !probe.near_primaries.empty()) {
      facts.back().remark = format("it names {}", probe.near_primaries);
    }
  }
  capture.pixel_aspect = settle(facts, options.pixel_aspect, probe.pixel_aspect, Rational{1, 1},
                                Setting::pixel_aspect, pixel_aspect_text);
}

// What a decoded picture takes.
std::uint64_t decoded_bytes(const AVCodecParameters& parameters) {
  const int bytes = av_image_get_buffer_size(static_cast<AVPixelFormat>(parameters.format), parameters.width,
                                             parameters.height, 64);
  if (bytes > 0) return static_cast<std::uint64_t>(bytes);
  return static_cast<std::uint64_t>(parameters.width) * static_cast<std::uint64_t>(parameters.height) * 3 + 1;
}

// Whether pictures of such a codec may be made of others.
bool refers_to_others(const AVCodecParameters& parameters) {
  const AVCodecDescriptor* kind = avcodec_descriptor_get(parameters.codec_id);
  return kind == nullptr || (kind->props & AV_CODEC_PROP_INTRA_ONLY) == 0;
}

// Pictures that are kept beside those worked on: the packet and the picture it becomes; where pictures refer to
// others, those, of which encoders use five or fewer unless they are told otherwise, and those that are shown later.
std::uint64_t kept_pictures(const AVCodecParameters& parameters) {
  return 2 + (refers_to_others(parameters) ? 5 + static_cast<std::uint64_t>(parameters.video_delay) : 0);
}

int decoder_threads(const OpenedVideo& opened, const ClipOptions& options) {
  const std::uint64_t cores = core_count();
  if (!options.decoder_bytes) return static_cast<int>(cores);
  const AVCodecParameters& parameters = *opened.format->streams[opened.stream]->codecpar;
  const std::uint64_t pictures = *options.decoder_bytes / decoded_bytes(parameters);
  const std::uint64_t kept = kept_pictures(parameters);
  return static_cast<int>(std::clamp<std::uint64_t>(pictures - std::min(pictures, kept), 1, cores));
}

// Whether a picture of a GIF, or with a palette, has a pixel that is transparent. Throws InputError naming `name` where
// the palette is none: even black is opaque.
bool is_transparent(const AVFrame& frame, const std::string& name) {
  const bool has_palette = frame.format == AV_PIX_FMT_PAL8;
  if (!has_palette && frame.format != AV_PIX_FMT_RGB32) return false;
  std::array<std::uint32_t, 256> palette{};
  if (has_palette) {
    std::memcpy(palette.data(), frame.data[1], sizeof palette);
    if (std::ranges::count(palette, 0u) == std::ssize(palette)) {
      throw InputError(format("{}: its pictures are numbers of colours, and the file has no palette that tells these: "
                              "save it with one of greys, as grey (Y800) or as TIFF",
                              name));
    }
  }
  for (int y = 0; y < frame.height; ++y) {
    const std::uint8_t* const row = frame.data[0] + std::ptrdiff_t{y} * frame.linesize[0];
    for (int x = 0; x < frame.width; ++x) {
      if ((has_palette ? palette[row[x]] >> 24 : row[4 * x + 3]) != 255) return true;
    }
  }
  return false;
}

// From this share of a picture's luma on it is told that light above white was cut off. Codecs' ringing and noise pass
// white at a few edges of nearly all clips.
constexpr double kToldShare = 0.001;

// The filter of FFmpeg that keeps such light of a clip whose curve is sRGB's, at half of it; empty: none is known.
std::string darker_filter(const Probe& probe, const YuvCoding& coding, const Transfer& transfer) {
  if (!is_colour_yuv(probe) || transfer != Transfer::srgb()) return {};
  const bool is_named = probe.matrix == coding.matrix;
  if (!is_named && coding.matrix != YuvMatrix::bt601 && coding.matrix != YuvMatrix::bt709) return {};
  return format("zscale=rin=limited:{}tin=iec61966-2-1:t=linear:agamma=0,format=gbrpf32le,exposure=-1,format=gbrp16le",
                is_named ? "" : coding.matrix == YuvMatrix::bt709 ? "min=709:" : "min=170m:");
}

class LibavClip final : public Clip {
 public:
  LibavClip(OpenedVideo opened, int threads, const std::filesystem::path& path, const Probe& probe,
            const ClipOptions& options)
      : name_(input_title(path.string())),
        watched_(path),
        coded_(probe.shape),
        converter_(probe.pixels, probe.upright, yuv_coding(probe, options, name_)),
        decoder_(std::move(opened), name_, PictureDecoder::Wanted::pictures, probe.packets, threads),
        frame_(allocated(av_frame_alloc())) {
    const PixelKind& pixels = probe.pixels;
    CaptureFormat& capture = info_.format;
    capture.shape = coded_;
    capture.shape.channels = pixels.is_grey ? 1 : 3;
    if (probe.upright.quarter_turns % 2 != 0) std::swap(capture.shape.width, capture.shape.height);
    capture.code_bytes = pixels.bits > 8 ? 2 : 1;
    capture.white_code = pixels.white_code();
    if (options.white_code) set_white(*options.white_code, pixels);
    info_.notes = probe.notes;
    info_.timing = probe.timing;
    info_.sample_count = probe.sample_count;
    info_.sound = probe.sound;
    const AVCodecParameters& parameters = *decoder_.stream().codecpar;
    info_.decoder_bytes = (static_cast<std::uint64_t>(decoder_.threads()) + kept_pictures(parameters)) *
                          decoded_bytes(parameters);
    describe(info_, probe, options);
    const YuvCoding coding = yuv_coding(probe, options, name_);
    is_everyday_ = pixels.is_everyday();
    darker_filter_ = darker_filter(probe, coding, capture.transfer);
    const ColourNumbers coded = colours_of(parameters);
    if (is_colour_yuv(probe) && !options.matrix)
      matrix_ = named_matrix(coded.matrix, coded.primaries).value_or(coding.matrix);
    if (!options.range) range_ = named_range(coded.range, probe.pixel_format).value_or(coding.range);
    if (!options.transfer) transfer_ = named_transfer(coded.curve).value_or(capture.transfer);
    if (!pixels.is_grey && !options.primaries)
      primaries_ = primaries_of_coding_point(coded.primaries).value_or(capture.primaries);
    if (!options.pixel_aspect) aspect_ = named_aspect(parameters.sample_aspect_ratio).value_or(Rational{1, 1});
    settle_fields(options.interlaced);
  }

  [[nodiscard]] const ClipInfo& info() const override { return info_; }

  [[nodiscard]] std::vector<Note> remarks() const override {
    auto doubt = fields_ || frames_read_ == 0 ? std::nullopt : doubt_about_fields(has_interlaced_);
    std::vector<Note> all;
    if (doubt) all.emplace_back(std::move(*doubt));
    if (other_order_ > 0) {
      all.emplace_back(
          format("the container says {}, and {} frames say the other, which counts: where what moves jumps to and fro, "
                 "they are wrong",
                 to_text(*fields_), other_order_));
    }
    if (has_transparent_) all.emplace_back(left_out_note(kTransparency));
    if (pictures_above_white_ > 0) all.push_back(cut_off());
    return all;
  }

  bool read(std::span<std::byte> raster) override {
    if (!next_picture()) {
      if (frames_read_ > 0) return false;
      throw InputError(format("{} shows no picture; if its edit list leaves them all out, ffmpeg -ignore_editlist 1 -i "
                              "CLIP -c:v ffv1 film.mkv makes a clip of them",
                              name_));
    }
    check_whole();
    if (is_seen_as_transparent(*decoder_.stream().codecpar)) has_transparent_ |= is_transparent(*frame_, name_);
    if (is_phantom_packed(*decoder_.stream().codecpar)) expand_phantom_codes(*frame_);
    converter_.convert(*frame_, raster, name_);
    const double above = converter_.share_above_white();
    pictures_above_white_ += above >= kToldShare ? 1 : 0;
    most_above_white_ = std::max(most_above_white_, above);
    ++frames_read_;
    return true;
  }

  bool skip(std::span<std::byte> /*room*/) override {
    const bool takes_frames = interlaced_ == Interlaced::refused || interlaced_ == Interlaced::ignored;
    if (takes_frames && !is_decoding_ && !refers_to_others(*decoder_.stream().codecpar)) {
      if (!decoder_.skip()) return false;
      is_first_ = false;
    } else {
      if (!next_picture()) return false;
      check_whole();
    }
    ++frames_read_;
    return true;
  }

 private:
  [[nodiscard]] Note cut_off() const {
    Note note = warning_of(format("light above the limited range's white was cut off in up to {:.3g} % of a picture "
                                  "(pictures with at least {:g} %: {}), and bounds do not hold there",
                                  100 * most_above_white_, 100 * kToldShare, pictures_above_white_));
    const auto range = std::ranges::find(info_.facts, Setting::range, &Fact::setting);
    if (range->origin == Origin::assumed) {
      note.text += "; if the clip is of the full range, say so";
      note.settings = {Setting::range};
    } else if (!darker_filter_.empty()) {
      note.text +=
          format("; ffmpeg -i CLIP -vf {} -c:v ffv1 darker.mkv keeps it, at half of all light", darker_filter_);
    }
    return note;
  }

  // None for what everyday cameras name whatever theirs is.
  [[nodiscard]] std::optional<Transfer> named_transfer(unsigned curve) const {
    const auto transfer = transfer_of_coding_point(curve);
    return is_everyday_ && transfer == Transfer::bt709() ? std::nullopt : transfer;
  }

  [[nodiscard]] static std::optional<Rational> named_aspect(AVRational aspect) {
    return aspect.num > 0 && aspect.den > 0 ? std::optional(Rational::of(aspect.num, aspect.den)) : std::nullopt;
  }

  // What rasters are made of.
  [[nodiscard]] std::string pixels_text(int format) const {
    AVCodecParameters parameters = *decoder_.stream().codecpar;
    parameters.format = format;
    const PixelKind kind = pixel_kind(parameters, name_);
    const bool is_of_yuv = is_yuv(static_cast<AVPixelFormat>(format));
    return nutik::format("{} of {} bits", kind.is_grey ? "grey" : is_of_yuv ? "YUV" : "RGB", kind.bits);
  }

  // Throws where the picture names another coding than the first one, where that was not stated.
  void check_colour() {
    const auto check = [&](const auto& named, auto& taken, const auto& text) {
      if (!named || !taken) return;
      if (is_first_) taken = named;
      if (*named == *taken) return;
      throw InputError(format("{}: picture {} is of {}, the ones before it of {}", name_, frames_read_, text(*named),
                              text(*taken)));
    };
    const auto pixels = static_cast<AVPixelFormat>(frame_->format);
    check(named_range(number_of(frame_->color_range), pixels), range_,
          [](CodeRange each) { return format("the {} range", to_text(each)); });
    check(named_matrix(number_of(frame_->colorspace), number_of(frame_->color_primaries)), matrix_,
          [](YuvMatrix each) { return format("matrix {}", to_text(each)); });
    check(named_transfer(number_of(frame_->color_trc)), transfer_,
          [](const Transfer& each) { return "transfer " + each.text(); });
    check(primaries_of_coding_point(number_of(frame_->color_primaries)), primaries_,
          [](Primaries each) { return format("primaries {}", to_text(each)); });
    check(named_aspect(frame_->sample_aspect_ratio), aspect_, pixel_aspect_text);
    is_first_ = false;
    const int taken_format = decoder_.stream().codecpar->format;
    if (frame_->format == taken_format) return;
    std::optional taken(pixels_text(taken_format));
    check(std::optional(pixels_text(frame_->format)), taken, [](const std::string& each) { return each; });
  }

  // Throws where the picture is of another size or coding, or damaged.
  void check_whole() {
    if (frame_->width != static_cast<int>(coded_.width) ||
        frame_->height != static_cast<int>(coded_.height)) {
      throw InputError(format("{}: picture {} has {} x {} pixels, the ones before it {} x {}", name_,
                              frames_read_, frame_->width, frame_->height, coded_.width, coded_.height));
    }
    check_colour();
    // A decoder fills damaged parts with what was there before, which would pass for a still scene.
    const bool is_flagged = frame_->decode_error_flags != 0 || (frame_->flags & AV_FRAME_FLAG_CORRUPT) != 0;
    const auto said = decoder_.damage();
    if (is_flagged || said) {
      // Decoders are some pictures ahead of who reads them.
      throw InputError(
          format("{}: picture {}{} is damaged{}. What can be read of the clip is another clip after "
                 "ffmpeg -i CLIP -c:v ffv1 mended.mkv",
                 name_, frames_read_, is_flagged ? "" : " or one soon after it",
                 said ? format(" (FFmpeg says: {})", *said) : std::string()));
    }
  }

  void settle_fields(Interlaced wish) {
    fields_ = field_order(decoder_.stream().codecpar->field_order);
    interlaced_ = wish;
    if (wish == Interlaced::refused && fields_) refuse_fields(name_, *fields_);
    const bool is_progressive = decoder_.stream().codecpar->field_order == AV_FIELD_PROGRESSIVE;
    if (auto doubt = fields_ ? doubt_about_fields(true) : std::nullopt)
      info_.notes.emplace_back(std::move(*doubt), std::vector{Setting::deinterlace});
    if (wish == Interlaced::refused && !fields_ && !is_progressive)
      info_.facts.push_back({"progressive frames", Origin::assumed, Setting::deinterlace});
    if (wish == Interlaced::ignored) {
      info_.facts.push_back({fields_ ? "interlaced frames as they are" : "frames as they are", Origin::stated,
                             Setting::deinterlace});
    }
    if (wish != Interlaced::frames && wish != Interlaced::fields) return;
    info_.decoder_bytes += Deinterlacer::kHeldPictures * decoded_bytes(*decoder_.stream().codecpar);
    info_.roundings.add(0.0, 1.0, "fields");
    if (wish == Interlaced::fields) info_ = of_fields(std::move(info_));
    info_.facts.push_back(
        {format("a picture from each {}, {}", wish == Interlaced::fields ? "field" : "frame",
                fields_ ? format("{} unless a frame tells another order", to_text(*fields_))
                        : "in the order that each frame tells"),
         Origin::stated, Setting::deinterlace});
  }

  // What speaks against what was asked for, where the clip is interlaced, or is not.
  [[nodiscard]] std::optional<std::string> doubt_about_fields(bool is_interlaced) const {
    if (interlaced_ == Interlaced::ignored && is_interlaced) {
      return "the clip says that it is interlaced, and its frames are taken as they are: what moves comes "
             "out "
             "as combs if that is so";
    }
    if (is_interlaced || interlaced_ == Interlaced::refused || interlaced_ == Interlaced::ignored) return {};
    return format(
        "nothing in the clip says that it is interlaced, and {} all the same: if it is not, half of the lines are made "
        "up for nothing",
        interlaced_ == Interlaced::fields ? "two pictures are made of each"
                                          : "each picture is made of one field");
  }

  [[noreturn]] void refuse_fields(const std::string& what, FieldOrder order) const {
    throw InputError(
        format("{} is interlaced, {}: odd and even lines of its frames were filmed at two moments, and what "
               "moves would come out as combs. Make a picture of each field, 'fields' (twice as many, and no "
               "moment is lost), or of each frame, 'frames'; or take frames as they are, 'no', where a file "
               "only says that it is interlaced",
               what, to_text(order)),
        {Setting::deinterlace});
  }

  void set_white(std::uint32_t white, const PixelKind& pixels) {
    if ((!pixels.is_grey || pixels.is_limited) && white != pixels.white_code()) {
      throw UsageError(
          format("{}, whose white is {} whatever its depth was, not {}; leave the white code out",
                 pixels.is_grey ? "grey video of the limited range is scaled to the full one"
                                : "colour video is converted to RGB",
                 pixels.white_code(), white),
          {Setting::white_code});
    }
    info_.format.white_code = white;
  }

  bool next_frame() {
    is_decoding_ = true;
    if (!decoder_.next(*frame_)) return false;
    has_interlaced_ |= is_interlaced(*frame_);
    other_order_ += fields_ && is_interlaced(*frame_) && order_of(*frame_) != *fields_ ? 1 : 0;
    return true;
  }

  // The next picture, which was made of fields where that was asked for.
  bool next_picture() {
    if (interlaced_ == Interlaced::refused || interlaced_ == Interlaced::ignored) {
      if (!next_frame()) return false;
      if (interlaced_ == Interlaced::refused && is_interlaced(*frame_)) {
        refuse_fields(format("{}: picture {}", name_, frames_read_), order_of(*frame_));
      }
      return true;
    }
    while (!deinterlacer_ || !deinterlacer_->take(*frame_)) {
      if (has_ended_) return false;
      has_ended_ = !next_frame();
      if (has_ended_ && !deinterlacer_) return false;
      if (has_ended_) {
        deinterlacer_->end();
        continue;
      }
      check_whole();
      if (!deinterlacer_) deinterlacer_.emplace(*frame_, interlaced_ == Interlaced::fields, name_);
      if (fields_ && !is_interlaced(*frame_)) set_interlaced(*frame_, *fields_ == FieldOrder::top_first);
      deinterlacer_->add(*frame_);
    }
    return true;
  }

  std::string name_;
  MappedFile watched_;  // what was made of a file that changes meanwhile gets no name
  ClipInfo info_;
  Shape coded_;  // before the pictures are turned upright
  PixelConverter converter_;
  PictureDecoder decoder_;
  FramePointer frame_;
  std::uint64_t frames_read_ = 0;
  bool is_decoding_ = false;
  // As pictures name them that were read so far, or taken where none did; none where nothing depends on them.
  std::optional<CodeRange> range_;
  std::optional<YuvMatrix> matrix_;
  std::optional<Transfer> transfer_;
  std::optional<Primaries> primaries_;
  std::optional<Rational> aspect_;
  bool is_everyday_ = false, is_first_ = true;
  Interlaced interlaced_ = Interlaced::refused;
  std::optional<FieldOrder> fields_;  // as the container says of all frames
  bool has_interlaced_ = false;       // a frame that says so itself
  std::uint64_t other_order_ = 0;     // frames that say another one themselves
  bool has_transparent_ = false;      // a picture whose pixels tell it
  std::uint64_t pictures_above_white_ = 0;  // that have at least kToldShare
  double most_above_white_ = 0;             // a picture's share
  std::string darker_filter_;
  std::optional<Deinterlacer> deinterlacer_;
  bool has_ended_ = false;  // the decoder
};

std::unique_ptr<Clip> open_video_clip(const std::filesystem::path& path, const ClipOptions& options) {
  listen_to_ffmpeg();
  Probe probed = probe(path, options.raw);
  probed.pixels.is_limited =
      !is_colour_yuv(probed) && options.range.value_or(probed.range.value_or(CodeRange::full)) == CodeRange::limited;
  OpenedVideo opened = open_video(path, options.raw);
  const int threads = decoder_threads(opened, options);
  return std::make_unique<LibavClip>(std::move(opened), threads, path, probed, options);
}

}  // namespace
}  // namespace nutik::videos

// What nutik-videos.so gives the program (media/module.hpp).
extern "C" __attribute__((visibility("default"))) const nutik::VideoModule nutik_video_module{
    nutik::use_shared_state, nutik::videos::open_video_clip, nutik::videos::story_beside,
    nutik::videos::open_libav_writer};

extern "C" __attribute__((visibility("default"))) const char nutik_module_version[] = NUTIK_VERSION;
