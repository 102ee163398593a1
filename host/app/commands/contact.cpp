#include <cmath>

#include "app/commands/commands.hpp"
#include "app/input/opened_capture.hpp"
#include "app/input/sheet_exposures.hpp"
#include "app/input/sweep_values.hpp"
#include "app/output/ending.hpp"
#include "app/output/exposure_report.hpp"
#include "app/output/json.hpp"
#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/shared_warnings.hpp"
#include "app/output/stopwatch.hpp"
#include "app/text/time_text.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/picture_writer.hpp"
#include "session/size_text.hpp"

namespace nutik::app {
namespace {

constexpr std::uint64_t kUsualCount = 24;

// What was asked for, before anything is opened.
struct ContactRequest {
  std::optional<TimeText> start;
  std::optional<TimeText> every;
  std::optional<TimeText> length;

  static ContactRequest from(const Options& options) {
    ContactRequest request;
    if (options.start) request.start = TimeText::parse(*options.start, "start");
    if (options.every) request.every = TimeText::parse(*options.every, "--every");
    if (options.exposure) request.length = TimeText::parse(*options.exposure, "exposure");
    if (request.every && request.every->number.numerator <= 0) {
      throw UsageError(format("--every '{}' is not longer than nothing", *options.every));
    }
    if (request.every && request.every->counts_samples() && request.every->number.denominator != 1) {
      throw UsageError(format("--every {} is not a whole number of pictures", *options.every));
    }
    return request;
  }
};

[[noreturn]] void fail_too_many(std::uint64_t count, const Options& options, const Timeline& timeline,
                                std::int64_t start_ns) {
  const double wide =
      static_cast<double>(timeline.duration_ns() - start_ns) / static_cast<double>(kMostOnASheet) * 1e-9;
  throw UsageError(format(
      "--every {} makes {} pictures and a sheet holds {}; take --every {:.3g}s or more, or begin later with "
      "--start",
      *options.every, count, kMostOnASheet, std::ceil(wide * 1000) / 1000));
}

// When each exposure begins: sample by sample where pictures are counted or nothing is stated, else at exact
// multiples of a time.
std::vector<std::int64_t> starts_of(const ContactRequest& request, const Options& options,
                                    const Timeline& timeline) {
  const std::uint64_t first = options.start ? sample_at(*options.start, "start", timeline) : 0;
  std::vector<std::int64_t> starts;
  if (!request.every || request.every->counts_samples()) {
    const std::uint64_t samples = timeline.sample_count() - first;
    const std::uint64_t stride = request.every ? static_cast<std::uint64_t>(request.every->number.numerator)
                                               : (samples + kUsualCount - 1) / kUsualCount;
    const std::uint64_t count = (samples + stride - 1) / stride;
    if (count > kMostOnASheet) fail_too_many(count, options, timeline, timeline.start_ns(first));
    for (std::uint64_t k = first; k < timeline.sample_count(); k += stride)
      starts.push_back(timeline.start_ns(k));
    return starts;
  }
  const std::int64_t start_ns = !request.start                    ? 0
                                : request.start->counts_samples() ? timeline.start_ns(first)
                                                                  : request.start->nanoseconds();
  const int128 step = static_cast<int128>(request.every->number.numerator) * request.every->unit_ns;
  const int128 span =
      static_cast<int128>(timeline.duration_ns() - start_ns) * request.every->number.denominator;
  const int128 count = (span + step - 1) / step;
  if (count > static_cast<int128>(kMostOnASheet)) {
    fail_too_many(static_cast<std::uint64_t>(std::min<int128>(count, INT64_MAX)), options, timeline,
                  start_ns);
  }
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(count); ++i) {
    const std::int64_t at_ns = start_ns + round_half_up(i * step, request.every->number.denominator);
    if (at_ns < timeline.duration_ns()) starts.push_back(at_ns);
  }
  return starts;
}

// As plain_interval has it; pictures that the capture no longer has may be counted, too. How far an exposure passes
// the end is all the same, as long as it does: a warning then says so.
Exposure interval_from(std::int64_t start_ns, const TimeText& length, const Timeline& timeline) {
  const TimeText start = TimeText::of_nanoseconds(start_ns);
  if (length.counts_samples() && length.number.denominator == 1) {
    const std::uint64_t left = timeline.sample_count() - sample_at(start.text(), "start", timeline);
    if (length.number.numerator > static_cast<std::int64_t>(left))
      return {start_ns, timeline.duration_ns() + 1};
  }
  return plain_interval(start, length, timeline);
}

// From each start on, for the length that was asked for; without one, what the camera exposed at that time.
std::vector<Exposure> exposures_of(const ContactRequest& request, const Options& options,
                                   const Timeline& timeline) {
  std::vector<Exposure> exposures;
  for (const std::int64_t start_ns : starts_of(request, options, timeline)) {
    if (request.length) {
      exposures.push_back(interval_from(start_ns, *request.length, timeline));
    } else {
      const std::uint64_t sample = sample_at(format("{}ns", start_ns), "start", timeline);
      exposures.push_back({timeline.start_ns(sample), timeline.end_ns(sample)});
    }
  }
  return exposures;
}

// Times in one unit, with the decimals that tell neighbours apart, and the picture of the clip.
class TimeLabels {
 public:
  TimeLabels(const std::vector<Exposure>& exposures, const Timeline& timeline) : timeline_(timeline) {
    const auto last = static_cast<double>(exposures.back().start_ns);
    unit_ = last >= 1e9   ? Unit{"s", 1e9}
            : last >= 1e6 ? Unit{"ms", 1e6}
            : last >= 1e3 ? Unit{"µs", 1e3}
                          : Unit{"ns", 1};
    const double step = exposures.size() < 2
                            ? unit_.nanoseconds
                            : static_cast<double>(exposures[1].start_ns - exposures[0].start_ns);
    const double digits = std::log10(unit_.nanoseconds);
    decimals_ = static_cast<int>(
        std::clamp(1.0 - std::floor(std::log10(std::max(step, 1.0) / unit_.nanoseconds)), 0.0, digits));
  }

  [[nodiscard]] std::string at(const Exposure& exposure) const {
    const std::uint64_t sample = sample_at(format("{}ns", exposure.start_ns), "start", timeline_);
    return format("{:.{}f} {}   {}f", static_cast<double>(exposure.start_ns) / unit_.nanoseconds, decimals_,
                  unit_.name, sample);
  }

 private:
  struct Unit {
    const char* name;
    double nanoseconds;
  };

  const Timeline& timeline_;
  Unit unit_{"s", 1e9};
  int decimals_ = 0;
};

}  // namespace

int run_contact(const Options& options) {
  const Stopwatch stopwatch;
  const ContactRequest request = ContactRequest::from(options);
  const sheet::SheetWishes wishes = sheet_wishes(options);
  const std::filesystem::path output = sheet_output(options, "contact", "contact");
  const std::string& input = options.operands.front();
  check_sheet_output(output, input_files(options));

  OpenedCapture opened(input, options);
  tik::Reader& capture = opened.reader();
  const Shape& shape = capture.format().shape;
  const std::vector<Exposure> exposures = exposures_of(request, options, capture.timeline());
  const sheet::SheetLayout layout =
      sheet::lay_out(shape, static_cast<std::uint32_t>(exposures.size()), wishes);
  const std::string length = options.exposure ? *options.exposure : "one picture";
  sheet::ContactSheet sheet(layout, format("{}: {} of {}", std::filesystem::path(input).filename().string(),
                                           counted(exposures.size(), "exposure"), length));
  PlanOptions plan_options;
  plan_options.function_name = "the exposure";
  SheetExposures exposing(options, capture, Mask::uniform(shape.width, shape.height, 0), plan_options);
  const TimeLabels labels(exposures, capture.timeline());
  SharedWarnings warnings;
  {
    Progress progress("exposing", exposures.size(), options.quiet);
    for (std::size_t i = 0; i < exposures.size(); ++i) {
      progress.show(i);
      FunctionSet functions;
      functions.emplace(0, GainFunction::boxcar(exposures[i].start_ns, exposures[i].end_ns));
      const std::string label = labels.at(exposures[i]);
      const Exposed exposed = exposing.expose(functions);
      warnings.add(label, exposure_warnings(exposed));
      sheet.add(label, exposed.picture, exposing.transfer());
    }
  }
  warnings.print();
  write_picture(output, sheet.finished());

  if (options.json) {
    Json json{{"sheet", output.string()}, {"columns", layout.columns}, {"rows", layout.rows}};
    json["exposures"] = Json::array();
    for (const Exposure& exposure : exposures) {
      const std::int64_t end_ns = std::min(exposure.end_ns, capture.timeline().duration_ns());
      json["exposures"].push_back({{"start_ns", exposure.start_ns}, {"end_ns", end_ns}});
    }
    add_saturation(json, exposing.saturation(), exposing.type());
    print_json(json);
    return 0;
  }
  if (ended_quietly(options, output)) return 0;
  print_line(format("{}: {} of {}, {}, {}{}, {:.2f} s on {}", output.string(),
                    counted(exposures.size(), "exposure"), length, counted(layout.columns, "column"),
                    counted(layout.rows, "row"), saturation_text(exposing.saturation(), exposing.type()),
                    stopwatch.seconds(), exposing.exposer().renderer_name()));
  print_details(options, exposing.exposer(), opened.notes());
  return 0;
}

}  // namespace nutik::app
