// Clips: what a capture is made from. A clip hands out its samples one after another as rasters of codes
// (layout: capture/picture.hpp) and knows what can be known of their times before they are decoded.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "capture/code_roundings.hpp"
#include "capture/error.hpp"
#include "capture/fact.hpp"
#include "capture/made_samples.hpp"
#include "capture/part_of_clip.hpp"
#include "capture/picture.hpp"
#include "capture/pixel_change.hpp"
#include "capture/timeline.hpp"
#include "system/shared.hpp"

namespace nutik {

// When a clip's samples were taken, as far as its files tell: a constant rate, or for each its start, or its
// exposure. One of them, or none.
struct ClipTiming {
  std::optional<Rational> rate;         // samples a second
  // Where the rate is not constant; of a part of a clip also that of the picture behind it.
  std::vector<std::int64_t> starts_ns;
  std::vector<Exposure> exposures;      // in order, without overlaps
  // How long each sample was exposed, beside rate or starts, where the camera wrote it down.
  std::optional<std::int64_t> exposed_ns;
  std::string exposed_from = "the file";  // what tells that, for people
  std::string rate_from = {};             // what tells the times; empty: the file as it is played
  std::string rate_doubt = {};            // why a rate that it states is none, where nothing else tells the times

  [[nodiscard]] bool is_known() const { return rate || !starts_ns.empty() || !exposures.empty(); }
};

// When a player of a file with sound shows the first and the last picture, and how long it is from the one to the other
// as they were filmed (what opens the clip for a capture fills that in).
struct ClipSound {
  double first_s = 0, last_s = 0;
  double filmed_s = 0;
  std::string codec = {};
  int track = 1, tracks = 1;  // which of the file's tracks of sound it is, from 1
  double uneven_s = 0;        // by which pictures lie off even times, at most, where those were stated in their place
};

struct ClipInfo {
  CaptureFormat format;  // the noise model is left at lossless
  ClipTiming timing;
  // As the files announce it. Decoding may end earlier or later; the clip is right then.
  std::uint64_t sample_count = 0;
  std::uint64_t decoder_bytes = 0;  // of the pictures that its decoder holds, about
  std::vector<Note> notes;
  std::vector<Fact> facts;  // what samples are taken for, each with who said it
  std::optional<PartOfClip> part = std::nullopt;  // which pictures these are, if not all of a clip's
  std::optional<ClipSound> sound = std::nullopt;  // none: it has none
  bool holds_light = false;  // its files do: codes are the nearest ones
  CodeRoundings roundings = {};  // by which codes were made
  // Samples between the pictures of a capture that is read as a clip; they are read like pictures. Times, and what a
  // part counts, are those of the pictures.
  std::optional<Shared<MadeSamples>> made = std::nullopt;
  std::string left_out = {};  // of its first still, as left_out_note() takes it; empty: nothing

  [[nodiscard]] std::uint64_t picture_count() const { return made ? (*made)->after.size() : sample_count; }
};

// How YUV becomes RGB, which codes stand for black and white, and where samples of chroma lie that pixels share, among
// those of luma.
enum class YuvMatrix { bt601, bt709, bt2020, fcc, smpte240m, p3, ycgco };
enum class CodeRange { limited, full };
enum class ChromaPlace { left, center, topleft, top, bottomleft, bottom };
[[nodiscard]] std::string_view to_text(YuvMatrix matrix);
[[nodiscard]] std::string_view to_text(CodeRange range);
[[nodiscard]] std::string_view to_text(ChromaPlace place);
// `32:27`, from 1:64 to 64:1. Throws UsageError.
[[nodiscard]] Rational parse_pixel_aspect(std::string_view text);

// A video without a header: what its bytes are.
struct RawVideo {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::string pixel_format;  // as FFmpeg names it: yuv420p10le, gray16le
  friend bool operator==(const RawVideo&, const RawVideo&) = default;
};

// Where a part of a clip begins or ends: at the first picture whose exposure starts no earlier.
struct ClipMoment {
  std::int64_t value = 0;   // nanoseconds after the start of the first picture
  bool is_picture = false;  // the number of a picture, from 0
  friend bool operator==(const ClipMoment&, const ClipMoment&) = default;
};

// Fewer pixels (media/clip_part.hpp): one for each square of `divisor`, or so many.
struct ClipScale {
  std::uint32_t divisor = 0;  // 0: as many as stated
  std::uint32_t width = 0, height = 0;
  friend bool operator==(const ClipScale&, const ClipScale&) = default;
};

// `640x360+100+50`: width, height, and how far right and down of the top left corner. Throws UsageError.
[[nodiscard]] Rectangle parse_crop(std::string_view text);
// `1/2`, or `640x360`. Throws UsageError.
[[nodiscard]] ClipScale parse_scale(std::string_view text);

// What becomes of interlaced video: it is refused; a picture is made of each frame, or of each field; or frames are
// taken as they are, where a file only says that they were interlaced.
enum class Interlaced { refused, frames, fields, ignored };

// By how much the natural logarithm of light changes with an event: up, and down.
struct Contrast {
  double up = 0, down = 0;
  friend bool operator==(const Contrast&, const Contrast&) = default;
};

// Light before the first event: everywhere the same, or a picture's.
using StartLight = std::variant<double, std::filesystem::path>;

// What can be stated of recordings whose pixels keep their own time (media/events/event_clip.hpp).
struct EventOptions {
  std::optional<Contrast> contrast = std::nullopt;
  std::optional<StartLight> start = std::nullopt;
  std::optional<std::int64_t> tick_ns = std::nullopt;  // changes count at the start of the tick that they are in
  friend bool operator==(const EventOptions&, const EventOptions&) = default;
};

// `0.2`, or `0.3:0.17`: up, and down; each from 0.001 to 10. Throws UsageError.
[[nodiscard]] Contrast parse_contrast(std::string_view text);
// `0.18`, from 0.0001 to 1, else the name of a picture. Throws UsageError.
[[nodiscard]] StartLight parse_start_light(std::string_view text);

// What is stated about a clip; it goes before what the files say.
struct ClipOptions {
  std::optional<Rational> rate = std::nullopt;
  std::optional<std::uint32_t> white_code = std::nullopt;
  std::optional<Transfer> transfer = std::nullopt;
  std::optional<RawVideo> raw = std::nullopt;
  std::optional<YuvMatrix> matrix = std::nullopt;
  std::optional<CodeRange> range = std::nullopt;
  std::optional<ChromaPlace> chroma_at = std::nullopt;
  std::optional<Primaries> primaries = std::nullopt;
  std::optional<Rational> pixel_aspect = std::nullopt;
  // The part that is taken: pictures that start from the one moment on and before the other, and of these a rectangle
  // as they are shown, with fewer pixels.
  std::optional<ClipMoment> from = std::nullopt, to = std::nullopt;
  std::optional<Rectangle> crop = std::nullopt;
  std::optional<ClipScale> scale = std::nullopt;
  Interlaced interlaced = Interlaced::refused;
  bool ends_at_damage = false;  // instead of being an error
  EventOptions events = {};
  // What its decoder may hold: it works on no more pictures at a time than fit, one at least. None: on one for each
  // core.
  std::optional<std::uint64_t> decoder_bytes = std::nullopt;
  std::optional<double> white_light = std::nullopt;  // of floating-point pictures; a white code is one, too
  friend bool operator==(const ClipOptions&, const ClipOptions&) = default;
};

class Clip {
 public:
  virtual ~Clip() = default;

  // Does not change once the clip is open; may be asked for while another thread reads.
  [[nodiscard]] virtual const ClipInfo& info() const = 0;

  // Reads the next sample into `raster`, of info().format.sample_bytes(). Returns false at the end.
  // Throws InputError where a sample is damaged or of another size than the first.
  virtual bool read(std::span<std::byte> raster) = 0;

  // Passes over the next sample, as read() reads it; `room` is as large. Returns false at the end.
  virtual bool skip(std::span<std::byte> room) { return read(room); }

  // After it has ended, why that came before its files' end: ClipOptions::ends_at_damage.
  [[nodiscard]] virtual std::optional<std::string> ended_early() const { return std::nullopt; }

  // After it has ended, what was done to its pictures that only they told.
  [[nodiscard]] virtual std::vector<Note> remarks() const { return {}; }

  // Whether samples can also be read as the pixels that change: where there are many, and most pixels stay as they
  // were.
  [[nodiscard]] virtual bool tells_changes() const { return false; }

  // Reads the next sample, after the first: pixels that it may hold other codes of than the one before it, until the
  // next call; if a pixel is among them twice, the later counts. Returns none at the end.
  virtual std::optional<std::span<const PixelChange>> read_changes() { return std::nullopt; }

  // Whether codes are made here of what the files hold: a stated white is none of them.
  [[nodiscard]] virtual bool makes_codes() const { return false; }
};

// Opens a video (`-` is one from standard input), a sequence of stills (media/stills/still_sequence.hpp), a table of
// stills (media/stills/stills_table.hpp), a Photron camera's pictures (media/cameras/photron_clip.cpp), or a recording
// without pictures (media/events/event_clip.hpp). Their times do not count where a rate is stated. Throws InputError
// where there is none, or none that can be read.
[[nodiscard]] std::unique_ptr<Clip> open_clip(const std::filesystem::path& path, const ClipOptions& options);

// The files that it would read: a table before its stills, pictures before what a camera wrote beside them.
[[nodiscard]] std::vector<std::filesystem::path> files_of_clip(const std::filesystem::path& path, bool is_raw = false);

// That a clip announces other pictures than could be decoded; nothing where it announces none, or as many.
[[nodiscard]] std::optional<std::string> lost_pictures_text(const std::string& name, std::uint64_t announced,
                                                            std::uint64_t decoded);

// Opens a clip from its start, as often as it is asked.
using OpenClip = std::function<std::unique_ptr<Clip>()>;

// What files say of codes that are read as they are stored, and what transfer function is usual for such.
struct StoredCodes {
  Transfer usual;
  std::optional<Transfer> transfer = std::nullopt;
  std::optional<Primaries> primaries = std::nullopt;
  std::string colours_from = {};  // what of the file says these, for people; empty: the file itself
  // What they name besides that is none of those known here, for people.
  std::string unread_transfer = {}, unread_primaries = {};
  std::optional<Rational> pixel_aspect = std::nullopt;
};

// Channels beside grey or colour are left out of clips, with a note: `transparency`, or `channels A and Z`.
inline constexpr const char* kTransparency = "transparency";
[[nodiscard]] std::string left_out_note(std::string_view channels);
// Throws InputError if there are any in a picture whose codes are to count as they stand.
void refuse_left_out(const std::string& name, std::string_view channels);

// Throws UsageError where something is stated that is said of YUV only.
void refuse_yuv_options(const ClipOptions& options);

// Codes of light of floating point: the nearest ones of equal steps up to `white`.
inline constexpr std::uint32_t kLightSteps = 65'535;
// That light of a pixel has none of them.
struct LightOutside : InputError {
  LightOutside(const std::string& message, std::vector<Setting> settings, std::string where, double light)
      : InputError(message, std::move(settings)), pixel(std::move(where)), value(light) {}
  std::string pixel;  // `3,0`
  double value;
};
// Describes a clip of such codes.
void describe_light(ClipInfo& info, double white);

// Describes such codes, of a format whose shape and white code are known, as stated, as the files say, or as usual.
// Throws UsageError where what is stated is said of YUV.
void describe_stored_codes(ClipInfo& info, const ClipOptions& options, const StoredCodes& codes);

// The timeline of the clip `name` with `sample_count` samples. Throws InputError where nothing
// tells how fast it was taken, or its times are not in order.
[[nodiscard]] Timeline timeline_of(const std::string& name, const ClipInfo& info, const ClipOptions& options,
                                   Rational shutter_angle, std::uint64_t sample_count);
// The same where no angle was stated: each sample exposed for as long as the camera wrote down, else all the time.
[[nodiscard]] Timeline timeline_of(const std::string& name, const ClipInfo& info, const ClipOptions& options,
                                   std::uint64_t sample_count);

}  // namespace nutik
