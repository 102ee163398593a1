#include "media/clip.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <system_error>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/seconds_text.hpp"
#include "media/clip_part.hpp"
#include "media/events/event_clip.hpp"
#include "media/formats/file_kinds.hpp"
#include "media/module.hpp"
#include "media/cameras/photron_clip.hpp"
#include "media/cameras/photron_header.hpp"
#include "media/settled_fact.hpp"
#include "media/stills/still_sequence.hpp"
#include "media/stills/stills_table.hpp"
#include "system/input_bytes.hpp"
#include "system/is_absent.hpp"
#include "system/mapped_file.hpp"

namespace nutik {

namespace {

std::unique_ptr<Clip> open_table(const std::filesystem::path& path, const ClipOptions& options) {
  const StillModule& module = still_module();
  const std::vector<ListedStill> stills = read_stills_table(path);
  std::vector<std::filesystem::path> files;
  std::vector<StillTimes> exif;
  ClipTiming listed;  // for whoever wants to know what a stated rate replaces
  for (const ListedStill& still : stills) {
    files.push_back(still.file);
    if (still.times.start_ns) listed.starts_ns.push_back(*still.times.start_ns);
    const bool is_timed = still.times.start_ns && still.times.exposure_ns;
    exif.push_back(is_timed || options.rate ? StillTimes{} : module.read_exif_times(still.file));
  }
  if (listed.starts_ns.size() < stills.size()) listed.starts_ns.clear();
  return module.open(files, options.rate ? listed : timing_of(path, stills, exif), options);
}

// A clip of which there is more to tell than its module knows.
class DescribedClip final : public Clip {
 public:
  DescribedClip(std::unique_ptr<Clip> clip, ClipInfo info) : clip_(std::move(clip)), info_(std::move(info)) {}

  [[nodiscard]] const ClipInfo& info() const override { return info_; }
  bool read(std::span<std::byte> raster) override { return clip_->read(raster); }
  bool skip(std::span<std::byte> room) override { return clip_->skip(room); }
  [[nodiscard]] std::vector<std::string> remarks() const override { return clip_->remarks(); }

 private:
  std::unique_ptr<Clip> clip_;
  ClipInfo info_;
};

// A clip with a picture that cannot be read: that is its end, or an error which says that it could be.
class PerhapsDamaged final : public Clip {
 public:
  PerhapsDamaged(std::unique_ptr<Clip> clip, const std::filesystem::path& path, bool ends_at_damage)
      : clip_(std::move(clip)), name_(input_title(path.string())), ends_at_damage_(ends_at_damage) {}

  [[nodiscard]] const ClipInfo& info() const override { return clip_->info(); }

  bool read(std::span<std::byte> raster) override {
    return take([&] { return clip_->read(raster); });
  }
  bool skip(std::span<std::byte> room) override {
    return take([&] { return clip_->skip(room); });
  }

  [[nodiscard]] bool tells_changes() const override { return clip_->tells_changes(); }
  [[nodiscard]] bool makes_codes() const override { return clip_->makes_codes(); }
  std::optional<std::span<const PixelChange>> read_changes() override { return clip_->read_changes(); }

  [[nodiscard]] std::optional<std::string> ended_early() const override {
    return has_ended_ ? std::optional(reason_) : std::nullopt;
  }
  [[nodiscard]] std::vector<std::string> remarks() const override { return clip_->remarks(); }

 private:
  template <typename Take>
  bool take(Take take_next) {
    if (has_ended_) return false;
    try {
      if (!take_next()) return false;
      ++samples_read_;
      return true;
    } catch (const InputError& error) {
      // What has settings of its own is no damage.
      if (samples_read_ == 0 || (!ends_at_damage_ && !error.settings().empty())) throw;
      if (!ends_at_damage_) {
        throw InputError(format("{}; the {} before it can be taken", error.what(),
                                samples_read_ == 1 ? "picture" : format("{} pictures", samples_read_)),
                         {Setting::end_at_damage});
      }
      reason_ = format("{} is taken as far as it goes, {} of {} pictures: {}", name_, samples_read_,
                       clip_->info().sample_count, error.what());
      has_ended_ = true;
      return false;
    }
  }

  std::unique_ptr<Clip> clip_;
  std::string name_;
  bool ends_at_damage_;
  std::uint64_t samples_read_ = 0;
  std::string reason_;
  std::atomic<bool> has_ended_ = false;  // asked for while another thread reads; `reason_` stays from then on
};

// Pictures that tell no times themselves have those of the camera's header beside them.
void add_photron_header(ClipInfo& info, const std::filesystem::path& pictures) {
  if (info.timing.is_known()) return;
  const auto header = photron_header_of(pictures);
  if (!header) return;
  info.timing.rate = header->rate;
  info.timing.exposed_ns = header->exposed_ns;
  info.timing.rate_from = header->file.filename().string();
}

std::unique_ptr<Clip> open_stills(const std::filesystem::path& path,
                                  const std::vector<std::filesystem::path>& stills,
                                  const ClipOptions& options) {
  std::unique_ptr<Clip> clip = still_module().open(stills, {}, options);
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) return clip;
  ClipInfo info = clip->info();
  for (auto note : {missing_still_note(path, stills), left_out_note(path, stills)}) {
    if (note) info.notes.emplace_back(std::move(*note));
  }
  add_photron_header(info, path);
  return std::make_unique<DescribedClip>(std::move(clip), std::move(info));
}

std::unique_ptr<Clip> open_raw(const std::filesystem::path& path, const ClipOptions& options) {
  std::unique_ptr<Clip> clip = video_module().open(path, options);
  ClipInfo info = clip->info();
  add_photron_header(info, path);
  return std::make_unique<DescribedClip>(std::move(clip), std::move(info));
}

void refuse_event_options(const std::filesystem::path& path, const EventOptions& events) {
  std::vector<Setting> stated;
  if (events.contrast) stated.push_back(Setting::contrast);
  if (events.start) stated.push_back(Setting::start_picture);
  if (events.tick_ns) stated.push_back(Setting::tick);
  if (stated.empty()) return;
  throw UsageError(format("{} holds pictures, of which nothing is said by events; leave that out",
                          input_title(path.string())),
                   std::move(stated));
}

// All of it, as its files have it.
std::unique_ptr<Clip> open_whole(const std::filesystem::path& path, const ClipOptions& options) {
  if (!options.raw) refuse_unread_kind(path);
  const bool holds_events = !options.raw && is_event_recording(path);
  if (holds_events) return open_event_clip(path, options);
  refuse_event_options(path, options.events);
  if (!options.raw) {
    if (is_stills_table(path)) return open_table(path, options);
    if (const auto stills = list_stills(path)) return open_stills(path, *stills, options);
  }
  if (is_absent(path)) {
    throw InputError(format("{} cannot be read: no such file", input_title(path.string())));
  }
  if (options.raw) return open_raw(path, options);
  if (is_photron_clip(path)) return open_photron_clip(path, options);
  refuse_text(path);
  return video_module().open(path, options);
}

}  // namespace

std::unique_ptr<Clip> open_clip(const std::filesystem::path& name, const ClipOptions& options) {
  const std::filesystem::path& path = is_standard_input(name.string()) ? standard_input_file() : name;
  std::unique_ptr<Clip> clip = open_whole(path, options);
  return take_part(std::make_unique<PerhapsDamaged>(std::move(clip), path, options.ends_at_damage), path,
                   options);
}

void refuse_yuv_options(const ClipOptions& options) {
  if (!options.matrix && !options.range && !options.chroma_at) return;
  throw UsageError(
      "its pictures are RGB or grey as they are: leave matrix, range and the place of chroma out",
      {Setting::matrix, Setting::range, Setting::chroma_place});
}

void describe_stored_codes(ClipInfo& info, const ClipOptions& options, const StoredCodes& codes) {
  refuse_yuv_options(options);
  CaptureFormat& capture = info.format;
  capture.transfer = settle(info.facts, options.transfer, codes.transfer, codes.usual, Setting::transfer,
                            [](const Transfer& transfer) { return "transfer " + transfer.text(); });
  const auto add_origin = [&](const std::string& unread) {
    Fact& fact = info.facts.back();
    if (fact.origin == Origin::file) fact.source = codes.colours_from;
    if (fact.origin == Origin::assumed && !unread.empty()) fact.remark = format("the file names {}", unread);
  };
  add_origin(codes.unread_transfer);
  if (capture.shape.channels > 1) {
    capture.primaries =
        settle(info.facts, options.primaries, codes.primaries, Primaries::bt709, Setting::primaries,
               [](Primaries primaries) { return format("primaries {}", to_text(primaries)); });
    add_origin(codes.unread_primaries);
  }
  capture.pixel_aspect = settle(info.facts, options.pixel_aspect, codes.pixel_aspect, Rational{1, 1},
                                Setting::pixel_aspect, pixel_aspect_text);
}

Interlaced parse_deinterlacing(std::string_view text) {
  if (text == "frames") return Interlaced::frames;
  if (text == "fields") return Interlaced::fields;
  if (text == "no") return Interlaced::ignored;
  throw UsageError(format("deinterlacing '{}' is not known; choose frames, fields or no", text));
}

std::string_view to_text(YuvMatrix matrix) {
  switch (matrix) {
    case YuvMatrix::bt601: return "bt601";
    case YuvMatrix::bt709: return "bt709";
    case YuvMatrix::bt2020: return "bt2020";
    case YuvMatrix::fcc: return "fcc";
    case YuvMatrix::smpte240m: return "smpte240m";
    case YuvMatrix::p3: return "p3";
    case YuvMatrix::ycgco: return "ycgco";
  }
  return {};
}

std::string_view to_text(CodeRange range) { return range == CodeRange::full ? "full" : "limited"; }

std::string_view to_text(ChromaPlace place) {
  switch (place) {
    case ChromaPlace::left: return "left";
    case ChromaPlace::center: return "center";
    case ChromaPlace::topleft: return "topleft";
    case ChromaPlace::top: return "top";
    case ChromaPlace::bottomleft: return "bottomleft";
    case ChromaPlace::bottom: return "bottom";
  }
  return {};
}

YuvMatrix parse_yuv_matrix(std::string_view text) {
  for (const YuvMatrix matrix : {YuvMatrix::bt601, YuvMatrix::bt709, YuvMatrix::bt2020, YuvMatrix::ycgco}) {
    if (text == to_text(matrix)) return matrix;
  }
  throw UsageError(format("matrix '{}' is not known; choose bt601, bt709, bt2020 or ycgco", text));
}

CodeRange parse_code_range(std::string_view text) {
  for (const CodeRange range : {CodeRange::limited, CodeRange::full}) {
    if (text == to_text(range)) return range;
  }
  throw UsageError(format("range '{}' is not known; choose limited or full", text));
}

ChromaPlace parse_chroma_place(std::string_view text) {
  for (const ChromaPlace place : {ChromaPlace::left, ChromaPlace::center, ChromaPlace::topleft,
                                  ChromaPlace::top, ChromaPlace::bottomleft, ChromaPlace::bottom}) {
    if (text == to_text(place)) return place;
  }
  throw UsageError(format(
      "place of chroma '{}' is not known; choose left, center, topleft, top, bottomleft or bottom", text));
}

Rational parse_pixel_aspect(std::string_view text) {
  constexpr double kMax = 64.0;
  const auto colon = text.find(':');
  std::string fraction(text);
  if (colon != std::string_view::npos) fraction[colon] = '/';
  const Rational aspect = Rational::parse(fraction, "pixel aspect");
  if (!(aspect.value() >= 1 / kMax && aspect.value() <= kMax)) {
    throw UsageError(format("pixel aspect '{}' lies outside 1:64 … 64:1", text));
  }
  return aspect;
}

Timeline timeline_of(const std::string& name, const ClipInfo& info, const ClipOptions& options,
                     std::uint64_t sample_count) {
  const ClipTiming& timing = info.timing;
  const std::optional<Rational> rate = options.rate ? options.rate : timing.rate;
  if (!timing.exposed_ns) return timeline_of(name, info, options, Timeline::kFullShutter, sample_count);
  if (rate) {
    const double degrees =
        360.0 * static_cast<double>(*timing.exposed_ns) * rate->value() / static_cast<double>(kSecondNs);
    constexpr double kRounding = 1.01;  // of times that cameras write
    if (degrees > 360.0 * kRounding) {
      throw InputError(
          format("{}: at {} pictures a second each lasts {:.6g} s, and the shutter is said to "
                 "have been open for {}; state the rate or the shutter angle that it was filmed with",
                 name, rate->text(), 1 / rate->value(), seconds_text(*timing.exposed_ns)),
          {Setting::frame_rate, Setting::shutter_angle});
    }
    // As exact as anybody reads an angle; longer than a period none is.
    constexpr std::int64_t kParts = 1'000'000;
    const auto parts =
        static_cast<std::int64_t>(std::clamp(std::round(degrees * kParts), 1.0, 360.0 * kParts));
    return timeline_of(name, info, options, Rational::of(parts, kParts), sample_count);
  }
  ClipInfo listed = info;
  const std::vector<std::int64_t>& starts = timing.starts_ns;
  for (std::size_t k = 0; k < starts.size(); ++k) {
    const std::int64_t end_ns = starts[k] + *timing.exposed_ns;
    listed.timing.exposures.push_back(
        {starts[k], k + 1 < starts.size() ? std::min(end_ns, starts[k + 1]) : end_ns});
  }
  return timeline_of(name, listed, options, Timeline::kFullShutter, sample_count);
}

Timeline timeline_of(const std::string& name, const ClipInfo& info, const ClipOptions& options,
                     Rational shutter_angle, std::uint64_t sample_count) {
  if (options.rate) return Timeline::constant(*options.rate, shutter_angle, sample_count);
  if (!info.timing.is_known()) {
    const std::string& doubt = info.timing.rate_doubt;
    throw InputError(format("{} does not say how fast it was taken{}{}; state the rate", name,
                            doubt.empty() ? "" : ": ", doubt),
                     {Setting::frame_rate});
  }
  if (info.timing.rate) {
    try {
      static_cast<void>(Timeline::constant(*info.timing.rate, Timeline::kFullShutter, sample_count));
    } catch (const UsageError& error) {  // nobody stated it
      throw InputError(format("{}: the rate in the file cannot be: {}; state another", name, error.what()),
                       {Setting::frame_rate});
    }
    return Timeline::constant(*info.timing.rate, shutter_angle, sample_count);
  }
  const std::size_t times = std::max(info.timing.starts_ns.size(), info.timing.exposures.size());
  if (times < sample_count) {
    throw InputError(
        format("{} has {} pictures but only {} times; state its rate", name, sample_count, times),
        {Setting::frame_rate});
  }
  try {
    if (!info.timing.exposures.empty()) {
      const auto& exposures = info.timing.exposures;
      return Timeline::explicit_exposures(
          {exposures.begin(), exposures.begin() + static_cast<std::ptrdiff_t>(sample_count)});
    }
    // Where the picture behind the last one begins, it does not have to be guessed how long the last one holds.
    const std::vector<std::int64_t>& starts = info.timing.starts_ns;
    const bool is_next_known = starts.size() > sample_count && sample_count > 0;
    Timeline timeline = Timeline::irregular(
        {starts.begin(),
         starts.begin() + static_cast<std::ptrdiff_t>(sample_count + (is_next_known ? 1 : 0))},
        shutter_angle);
    if (!is_next_known) return timeline;
    const auto samples = timeline.table().first(sample_count);
    return Timeline::stored({samples.begin(), samples.end()}, timeline.start_ns(sample_count), shutter_angle);
  } catch (const InputError& error) {
    throw InputError(format("{}: {}", name, error.what()), error.settings());
  }
}

}  // namespace nutik
