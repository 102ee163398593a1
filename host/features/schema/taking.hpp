// How a word becomes the value that a row of the schema keeps. A row names the field,
// `take<InClip<&ClipOptions::rate>>`; what its words mean follows from the field's type, or is stated: take_choice with
// the values of the choices, take_whole with its bounds, take_by with a parser.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "features/schema/option.hpp"
#include "session/text/number_text.hpp"

namespace nutik {

// For take_by. All throw UsageError naming `what`.
[[nodiscard]] RawVideo parse_raw_video(std::string_view word);  // 480x270:yuv420p10le
[[nodiscard]] ClipMoment parse_clip_moment(std::string_view word, std::string_view what);
[[nodiscard]] MaskSize parse_mask_size(std::string_view word);
[[nodiscard]] std::optional<Precision> parse_wished_precision(std::string_view word);  // none: auto
[[nodiscard]] MemoryBudget parse_memory(std::string_view word, std::string_view what);
[[nodiscard]] std::int64_t parse_tick(std::string_view word, std::string_view what);
[[nodiscard]] double parse_sigmas(std::string_view word, std::string_view what);
[[nodiscard]] std::uint32_t parse_share(std::string_view word, std::string_view what);  // of kWholeWay
[[nodiscard]] std::pair<std::uint32_t, std::uint32_t> parse_pixel(std::string_view word,
                                                                  std::string_view what);
[[nodiscard]] double parse_shutter_error(std::string_view word, std::string_view what);
[[nodiscard]] double parse_signed(std::string_view word, std::string_view what);
// How many there may be is the style's business.
[[nodiscard]] std::variant<std::uint32_t, std::vector<StatedTime>> parse_moments(std::string_view word,
                                                                                 std::string_view what);
[[nodiscard]] StatedTime parse_step(std::string_view word, std::string_view what);  // longer than nothing

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
template <auto... path>
using InExposure = In<&Options::asked, path...>;
template <auto member>
using InFilm = In<&Options::film, member>;
template <auto member>
using InStudy = In<&Options::study, member>;
template <auto member>
using InPicture = In<&Options::picture, member>;

// What a field holds, be it optional or not.
template <typename Held>
struct StatedIn {
  using Value = Held;
};
template <typename Held>
struct StatedIn<std::optional<Held>> {
  using Value = Held;
};

// As the field's type is read: a flag, text, or what its parse() makes of the word.
template <typename Field>
void take(Options& options, const Option&, std::string_view what, const std::string& word) {
  auto& field = Field::of(options);
  using Value = typename StatedIn<std::remove_reference_t<decltype(field)>>::Value;
  if constexpr (std::is_same_v<Value, bool>) {
    field = true;
  } else if constexpr (std::is_same_v<Value, std::string>) {
    field = word;
  } else if constexpr (requires { Value::parse(word, what); }) {
    field = Value::parse(word, what);
  } else {
    field = Value::parse(word);
  }
}

// Which of the row's choices a word is. Throws UsageError listing them.
[[nodiscard]] std::size_t choice_of(const Option& row, std::string_view what, std::string_view word);

// The value of a choice: one for each of the row's, in their order.
template <typename Field, auto... values>
void take_choice(Options& options, const Option& row, std::string_view what, const std::string& word) {
  Field::of(options) = std::array{values...}.at(choice_of(row, what, word));
}

template <typename Field, std::uint32_t low, std::uint32_t high>
void take_whole(Options& options, const Option&, std::string_view what, const std::string& word) {
  Field::of(options) = parse_whole_number(word, what, low, high);
}

// By a parser that is told what is read, or one that says itself what it reads.
template <typename Field, auto parse>
void take_by(Options& options, const Option&, std::string_view what, const std::string& word) {
  if constexpr (requires { parse(word, what); }) {
    Field::of(options) = parse(word, what);
  } else {
    Field::of(options) = parse(word);
  }
}

// In the order of the command line: the first range is the columns.
template <SweepParameter parameter>
void take_range(Options& options, const Option&, std::string_view what, const std::string& word) {
  options.sweep.push_back(SweepRange::parse(parameter, word, what));
}

// A code, a whole number; anything else, and a whole number too, is light of floating-point pictures.
void take_white(Options& options, const Option&, std::string_view what, const std::string& word);
// A tag, or `all`.
void take_activity_tag(Options& options, const Option&, std::string_view what, const std::string& word);

}  // namespace nutik
