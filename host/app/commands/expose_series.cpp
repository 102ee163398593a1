#include "app/commands/expose_series.hpp"

#include <filesystem>
#include <future>
#include <set>

#include "app/input/exposer.hpp"
#include "app/input/exposure_request.hpp"
#include "app/input/exposure_series.hpp"
#include "app/input/opened_capture.hpp"
#include "app/output/console.hpp"
#include "app/output/exposure_report.hpp"
#include "app/output/output_format.hpp"
#include "app/output/output_name.hpp"
#include "app/output/picture_recipe.hpp"
#include "app/output/progress.hpp"
#include "app/output/stopwatch.hpp"
#include "app/text/size_text.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/numbered_name.hpp"
#include "media/picture_writer.hpp"
#include "media/still_sequence.hpp"

namespace nutik::app {
namespace {

namespace fs = std::filesystem;

// Where each picture goes; numbers count from 0, as pictures of a clip do.
class PictureNames {
 public:
  explicit PictureNames(const fs::path& pattern) : folder_(pattern.parent_path()) {
    const auto name = NumberedName::parse(pattern.filename().string());
    if (!name) {
      throw UsageError(
          format("a series needs a number in its pictures' name, as in {}; {} would be written again and "
                 "again",
                 (folder_ / (pattern.stem().string() + "-%03d" + pattern.extension().string())).string(),
                 pattern.string()));
    }
    name_ = *name;
  }

  [[nodiscard]] fs::path operator[](std::uint64_t k) const { return folder_ / name_.with(k); }

 private:
  fs::path folder_;
  NumberedName name_;
};

// Prints a warning that was not printed before: what is said of one exposure is often said of all.
class Warnings {
 public:
  void print(const fs::path& picture, const std::string& text) {
    if (said_.insert(text).second) print_warning(format("{}: {}", picture.string(), text));
  }

 private:
  std::set<std::string> said_;
};

}  // namespace

int expose_series(const Options& options) {
  const auto stated = stated_output(options.output, options.operands, "expose");
  const std::string& input = options.operands.front();
  ExposureRequest request = ExposureRequest::from(options);
  const ExposureSeries series = ExposureSeries::from(options);
  const PictureNames names(stated.value_or(sequence_name(input) + "-" + request.label() + "-%04d.png"));
  const std::vector<std::string> inputs = exposure_inputs(options);
  check_output(names[0], OutputKind::picture, inputs);  // before a clip is read
  Exposer exposer(options);
  PictureRecipe recipe(options);
  OpenedCapture opened(input, options);
  tik::Reader& capture = opened.reader();
  const std::vector<TimeText> starts = series.starts(request, capture.timeline());
  for (std::uint64_t k = 1; k < starts.size(); ++k) check_output(names[k], OutputKind::picture, inputs);
  const OutputFormat format_of_all = output_format(options, names[0], capture.format());
  const Mask mask = request.mask(capture.format().shape);

  const Stopwatch stopwatch;
  Progress progress("exposing", starts.size(), options.quiet);
  Warnings warnings;
  std::future<void> writing;  // the picture before, beside the next exposure
  std::optional<RenderPlan> first_plan;
  for (std::uint64_t k = 0; k < starts.size(); ++k) {
    progress.show(k);
    Exposed exposed = exposer.expose(capture, request.functions(starts[k], capture.timeline()), mask,
                                     request.plan_options(), format_of_all);
    for (const std::string& warning : exposure_warnings(exposed)) warnings.print(names[k], warning);
    if (writing.valid()) writing.get();
    writing = std::async(std::launch::async, [path = names[k], picture = std::move(exposed.picture),
                                              text = recipe.text(exposer.precision(), starts[k].text())] {
      write_picture(path, picture, text);
    });
    if (k == 0) first_plan = std::move(exposed.plan);
  }
  writing.get();
  if (options.quiet) {
    if (!stated) print_line(names[0].string());  // a name that nobody gave
    return 0;
  }

  const double seconds = stopwatch.seconds();
  print_line(format("{} … {}: {} exposures every {}, {}{}, {:.1f} exposures a second, {:.2f} s on {}",
                    names[0].string(), names[starts.size() - 1].filename().string(), starts.size(),
                    series.every_text(), shape_text(capture.format().shape),
                    still_gains_text(*first_plan, request.is_plain()),
                    static_cast<double>(starts.size()) / seconds, seconds, exposer.renderer_name()));
  if (const std::string report = exposer.report(); options.verbose && !report.empty()) print_line(report);
  for (const std::string& note : opened.notes()) print_note(note);
  return 0;
}

}  // namespace nutik::app
