#include "features/masks/mask_making.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/mask_check.hpp"
#include "features/masks/comparable_codes.hpp"
#include "imev/each_block.hpp"
#include "mask/code_span.hpp"
#include "mask/distance.hpp"
#include "mask/layers.hpp"
#include "media/writers/picture_writer.hpp"
#include "scene/clean_plate.hpp"
#include "session/requests/named_inputs.hpp"
#include "session/requests/output_request.hpp"

namespace nutik {
namespace {

template <typename... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
// What compilers find by themselves since clang 17.
template <typename... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

std::string text_of(const PictureSource& source) {
  const auto* picture = std::get_if<NamedPicture>(&source);
  return picture != nullptr ? picture->name : std::get<StatedTime>(source).text();
}

Region changed_by(const RegionChange& change, const Region& region) {
  const select::Rectangle& limits = change.rectangle;
  switch (change.kind) {
    case RegionChange::Kind::largest: return largest_part(region);
    case RegionChange::Kind::fill_holes: return with_holes_filled(region);
    case RegionChange::Kind::invert: return inverted(region);
    case RegionChange::Kind::grow: return grown(region, change.radius);
    case RegionChange::Kind::shrink: return shrunk(region, change.radius);
    case RegionChange::Kind::smooth: return smoothed(region, change.radius);
    case RegionChange::Kind::within: break;
  }
  return intersection(region,
                      rectangle(region.width, region.height, limits.corner, limits.width, limits.height));
}

// How far the changes move a region's border outwards, in whole pixels.
std::uint32_t margin_of(const MaskStep& step) {
  double margin = 0;
  for (const RegionChange& change : step.changes) {
    if (change.kind == RegionChange::Kind::grow) margin += change.radius;
    if (change.kind == RegionChange::Kind::shrink) margin -= change.radius;
  }
  return static_cast<std::uint32_t>(std::max(margin, 0.0));
}

Advice advice_of(std::uint32_t width, std::uint32_t height, const CaptureSource* capture) {
  return capture == nullptr ? Advice{} : size_advice(width, height, capture->format());
}

MaskSize size_of(const MaskRequest& request, const CaptureSource* capture, const std::string& capture_name) {
  std::vector<NamedSize> sizes;
  if (request.size) sizes.push_back(*request.size);
  if (capture != nullptr) {
    const Shape& shape = capture->format().shape;
    sizes.push_back({capture_name, {shape.width, shape.height}});
  }
  if (request.base) {
    sizes.push_back({request.base->name, {request.base->mask->width, request.base->mask->height}});
  }
  for (const MaskStep& step : request.steps) {
    if (!sizes.empty()) break;
    for (const NamedPicture* file : step.pictures()) {
      sizes.push_back({file->name, {file->picture->shape.width, file->picture->shape.height}});
    }
  }
  if (sizes.empty())
    throw UsageError("how large is the mask? Name the capture it is for", Advice{", or say `size 640x360`"});
  const NamedSize& first = sizes.front();
  for (const NamedSize& other : sizes) {
    if (other.size == first.size) continue;
    throw UsageError(format("{} is {} x {}, {} is {} x {}: the sizes must agree", first.name, first.size.width,
                            first.size.height, other.name, other.size.width, other.size.height),
                     advice_of(other.size.width, other.size.height, capture));
  }
  return first.size;
}

class MaskMaker {
 public:
  MaskMaker(Mask base, CaptureSource* capture, const std::function<Picture()>& plate)
      : made_{std::move(base), {}, {}}, capture_(capture), make_plate_(plate) {}

  void add(const MaskStep& step) {
    StepReport report{step.name, step.tag, step.last_tag(), 0, std::nullopt, std::nullopt, std::nullopt, {}};
    Region region = region_of(step, report);
    for (const RegionChange& change : step.changes) region = changed_by(change, region);
    report.pixel_count = region.pixel_count();
    if (seen_) {
      report.plate_edges = plate_edge_share(*seen_, *plate_, region, *report.by_codes, margin_of(step));
      report.own_edges = plate_edge_share(*plate_, *seen_, region, *report.by_codes, margin_of(step));
      seen_.reset();
    }
    if (const auto* grid = std::get_if<select::Grid>(&step.selection)) {
      if (grid->columns > mask().width || grid->rows > mask().height) {
        throw InputError(format("{} {}x{} has more cells than pixels along a side: the mask is {} x {}",
                                step.name, grid->columns, grid->rows, mask().width, mask().height));
      }
      paint_grid(made_.mask, region, grid->columns, grid->rows, step.tag);
    } else {
      paint(made_.mask, region, step.tag);
    }
    if (report.pixel_count > 0) report.covered_tags = tags_on_pixels(report);
    made_.steps.push_back(std::move(report));
  }

  [[nodiscard]] MadeMask finished() {
    for (StepReport& step : made_.steps) {
      const std::vector<std::uint8_t> left = tags_on_pixels(step);
      std::erase_if(step.covered_tags,
                    [&](std::uint8_t tag) { return std::ranges::binary_search(left, tag); });
    }
    return std::move(made_);
  }

 private:
  [[nodiscard]] const Mask& mask() const { return made_.mask; }

  // Those of a step that some pixel has now.
  [[nodiscard]] std::vector<std::uint8_t> tags_on_pixels(const StepReport& step) const {
    const auto counts = mask().pixels_per_tag();
    std::vector<std::uint8_t> tags;
    for (std::uint32_t tag = step.tag; tag <= step.last_tag; ++tag) {
      if (counts[tag] > 0) tags.push_back(static_cast<std::uint8_t>(tag));
    }
    return tags;
  }

  Region region_of(const MaskStep& step, StepReport& report) {
    const std::uint32_t width = mask().width, height = mask().height;
    return std::visit(
        Overloaded{
            [&](const select::Whole&) { return Region::all(width, height); },
            [&](const select::Grid&) { return Region::all(width, height); },
            [&](const select::Rectangle& shape) {
              return rectangle(width, height, shape.corner, shape.width, shape.height);
            },
            [&](const select::Ellipse& shape) {
              return ellipse(width, height, shape.centre, shape.radius_x, shape.radius_y);
            },
            [&](const select::Polygon& shape) { return polygon(width, height, shape.corners); },
            [&](const select::Threshold& threshold) {
              const Shared<Picture> picture = picture_of(threshold.picture, step);
              const double unit = threshold.is_share ? picture->white_code / 100.0 : 1.0;
              return between(*picture, threshold.low * unit, threshold.high * unit);
            },
            [&](const select::Difference& difference) {
              const auto [before, after] = compared(difference, step);
              return changed(differences(*before, *after), before->white_code, step, report);
            },
            [&](const select::Motion& motion) { return moving(samples_of(motion, step), step, report); },
            [&](const select::Subject& subject) {
              if (!plate_) plate_ = make_plate_();
              const std::uint64_t sample = sample_at(subject.at, step.name, capture_->timeline());
              seen_ = picture_of_sample(*capture_, sample);
              const Region all = changed(differences(*seen_, *plate_), plate_->white_code, step, report);
              return subject.is_without_shadow ? without_shadow(*seen_, *plate_, all) : all;
            },
            [&](const select::Stillness&) {
              return inverted(moving({0, capture_->timeline().sample_count()}, step, report));
            },
        },
        step.selection);
  }

  // A picture from a file and one of the capture are seen in the codes of the capture, two from files in the first's.
  std::pair<Shared<Picture>, Shared<Picture>> compared(const select::Difference& difference, const MaskStep& step) {
    Shared<Picture> before = picture_of(difference.before, step), after = picture_of(difference.after, step);
    if (before->shape != after->shape) {
      throw InputError(format("{} {} {}: the pictures differ in kind, one is grey and one colour", step.name,
                              text_of(difference.before), text_of(difference.after)));
    }
    const auto* const first = std::get_if<NamedPicture>(&difference.before);
    const auto* const second = std::get_if<NamedPicture>(&difference.after);
    const NamedPicture* const named = second != nullptr ? second : first;
    if (named == nullptr) return {before, after};
    CaptureFormat like = first == nullptr || second == nullptr ? capture_->format() : CaptureFormat();
    if (first != nullptr && second != nullptr) {
      like.code_bytes = static_cast<std::uint32_t>(value_bytes(before->type));
      like.white_code = before->white_code;
      like.transfer = before->transfer.value_or(after->transfer.value_or(Transfer::srgb()));
      like.primaries = before->primaries;
    }
    for (const NamedPicture* each : step.pictures()) {
      std::string note = silence_note(like, *each);
      if (!note.empty() && !std::ranges::count(made_.notes, note)) made_.notes.push_back(std::move(note));
    }
    return comparable_codes(named == first ? after : before, like, *named);
  }

  [[nodiscard]] SampleRange samples_of(const select::Motion& motion, const MaskStep& step) const {
    const Timeline& timeline = capture_->timeline();
    if (!motion.between) return {0, timeline.sample_count()};
    const auto& [begin, end] = *motion.between;
    const std::uint64_t from = sample_at(begin, step.name, timeline);
    const std::uint64_t to = sample_at(end, step.name, timeline);
    if (from >= to) {
      throw UsageError(
          format("{} {} {}: both times lie in picture {} or in the wrong order, so nothing changes between "
                 "them; write the earlier first, at least a picture apart",
                 step.name, begin.text(), end.text(), to));
    }
    return {from, to + 1};
  }

  Region moving(SampleRange samples, const MaskStep& step, StepReport& report) {
    auto [known, is_new] = spans_.try_emplace({samples.first, samples.last});
    if (is_new) {
      CodeSpan span(capture_->format(), samples);
      for_each_block(*capture_, samples, [&](const BlockView& block) { span.add(block); });
      known->second = span.spans();
    }
    return changed(known->second, capture_->format().white_code, step, report);
  }

  [[nodiscard]] Region changed(const std::vector<std::uint32_t>& spans, std::uint32_t white_code,
                               const MaskStep& step, StepReport& report) const {
    if (step.by_codes && *step.by_codes >= white_code) {
      throw UsageError(format("{}: no codes differ by more than {}, for white is {}; state fewer codes",
                              step.name, *step.by_codes, white_code));
    }
    report.by_codes = step.by_codes ? *step.by_codes : default_noise(spans, white_code);
    return spanning_more({mask().width, mask().height, 1}, spans, *report.by_codes);
  }

  [[nodiscard]] Shared<Picture> picture_of(const PictureSource& source, const MaskStep& step) const {
    if (const auto* time = std::get_if<StatedTime>(&source)) {
      return Shared(picture_of_sample(*capture_, sample_at(*time, step.name, capture_->timeline())));
    }
    const std::string& name = std::get<NamedPicture>(source).name;
    const Shared<Picture>& picture = std::get<NamedPicture>(source).picture;
    if (picture->shape.width != mask().width || picture->shape.height != mask().height) {
      throw InputError(format("{} {}: the picture is {} x {}, the mask {} x {}; they must be of one size", step.name,
                              name, picture->shape.width, picture->shape.height, mask().width, mask().height),
                       advice_of(picture->shape.width, picture->shape.height, capture_));
    }
    return picture;
  }

  MadeMask made_;
  CaptureSource* capture_;
  const std::function<Picture()>& make_plate_;
  std::optional<Picture> plate_;
  std::optional<Picture> seen_;  // that a subject was found in, until its region is whole
  // Samples that a step has looked at: the capture is read once for steps with the same times.
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::vector<std::uint32_t>> spans_;
};

}  // namespace

Picture picture_of_sample(CaptureSource& source, std::uint64_t sample) {
  const CaptureFormat& format = source.format();
  Picture picture(format.shape, code_type(format), format.white_code);
  for_each_block(source, {sample, sample + 1}, [&](const BlockView& block) {
    block.read_sample(static_cast<std::uint32_t>(sample - block.extent().first_sample), picture.bytes);
  });
  return picture;
}

MemoryNeeds mask_making_needs(const CaptureFormat& capture) {
  const Shape& shape = capture.shape;
  return {{"codes of pixels", 2 * shape.value_count() * sizeof(std::uint16_t)},
          {"spans and regions of pixels", shape.pixel_count() * (2 * sizeof(std::uint32_t) + 4)}};
}

MadeMask make_mask(const MaskRequest& request, CaptureSource* capture, const std::string& capture_name,
                   const std::function<Picture()>& plate) {
  for (const MaskStep& step : request.steps) {
    if (step.reads_capture() && capture == nullptr)
      throw UsageError(format("{} looks at a capture, and none is given", step.name));
    if (step.needs_plate() && !plate)
      throw UsageError(format("{} looks at the capture's background, and nothing makes it", step.name));
  }
  const MaskSize size = size_of(request, capture, capture_name);
  MaskMaker maker(request.base ? *request.base->mask : Mask::uniform(size.width, size.height, 0), capture,
                  plate);
  for (const MaskStep& step : request.steps) maker.add(step);
  return maker.finished();
}

std::vector<std::string> warnings_of(const MadeMask& made) {
  constexpr std::size_t kMaxShown = 8;
  std::vector<std::string> warnings;
  for (const StepReport& step : made.steps) {
    if (step.pixel_count == 0) warnings.push_back(format("{} for M{} selects no pixel", step.name, step.tag));
    if (step.covered_tags.empty()) continue;
    std::string tags;
    for (std::size_t i = 0; i < std::min(step.covered_tags.size(), kMaxShown); ++i)
      tags += format("{}M{}", i == 0 ? "" : ", ", step.covered_tags[i]);
    if (step.covered_tags.size() > kMaxShown)
      tags += format(" and {} more", step.covered_tags.size() - kMaxShown);
    warnings.push_back(
        format("{}: later steps cover all of {}, which no pixel has in the end", step.name, tags));
  }
  return warnings;
}

ExposedPicture backdrop_of(Session& session, const std::optional<StatedTime>& start,
                           const std::optional<StatedTime>& length) {
  const Timeline& timeline = session.timeline();
  Exposure interval{0, timeline.duration_ns()};
  if (length) {
    interval = plain_interval(start.value_or(StatedTime{}), *length, timeline);
  } else if (start) {
    const std::uint64_t sample = sample_at(*start, "start", timeline);
    interval = {timeline.start_ns(sample), timeline.end_ns(sample)};
  }
  const CaptureFormat& format = session.format();
  FunctionSet functions;
  functions.emplace(0, GainFunction::boxcar(interval.start_ns, interval.end_ns));
  PlanOptions plan;
  plan.function_name = "the preview's exposure";
  return session.render(functions, Mask::uniform(format.shape.width, format.shape.height, 0), plan,
                        output_format({}, format));
}

Picture backdrop_of(const MaskRequest& request, const Mask& mask) {
  for (const MaskStep& step : request.steps) {
    for (const NamedPicture* picture : step.pictures()) return *picture->picture;
  }
  Picture grey({mask.width, mask.height, 1}, ValueType::code8, 255);
  std::fill(grey.bytes.begin(), grey.bytes.end(), std::byte{200});
  return grey;
}

namespace {

NumberedName numbered(const std::filesystem::path& name) {
  if (const auto parsed = NumberedName::parse(name.filename().string())) {
    parsed->expect_one(name.string());
    return *parsed;
  }
  throw UsageError(
      format("a soft mask is written as layers, one for each tag, so its name needs a number, as in {}",
             (name.parent_path() / (name.stem().string() + "-%d.png")).string()));
}

}  // namespace

MaskLayers::MaskLayers(const std::filesystem::path& name)
    : name_(name), folder_(name.parent_path()), numbered_(numbered(name)) {}

void MaskLayers::check(std::span<const std::string> inputs, Replacing replacing) const {
  for (std::uint32_t tag = 0; tag < kMaskValues; ++tag) check_mask_output(file(tag), inputs, replacing);
}

void MaskLayers::write(const Mask& mask) const {
  const auto counts = mask.pixels_per_tag();
  for (const auto& [tag, file] : layer_files(name_.string())) {
    if (counts[tag] > 0) continue;
    throw OutputError(
        format("{} is there, and M{} has no pixel in this mask: it would be taken for one of its layers. "
               "Remove it, or choose another name",
               file.string(), tag));
  }
  for (std::size_t tag = 0; tag < counts.size(); ++tag) {
    if (counts[tag] > 0) write_picture(file(tag), layer_of(mask, static_cast<std::uint8_t>(tag)));
  }
}

}  // namespace nutik
