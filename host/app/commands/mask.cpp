#include <algorithm>

#include "app/commands/commands.hpp"
#include "app/commands/opened_session.hpp"
#include "app/input/standard_input.hpp"
#include "app/output/console.hpp"
#include "app/output/ending.hpp"
#include "app/output/exposure_report.hpp"
#include "app/output/json.hpp"
#include "app/output/output_name.hpp"
#include "app/requests/mask_words.hpp"
#include "session/error.hpp"
#include "session/format.hpp"
#include "session/mask_making.hpp"
#include "session/pictures.hpp"
#include "session/sheets.hpp"
#include "session/size_text.hpp"
#include "session/stated_time.hpp"

namespace nutik::app {
namespace {

constexpr std::ptrdiff_t kMostTagsListed = 32;

// What the command line asks for.
struct MaskJob {
  MaskRequest request;
  std::optional<std::string> capture;
  std::filesystem::path output;
};

bool is_mask_name(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  return extension == ".pgm" || extension == ".png" || extension == ".PGM" || extension == ".PNG";
}

// Nothing large is read before all of it makes sense.
MaskJob job_of(const Options& options) {
  MaskJob job;
  job.request = mask_request(options);
  const std::vector<MaskStep>& steps = job.request.steps;
  if (!options.operands.empty()) {
    job.capture = options.operands.front();
    const bool is_output = !options.output && options.operands.size() == 1 && is_mask_name(*job.capture) &&
                           !std::filesystem::exists(*job.capture);
    if (is_output) {
      throw UsageError(format("'{}' stands where a capture or clip is read; to write it: -o {}", *job.capture,
                              *job.capture));
    }
    job.output = stated_output(options.output, options.operands, "mask")
                     .value_or(sequence_name(*job.capture) + "-mask.pgm");
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
      throw UsageError(format("{} needs a capture or a clip: nutik-cl mask … clip.tik -o {}", step.name.text,
                              job.output.string()));
    }
    for (const NamedPicture* picture : step.pictures()) inputs.push_back(picture->name.text);
  }
  if (!is_mask_name(job.output)) {
    throw UsageError(
        format("{}: masks are written as .pgm or .png, which keep every tag", job.output.string()));
  }
  check_output(job.output, OutputKind::picture, inputs);
  if (options.preview) {
    inputs.push_back(job.output.string());
    check_output(*options.preview, OutputKind::picture, inputs);
  } else if (options.start || options.exposure) {
    throw UsageError("--start and --exposure say what --preview shows; add --preview picture.png");
  }
  read_inputs(job.request, options);
  return job;
}

// What the mask is laid over: an exposure of the capture, all of it where none was asked for; else a picture
// that the mask was made from, else plain grey.
Picture backdrop(const Options& options, const MaskRequest& request, const Mask& mask, Session* session) {
  if (session == nullptr) {
    if (options.start || options.exposure) {
      throw UsageError("--start and --exposure need a capture: nutik-cl mask … clip.tik");
    }
    for (const MaskStep& step : request.steps) {
      for (const NamedPicture* picture : step.pictures()) return *picture->picture;
    }
    Picture grey({mask.width, mask.height, 1}, ValueType::code8, 255);
    std::fill(grey.bytes.begin(), grey.bytes.end(), std::byte{200});
    return grey;
  }
  const Timeline& timeline = session->timeline();
  Exposure interval{0, timeline.duration_ns()};
  if (options.exposure) {
    interval = plain_interval(StatedTime::parse(options.start.value_or("0s"), "start"),
                              StatedTime::parse(*options.exposure, "exposure"), timeline);
  } else if (options.start) {
    const std::uint64_t sample = sample_at(StatedTime::parse(*options.start, "start"), "start", timeline);
    interval = {timeline.start_ns(sample), timeline.end_ns(sample)};
  }
  const CaptureFormat& format = session->format();
  FunctionSet functions;
  functions.emplace(0, GainFunction::boxcar(interval.start_ns, interval.end_ns));
  PlanOptions plan_options;
  plan_options.function_name = "the preview's exposure";
  ExposedPicture exposed = session->render(functions, Mask::uniform(mask.width, mask.height, 0), plan_options,
                                           {code_type(format), format.white_code});
  for (const std::string& warning : exposure_warnings(exposed)) print_warning(warning);
  return std::move(exposed.picture);
}

double percent_of(std::uint64_t pixels, const Mask& mask) {
  return 100.0 * static_cast<double>(pixels) / static_cast<double>(mask.tags.size());
}

void report_text(const std::filesystem::path& output, const Mask& mask,
                 const std::vector<StepReport>& steps) {
  const auto counts = mask.pixels_per_tag();
  const auto tag_count = kMaskValues - std::count(counts.begin(), counts.end(), 0u);
  print_line(format("{}: {} x {}, {}", output.string(), mask.width, mask.height,
                    counted(static_cast<std::uint64_t>(tag_count), "tag")));
  for (const StepReport& step : steps) {
    const std::string tags =
        step.tag == step.last_tag ? format("M{}", step.tag) : format("M{} … M{}", step.tag, step.last_tag);
    print_line(format("  {:<18} {:<5}{:>10} pixels {:6.2f} %{}", step.name, tags, step.pixel_count,
                      percent_of(step.pixel_count, mask),
                      step.by_codes ? format(", by more than {} codes", *step.by_codes) : ""));
  }
  print_line("the mask");
  if (tag_count > kMostTagsListed) {
    const auto fewest = std::min_element(counts.begin(), counts.end(), [](auto a, auto b) {
      return a != 0 && (b == 0 || a < b);  // tags without a pixel come last
    });
    print_line(format("  {:<18} {} tags of {} … {} pixels; --json lists each", "", tag_count, *fewest,
                      *std::max_element(counts.begin(), counts.end())));
    return;
  }
  for (std::size_t tag = 0; tag < counts.size(); ++tag) {
    if (counts[tag] == 0) continue;
    print_line(format("  {:<18} M{:<4}{:>10} pixels {:6.2f} %", "", tag, counts[tag],
                      percent_of(counts[tag], mask)));
  }
}

void report_json(const std::filesystem::path& output, const Mask& mask,
                 const std::vector<StepReport>& steps) {
  Json json{{"mask", output.string()}, {"width", mask.width}, {"height", mask.height}};
  json["steps"] = Json::array();
  for (const StepReport& step : steps) {
    Json entry{{"step", step.name}, {"tag", step.tag}, {"pixel_count", step.pixel_count}};
    if (step.last_tag != step.tag) entry["last_tag"] = step.last_tag;
    if (step.by_codes) entry["more_than_codes"] = *step.by_codes;
    json["steps"].push_back(std::move(entry));
  }
  json["tags"] = Json::array();
  const auto counts = mask.pixels_per_tag();
  for (std::size_t tag = 0; tag < counts.size(); ++tag) {
    if (counts[tag] != 0) json["tags"].push_back({{"tag", tag}, {"pixel_count", counts[tag]}});
  }
  print_json(json);
}

}  // namespace

int run_mask(const Options& options) {
  const MaskJob job = job_of(options);
  std::optional<Session> session;
  if (job.capture) session.emplace(open_session(*job.capture, options));

  const auto [mask, steps] =
      make_mask(job.request, session ? &session->capture() : nullptr, job.capture.value_or(""));
  for (const StepReport& step : steps) {
    if (step.pixel_count == 0) print_warning(format("{} for M{} selects no pixel", step.name, step.tag));
  }
  if (options.preview) {
    const Transfer transfer = session ? session->format().transfer : Transfer::srgb();
    write_picture(*options.preview,
                  sheet::mask_overlay(
                      mask, backdrop(options, job.request, mask, session ? &*session : nullptr), transfer));
  }
  write_picture(job.output, mask.to_picture());
  if (options.json) {
    report_json(job.output, mask, steps);
  } else if (!ended_quietly(options, job.output)) {
    report_text(job.output, mask, steps);
  }
  if (session && !options.quiet) {
    for (const std::string& line : source_lines(*session)) print_note(line);
  }
  return 0;
}

}  // namespace nutik::app
