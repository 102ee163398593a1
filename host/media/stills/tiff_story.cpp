#include "media/stills/tiff_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "capture/format.hpp"
#include "capture/text.hpp"

namespace nutik {
namespace {

// A start tag of an XML text. Entities stay as they are.
struct XmlTag {
  std::string_view name, attributes;

  // Empty where it is not there.
  [[nodiscard]] std::string_view value(std::string_view key) const {
    for (std::string_view rest = attributes;;) {
      const auto equals = rest.find('=');
      if (equals == rest.npos) return {};
      const std::string_view name_here = trimmed(rest.substr(0, equals));
      rest = trimmed(rest.substr(equals + 1));
      const auto end = rest.empty() ? rest.npos : rest.find(rest.front(), 1);
      if (end == rest.npos) return {};
      if (name_here == key) return rest.substr(1, end - 1);
      rest.remove_prefix(end + 1);
    }
  }
};

// The next one, named without its prefix (OME:), cut off with what is before it.
std::optional<XmlTag> take_tag(std::string_view& text) {
  for (;;) {
    text.remove_prefix(std::min(text.find('<'), text.size()));
    if (text.empty()) return std::nullopt;
    const std::string_view start = text.substr(1, 1);
    if (start.empty() || start.find_first_of("/?!") == 0) {
      text.remove_prefix(text.starts_with("<!--") ? std::min(text.find("-->"), text.size()) : 1);
      continue;
    }
    std::size_t end = 1;
    for (char quote = 0; end < text.size() && (quote != 0 || text[end] != '>'); ++end) {
      if (text[end] != '"' && text[end] != '\'') continue;
      quote = quote == 0 ? text[end] : quote == text[end] ? '\0' : quote;
    }
    std::string_view tag = text.substr(1, end - 1);
    text.remove_prefix(end);
    if (tag.ends_with('/')) tag.remove_suffix(1);
    const std::string_view name = tag.substr(0, tag.find_first_of(" \t\r\n"));
    return XmlTag{name.substr(name.find(':') + 1), tag.substr(name.size())};
  }
}

// What stands behind `key`, up to the end of its line; empty where there is none.
std::string_view behind(std::string_view text, std::string_view key) {
  const auto at = text.find(key);
  if (at == std::string_view::npos) return {};
  text.remove_prefix(at + key.size());
  return trimmed(text.substr(0, text.find_first_of("\r\n")));
}

std::uint64_t count_of(std::string_view text) {
  std::uint64_t count = 0;
  std::from_chars(text.data(), text.data() + text.size(), count);
  return std::max<std::uint64_t>(count, 1);
}

// Above 0; none where a text is no such number. What has more digits than people write is a double, or was a float: the
// simplest fraction as near as these are.
std::optional<Rational> number_of(std::string_view text) {
  constexpr double kMost = 1e9;
  if (const auto number = Rational::read(text)) return number->numerator > 0 ? number : std::nullopt;
  const auto value = parsed<double>(text);
  if (!value || !(*value > 1 / kMost && *value < kMost)) return std::nullopt;
  const double rounding = static_cast<float>(*value) == *value ? 6e-8 : 1e-15;
  std::int64_t top = 1, bottom = 0, top_before = 0, bottom_before = 1;
  for (double rest = *value;; rest = 1 / (rest - std::floor(rest))) {  // its continued fraction
    const auto whole = static_cast<std::int64_t>(rest);
    top_before = std::exchange(top, whole * top + top_before);
    bottom_before = std::exchange(bottom, whole * bottom + bottom_before);
    const double off = static_cast<double>(top) / static_cast<double>(bottom) / *value - 1;
    if (std::abs(off) < rounding) return Rational::of(top, bottom);
  }
}

// How many of a unit of time are a second, which is meant where none is named; none where it is not known.
std::optional<Rational> in_second(std::string_view unit) {
  // Letters for micro: the sign and the Greek one in UTF-8, the sign in Latin-1, and as Java escapes it.
  constexpr std::string_view kUnits[][5]{{"", "s", "sec", "second", "seconds"},
                                         {"us", "\xC2\xB5s", "\xCE\xBCs", "\xB5s", "\\u00B5s"},
                                         {"ms", "msec"},
                                         {"ns"},
                                         {"min", "minute", "minutes"},
                                         {"h", "hr", "hour", "hours"}};
  constexpr Rational kInSecond[]{{1, 1}, {1'000'000, 1}, {1000, 1}, {kSecondNs, 1}, {1, 60}, {1, 3600}};
  for (std::size_t k = 0; k < std::size(kUnits); ++k) {
    const bool is_it = std::ranges::find(kUnits[k], unit) != std::end(kUnits[k]);
    if (is_it && (k == 0 || !unit.empty())) return kInSecond[k];
  }
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

// The rate of pictures so far apart; else what is said in its place, if it is anything.
void follow_interval(TiffStory& story, std::string_view interval, std::string_view unit) {
  if (interval.empty() || parsed<double>(interval) == 0.0) return;
  story.rate = rate_of(number_of(interval), unit);
  if (story.rate) return;
  story.rate_doubt = format("{}'s description has pictures '{}{}{}' apart, which is not read", story.who, interval,
                            unit.empty() ? "" : " ", unit);
}

// Moments may be called slices, as ImageJ does where nobody told it otherwise; but not beside frames.
std::string mixed_text(std::uint64_t channels, std::uint64_t slices, std::uint64_t frames) {
  std::string text = channels > 1 ? format("{} channels", channels) : "";
  if (slices > 1 && (channels > 1 || frames > 1)) text += format("{}{} slices", text.empty() ? "" : ", ", slices);
  if (!text.empty() && frames > 1) text += format(", {} moments", frames);
  return text;
}

void refuse_mixed(TiffStory& story, const std::string& what) {
  if (what.empty()) return;
  story.refused = format(
      "holds {}, as its description by {} says, and its pages are not moments one after another; save one channel and "
      "slice as a TIFF of its own (in Fiji: Image, Hyperstacks, Make Subset)",
      what, story.who);
}

void refuse_depth(TiffStory& story, std::uint64_t slices) {
  story.refused = format(
      "holds {} slices in depth, as its description by {} says, and no moments; if these are moments, make them "
      "frames, and save it as a TIFF (in Fiji: Image, Properties)",
      slices, story.who);
}

TiffStory story_of_imagej(std::string_view text) {
  const auto value = [&](std::string_view key) { return behind(text, key); };
  TiffStory story;
  story.who = "ImageJ";
  story.pictures = value("\nimages=").empty() ? 0 : count_of(value("\nimages="));
  const std::uint64_t slices = count_of(value("\nslices="));
  refuse_mixed(story, mixed_text(count_of(value("\nchannels=")), slices, count_of(value("\nframes="))));
  if (slices > 1) {
    const std::string_view spacing = value("\nspacing=");
    story.notes.emplace_back(format("ImageJ's description calls the pictures slices{}: they are taken for moments",
                                    spacing.empty() ? "" : format(", {} apart in depth", spacing)));
  }
  if (value("\nc0=").starts_with("-32768") && number_of(value("\nc1=")) == Rational{1, 1}) {
    story.unread =
        "cannot be read: its values are signed, by its description by ImageJ, and 0 is code 32768; save it as "
        "floating point of 32 bits (in Fiji: Image, Type, 32-bit)";
  }
  // The interval is one of time, and goes before the speed at which the stack is shown, unless that is the same,
  // rounded less.
  follow_interval(story, value("\nfinterval="), value("\ntunit="));
  const auto shown = number_of(value("\nfps="));
  constexpr double kRounding = 1e-3;
  const bool is_same = story.rate && shown && std::abs(shown->value() / story.rate->value() - 1.0) < kRounding;
  if (is_same || (!story.rate && story.rate_doubt.empty())) story.rate = shown;
  return story;
}

// Pixels of an OME image, and what is said of their planes and places.
struct OmePixels {
  struct Data {
    XmlTag tag;
    std::string_view file;  // empty: this one
  };
  XmlTag tag;
  std::vector<Data> data;
  std::vector<XmlTag> planes;

  [[nodiscard]] bool is_in(std::string_view file) const {
    return data.empty() || std::ranges::any_of(data, [&](const Data& each) {
             return each.file.empty() || each.file == file;
           });
  }
};

// Which channel is the only one that the file holds, each moment of it, in one depth; none where it is not sure.
std::string_view only_channel(const OmePixels& pixels, std::string_view file, std::uint64_t frames) {
  std::uint64_t count = 0;
  std::set<std::pair<std::string_view, std::string_view>> held;
  for (const auto& [tag, its_file] : pixels.data) {
    const std::uint64_t planes = count_of(tag.value("PlaneCount"));
    if (planes > 1 && tag.value("FirstT") > "0") return {};  // they may run through the channels
    if (its_file != file) continue;
    count += planes;
    const auto first = [&tag = tag](std::string_view key) { return tag.value(key).empty() ? "0" : tag.value(key); };
    held.emplace(first("FirstC"), first("FirstZ"));
  }
  return held.size() == 1 && count == frames ? held.begin()->first : "";
}

// Times of all planes go before an interval that puts one of them elsewhere by half of it or more.
void follow_planes(TiffStory& story, const std::vector<XmlTag>& planes, std::string_view channel,
                   std::uint64_t frames) {
  std::map<std::uint64_t, std::int64_t> times_ns;
  for (const XmlTag& plane : planes) {
    const auto time = parsed<double>(plane.value("DeltaT"));
    const auto frame = parsed<std::uint64_t>(plane.value("TheT"));
    const auto parts = in_second(plane.value("DeltaTUnit"));
    const bool is_it = plane.value("TheZ") <= "0" && plane.value("TheC") == channel;
    constexpr double kMost = 1e9;  // seconds
    if (!is_it || !time || !frame || !parts || *frame >= frames) continue;
    const double seconds = *time / parts->value();
    if (std::abs(seconds) < kMost)
      times_ns[*frame] = std::llround(seconds * static_cast<double>(kSecondNs));
  }
  if (times_ns.size() != frames || frames < 2) return;
  std::vector<std::int64_t> starts_ns;
  for (const auto& [frame, time_ns] : times_ns) starts_ns.push_back(time_ns - times_ns.begin()->second);
  if (std::ranges::adjacent_find(starts_ns, std::greater_equal<>()) != starts_ns.end()) return;
  // Three pictures would be near it whatever the one in the middle is.
  std::optional<Rational> rate = story.rate;
  if (!rate && frames > 3)
    rate = Rational::of(static_cast<std::int64_t>(frames - 1) * kSecondNs, starts_ns.back());
  double least_ns = 0, most_ns = 0;
  const double period_ns = rate ? static_cast<double>(kSecondNs) / rate->value() : 0;
  for (std::size_t k = 0; k < starts_ns.size(); ++k) {
    const double off_ns = static_cast<double>(starts_ns[k]) - static_cast<double>(k) * period_ns;
    least_ns = std::min(least_ns, off_ns);
    most_ns = std::max(most_ns, off_ns);
  }
  if (2 * (most_ns - least_ns) < period_ns) {
    story.rate = rate;
  } else {
    story.starts_ns = std::move(starts_ns);
  }
}

TiffStory story_of_ome(std::string_view text, const Shape& page, std::string_view file) {
  TiffStory story;
  story.who = "OME";
  std::vector<OmePixels> all;
  while (const auto tag = take_tag(text)) {
    if (tag->name == "BinaryOnly") {
      story.refused = format(
          "holds pages that another file describes, {}, which is not read; save it as one TIFF (in Fiji: File, Import, "
          "Bio-Formats, then Save As, Tiff)",
          tag->value("MetadataFile"));
    }
    if (tag->name == "Pixels") all.push_back({*tag, {}, {}});
    if (all.empty()) continue;
    if (tag->name == "TiffData") all.back().data.push_back({*tag, {}});
    if (tag->name == "UUID" && !all.back().data.empty()) all.back().data.back().file = tag->value("FileName");
    if (tag->name == "Plane") all.back().planes.push_back(*tag);
  }
  if (all.empty()) return story;
  // Each file of a set may describe all; one that got another name is that of the first pixels.
  const auto is_elsewhere = [&](const OmePixels& each) { return !each.is_in(file); };
  if (std::ranges::all_of(all, is_elsewhere)) file = all.front().data.front().file;
  std::erase_if(all, is_elsewhere);
  if (all.size() > 1) {
    refuse_mixed(story, format("{} images", all.size()));
    return story;
  }
  const OmePixels& pixels = all.front();
  const auto value = [&](std::string_view key) { return pixels.tag.value(key); };
  std::uint64_t channels = std::max<std::uint64_t>(count_of(value("SizeC")) / page.channels, 1);
  std::uint64_t slices = count_of(value("SizeZ"));
  const std::uint64_t frames = count_of(value("SizeT"));
  std::string_view channel = "0";
  if (channels > 1 || slices > 1) {
    if (const std::string_view only = only_channel(pixels, file, frames); !only.empty()) {
      channel = only;
      channels = slices = 1;
    }
  }
  story.pictures = channels * slices * frames;
  refuse_mixed(story, mixed_text(channels, slices, frames));
  if (story.refused.empty() && slices > 1) refuse_depth(story, slices);
  story.white = white_of_bits(value("SignificantBits"));
  follow_interval(story, value("TimeIncrement"), value("TimeIncrementUnit"));
  follow_planes(story, pixels.planes, channel, frames);
  return story;
}

// A list of sides, whose axes may be named: {"shape": [10, 2, 12, 17], "axes": "TCYX"}.
TiffStory story_of_tifffile(const nlohmann::json& text, const Shape& page) {
  TiffStory story;
  story.who = "tifffile";
  const nlohmann::json& shape = text["shape"];
  const std::string axes = text.contains("axes") && text["axes"].is_string() ? text["axes"].get<std::string>() : "";
  const std::size_t of_page = page.channels > 1 ? 3 : 2;
  if (shape.size() <= of_page) return story;
  std::vector<std::uint64_t> sides;
  char axis = 'T';
  story.pictures = 1;
  for (std::size_t k = 0; k + of_page < shape.size(); ++k) {
    const std::uint64_t side = shape[k].is_number_unsigned() ? shape[k].get<std::uint64_t>() : 1;
    if (side <= 1) continue;
    sides.push_back(side);
    story.pictures = side > UINT64_MAX / story.pictures ? UINT64_MAX : story.pictures * side;
    if (axes.size() == shape.size()) axis = axes[k];
  }
  if (sides.size() > 1) {
    refuse_mixed(story, format("pictures in {}", joined(sides, " x ", [](auto side) { return format("{}", side); })));
  } else if (axis == 'C') {
    refuse_mixed(story, mixed_text(sides.front(), 1, 1));
  } else if (axis == 'Z') {
    refuse_depth(story, sides.front());
  }
  return story;
}

}  // namespace

std::optional<std::uint32_t> white_of_bits(std::string_view bits) {
  const auto count = parsed<std::uint32_t>(bits);
  return count && *count > 8 && *count < 16 ? std::optional((1U << *count) - 1) : std::nullopt;
}

std::optional<std::uint32_t> white_of_micro_manager(std::string_view text) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  const auto bits = json.is_object() ? json.find("BitDepth") : json.end();
  return bits != json.end() && bits->is_number_unsigned() ? white_of_bits(bits->dump()) : std::nullopt;
}

TiffStory read_tiff_story(std::string_view description, const Shape& page, std::string_view file) {
  if (description.starts_with("ImageJ=")) return story_of_imagej(description);
  std::string_view start = description;
  if (const auto tag = take_tag(start); tag && tag->name == "OME") return story_of_ome(description, page, file);
  if (!description.starts_with('{')) return {};
  const nlohmann::json json = nlohmann::json::parse(description, nullptr, false);
  if (json.is_object() && json.contains("shape") && json["shape"].is_array()) return story_of_tifffile(json, page);
  return {};
}

}  // namespace nutik
