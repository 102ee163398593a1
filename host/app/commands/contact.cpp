#include "app/commands/commands.hpp"
#include "app/commands/opened_session.hpp"
#include "app/output/ending.hpp"
#include "app/output/exposure_report.hpp"
#include "app/output/json.hpp"
#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/shared_warnings.hpp"
#include "app/output/sheet_exposures.hpp"
#include "app/output/stopwatch.hpp"
#include "session/contact_request.hpp"
#include "session/error.hpp"
#include "session/format.hpp"
#include "session/pictures.hpp"
#include "session/size_text.hpp"

namespace nutik::app {
namespace {

ContactRequest contact_request(const Options& options) {
  ContactRequest request;
  if (options.start) request.start = StatedTime::parse(*options.start, "start");
  if (options.every) request.every = StatedTime::parse(*options.every, "--every");
  if (options.exposure) request.length = StatedTime::parse(*options.exposure, "exposure");
  if (request.every && request.every->number.numerator <= 0) {
    throw UsageError(format("--every '{}' is not longer than nothing", *options.every));
  }
  if (request.every && request.every->counts_samples() && request.every->number.denominator != 1) {
    throw UsageError(format("--every {} is not a whole number of pictures", *options.every));
  }
  return request;
}

}  // namespace

int run_contact(const Options& options) {
  const Stopwatch stopwatch;
  const ContactRequest request = contact_request(options);
  const sheet::SheetWishes wishes = sheet_wishes(options);
  const std::filesystem::path output = sheet_output(options, "contact", "contact");
  const std::string& input = options.operands.front();
  check_sheet_output(output, input_files(options));

  Session session = open_session(input, options);
  const Shape& shape = session.format().shape;
  const std::vector<Exposure> exposures = exposures_of(request, session.timeline());
  const sheet::SheetLayout layout =
      sheet::lay_out(shape, static_cast<std::uint32_t>(exposures.size()), wishes);
  const std::string length = options.exposure ? *options.exposure : "one picture";
  sheet::ContactSheet sheet(layout, format("{}: {} of {}", std::filesystem::path(input).filename().string(),
                                           counted(exposures.size(), "exposure"), length));
  PlanOptions plan_options;
  plan_options.function_name = "the exposure";
  SheetExposures exposing(options, session, Mask::uniform(shape.width, shape.height, 0), plan_options);
  const std::vector<std::string> labels = labels_of(exposures, session.timeline());
  SharedWarnings warnings;
  {
    Progress progress("exposing", exposures.size(), options.quiet);
    for (std::size_t i = 0; i < exposures.size(); ++i) {
      progress.show(i);
      FunctionSet functions;
      functions.emplace(0, GainFunction::boxcar(exposures[i].start_ns, exposures[i].end_ns));
      const ExposedPicture exposed = exposing.expose(functions);
      warnings.add(labels[i], exposure_warnings(exposed));
      sheet.add(labels[i], exposed.picture, exposing.transfer());
    }
  }
  warnings.print();
  write_picture(output, sheet.finished());

  if (options.json) {
    Json json{{"sheet", output.string()}, {"columns", layout.columns}, {"rows", layout.rows}};
    json["exposures"] = Json::array();
    for (const Exposure& exposure : exposures) {
      const std::int64_t end_ns = std::min(exposure.end_ns, session.timeline().duration_ns());
      json["exposures"].push_back({{"start_ns", exposure.start_ns}, {"end_ns", end_ns}});
    }
    add_saturation(json, exposing.tally().saturation(), exposing.type());
    print_json(json);
    return 0;
  }
  if (ended_quietly(options, output)) return 0;
  print_line(format("{}: {} of {}, {}, {}{}, {:.2f} s on {}", output.string(),
                    counted(exposures.size(), "exposure"), length, counted(layout.columns, "column"),
                    counted(layout.rows, "row"),
                    saturation_text(exposing.tally().saturation(), exposing.type()), stopwatch.seconds(),
                    session.devices().renderer().name()));
  print_details(options, exposing.tally(), source_lines(session));
  return 0;
}

}  // namespace nutik::app
