// Sequences of stills. Pages of a TIFF are read in one go; light of floating-point pictures becomes codes of 16 bits.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/light_codes.hpp"
#include "capture/text.hpp"
#include "capture/turned.hpp"
#include "media/formats/colour_profile.hpp"
#include "media/formats/file_kinds.hpp"
#include "media/stills/picture_files.hpp"
#include "media/formats/input_kinds.hpp"
#include "media/module.hpp"
#include "media/settled_fact.hpp"
#include "media/stills/raw_file.hpp"
#include "media/stills/stills.hpp"
#include "media/stills/tiff_reader.hpp"
#include "system/mapped_file.hpp"

namespace nutik::stills {
namespace {

// One picture of a file.
struct Page {
  std::filesystem::path file;
  const inputs::InputKind* kind = nullptr;
  std::uint64_t number = 1;
  std::uint64_t count = 1;  // of the file's pages
  std::size_t place = 0;    // as the kind's reader takes it

  [[nodiscard]] std::string name() const {
    return count == 1 ? file.string() : format("page {} of {}", number, file.string());
  }
};

struct Still {
  Shape shape;
  std::uint32_t code_bytes = 1;
  std::optional<std::uint32_t> maximum;  // that the file states
  std::vector<std::byte> codes;          // interleaved raster
  std::optional<Rational> pixel_aspect = std::nullopt;
  std::optional<Transfer> transfer = std::nullopt;  // that the file names
  std::optional<Primaries> primaries = std::nullopt;
  std::string profile = {};                                 // whose colours these are; empty: the file's own
  std::string unread_transfer = {}, unread_primaries = {};  // that it names and that are not believed
  bool holds_light = false;
  bool has_palette = false;
  std::string left_out = {};
};

// How much wider than high a pixel is of which so many are as long as one and the same length. Pictures state pixels an
// inch, rounded as they like: what lies within a thousandth of a square is one. None that no pixel has.
std::optional<Rational> aspect_of(double pixels_across, double pixels_down) {
  constexpr double kMax = 64.0, kSquare = 1e-3;
  constexpr std::int64_t kParts = 10'000;
  const double aspect = pixels_down / pixels_across;
  if (!(aspect >= 1 / kMax && aspect <= kMax)) return std::nullopt;
  if (std::abs(aspect - 1.0) <= kSquare) return Rational{1, 1};
  const bool are_whole = pixels_across == std::floor(pixels_across) &&
                         pixels_down == std::floor(pixels_down) && std::max(pixels_across, pixels_down) < 1e9;
  if (are_whole)
    return Rational::of(static_cast<std::int64_t>(pixels_down), static_cast<std::int64_t>(pixels_across));
  return Rational::of(std::llround(aspect * kParts), kParts);
}

Still still_of(Picture&& picture, std::optional<std::uint32_t> maximum) {
  return {picture.shape, static_cast<std::uint32_t>(value_bytes(picture.type)), maximum,
          std::move(picture.bytes)};
}

// Light as the nearest of equal steps up to white, or of a stated curve's. Throws InputError where a capture cannot
// hold a value.
template <typename Value>
Picture codes_of_light(const Picture& light, std::optional<double> white, const std::optional<LightCodes>& curve,
                       const std::string& name) {
  const auto values = light.values<Value>();
  if (!white) {
    const double largest = *std::ranges::max_element(values);
    throw InputError(format("{} holds floating-point light, and nothing says how much of it is white; the largest "
                            "value is {:.6g}: state the light of white",
                            name, largest),
                     {Setting::white_code});
  }
  Picture codes(light.shape, ValueType::code16, kLightSteps);
  auto* code = codes.values<std::uint16_t>().data();
  // White as the file's type rounds it, for pictures were clipped to that.
  const auto most = static_cast<Value>(*white);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double value = values[i];
    if (value >= 0 && values[i] <= most && std::isfinite(value)) {
      const double share = value / *white;
      *code++ = static_cast<std::uint16_t>(curve ? curve->code_of(share) : std::floor(share * kLightSteps + 0.5));
      continue;
    }
    const std::size_t pixel = i / light.shape.channels;
    const bool is_bright = value > most && std::isfinite(value);
    const std::string where = format("{},{}", pixel % light.shape.width, pixel / light.shape.width);
    throw LightOutside(format("{}: pixel {} has light {:.6g}, and a capture holds what lies between 0 and white, "
                              "{:.6g}; {}",
                              name, where, value, *white,
                              is_bright ? "state a larger white"
                              : value < 0 && std::isfinite(value)
                                  ? "add as much to all of its light as the darkest lacks"
                                  : "it is no light"),
                       is_bright ? std::vector{Setting::white_code} : std::vector<Setting>{}, where, value);
  }
  return codes;
}

// What pages are read with, one after the other.
struct Reading {
  std::optional<double> white;      // stated, of light
  std::optional<LightCodes> curve;  // likewise
  RawDeveloper raws = {};
  std::optional<TiffReader> tiff = std::nullopt;  // of the page read last
  std::filesystem::path tiff_file = {};           // likewise
  bool ends_at_damage = false;
  TiffStory story = {};                           // of the first file
};

Still still_of_light(const Picture& light, const Reading& reading, const Page& page) {
  Still still = still_of(light.type == ValueType::light64
                             ? codes_of_light<double>(light, reading.white, reading.curve, page.name())
                             : codes_of_light<float>(light, reading.white, reading.curve, page.name()),
                         kLightSteps);
  still.holds_light = true;
  return still;
}

void add_pages(std::vector<Page>& pages, const std::filesystem::path& file, const inputs::InputKind& kind,
               std::uint64_t count) {
  for (std::uint64_t number = 1; number <= count; ++number) pages.push_back({file, &kind, number, count});
}

void add_tiff(std::vector<Page>& pages, const std::filesystem::path& file, Reading& reading) try {
  const TiffReader tiff(file, reading.ends_at_damage);
  if (tiff.is_dng()) return add_pages(pages, file, inputs::kDng, 1);  // whose pages show one picture
  if (pages.empty()) reading.story = tiff.story();
  add_pages(pages, file, inputs::kTiff, tiff.page_count());
} catch (const InputError& error) {
  if (!reading.ends_at_damage || pages.empty() || !error.settings().empty()) throw;
  add_pages(pages, file, inputs::kTiff, 1);  // which ends the clip
}

void follow_profile(Still& still, std::span<const std::byte> profile) {
  const ProfiledColours colours = read_colour_profile(profile);
  still.transfer = colours.transfer;
  still.primaries = colours.primaries;
  still.profile = colours.name;
  if (!colours.transfer) still.unread_transfer = colours.name;
  if (!colours.primaries) still.unread_primaries = colours.name;
}

// From how a picture lies, as EXIF and TIFF number it.
void turn_upright(Still& still, unsigned orientation) {
  turn_upright(still.codes, still.shape, still.code_bytes * still.shape.channels, orientation);
  if (orientation >= 5 && still.pixel_aspect)
    still.pixel_aspect = Rational::of(still.pixel_aspect->denominator, still.pixel_aspect->numerator);
}

// What the file says of its pixels is followed, too.
Still still_of(FilePicture&& read, const Reading& reading, const Page& page) {
  Still still = holds_codes(read.picture.type) ? still_of(std::move(read.picture), read.maximum)
                                               : still_of_light(read.picture, reading, page);
  if (!read.profile.empty()) follow_profile(still, read.profile);
  still.left_out = std::move(read.left_out);
  still.has_palette = read.has_palette;
  if (read.density) still.pixel_aspect = aspect_of(read.density->first, read.density->second);
  turn_upright(still, read.orientation);
  return still;
}

void check_front(std::string_view bytes, const std::string& name) {
  if (inputs::kPng.begins(bytes) || inputs::kJpeg.begins(bytes)) return;
  throw InputError(
      format("{} cannot be read: it is damaged or no picture: neither a PNG nor a JPEG begins like that", name));
}

Still read_jpeg_still(const Page& page, Reading& reading) {
  const std::filesystem::path& file = page.file;
  const MappedFile mapped(file);
  check_front(as_text(mapped.bytes()), file.string());
  if (holds_several_pictures(file))
    throw InputError(format("{} holds several pictures: name it alone, as a video is", file.string()));
  FilePicture read = read_jpeg(mapped.bytes(), file.string());
  read.orientation = exif_orientation(file);
  return still_of(std::move(read), reading, page);
}

Still read_png_still(const Page& page, Reading& reading) {
  const MappedFile mapped(page.file);
  const std::string name = page.file.string();
  check_front(as_text(mapped.bytes()), name);
  const PngTags tags = read_png_tags(mapped.bytes(), name);
  if (holds_several_pictures(page.file)) {
    throw InputError(format("{} holds several pictures, as an animated PNG does: name it alone, as a video is", name));
  }
  FilePicture read = read_png(mapped.bytes(), name, PngUse::still);
  const std::vector<std::byte> profile = std::exchange(read.profile, {});
  read.density = tags.density;
  read.orientation = png_orientation(mapped.bytes());
  Still still = still_of(std::move(read), reading, page);
  still.transfer = tags.transfer;
  still.primaries = tags.primaries;
  if (!tags.transfer) still.unread_transfer = tags.unread_transfer;
  if (!tags.primaries) still.unread_primaries = tags.unread_primaries;
  if (tags.has_profile) follow_profile(still, profile);
  return still;
}

Still read_dng_still(const Page& page, Reading& reading) {
  Still still = still_of(reading.raws.develop(page.file), 65'535);
  still.transfer = Transfer::linear();
  still.primaries = Primaries::bt709;
  return still;
}

Still read_exr_still(const Page& page, Reading& reading) {
  const ExrPicture read = read_exr(page.file);
  Still still = still_of_light(read.light, reading, page);
  still.primaries = read.primaries.known;
  still.unread_primaries = read.primaries.unread;
  still.left_out = read.left_out;
  still.pixel_aspect = aspect_of(1, read.pixel_aspect);
  return still;
}

Still read_tiff_still(const Page& page, Reading& reading) {
  if (page.number == 1 || reading.tiff_file != page.file) {
    reading.tiff.emplace(page.file, reading.ends_at_damage);
    reading.tiff_file = page.file;
  }
  reading.tiff->pass_to(page.number);
  std::optional<FilePicture> read = reading.tiff->next();
  if (!read) throw InputError(format("{} cannot be read: the file was cut off", page.name()));
  return still_of(std::move(*read), reading, page);
}

// Kinds of which more is read than a picture's bytes tell.
struct StillFormat {
  const inputs::InputKind* kind;
  Still (*read)(const Page& page, Reading& reading);
  // Adds the pages of a file, and what is known of them; null: it is one.
  void (*add)(std::vector<Page>& pages, const std::filesystem::path& file, Reading& reading) = nullptr;
};
constexpr StillFormat kFormats[] = {
    {&inputs::kPng, read_png_still},
    {&inputs::kJpeg, read_jpeg_still},
    {&inputs::kTiff, read_tiff_still, add_tiff},
    {&inputs::kDng, read_dng_still},
    {&inputs::kExr, read_exr_still},
};

// Null of the others.
const StillFormat* format_of(const inputs::InputKind& kind) {
  const auto* const found = std::ranges::find(kFormats, kind, [](const StillFormat& each) { return *each.kind; });
  return found == std::end(kFormats) ? nullptr : found;
}

Still read_still(const Page& page, Reading& reading) {
  if (page.kind->read == nullptr) return format_of(*page.kind)->read(page, reading);
  return still_of(page.kind->read(MappedFile(page.file).bytes(), page.name(), page.place), reading, page);
}

void add_file(std::vector<Page>& pages, const std::filesystem::path& file, const inputs::InputKind& kind,
              Reading& reading) {
  if (const StillFormat* const format = format_of(kind); format != nullptr && format->add != nullptr)
    return format->add(pages, file, reading);
  if (kind.places == nullptr) return add_pages(pages, file, kind, 1);
  const std::vector<std::size_t> places = kind.places(MappedFile(file).bytes(), file.string());
  for (std::size_t i = 0; i < places.size(); ++i)
    pages.push_back({file, &kind, i + 1, places.size(), places[i]});
}

class StillClip final : public Clip {
 public:
  StillClip(std::span<const std::filesystem::path> files, const ClipTiming& timing,
            const ClipOptions& options)
      : stated_(options) {
    reading_.ends_at_damage = options.ends_at_damage && !timing.is_known();
    for (const std::filesystem::path& file : files) {
      refuse_unsupported_kind(file);
      const inputs::InputKind* kind = still_kind(file);
      if (kind == nullptr) kind = &inputs::kPng;  // which says that it is none
      add_file(pages_, file, *kind, reading_);
      if (const std::uint64_t count = pages_.back().count; count > 1 && timing.is_known()) {
        throw InputError(format("{} has {} pages; in a table with times each picture is a file of its own",
                                file.string(), count));
      }
    }
    reading_.white = options.white_light;
    if (options.white_light && options.transfer && !options.transfer->is_linear())
      reading_.curve.emplace(*options.transfer, kLightSteps);
    first_ = read(pages_.front());
    first_maximum_ = first_.maximum;
    unread_transfer_ = first_.unread_transfer;
    unread_primaries_ = first_.unread_primaries;
    CaptureFormat& capture = info_.format;
    capture.shape = first_.shape;
    capture.code_bytes = first_.code_bytes;
    if (first_.holds_light) {
      describe_light(info_, *options.white_light);
    } else if (first_.code_bytes == 1) {
      capture.white_code = options.white_code.value_or(first_.maximum.value_or(255));
    } else {
      capture.white_code = settle_white(info_, options.white_code, first_.maximum);
    }
    const bool is_developed = *pages_.front().kind == inputs::kDng;
    describe_stored_codes(info_, options,
                          {default_transfer(first_), first_.transfer, first_.primaries, first_.profile,
                           first_.unread_transfer, first_.unread_primaries, first_.pixel_aspect});
    add_unread_colours(options);
    info_.left_out = first_.left_out;
    if (!info_.left_out.empty()) info_.notes.emplace_back(left_out_note(info_.left_out));
    if (first_.has_palette) {
      info_.notes.emplace_back(
          "the pictures have a palette: its colours are read, not the values that are stored. Without it these are (in "
          "Fiji: Image, Lookup Tables, Grays)");
    }
    if (is_developed && pages_.size() > 1) {
      info_.notes.emplace_back(
          format("black level, white balance and colours of all pictures are those that {} states",
                 pages_.front().file.filename().string()));
    }
    info_.timing = timing;
    info_.sample_count = pages_.size();
    if (!timing.is_known()) add_story(files.size());
    if (is_developed && !timing.is_known()) add_raw_times();
  }

  [[nodiscard]] const ClipInfo& info() const override { return info_; }

  bool read(std::span<std::byte> raster) override {
    if (next_ == pages_.size()) return false;
    const Page& page = pages_[next_];
    const Still still = next_ == 0 ? std::move(first_) : read(page);
    check_like_first(still, page);
    check_colours(still, page);
    check_pixel_aspect(still, page);
    if (remark_.empty() && !still.left_out.empty() && still.left_out != info_.left_out)
      remark_ = format("{}: {}", page.name(), left_out_note(still.left_out));
    std::memcpy(raster.data(), still.codes.data(), still.codes.size());
    ++next_;
    return true;
  }

  [[nodiscard]] std::vector<Note> remarks() const override {
    return remark_.empty() ? std::vector<Note>{} : std::vector<Note>{remark_};
  }

  [[nodiscard]] bool makes_codes() const override { return info_.holds_light; }

  bool skip(std::span<std::byte> /*room*/) override {
    if (next_ == pages_.size()) return false;
    if (next_ == 0) first_ = {};
    ++next_;
    return true;
  }

 private:
  Still read(const Page& page) { return read_still(page, reading_); }

  // A profile or primaries were meant for these codes: what they say and is not known here would be right.
  void add_unread_colours(const ClipOptions& options) {
    const bool has_profile = !first_.profile.empty();
    std::vector<Setting> open;
    if (has_profile && !first_.transfer && !options.transfer) open.push_back(Setting::transfer);
    if (first_.shape.channels > 1 && !first_.unread_primaries.empty() && !options.primaries)
      open.push_back(Setting::primaries);
    if (open.empty()) return;
    const bool are_both = open.size() == 2, is_transfer = open.front() == Setting::transfer;
    const std::string what =
        has_profile ? format("{} says what the codes stand for, and its {}", first_.profile,
                             are_both ? "curves and primaries" : is_transfer ? "curves" : "primaries")
                    : format("the file's primaries, {},", first_.unread_primaries);
    info_.notes.emplace_back(
        format("{} are none that are known here: what is usual is taken, and colours are wrong by what it differs; {}"
               "state what comes nearest",
               what, has_profile ? "magick IN -profile sRGB.icc OUT makes pictures of known ones; or " : ""),
        std::move(open));
  }

  // What the description of the first TIFF says of times, and of pictures that are not there.
  void add_story(std::size_t files) {
    const TiffStory& story = reading_.story;
    if (!story.who.empty()) info_.timing.rate_from = format("{}'s description in the file", story.who);
    info_.timing.rate_doubt = story.rate_doubt;
    info_.timing.rate = story.rate;
    info_.notes.insert(info_.notes.end(), story.notes.begin(), story.notes.end());
    if (!story.starts_ns.empty() && story.starts_ns.size() >= pages_.size()) {
      info_.timing.rate.reset();
      info_.timing.starts_ns = story.starts_ns;
      if (story.rate) {
        info_.notes.emplace_back(
            format("{}'s description states {} pictures a second, and times of its pictures that differ from these by "
                   "half a period or more. These times are taken; state a rate if they are wrong",
                   story.who, story.rate->text()),
            std::vector{Setting::frame_rate});
      }
    }
    if (files > 1 || story.pictures == 0 || story.pictures == pages_.size()) return;
    info_.notes.emplace_back(format("{}'s description counts its pictures as {}, and the file holds {}", story.who,
                                    story.pictures, pages_.size()));
  }

  // The rate that the first picture states, and the exposure, where it was the same for all.
  void add_raw_times() {
    const std::filesystem::path& file = pages_.front().file;
    const RawTags first = read_raw_tags(file);
    info_.timing.rate = first.rate;
    info_.timing.exposed_from = info_.timing.rate_from = file.filename().string();
    if (!first.exposure_ns) return;
    for (const Page& page : pages_) {
      const RawTags tags = read_raw_tags(page.file);
      if (tags.exposure_ns == first.exposure_ns) continue;
      info_.notes.emplace_back(
          format(
              "exposures are not used, which differ: {} was exposed for {} ns, {} for {}; a table of stills "
              "takes each picture's own",
              file.filename().string(), *first.exposure_ns, page.file.filename().string(),
              tags.exposure_ns ? format("{} ns", *tags.exposure_ns) : "a time that it does not tell"),
          std::vector{Setting::shutter_angle});
      return;
    }
    info_.timing.exposed_ns = first.exposure_ns;
  }

  // Deep stills come from scientific cameras, whose codes are linear; shallow ones are made to be seen.
  [[nodiscard]] static Transfer default_transfer(const Still& still) {
    return still.code_bytes == 1 ? Transfer::srgb() : Transfer::linear();
  }

  void check_colours(const Still& still, const Page& page) const {
    const CaptureFormat& capture = info_.format;
    const Transfer transfer = still.transfer.value_or(default_transfer(still));
    const auto stated_by = [](const Still& each) { return each.primaries.value_or(Primaries::bt709); };
    const Primaries primaries = stated_by(still);
    const bool other_transfer =
        !stated_.transfer && (transfer != capture.transfer || still.unread_transfer != unread_transfer_);
    const bool other_primaries = !stated_.primaries && capture.shape.channels > 1 &&
                                 (primaries != stated_by(first_) || still.unread_primaries != unread_primaries_);
    if (!other_transfer && !other_primaries) return;
    // What is named and not known here, by its name.
    const auto named = [](const std::string& unread, std::string known) {
      return unread.empty() ? std::move(known) : unread;
    };
    throw InputError(
        format("{} has transfer {} and primaries {}, the first still, {}, {} and {}. All must be "
               "alike; state what all are to be taken for",
               page.name(), named(still.unread_transfer, transfer.text()),
               named(still.unread_primaries, std::string(to_text(primaries))), pages_.front().file.string(),
               named(unread_transfer_, capture.transfer.text()),
               named(unread_primaries_, std::string(to_text(capture.primaries)))),
        {other_transfer ? Setting::transfer : Setting::primaries});
  }

  void check_pixel_aspect(const Still& still, const Page& page) const {
    const Rational aspect = still.pixel_aspect.value_or(Rational{1, 1}), &first = info_.format.pixel_aspect;
    if (stated_.pixel_aspect || aspect == first) return;
    throw InputError(
        format("{} has {}, the first still, {}, {}. All must be alike; state what all have", page.name(),
               pixel_aspect_text(aspect), pages_.front().file.string(), pixel_aspect_text(first)),
        {Setting::pixel_aspect});
  }

  void check_like_first(const Still& still, const Page& page) const {
    const CaptureFormat& capture = info_.format;
    const bool same_white =
        still.holds_light == info_.holds_light && (stated_.white_code || still.maximum == first_maximum_);
    if (still.shape == capture.shape && still.code_bytes == capture.code_bytes && same_white) return;
    const auto text = [](const Shape& shape, std::uint32_t code_bytes, std::optional<std::uint32_t> maximum) {
      return format("{} x {} {} of {} bits{}", shape.width, shape.height,
                    shape.channels == 1 ? "grey" : "colour", code_bytes * 8,
                    maximum ? format(", white code {}", *maximum) : "");
    };
    throw InputError(format("{} is {}; the first still, {}, is {}. All must be alike{}", page.name(),
                            text(still.shape, still.code_bytes, still.maximum), pages_.front().file.string(),
                            text(capture.shape, capture.code_bytes, first_maximum_),
                            same_white ? "; name those that are with a pattern: 'frame*.png'"
                                       : ", or state what is white"),
                     same_white ? std::vector<Setting>{} : std::vector{Setting::white_code});
  }

  std::vector<Page> pages_;
  Reading reading_;
  Still first_;
  std::optional<std::uint32_t> first_maximum_;
  std::string unread_transfer_, unread_primaries_;  // of the first
  ClipOptions stated_;
  std::string remark_;  // on the first later still of which something else is left out
  std::size_t next_ = 0;
  ClipInfo info_;
};

std::unique_ptr<Clip> open_still_files(std::span<const std::filesystem::path> files, const ClipTiming& timing,
                                       const ClipOptions& options) {
  return std::make_unique<StillClip>(files, timing, options);
}

// Between the codes themselves, as players do: in light, Lanczos' kernel would draw dark lines beside bright edges.
Picture enlarged(const Picture& picture, const Shape& shape) {
  Picture large(shape, picture.type, picture.white_code);
  large.transfer = picture.transfer;
  large.primaries = picture.primaries;
  large.exposed_ns = picture.exposed_ns;
  const int depth = picture.type == ValueType::code8 ? CV_8U : CV_16U;
  const auto matrix_of = [&](const Shape& of, const std::byte* bytes) {
    return cv::Mat(static_cast<int>(of.height), static_cast<int>(of.width),
                   CV_MAKETYPE(depth, static_cast<int>(of.channels)), const_cast<std::byte*>(bytes));
  };
  cv::Mat to = matrix_of(shape, large.bytes.data());
  cv::resize(matrix_of(picture.shape, picture.bytes.data()), to, to.size(), 0, 0, cv::INTER_LANCZOS4);
  const double white = picture.white_code;
  cv::min(to, cv::Scalar(white, white, white), to);
  return large;
}

// Without OpenCV's threads, as in align/motion/robust_registrar.cpp.
void begin(SharedState& of_program) {
  use_shared_state(of_program);
  if (of_program.is_one_work) cv::setNumThreads(0);
}

}  // namespace
}  // namespace nutik::stills

// What nutik-stills.so gives the program (media/module.hpp).
extern "C" __attribute__((visibility("default"))) const nutik::StillModule nutik_still_module{
    nutik::stills::begin, nutik::stills::open_still_files, nutik::stills::read_exif_times,
    nutik::stills::write_exr, nutik::stills::write_exr_layers, nutik::stills::read_exr_text, nutik::stills::enlarged};

extern "C" __attribute__((visibility("default"))) const char nutik_module_version[] = NUTIK_VERSION;
