#include "media/stills/tiff_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik {
namespace {

// What stands behind `key`, up to one of `ends`; empty where there is none.
std::string_view behind(std::string_view text, std::string_view key, std::string_view ends) {
  const auto at = text.find(key);
  if (at == std::string_view::npos) return {};
  text.remove_prefix(at + key.size());
  return text.substr(0, text.find_first_of(ends));
}

std::uint64_t count_of(std::string_view text) {
  std::uint64_t count = 0;
  std::from_chars(text.data(), text.data() + text.size(), count);
  return std::max<std::uint64_t>(count, 1);
}

// Above 0; none where a text is no such number.
std::optional<Rational> number_of(std::string_view text) {
  try {
    const Rational number = Rational::parse(text, "number");
    if (number.numerator > 0) return number;
  } catch (const UsageError&) {  // nobody stated it
  }
  return std::nullopt;
}

// How many of a unit of time are a second, which is meant where none is named; none where it is not known.
std::optional<Rational> in_second(std::string_view unit) {
  // Letters for micro: the sign and the Greek one in UTF-8, the sign in Latin-1, and as Java escapes it.
  constexpr std::string_view kSeconds[]{"", "s", "sec", "second", "seconds"},
      kMicroseconds[]{"us", "\xC2\xB5s", "\xCE\xBCs", "\xB5s", "\\u00B5s"};
  if (std::ranges::find(kSeconds, unit) != std::end(kSeconds)) return Rational{1, 1};
  if (std::ranges::find(kMicroseconds, unit) != std::end(kMicroseconds)) return Rational{1'000'000, 1};
  if (unit == "ms" || unit == "msec") return Rational{1000, 1};
  if (unit == "ns") return Rational{kSecondNs, 1};
  if (unit == "min") return Rational{1, 60};
  return std::nullopt;
}

std::optional<Rational> rate_of(const std::optional<Rational>& period, std::string_view unit) {
  const auto parts = in_second(unit);
  if (!period || !parts || period->denominator > INT64_MAX / parts->numerator ||
      period->numerator > INT64_MAX / parts->denominator) {
    return std::nullopt;
  }
  return Rational::of(period->denominator * parts->numerator, period->numerator * parts->denominator);
}

// Moments may be called slices, as ImageJ does where nobody told it otherwise; but not beside frames.
std::string mixed_text(std::uint64_t channels, std::uint64_t slices, std::uint64_t frames) {
  std::string text = channels > 1 ? format("{} channels", channels) : "";
  if (slices > 1 && (channels > 1 || frames > 1)) text += format("{}{} slices", text.empty() ? "" : ", ", slices);
  if (!text.empty() && frames > 1) text += format(", {} moments", frames);
  return text;
}

TiffStory story_of_imagej(std::string_view text) {
  const auto value = [&](std::string_view key) { return behind(text, key, "\r\n"); };
  TiffStory story;
  story.who = "ImageJ";
  story.pictures = count_of(value("\nimages="));
  story.mixed = mixed_text(count_of(value("\nchannels=")), count_of(value("\nslices=")), count_of(value("\nframes=")));
  // The interval is one of time, and goes before the speed at which the stack is shown, unless that is the same,
  // rounded less.
  const auto shown = number_of(value("\nfps=")), interval = number_of(value("\nfinterval="));
  story.rate = rate_of(interval, value("\ntunit="));
  constexpr double kRounding = 1e-3;
  const bool is_same = story.rate && shown && std::abs(shown->value() / story.rate->value() - 1.0) < kRounding;
  if (!interval || is_same) story.rate = shown;
  return story;
}

TiffStory story_of_ome(std::string_view text, const Shape& page) {
  const std::string_view pixels = behind(text, "<Pixels ", ">");
  const auto value = [&](std::string_view key) { return behind(pixels, key, "\""); };
  TiffStory story;
  story.who = "OME";
  const std::uint64_t channels = std::max<std::uint64_t>(count_of(value("SizeC=\"")) / page.channels, 1);
  const std::uint64_t slices = count_of(value("SizeZ=\"")), frames = count_of(value("SizeT=\""));
  story.mixed = mixed_text(channels, slices, frames);
  if (story.mixed.empty()) story.pictures = std::max(slices, frames);
  story.rate = rate_of(number_of(value("TimeIncrement=\"")), value("TimeIncrementUnit=\""));
  return story;
}

TiffStory story_of_tifffile(std::string_view text, const Shape& page) {
  TiffStory story;
  story.who = "tifffile";
  std::string_view list = behind(text, "\"shape\": [", "]");
  std::vector<std::uint64_t> sides;
  while (!list.empty()) {
    sides.push_back(count_of(list.substr(list.find_first_not_of(' ') == list.npos ? 0 : list.find_first_not_of(' '))));
    const auto comma = list.find(',');
    list = comma == list.npos ? std::string_view() : list.substr(comma + 1);
  }
  const std::size_t of_page = page.channels > 1 ? 3 : 2;
  if (sides.size() <= of_page) return story;
  sides.resize(sides.size() - of_page);
  std::erase(sides, std::uint64_t{1});
  if (sides.size() > 1) {
    for (const std::uint64_t side : sides)
      story.mixed += format("{}{}", story.mixed.empty() ? "pictures in " : " x ", side);
  } else {
    story.pictures = sides.empty() ? 1 : sides.front();
  }
  return story;
}

}  // namespace

TiffStory read_tiff_story(std::string_view description, const Shape& page) {
  if (description.starts_with("ImageJ=")) return story_of_imagej(description);
  if (description.find("<Pixels ") != std::string_view::npos && description.find("OME") != std::string_view::npos) {
    return story_of_ome(description, page);
  }
  if (description.starts_with("{\"shape\": [")) return story_of_tifffile(description, page);
  return {};
}

}  // namespace nutik
