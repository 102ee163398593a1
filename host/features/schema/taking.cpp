#include "features/schema/taking.hpp"

#include <algorithm>
#include <initializer_list>

#include "capture/format.hpp"
#include "session/text/number_text.hpp"

namespace nutik {
namespace {

// The value that a name stands for.
template <typename Value>
Value named(std::string_view word, std::string_view what,
            std::initializer_list<std::pair<std::string_view, Value>> values) {
  std::string known;
  for (const auto& [name, value] : values) {
    if (word == name) return value;
    known += (known.empty() ? "" : ", ") + std::string(name);
  }
  throw UsageError(format("{} '{}' is unknown; there are {}", what, word, known));
}

bool parse_only(std::string_view word, std::string_view what, std::string_view only) {
  if (word == only) return true;
  throw UsageError(format("{} {} is not known; the only choice is {} {}", what, word, what, only));
}

}  // namespace

void read_word(std::string_view word, std::string_view, std::string& value) { value = word; }
void read_word(std::string_view word, std::string_view what, Rational& value) {
  value = Rational::parse(word, what);
}
void read_word(std::string_view word, std::string_view what, StatedTime& value) {
  value = StatedTime::parse(word, what);
}
void read_word(std::string_view word, std::string_view, std::optional<Transfer>& value) {
  value = Transfer::parse(word);
}
void read_word(std::string_view word, std::string_view, YuvMatrix& value) { value = parse_yuv_matrix(word); }
void read_word(std::string_view word, std::string_view, CodeRange& value) { value = parse_code_range(word); }
void read_word(std::string_view word, std::string_view, ChromaPlace& value) {
  value = parse_chroma_place(word);
}
void read_word(std::string_view word, std::string_view, Primaries& value) { value = parse_primaries(word); }
void read_word(std::string_view word, std::string_view what, ClipMoment& value) {
  value = clip_moment(StatedTime::parse(word, what), what);
}
void read_word(std::string_view word, std::string_view, Rectangle& value) { value = parse_crop(word); }
void read_word(std::string_view word, std::string_view, ClipScale& value) { value = parse_scale(word); }
void read_word(std::string_view word, std::string_view, Interlaced& value) {
  value = parse_deinterlacing(word);
}
void read_word(std::string_view word, std::string_view, Contrast& value) { value = parse_contrast(word); }
void read_word(std::string_view word, std::string_view, StartLight& value) {
  value = parse_start_light(word);
}
void read_word(std::string_view word, std::string_view, TilePolicy& value) {
  value = parse_tile_policy(word);
}
void read_word(std::string_view word, std::string_view, tik::Codec& value) {
  value = tik::Codec::parse(word);
}
void read_word(std::string_view word, std::string_view, Feather& value) {
  value = Feather::parse(std::string(word));
}
void read_word(std::string_view word, std::string_view what, DelayRequest& value) {
  value = DelayRequest::parse(word, what);
}
void read_word(std::string_view word, std::string_view, ShutterShape& value) {
  value = ShutterShape::parse(word);
}
void read_word(std::string_view word, std::string_view, Normalization& value) {
  value = Normalization::parse(word);
}
void read_word(std::string_view word, std::string_view what, FrameRanges& value) {
  value = FrameRanges::parse(word, what);
}
void read_word(std::string_view word, std::string_view, Depth& value) { value = parse_depth(word); }

void read_word(std::string_view word, std::string_view, RawVideo& value) {
  const auto colon = word.find(':');
  if (colon == std::string_view::npos || word.find('x') > colon) {
    throw UsageError(format(
        "raw video '{}' is not described; write its size and pixel format, as in 480x270:yuv420p10le", word));
  }
  constexpr std::uint32_t kLargestSide = 65'536;
  const auto [width, height] =
      parse_pair(word.substr(0, colon), 'x', {"width", 1, kLargestSide}, {"height", 1, kLargestSide}, {});
  value = {width, height, std::string(word.substr(colon + 1))};
}

void read_word(std::string_view word, std::string_view what, CameraMotion& value) {
  const auto motion = camera_motion_of(word);
  if (!motion)
    throw UsageError(format("{} '{}' is no motion; choose translation, rigid or homography", what, word));
  value = *motion;
}

void read_word(std::string_view word, std::string_view what, Unseen& value) {
  if (word != "hold" && word != "crop")
    throw UsageError(format("{} '{}' is neither crop nor hold", what, word));
  value = word == "hold" ? Unseen::held : Unseen::cropped;
}

void read_word(std::string_view word, std::string_view, Combining& value) { value = Combining::parse(word); }

void read_word(std::string_view word, std::string_view what, FilmSoundWish& value) {
  if (word != "clip" && word != "stretch" && word != "no")
    throw UsageError(format("{} {} is not known; choose clip, stretch or no", what, word));
  value = word == "clip" ? FilmSoundWish::as_it_is : word == "no" ? FilmSoundWish::none : FilmSoundWish::stretched;
}

void read_word(std::string_view word, std::string_view what, MaskBlend& value) {
  if (word != "distance" && word != "alpha")
    throw UsageError(format("{} {} is not known; choose distance or alpha", what, word));
  value = word == "alpha" ? MaskBlend::alpha : MaskBlend::distance;
}

void read_word(std::string_view word, std::string_view, MaskSize& value) {
  constexpr std::uint32_t kLargestSide = 1u << 20;
  const auto [width, height] = parse_pair(word, 'x', {"width", 1, kLargestSide}, {"height", 1, kLargestSide},
                                          format("size '{}' is none; write WIDTHxHEIGHT: 640x360", word));
  value = {width, height};
}

void read_word(std::string_view word, std::string_view, RendererKind& value) {
  if (word != "opencl" && word != "reference")
    throw UsageError(format("renderer '{}' is not known; choose opencl or reference", word));
  value = word == "reference" ? RendererKind::reference : RendererKind::opencl;
}

void read_word(std::string_view word, std::string_view, std::optional<Precision>& value) {
  value = word == "auto" ? std::nullopt : std::optional(parse_precision(word));
}

void read_word(std::string_view word, std::string_view what, MemoryBudget& value) {
  const std::optional<std::uint64_t> bytes = parse_bytes(word);
  if (!bytes || *bytes == 0)
    throw UsageError(format("{} '{}' is no size; write 500MB, 2GB or 1GiB", what, word));
  value = {*bytes};
}

void read_word(std::string_view word, std::string_view what, NegativeLight& value) {
  if (word == "saturate") {
    value = NegativeLight::saturate;
  } else if (word == "offset") {
    value = NegativeLight::offset;
  } else if (word == "abs") {
    value = NegativeLight::absolute;
  } else {
    throw UsageError(format("{} {} is not known; choose saturate, offset or abs", what, word));
  }
}

void read_word(std::string_view word, std::string_view what, StudyStyle& value) {
  value = named<StudyStyle>(word, what,
                            {{"trail", StudyStyle::trail},
                             {"strobe", StudyStyle::strobe},
                             {"rear-curtain", StudyStyle::rear_curtain},
                             {"frozen", StudyStyle::frozen},
                             {"clean", StudyStyle::clean},
                             {"slit", StudyStyle::slit}});
}

void read_word(std::string_view word, std::string_view what, MomentSpacing& value) {
  value = named<MomentSpacing>(word, what,
                               {{"time", MomentSpacing::time}, {"distance", MomentSpacing::distance}});
}

void read_word(std::string_view word, std::string_view what, TrailShape& value) {
  value = named<TrailShape>(word, what,
                            {{"even", TrailShape::even},
                             {"fade", TrailShape::fade},
                             {"ramp", TrailShape::ramp},
                             {"none", TrailShape::none}});
}

void read_word(std::string_view word, std::string_view what, SlitFrom& value) {
  value = named<SlitFrom>(word, what,
                          {{"left", SlitFrom::left},
                           {"right", SlitFrom::right},
                           {"top", SlitFrom::top},
                           {"bottom", SlitFrom::bottom}});
}

std::int64_t parse_tick(std::string_view word, std::string_view what) {
  return tick_ns(StatedTime::parse(word, what), what);
}

double parse_sigmas(std::string_view word, std::string_view what) {
  return parse_number(word, what, SourceRequest::kMinSigmas, SourceRequest::kMaxSigmas);
}

std::uint32_t parse_share(std::string_view word, std::string_view what) {
  const Rational share = Rational::parse(word, what);
  if (share.numerator < 0 || share.numerator > share.denominator)
    throw UsageError(format("{} {} is no share of 0 to 1", what, word));
  return static_cast<std::uint32_t>(round_half_up(int128{share.numerator} * kWholeWay, share.denominator));
}

bool parse_zero(std::string_view word, std::string_view what) { return parse_only(word, what, "zero"); }
bool parse_all(std::string_view word, std::string_view what) { return parse_only(word, what, "all"); }

std::pair<std::uint32_t, std::uint32_t> parse_pixel(std::string_view word, std::string_view what) {
  constexpr std::uint32_t kLast = 65'535;
  return parse_pair(
      word, ',', {"pixel column", 0, kLast}, {"pixel row", 0, kLast},
      format("{0} '{1}' is no place; write its column and row from 0 on: {0} 320,180", what, word));
}

double parse_shutter_error(std::string_view word, std::string_view what) {
  const double error = parse_signed(word, what);
  if (!(error >= ShutterShape::kMinError && error < 1.0))
    throw UsageError(format("{} {} is no share from {} to 1", what, error, ShutterShape::kMinError));
  return error;
}

double parse_signed(std::string_view word, std::string_view what) {
  const std::string_view number = word.substr(word.starts_with('+') ? 1 : 0);
  const auto slash = number.find('/');  // a third of a stop is 1/3
  const auto above = parse_number(number.substr(0, slash));
  const auto below = slash == number.npos ? std::optional(1.0) : parse_number(number.substr(slash + 1));
  if (!above || !below || *below == 0.0) throw UsageError(format("{} {} is no number", what, word));
  return *above / *below;
}

StatedTime parse_step(std::string_view word, std::string_view what) {
  const StatedTime step = StatedTime::parse(word, what);
  if (step.number.numerator <= 0) throw UsageError(format("{} '{}' is not longer than nothing", what, word));
  if (step.counts_samples() && step.number.denominator != 1)
    throw UsageError(format("{} '{}' is not a whole number of pictures", what, word));
  return step;
}

std::uint32_t parse_whole(std::string_view word, std::string_view what, std::uint32_t low,
                          std::uint32_t high) {
  return parse_whole_number(word, what, low, high);
}

void take_activity_tag(Options& options, std::string_view what, const std::string& word) {
  options.each_tag = word == "all";
  if (!options.each_tag) options.tag = static_cast<std::uint8_t>(parse_whole(word, what, 0, 255));
}

}  // namespace nutik
