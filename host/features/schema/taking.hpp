// How a word becomes the value that a row of the schema keeps. A row names the field, `take<InClip<&ClipOptions::crop>>`;
// what its words mean follows from the field's type, or is stated: take_whole with its bounds, take_by with a parser.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "features/schema/option.hpp"

namespace nutik {

// Read a word as a value of that type. Throw UsageError naming `what`, or listing what there is.
void read_word(std::string_view word, std::string_view what, std::string& value);
void read_word(std::string_view word, std::string_view what, Rational& value);
void read_word(std::string_view word, std::string_view what, StatedTime& value);
void read_word(std::string_view word, std::string_view what, std::optional<Transfer>& value);
void read_word(std::string_view word, std::string_view what, YuvMatrix& value);
void read_word(std::string_view word, std::string_view what, CodeRange& value);
void read_word(std::string_view word, std::string_view what, ChromaPlace& value);
void read_word(std::string_view word, std::string_view what, Primaries& value);
void read_word(std::string_view word, std::string_view what, RawVideo& value);  // 480x270:yuv420p10le
void read_word(std::string_view word, std::string_view what, ClipMoment& value);
void read_word(std::string_view word, std::string_view what, Rectangle& value);
void read_word(std::string_view word, std::string_view what, ClipScale& value);
void read_word(std::string_view word, std::string_view what, Interlaced& value);
void read_word(std::string_view word, std::string_view what, Contrast& value);
void read_word(std::string_view word, std::string_view what, StartLight& value);
void read_word(std::string_view word, std::string_view what, CameraMotion& value);
void read_word(std::string_view word, std::string_view what, Unseen& value);
void read_word(std::string_view word, std::string_view what, TilePolicy& value);
void read_word(std::string_view word, std::string_view what, tik::Codec& value);
void read_word(std::string_view word, std::string_view what, Feather& value);
void read_word(std::string_view word, std::string_view what, DelayRequest& value);
void read_word(std::string_view word, std::string_view what, ShutterShape& value);
void read_word(std::string_view word, std::string_view what, Normalization& value);
void read_word(std::string_view word, std::string_view what, MaskBlend& value);
void read_word(std::string_view word, std::string_view what, MaskSize& value);
void read_word(std::string_view word, std::string_view what, FrameRanges& value);
void read_word(std::string_view word, std::string_view what, RendererKind& value);
void read_word(std::string_view word, std::string_view what, std::optional<Precision>& value);  // none: auto
void read_word(std::string_view word, std::string_view what, MemoryBudget& value);
void read_word(std::string_view word, std::string_view what, Depth& value);
void read_word(std::string_view word, std::string_view what, NegativeLight& value);
void read_word(std::string_view word, std::string_view what, StudyStyle& value);
void read_word(std::string_view word, std::string_view what, MomentSpacing& value);
void read_word(std::string_view word, std::string_view what, TrailShape& value);
void read_word(std::string_view word, std::string_view what, SlitFrom& value);
void read_word(std::string_view word, std::string_view, Combining& value);
void read_word(std::string_view word, std::string_view what, FilmSoundWish& value);
inline void read_word(std::string_view, std::string_view, bool& flag) { flag = true; }
template <typename Value>
void read_word(std::string_view word, std::string_view what, std::optional<Value>& value) {
  read_word(word, what, value.emplace());
}

// For take_by.
[[nodiscard]] std::int64_t parse_tick(std::string_view word, std::string_view what);
[[nodiscard]] double parse_sigmas(std::string_view word, std::string_view what);
[[nodiscard]] std::uint32_t parse_share(std::string_view word, std::string_view what);  // of kWholeWay
[[nodiscard]] bool parse_zero(std::string_view word, std::string_view what);  // the only word there is
[[nodiscard]] bool parse_all(std::string_view word, std::string_view what);
[[nodiscard]] std::pair<std::uint32_t, std::uint32_t> parse_pixel(std::string_view word,
                                                                  std::string_view what);
[[nodiscard]] double parse_shutter_error(std::string_view word, std::string_view what);
[[nodiscard]] double parse_signed(std::string_view word, std::string_view what);
[[nodiscard]] StatedTime parse_step(std::string_view word, std::string_view what);  // longer than nothing
// A whole number of low … high.
[[nodiscard]] std::uint32_t parse_whole(std::string_view word, std::string_view what, std::uint32_t low,
                                        std::uint32_t high);

// A field of Options, or of what stands in it.
template <auto... path>
struct In {
  static auto& of(Options& options) { return (options.*....*path); }
};
template <auto member>
using InSource = In<&Options::source, member>;
template <auto member>
using InClip = In<&Options::source, &SourceRequest::clip, member>;
template <auto member>
using InEvents = In<&Options::source, &SourceRequest::clip, &ClipOptions::events, member>;
template <auto member>
using InFilm = In<&Options::film, member>;
template <auto member>
using InStudy = In<&Options::study, member>;
template <auto member>
using InPicture = In<&Options::picture, member>;

template <typename Field>
void take(Options& options, std::string_view what, const std::string& word) {
  read_word(word, what, Field::of(options));
}

template <typename Field, std::uint32_t low, std::uint32_t high>
void take_whole(Options& options, std::string_view what, const std::string& word) {
  Field::of(options) = parse_whole(word, what, low, high);
}

// By a parser that is told what is read, or one that says itself what it reads.
template <typename Field, auto parse>
void take_by(Options& options, std::string_view what, const std::string& word) {
  if constexpr (requires { parse(word, what); }) {
    Field::of(options) = parse(word, what);
  } else {
    Field::of(options) = parse(word);
  }
}

// In the order of the command line: the first range is the columns.
template <SweepParameter parameter>
void take_range(Options& options, std::string_view what, const std::string& word) {
  options.sweep.push_back(SweepRange::parse(parameter, word, what));
}

// A code, a whole number; anything else, and a whole number too, is light of floating-point pictures.
void take_white(Options& options, std::string_view what, const std::string& word);
// A tag, or `all`.
void take_activity_tag(Options& options, std::string_view what, const std::string& word);

}  // namespace nutik
