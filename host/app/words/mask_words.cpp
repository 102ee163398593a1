#include "app/words/stated_requests.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/rational.hpp"
#include "session/requests/named_inputs.hpp"
#include "session/text/number_text.hpp"
#include "system/input_bytes.hpp"
#include "system/is_absent.hpp"

namespace nutik::app {
namespace {

constexpr double kLargestRadius = 10'000.0;

// The numbers of a list, as many as `count`, each of which `names` has a letter for.
std::vector<double> numbers_of(const Said& said, std::size_t count, std::string_view names) {
  std::vector<double> numbers = parse_numbers(said.words.front(), said.option);
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

select::Rectangle rectangle_of(const Said& said) {
  const auto n = numbers_of(said, 4, "X,Y,WIDTH,HEIGHT");
  require_positive(said, std::min(n[2], n[3]), "width and height");
  return {{n[0], n[1]}, n[2], n[3]};
}

Selection ellipse_of(const Said& said) {
  const auto n = numbers_of(said, 4, "CENTRE_X,CENTRE_Y,RADIUS_X,RADIUS_Y");
  require_positive(said, std::min(n[2], n[3]), "both radii");
  return select::Ellipse{{n[0], n[1]}, n[2], n[3]};
}

Selection polygon_of(const Said& said) {
  const std::vector<double> n = parse_numbers(said.words.front(), "polygon");
  if (n.size() < 6 || n.size() % 2 != 0) {
    throw UsageError(format("--polygon needs three corners or more, X,Y,X,Y,X,Y: '{}' has {} numbers",
                            said.words.front(), n.size()));
  }
  std::vector<Point> corners;
  for (std::size_t i = 0; i < n.size(); i += 2) corners.push_back({n[i], n[i + 1]});
  return select::Polygon{std::move(corners)};
}

// A file's name ends in an extension that is no unit: bright.png, frame.7. A picture is read later, when all that was
// said is known to make sense.
PictureSource picture_or_time(const Said& said, std::size_t place) {
  const std::string& word = said.words[place];
  if (StatedTime::read(word) || (has_too_many_digits(word) && is_absent(word)))
    return StatedTime::parse(word, "--" + std::string(said.option));
  return NamedPicture{word, Shared(Picture())};
}

// `100..255`, `100` (and above), or shares of white: `40%..100%`.
Selection threshold_of(const Said& said) {
  const std::string& text = said.words[1];
  const auto refusal = [&] {
    return UsageError(format(
        "--threshold {} {}: '{}' is no range of codes; write LOW..HIGH (100..255), LOW alone for that and "
        "brighter, or shares of white (40%..100%)",
        said.words[0], text, text));
  };
  select::Threshold threshold;
  threshold.picture = picture_or_time(said, 0);
  const auto dots = text.find("..");
  std::string low = text.substr(0, dots);
  std::string high = dots == std::string::npos ? std::string() : text.substr(dots + 2);
  threshold.is_share = low.ends_with('%');
  if (threshold.is_share) {
    low.pop_back();
    if (!high.empty() && !high.ends_with('%')) throw refusal();
    if (!high.empty()) high.pop_back();
  }
  const auto low_code = parse_number(low);
  const auto high_code = dots == std::string::npos ? std::optional(HUGE_VAL) : parse_number(high);
  if (!low_code || !high_code || *low_code > *high_code) throw refusal();
  threshold.low = *low_code;
  threshold.high = *high_code;
  return threshold;
}

// A grid's tags are counted up from the one that was stated, else from 0.
MaskStep grid_step(const Said& said, std::optional<std::uint8_t> first_tag) {
  const std::string& text = said.words.front();
  const auto [columns, rows] =
      parse_pair(text, 'x', {"--grid's columns", 1, kMaskValues}, {"--grid's rows", 1, kMaskValues},
                 format("--grid '{}' is none; write COLUMNSxROWS: 16x9", text));
  const std::uint32_t cells = columns * rows;
  const std::uint8_t first = first_tag.value_or(0);
  if (first + cells > kMaskValues) {
    throw UsageError(format("--grid {} has {} cells, tagged from {} on: tags end at {}", text, cells, first,
                            kMaskValues - 1));
  }
  return {"--grid", first, select::Grid{columns, rows}, std::nullopt, {}};
}

// The selection of a step that says which pixels; none for another step.
std::optional<Selection> selection_of(const Said& said) {
  if (said.option == "fill") return select::Whole{};
  if (said.option == "rectangle") return rectangle_of(said);
  if (said.option == "ellipse") return ellipse_of(said);
  if (said.option == "polygon") return polygon_of(said);
  if (said.option == "threshold") return threshold_of(said);
  if (said.option == "difference")
    return select::Difference{picture_or_time(said, 0), picture_or_time(said, 1)};
  if (said.option == "subject") return select::Subject{StatedTime::parse(said.words[0], "--subject")};
  if (said.option == "body") return select::Subject{StatedTime::parse(said.words[0], "--body"), true};
  if (said.option == "moving") return select::Motion{};
  if (said.option == "still") return select::Stillness{};
  if (said.option == "changed-between")
    return select::Motion{std::pair(StatedTime::parse(said.words[0], "--changed-between"),
                                    StatedTime::parse(said.words[1], "--changed-between"))};
  return std::nullopt;
}

constexpr std::string_view kHoles = "holes";  // of --smooth

double radius_of(const Said& said) {
  const auto radius = parse_number(said.words.front());
  if (!radius || *radius < 0.0 || *radius > kLargestRadius) {
    throw UsageError(format("--{} '{}' is no number of pixels of 0 … {}{}", said.option, said.words.front(),
                            kLargestRadius, said.option == "smooth" ? format(", nor {}", kHoles) : ""));
  }
  return *radius;
}

constexpr std::pair<std::string_view, RegionChange::Kind> kChanges[] = {
    {"largest", RegionChange::Kind::largest}, {"invert", RegionChange::Kind::invert},
    {"within", RegionChange::Kind::within},   {"grow", RegionChange::Kind::grow},
    {"shrink", RegionChange::Kind::shrink},   {"smooth", RegionChange::Kind::smooth}};

// The change of a step that changes a region; none for another step.
std::optional<RegionChange> change_of(const Said& said) {
  for (const auto& [name, kind] : kChanges) {
    if (said.option != name) continue;
    if (kind == RegionChange::Kind::within) return RegionChange{kind, 0.0, rectangle_of(said)};
    if (kind == RegionChange::Kind::smooth && said.words.front() == kHoles)
      return RegionChange{RegionChange::Kind::fill_holes, 0.0, {}};
    return RegionChange{kind, said.words.empty() ? 0.0 : radius_of(said), {}};
  }
  return std::nullopt;
}

}  // namespace

std::string change_words(const RegionChange& change) {
  if (change.kind == RegionChange::Kind::fill_holes) return format("--smooth {}", kHoles);
  const auto* known = std::ranges::find(kChanges, change.kind, [](const auto& each) { return each.second; });
  const auto& [corner, width, height] = change.rectangle;
  if (change.kind == RegionChange::Kind::within)
    return format("--within {},{},{},{}", corner.x, corner.y, width, height);
  return format("--{}{}", known->first, change.radius > 0 ? format(" {}", change.radius) : "");
}

namespace {

// All steps, in order.
std::vector<MaskStep> steps_of(const Options& options) {
  std::vector<MaskStep> steps;
  std::optional<std::uint8_t> tag;
  bool has_region = false;  // since the last --tag
  for (const Said& said : options.said) {
    const std::string name = "--" + std::string(said.option);
    if (said.option == "tag") {
      tag = static_cast<std::uint8_t>(parse_whole_number(said.words.front(), "--tag", 0, 255));
      has_region = false;
    } else if (said.option == "grid") {
      steps.push_back(grid_step(said, tag));
      has_region = true;
    } else if (auto selection = selection_of(said)) {
      steps.push_back({name, tag.value_or(255), std::move(*selection), std::nullopt, {}});
      has_region = true;
    } else if (auto change = change_of(said); change || said.option == "by") {
      if (!has_region) {
        throw UsageError(format(
            "{} changes the region before it{}: first select one, with --moving or --rectangle for example",
            name, steps.empty() ? "" : ", and after --tag there is none yet"));
      }
      MaskStep& step = steps.back();
      if (change) {
        step.changes.push_back(std::move(*change));
        continue;
      }
      if (!step.compares()) {
        throw UsageError(format("--by says how much codes must change; {} compares none", step.name));
      }
      step.by_codes = parse_whole_number(said.words.front(), "--by", 1, 65'535);
    }
  }
  if (tag && !has_region) {
    throw UsageError(format("--tag {0} has no region behind it: write --tag {0} before --moving, "
                            "--rectangle, …",
                            *tag));
  }
  return steps;
}

}  // namespace

MaskRequest mask_request(const Options& options) {
  MaskRequest request;
  request.steps = steps_of(options);
  if (options.size) request.size = NamedSize{"--size", *options.size};
  return request;
}

void read_inputs(MaskRequest& request, const Options& options) {
  if (options.base)
    request.base = NamedMask{input_title(*options.base), Shared(read_mask_input(*options.base))};
  read_named_pictures(request);
}

}  // namespace nutik::app
