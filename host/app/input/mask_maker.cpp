#include "app/input/mask_maker.hpp"

#include <filesystem>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "imev/each_block.hpp"
#include "mask/code_span.hpp"
#include "media/clip.hpp"
#include "media/still_sequence.hpp"
#include "session/stated_time.hpp"

namespace nutik::app {
namespace {

template <typename... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};

Picture picture_of(const CaptureFormat& format) {
  return {format.shape, code_type(format), format.white_code};
}

}  // namespace

Picture read_picture(const std::string& name) {
  if (std::error_code error; !std::filesystem::exists(name, error)) {
    throw InputError(format("{} cannot be read: no such file", name));
  }
  const auto stills = list_stills(name);
  if (!stills || stills->size() != 1) {
    throw UsageError(format(
        "{} is {}; a picture is needed (PNG, TIFF, PGM, PPM, JPEG), or a time of the capture: 0.3s, 12f",
        name, stills ? format("a sequence of {}", stills->size()) : "no picture"));
  }
  const auto clip = open_clip(name, {});
  Picture picture = picture_of(clip->info().format);
  if (!clip->read(picture.bytes)) throw InputError(format("{} has no picture", name));
  const std::uint32_t largest = largest_code(picture.bytes, clip->info().format.code_bytes);
  if (largest > picture.white_code) {
    throw InputError(
        format("{} cannot be read: it has a code of {}, above the {} that it states as its largest; write it "
               "again with the right one",
               name, largest, picture.white_code));
  }
  return picture;
}

Picture picture_of_sample(CaptureSource& source, std::uint64_t sample) {
  Picture picture = picture_of(source.format());
  for_each_block(source, {sample, sample + 1}, [&](const BlockView& block) {
    block.read_sample(static_cast<std::uint32_t>(sample - block.extent().first_sample), picture.bytes);
  });
  return picture;
}

void MaskMaker::add(const MaskStep& step) {
  StepReport report{step.option, step.tag, step.last_tag(), 0, std::nullopt};
  Region region = region_of(step, report);
  for (const auto& change : step.changes) region = change(region);
  report.pixel_count = region.pixel_count();
  reports_.push_back(std::move(report));
  if (const auto* grid = std::get_if<select::Grid>(&step.selection)) {
    if (grid->columns > mask_.width || grid->rows > mask_.height) {
      throw InputError(format("--grid {}x{} has more cells than pixels along a side: the mask is {} x {}",
                              grid->columns, grid->rows, mask_.width, mask_.height));
    }
    paint_grid(mask_, region, grid->columns, grid->rows, step.tag);
  } else {
    paint(mask_, region, step.tag);
  }
}

Region MaskMaker::region_of(const MaskStep& step, StepReport& report) {
  const auto whole = [&] { return SampleRange{0, capture_->timeline().sample_count()}; };
  return std::visit(
      Overloaded{
          [&](const select::Whole&) { return Region::all(mask_.width, mask_.height); },
          [&](const select::Grid&) { return Region::all(mask_.width, mask_.height); },
          [&](const select::Shape& shape) { return shape.draw(mask_.width, mask_.height); },
          [&](const select::Threshold& threshold) {
            const Picture picture = picture_at(threshold.picture, step);
            const double unit = threshold.is_share ? picture.white_code / 100.0 : 1.0;
            return between(picture, threshold.low * unit, threshold.high * unit);
          },
          [&](const select::Difference& difference) {
            const Picture before = picture_at(difference.before, step);
            const Picture after = picture_at(difference.after, step);
            if (before.shape != after.shape || before.white_code != after.white_code) {
              throw InputError(format(
                  "--difference {} {}: the pictures differ in {}", difference.before, difference.after,
                  before.shape != after.shape ? "kind, one is grey and one colour" : "depth or white code"));
            }
            return changed(differences(before, after), before.white_code, step, report);
          },
          [&](const select::Motion& motion) {
            if (motion.from.empty()) return moving(whole(), step, report);
            const Timeline& timeline = capture_->timeline();
            const std::uint64_t from =
                sample_at(StatedTime::parse(motion.from, step.option), step.option, timeline);
            const std::uint64_t to =
                sample_at(StatedTime::parse(motion.to, step.option), step.option, timeline);
            if (from >= to) {
              throw UsageError(format(
                  "--changed-between {} {}: both times lie in picture {} or in the wrong order, so nothing "
                  "changes between them; write the earlier first, at least a picture apart",
                  motion.from, motion.to, to));
            }
            return moving({from, to + 1}, step, report);
          },
          [&](const select::Stillness&) { return inverted(moving(whole(), step, report)); },
      },
      step.selection);
}

Region MaskMaker::moving(SampleRange samples, const MaskStep& step, StepReport& report) {
  auto [known, is_new] = spans_.try_emplace({samples.first, samples.last});
  if (is_new) {
    CodeSpan span(capture_->format(), samples);
    for_each_block(*capture_, samples, [&](const BlockView& block) { span.add(block); });
    known->second = span.spans();
  }
  return changed(known->second, capture_->format().white_code, step, report);
}

Region MaskMaker::changed(const std::vector<std::uint32_t>& spans, std::uint32_t white_code,
                          const MaskStep& step, StepReport& report) const {
  const std::uint32_t codes = step.by_codes > 0 ? step.by_codes : usual_noise(spans, white_code);
  report.by_codes = codes;
  return spanning_more({mask_.width, mask_.height, 1}, spans, codes);
}

Picture MaskMaker::picture_at(const PictureOrTime& word, const MaskStep& step) {
  if (is_time(word))
    return picture_of_sample(
        *capture_, sample_at(StatedTime::parse(word, step.option), step.option, capture_->timeline()));
  Picture picture = read_picture(word);
  if (picture.shape.width != mask_.width || picture.shape.height != mask_.height) {
    throw InputError(format("{} {}: the picture is {} x {}, the mask {} x {}; they must be of one size",
                            step.option, word, picture.shape.width, picture.shape.height, mask_.width,
                            mask_.height));
  }
  return picture;
}

}  // namespace nutik::app
