#include "app/input/mask_steps.hpp"

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "app/text/number_text.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "mask/distance.hpp"
#include "session/stated_time.hpp"

namespace nutik::app {
namespace {

constexpr std::uint32_t kLargestSide = 1u << 20;
constexpr double kLargestRadius = 10'000.0;

// The numbers of a list, as many as `count`, each of which `names` has a letter for.
std::vector<double> numbers_of(const Said& said, std::size_t count, std::string_view names) {
  std::vector<double> numbers = parse_numbers(said.words.front(), "--" + std::string(said.option));
  if (numbers.size() != count) {
    throw UsageError(format("--{} needs {} numbers, {}: '{}' has {}", said.option, count, names,
                            said.words.front(), numbers.size()));
  }
  return numbers;
}

void require_positive(const Said& said, double value, std::string_view what) {
  if (value > 0.0) return;
  throw UsageError(format("--{} {}: {} must be above 0", said.option, said.words.front(), what));
}

Selection rectangle_of(const Said& said) {
  const auto n = numbers_of(said, 4, "X,Y,WIDTH,HEIGHT");
  require_positive(said, std::min(n[2], n[3]), "width and height");
  return select::Shape{[n](std::uint32_t width, std::uint32_t height) {
    return rectangle(width, height, {n[0], n[1]}, n[2], n[3]);
  }};
}

Selection ellipse_of(const Said& said) {
  const auto n = numbers_of(said, 4, "CENTRE_X,CENTRE_Y,RADIUS_X,RADIUS_Y");
  require_positive(said, std::min(n[2], n[3]), "both radii");
  return select::Shape{[n](std::uint32_t width, std::uint32_t height) {
    return ellipse(width, height, {n[0], n[1]}, n[2], n[3]);
  }};
}

Selection polygon_of(const Said& said) {
  const std::vector<double> n = parse_numbers(said.words.front(), "--polygon");
  if (n.size() < 6 || n.size() % 2 != 0) {
    throw UsageError(format("--polygon needs three corners or more, X,Y,X,Y,X,Y: '{}' has {} numbers",
                            said.words.front(), n.size()));
  }
  std::vector<Point> corners;
  for (std::size_t i = 0; i < n.size(); i += 2) corners.push_back({n[i], n[i + 1]});
  return select::Shape{
      [corners](std::uint32_t width, std::uint32_t height) { return polygon(width, height, corners); }};
}

// `100..255`, `100` (and above), or shares of white: `40%..100%`.
Selection threshold_of(const Said& said) {
  const std::string& text = said.words[1];
  const auto fail = [&] [[noreturn]] () {
    throw UsageError(format(
        "--threshold {} {}: '{}' is no range of codes; write LOW..HIGH (100..255), LOW alone for that and "
        "brighter, or shares of white (40%..100%)",
        said.words[0], text, text));
  };
  select::Threshold threshold;
  threshold.picture = said.words[0];
  const auto dots = text.find("..");
  std::string low = text.substr(0, dots);
  std::string high = dots == std::string::npos ? std::string() : text.substr(dots + 2);
  threshold.is_share = low.ends_with('%');
  if (threshold.is_share) {
    low.pop_back();
    if (!high.empty() && !high.ends_with('%')) fail();
    if (!high.empty()) high.pop_back();
  }
  const auto low_code = parse_number(low);
  const auto high_code = dots == std::string::npos ? std::optional(HUGE_VAL) : parse_number(high);
  if (!low_code || !high_code || *low_code > *high_code) fail();
  threshold.low = *low_code;
  threshold.high = *high_code;
  return threshold;
}

// `16x9`: columns and rows.
select::Grid grid_of(const Said& said) {
  const std::string& text = said.words.front();
  const auto cross = text.find('x');
  if (cross == std::string::npos) {
    throw UsageError(format("--grid '{}' is none; write COLUMNSxROWS: 16x9", text));
  }
  return {parse_whole_number(text.substr(0, cross), "--grid's columns", 1, kMaskValues),
          parse_whole_number(text.substr(cross + 1), "--grid's rows", 1, kMaskValues)};
}

// A grid's tags are counted up from the one that was stated, else from 0.
MaskStep grid_step(const Said& said, std::optional<std::uint8_t> first_tag) {
  const select::Grid grid = grid_of(said);
  const std::uint32_t cells = grid.columns * grid.rows;
  const std::uint8_t first = first_tag.value_or(0);
  if (first + cells > kMaskValues) {
    throw UsageError(format("--grid {} has {} cells, tagged from {} on: tags end at {}", said.words.front(),
                            cells, first, kMaskValues - 1));
  }
  return {"--grid", first, grid, 0, {}};
}

PictureOrTime picture_or_time(const std::string& word) {
  if (is_time(word)) static_cast<void>(StatedTime::parse(word, "time"));
  return word;
}

Selection selection_of(const Said& said) {
  if (said.option == "fill") return select::Whole{};
  if (said.option == "rectangle") return rectangle_of(said);
  if (said.option == "ellipse") return ellipse_of(said);
  if (said.option == "polygon") return polygon_of(said);
  if (said.option == "threshold") return threshold_of(said);
  if (said.option == "difference")
    return select::Difference{picture_or_time(said.words[0]), picture_or_time(said.words[1])};
  if (said.option == "moving") return select::Motion{};
  if (said.option == "still") return select::Stillness{};
  for (const std::string& word : said.words) static_cast<void>(StatedTime::parse(word, "--changed-between"));
  return select::Motion{said.words[0], said.words[1]};
}

double radius_of(const Said& said) {
  const auto radius = parse_number(said.words.front());
  if (!radius || *radius < 0.0 || *radius > kLargestRadius) {
    throw UsageError(format("--{} '{}' is no number of pixels of 0 … {}", said.option, said.words.front(),
                            kLargestRadius));
  }
  return *radius;
}

std::function<Region(const Region&)> change_of(const Said& said) {
  if (said.option == "largest") return largest_part;
  if (said.option == "invert") return inverted;
  if (said.option == "within") {
    const auto n = numbers_of(said, 4, "X,Y,WIDTH,HEIGHT");
    require_positive(said, std::min(n[2], n[3]), "width and height");
    return [n](const Region& region) {
      return intersection(region, rectangle(region.width, region.height, {n[0], n[1]}, n[2], n[3]));
    };
  }
  const double radius = radius_of(said);
  if (said.option == "grow") return [radius](const Region& region) { return grown(region, radius); };
  if (said.option == "shrink") return [radius](const Region& region) { return shrunk(region, radius); };
  return [radius](const Region& region) { return smoothed(region, radius); };
}

bool is_one_of(std::string_view option, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), option) != names.end();
}

}  // namespace

bool is_time(const PictureOrTime& word) {
  // A file's name ends in an extension that is no unit: bright.png, frame.7.
  try {
    static_cast<void>(StatedTime::parse(word, "time"));
    return true;
  } catch (const UsageError&) {
    return false;
  }
}

bool MaskStep::compares() const {
  return std::holds_alternative<select::Difference>(selection) ||
         std::holds_alternative<select::Motion>(selection) ||
         std::holds_alternative<select::Stillness>(selection);
}

std::uint8_t MaskStep::last_tag() const {
  const auto* grid = std::get_if<select::Grid>(&selection);
  return grid == nullptr ? tag : static_cast<std::uint8_t>(tag + grid->columns * grid->rows - 1);
}

bool MaskStep::reads_capture() const {
  if (const auto* threshold = std::get_if<select::Threshold>(&selection)) return is_time(threshold->picture);
  if (const auto* difference = std::get_if<select::Difference>(&selection)) {
    return is_time(difference->before) || is_time(difference->after);
  }
  return compares();
}

std::vector<std::string> MaskStep::picture_files() const {
  std::vector<std::string> words;
  if (const auto* threshold = std::get_if<select::Threshold>(&selection)) words = {threshold->picture};
  if (const auto* difference = std::get_if<select::Difference>(&selection)) {
    words = {difference->before, difference->after};
  }
  std::erase_if(words, is_time);
  return words;
}

std::vector<MaskStep> mask_steps(const Options& options) {
  std::vector<MaskStep> steps;
  std::optional<std::uint8_t> tag;
  bool has_region = false;  // since the last --tag
  for (const Said& said : options.said) {
    const std::string name = "--" + std::string(said.option);
    if (said.option == "tag") {
      tag = static_cast<std::uint8_t>(parse_whole_number(said.words.front(), "tag", 0, 255));
      has_region = false;
    } else if (is_one_of(said.option, {"fill", "rectangle", "ellipse", "polygon", "threshold", "difference",
                                       "moving", "still", "changed-between"})) {
      steps.push_back({name, tag.value_or(255), selection_of(said), 0, {}});
      has_region = true;
    } else if (said.option == "grid") {
      steps.push_back(grid_step(said, tag));
      has_region = true;
    } else if (is_one_of(said.option, {"by", "within", "largest", "grow", "shrink", "smooth", "invert"})) {
      if (!has_region) {
        throw UsageError(format(
            "{} changes the region before it{}: first select one, with --moving or --rectangle for example",
            name, steps.empty() ? "" : ", and after --tag there is none yet"));
      }
      MaskStep& step = steps.back();
      if (said.option != "by") {
        step.changes.push_back(change_of(said));
        continue;
      }
      if (!step.compares()) {
        throw UsageError(format("--by says how much codes must change; {} compares none", step.option));
      }
      step.by_codes = parse_whole_number(said.words.front(), "--by", 1, 65'535);
    }
  }
  return steps;
}

MaskSize parse_mask_size(const std::string& text) {
  const auto cross = text.find('x');
  if (cross == std::string::npos)
    throw UsageError(format("size '{}' is none; write WIDTHxHEIGHT: 640x360", text));
  return {parse_whole_number(text.substr(0, cross), "width", 1, kLargestSide),
          parse_whole_number(text.substr(cross + 1), "height", 1, kLargestSide)};
}

}  // namespace nutik::app
