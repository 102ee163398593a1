#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "app/command_line/option_table.hpp"
#include "app/requests/requests.hpp"
#include "app/text/number_text.hpp"
#include "session/below/error.hpp"
#include "session/below/format.hpp"
#include "session/text/shell_text.hpp"

namespace nutik::app {
namespace {

constexpr std::uint32_t kMaxMoments = 50;
constexpr std::uint32_t kMaxStrips = 256;  // of a slit: a mask has no more values

// The value that a name stands for; `usual` where nothing was said.
template <typename Value, std::size_t count>
Value named(const std::optional<std::string>& word, std::string_view option,
            const std::array<std::pair<std::string_view, Value>, count>& values, Value usual) {
  if (!word) return usual;
  std::string known;
  for (const auto& [name, value] : values) {
    if (*word == name) return value;
    known += (known.empty() ? "" : ", ") + std::string(name);
  }
  throw UsageError(format("{} '{}' is unknown; there are {}", option, *word, known));
}

constexpr std::array kStyles{
    std::pair<std::string_view, StudyStyle>("trail", StudyStyle::trail),
    std::pair<std::string_view, StudyStyle>("strobe", StudyStyle::strobe),
    std::pair<std::string_view, StudyStyle>("rear-curtain", StudyStyle::rear_curtain),
    std::pair<std::string_view, StudyStyle>("frozen", StudyStyle::frozen),
    std::pair<std::string_view, StudyStyle>("clean", StudyStyle::clean),
    std::pair<std::string_view, StudyStyle>("slit", StudyStyle::slit),
};
constexpr std::array kSpacings{
    std::pair<std::string_view, MomentSpacing>("time", MomentSpacing::time),
    std::pair<std::string_view, MomentSpacing>("distance", MomentSpacing::distance),
};
constexpr std::array kTrails{
    std::pair<std::string_view, std::optional<TrailShape>>("even", TrailShape::even),
    std::pair<std::string_view, std::optional<TrailShape>>("fade", TrailShape::fade),
    std::pair<std::string_view, std::optional<TrailShape>>("ramp", TrailShape::ramp),
    std::pair<std::string_view, std::optional<TrailShape>>("none", TrailShape::none),
};
constexpr std::array kSides{
    std::pair<std::string_view, SlitFrom>("left", SlitFrom::left),
    std::pair<std::string_view, SlitFrom>("right", SlitFrom::right),
    std::pair<std::string_view, SlitFrom>("top", SlitFrom::top),
    std::pair<std::string_view, SlitFrom>("bottom", SlitFrom::bottom),
};

std::variant<std::uint32_t, std::vector<StatedTime>> parse_moments(const std::string& text,
                                                                   StudyStyle style) {
  if (text.find_first_not_of("0123456789") == std::string::npos) {
    return style == StudyStyle::slit ? parse_whole_number(text, "--moments", 2, kMaxStrips)
                                     : parse_whole_number(text, "--moments", 1, kMaxMoments);
  }
  if (style == StudyStyle::slit) {
    throw UsageError(
        "--style slit shows a moment in each strip; say with --moments how many there are, not which");
  }
  std::vector<StatedTime> times;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    times.push_back(StatedTime::parse(text.substr(begin, end - begin), "--moments"));
    begin = end + 1;
  }
  if (times.size() > kMaxMoments) {
    throw UsageError(format("--moments names {} times; a study has {} at most", times.size(), kMaxMoments));
  }
  return times;
}

Rectangle region_of(const std::string& text) {
  const std::vector<double> n = parse_numbers(text, "--region");
  const auto is_whole = [](double each) { return each >= 0 && each <= 65'535 && each == std::floor(each); };
  if (n.size() != 4 || !std::ranges::all_of(n, is_whole) || n[2] == 0 || n[3] == 0) {
    throw UsageError(format("--region '{}' is no rectangle; write whole pixels: X,Y,WIDTH,HEIGHT", text));
  }
  const auto pixels = [&](std::size_t i) { return static_cast<std::uint32_t>(n[i]); };
  return {pixels(0), pixels(1), pixels(2), pixels(3)};
}

}  // namespace

StudyRequest study_request(const Options& options) {
  StudyRequest request;
  request.style = named(options.style, "--style", kStyles, request.style);
  request.spacing = named(options.spacing, "--spacing", kSpacings, request.spacing);
  request.trail = named(options.trail, "--trail", kTrails, request.trail);
  request.slit_from = named(options.slit_from, "--slit-from", kSides, request.slit_from);
  const bool is_slit = request.style == StudyStyle::slit, is_clean = request.style == StudyStyle::clean;
  if (options.slit_from && !is_slit) {
    throw UsageError("--slit-from goes with --style slit only; leave it out, or state that style");
  }
  for (const auto& [said, name] :
       {std::pair(options.moments && !is_slit, "--moments"), std::pair(options.feather && !is_slit, "--feather"),
        std::pair(options.by.has_value(), "--by"), std::pair(options.spacing.has_value(), "--spacing"),
        std::pair(options.trail.has_value(), "--trail")}) {
    if ((is_slit || is_clean) && said) {
      throw UsageError(format("{} says nothing to --style {}, which shows {}; leave it out", name,
                              *options.style, is_slit ? "a moment in each strip" : "no subject"));
    }
  }
  for (const Said& said : options.said) {
    if (said.option != "region") continue;
    request.regions.push_back(region_of(said.words.front()));
    if (is_slit || is_clean) {
      throw UsageError(format("--region says nothing to --style {}, which follows no subject; leave it out",
                              *options.style));
    }
  }
  if (options.by) request.by_codes = parse_whole_number(*options.by, "--by", 1, 65'535);
  if (options.feather) request.feather = Feather::parse(*options.feather);
  if (is_slit) request.moments = kMaxStrips;
  if (options.moments) request.moments = parse_moments(*options.moments, request.style);
  const bool shows_one = request.style == StudyStyle::rear_curtain || request.style == StudyStyle::frozen;
  const auto* times = std::get_if<std::vector<StatedTime>>(&request.moments);
  if (shows_one && options.moments && (times == nullptr || times->size() != 1)) {
    throw UsageError(
        format("--style {} shows a single moment; leave --moments out, or name one time", *options.style));
  }
  return request;
}

std::string stated_words(const Options& options, CommandId command) {
  std::string words;
  for (const Option& option : app::options()) {
    const bool counts = option.makes_picture() || option.scope == Scope::computing;
    if (!counts || !option.is_of(command) || !option.is_in(options)) continue;
    words += " " + option.name();
    if (const std::string* const value = option.stated(options)) words += " " + shell_word(*value);
  }
  return words;
}

}  // namespace nutik::app
