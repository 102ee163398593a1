#include "features/schema/taking.hpp"

#include <algorithm>
#include <limits>

#include "capture/format.hpp"
#include "capture/text.hpp"

namespace nutik {

std::size_t choice_of(const Option& row, std::string_view what, std::string_view word) {
  const std::vector<std::string> choices = row.choices();
  const auto found = std::ranges::find(choices, word);
  if (found == choices.end() && choices.size() == 1)
    throw UsageError(format("{0} {1} is not known; the only choice is {0} {2}", what, word, choices.front()));
  if (found == choices.end())
    throw UsageError(format("{} '{}' is not known; choose {}", what, word, alternatives(choices)));
  return static_cast<std::size_t>(found - choices.begin());
}

RawVideo parse_raw_video(std::string_view word) {
  const auto colon = word.find(':');
  if (colon == std::string_view::npos || word.find('x') > colon) {
    throw UsageError(format(
        "raw video '{}' is not described; write its size and pixel format, as in 480x270:yuv420p10le", word));
  }
  constexpr std::uint32_t kLargestSide = 65'536;
  const auto [width, height] =
      parse_pair(word.substr(0, colon), 'x', {"width", 1, kLargestSide}, {"height", 1, kLargestSide}, {});
  return {width, height, std::string(word.substr(colon + 1))};
}

ClipMoment parse_clip_moment(std::string_view word, std::string_view what) {
  return clip_moment(StatedTime::parse(word, what), what);
}

MaskSize parse_mask_size(std::string_view word) {
  constexpr std::uint32_t kLargestSide = 1u << 20;
  const auto [width, height] = parse_pair(word, 'x', {"width", 1, kLargestSide}, {"height", 1, kLargestSide},
                                          format("size '{}' is none; write WIDTHxHEIGHT: 640x360", word));
  return {width, height};
}

std::optional<Precision> parse_wished_precision(std::string_view word) {
  return word == "auto" ? std::nullopt : std::optional(parse_precision(word));
}

MemoryBudget parse_memory(std::string_view word, std::string_view what) {
  const std::optional<std::uint64_t> bytes = parse_bytes(word);
  if (!bytes || *bytes == 0)
    throw UsageError(format("{} '{}' is no size; write 500MB, 2GB or 1GiB", what, word));
  return {*bytes};
}

std::int64_t parse_tick(std::string_view word, std::string_view what) {
  const StatedTime time = StatedTime::parse(word, what, false);
  if (time.nanoseconds() > 0) return time.nanoseconds();
  throw UsageError(format("{} {} is no length of time of 1 ns or more: 100us, 1ms", what, time.text()));
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
  if (!above || !below || *below == 0.0)
    throw UsageError(format("{} {} is no number{}", what, word, decimal_mark_hint(word)));
  return *above / *below;
}

std::variant<std::uint32_t, std::vector<StatedTime>> parse_moments(std::string_view word, std::string_view what) {
  if (word.find_first_not_of("0123456789") == word.npos)
    return parse_whole_number(word, what, 0, std::numeric_limits<std::uint32_t>::max());
  const std::vector<std::string> parts = parts_of(std::string(word) + ",", ',');
  if (parts.size() == 1 && !StatedTime::read(word))
    throw UsageError(format("{} '{}' is neither a number of moments, 7, nor their times, 0.4s,12f,1.5s", what, word));
  std::vector<StatedTime> times;
  for (const std::string& part : parts) times.push_back(StatedTime::parse(part, what));
  return times;
}

StatedTime parse_step(std::string_view word, std::string_view what) {
  const StatedTime step = StatedTime::parse(word, what);
  if (step.number.numerator <= 0) throw UsageError(format("{} '{}' is not longer than nothing", what, word));
  if (step.counts_samples() && step.number.denominator != 1)
    throw UsageError(format("{} '{}' is not a whole number of pictures", what, word));
  return step;
}

void take_white(Options& options, const Option&, std::string_view what, const std::string& word) {
  ClipOptions& clip = options.source.clip;
  const bool is_whole = word.find_first_not_of("0123456789") == word.npos;
  const auto light = is_whole ? std::nullopt : parse_number(word);
  clip.white_code.reset();
  if (is_whole && parse_number(word).value_or(0) > 65'535) {
    throw UsageError(format("{} '{}' is no whole number of 1 … 65535; light of floating-point clips has a point: {}.0",
                            what, word, word));
  }
  if (!light || !(*light > 0)) clip.white_code = parse_whole_number(word, what, 1, 65'535);
  clip.white_light = clip.white_code ? *clip.white_code : *light;
}

void take_activity_tag(Options& options, const Option&, std::string_view what, const std::string& word) {
  options.each_tag = word == "all";
  if (!options.each_tag) options.tag = static_cast<std::uint8_t>(parse_whole_number(word, what, 0, 255));
}

}  // namespace nutik
