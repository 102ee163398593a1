#include <algorithm>
#include <iterator>

#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/report.hpp"
#include "app/words/stated_requests.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/mask.hpp"
#include "features/masks/mask_making.hpp"
#include "features/plate/plate.hpp"
#include "features/schema/options.hpp"
#include "mask/feather.hpp"
#include "media/writers/picture_writer.hpp"
#include "session/text/number_text.hpp"
#include "sheet/drawings.hpp"
#include "system/is_absent.hpp"

namespace nutik::app {
namespace {

constexpr std::ptrdiff_t kMaxTagsListed = 32;

// What the command line asks for.
struct MaskJob {
  MaskRequest request;
  std::optional<std::string> capture;
  std::filesystem::path output;
  std::optional<Feather> feather;    // of a soft one, which is written as layers
  std::optional<MaskLayers> layers;  // that take the place of the output
};

// Nothing large is read before all of it makes sense.
MaskJob job_of(const Options& options) {
  MaskJob job;
  job.request = mask_request(options);
  const std::vector<MaskStep>& steps = job.request.steps;
  if (!options.operands.empty()) {
    job.capture = options.operands.front();
    const bool is_output = !options.output && options.operands.size() == 1 && is_mask_name(*job.capture) &&
                           (is_absent(*job.capture) || options.size);
    if (is_output) {
      throw UsageError(format("'{}' stands where a capture or clip is read; to write it: -o {}", *job.capture,
                              *job.capture));
    }
    job.output = output_name(options, "mask", "-mask.pgm");
  } else if (options.output && !options.output->empty()) {
    job.output = *options.output;
  } else {
    throw UsageError("the output is missing: nutik-cl mask --moving clip.tik mask.pgm");
  }
  std::vector<std::string> inputs = input_files(options);  // that no output may replace
  if (steps.empty() && !options.base) {
    throw UsageError(
        "what is the mask made of? Add a step: --moving, or --rectangle 100,50,200,120 for example");
  }
  for (const MaskStep& step : steps) {
    if (step.reads_capture() && !job.capture) {
      throw UsageError(format("{} needs a capture or a clip: nutik-cl mask … clip.tik -o {}", step.name,
                              job.output.string()));
    }
    for (const NamedPicture* picture : step.pictures()) inputs.push_back(picture->name);
  }
  if (options.feather) {
    job.feather = *options.feather;
    job.layers.emplace(job.output).check(inputs, replacing(options));
  } else {
    check_mask_output(job.output, inputs, replacing(options));
  }
  if (options.preview) {
    constexpr std::uint32_t kColour = 3;
    inputs.push_back(job.output.string());
    for (std::uint32_t tag = 0; job.layers && tag < kMaskValues; ++tag)
      inputs.push_back(job.layers->file(tag).string());
    check_picture_output(*options.preview, kColour, inputs, replacing(options));
  } else if (options.start || options.exposure) {
    throw UsageError("--start and --exposure say what --preview shows; add --preview picture.png");
  }
  if ((options.start || options.exposure) && !job.capture) {
    throw UsageError("--start and --exposure need a capture: nutik-cl mask … clip.tik");
  }
  read_inputs(job.request, options);
  return job;
}

// What the mask is laid over.
Picture backdrop(const MaskJob& job, const Options& options, const Mask& mask, Session* session) {
  if (session == nullptr) return backdrop_of(job.request, mask);
  ExposedPicture exposed = backdrop_of(*session, options.start, options.exposure);
  print_warnings(exposure_warnings(exposed));
  return std::move(exposed.picture);
}

// `       120 pixels   4.55 %`
std::string pixels_text(std::uint64_t pixels, const Mask& mask) {
  return format("{:>10} pixels {:6.2f} %", pixels,
                100.0 * static_cast<double>(pixels) / static_cast<double>(mask.tags.size()));
}

Answer answer_of(const MaskJob& job, const MadeMask& made) {
  const Mask& mask = made.mask;
  const std::filesystem::path& output = job.output;
  const auto counts = mask.pixels_per_tag();
  const auto tag_count = kMaskValues - std::count(counts.begin(), counts.end(), 0u);
  Answer answer{{{"mask", output.string()}, {"width", mask.width}, {"height", mask.height}}};
  answer.line = format("{}: {} x {}, {}", output.string(), mask.width, mask.height,
                       counted(static_cast<std::uint64_t>(tag_count), "tag"));
  answer.json["steps"] = Json::array();
  for (const StepReport& step : made.steps) {
    Json& entry = answer.json["steps"].emplace_back(
        Json{{"step", step.name}, {"tag", step.tag}, {"pixel_count", step.pixel_count}});
    std::string tags = format("M{}", step.tag), by_codes;
    if (step.last_tag != step.tag) {
      entry["last_tag"] = step.last_tag;
      tags += format(" … M{}", step.last_tag);
    }
    if (step.by_codes) {
      entry["more_than_codes"] = *step.by_codes;
      by_codes = format(", by more than {} codes", *step.by_codes);
    }
    answer.details.push_back(
        format("  {:<18} {:<5}{}{}", step.name, tags, pixels_text(step.pixel_count, mask), by_codes));
  }
  answer.details.push_back("the mask");
  if (job.feather) {
    const std::uint64_t mixed = mask.mixed.pixels().size();
    answer.json["mixed_pixel_count"] = mixed;
    answer.details.push_back(format("  {:<18} {:<5}{}", "shared", "", pixels_text(mixed, mask)));
  }
  answer.json["tags"] = Json::array();
  for (std::size_t tag = 0; tag < counts.size(); ++tag) {
    if (counts[tag] == 0) continue;
    answer.json["tags"].push_back({{"tag", tag}, {"pixel_count", counts[tag]}});
    if (job.layers) answer.json["tags"].back()["layer"] = job.layers->file(tag).string();
    if (tag_count > kMaxTagsListed) continue;
    answer.details.push_back(format("  {:<18} M{:<4}{}", "", tag, pixels_text(counts[tag], mask)));
  }
  if (tag_count > kMaxTagsListed) {
    const auto fewest = std::min_element(counts.begin(), counts.end(), [](auto a, auto b) {
      return a != 0 && (b == 0 || a < b);  // tags without a pixel come last
    });
    answer.details.push_back(format("  {:<18} {} tags of {} … {} pixels; --json lists each", "", tag_count,
                                    *fewest, *std::max_element(counts.begin(), counts.end())));
  }
  return answer;
}

}  // namespace

int run_mask(const Options& options) {
  const MaskJob job = job_of(options);
  std::optional<Session> session;
  if (job.capture) {
    session.emplace(
        open_session(*job.capture, options, make_devices(options),
                     {.besides = mask_needs_of(job.request), .renders = options.preview.has_value()}));
  }

  MadeMask made =
      make_mask(job.request, session ? &session->capture() : nullptr, job.capture.value_or(""), [&] {
        return make_rough_plate(session->capture(), *job.capture, session->devices().request().memory,
                                progress_bar("finding the background", options.quiet))
            .picture;
      });
  print_warnings(warnings_of(made));
  if (job.feather) made.mask = feathered(made.mask, *job.feather);
  // Before anything is written: what cannot be looked at is an error.
  const auto moved = job.request.tells_by_rest() ? moved_camera(session->capture()) : std::nullopt;
  if (options.preview) {
    const Picture below = backdrop(job, options, made.mask, session ? &*session : nullptr);
    write_picture(*options.preview, sheet::mask_overlay(made.mask, below));
  }
  if (job.layers) {
    job.layers->write(made.mask);
  } else {
    write_picture(job.output, made.mask.to_picture());
  }
  Answer answer = answer_of(job, made);
  answer.notes = camera_notes(moved);
  std::ranges::copy(made.notes, std::back_inserter(answer.notes));
  if (session) answer.tell_source(*session);
  return tell(options, job.output, answer);
}

}  // namespace nutik::app
