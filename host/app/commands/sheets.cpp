// Exposures on a sheet: of one moment after another, or of one exposure that is varied.
#include <algorithm>
#include <array>
#include <functional>
#include <optional>

#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/report.hpp"
#include "app/words/stated_requests.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "features/schema/options.hpp"
#include "features/sheets/sheet_request.hpp"
#include "media/writers/picture_writer.hpp"
#include "media/writers/recipe.hpp"
#include "session/text/number_text.hpp"
#include "sheet/contact_sheet.hpp"
#include "system/output_file.hpp"

namespace nutik::app {
namespace {

constexpr const char* kNoRecipe =
    "it carries no recipe: neither a plain interval in the capture nor a function file, which has no jumps, "
    "says its gains";

// What is exposed for a sheet: every picture is what expose would write at the capture's own depth.
struct SheetRequest {
  struct Exposed {
    std::string label;
    FunctionSet functions;
  };

  std::string heading;
  std::vector<Exposed> exposures;
  Mask mask;
  PlanOptions plan;
  sheet::SheetWishes wishes;
};

// What a sheet takes while it is drawn, if it is no higher than wide.
NeedsOfFormat sheet_needs(const sheet::SheetWishes& wishes) {
  constexpr std::uint64_t kPixelBytes = 8;  // on the canvas and in the picture
  const std::uint64_t width = wishes.width.value_or(sheet::kDefaultWidth);
  return [bytes = kPixelBytes * width * width](const CaptureFormat&) {
    return MemoryNeeds{{"the sheet", bytes}};
  };
}

// A sheet of one capture, from the command line to the answer.
class SheetJob {
 public:
  using Each =
      std::function<void(std::size_t number, const ExposedPicture& exposed, SharedWarnings& warnings)>;

  // `behind` ends the name of a sheet that nobody named: clip-contact.png.
  SheetJob(const Options& options, RecipeOf of, const std::string& behind)
      : options_(options),
        of_(of),
        output_(output_name(options, to_text(of), behind)),
        inputs_(input_files(options)),
        codes_(options.picture) {
    check_picture_output(output_, /*channels=*/3, inputs_, replacing(options));
    check_quality(codes_, output_);
  }

  [[nodiscard]] const std::filesystem::path& output() const { return output_; }
  [[nodiscard]] const std::vector<std::string>& inputs() const { return inputs_; }
  [[nodiscard]] const ExposureTally& tally() const { return tally_; }
  [[nodiscard]] const OutputRequest& wishes() const { return codes_; }
  [[nodiscard]] std::string heading(const std::string& of) const {
    return format("{}: {}", std::filesystem::path(options_.operands.front()).filename().string(), of);
  }

  // `each` is told every picture beside that. Returns the exit status.
  int run(Session& session, SheetRequest request, const std::string& counted_as, std::string_view key,
          Json exposures, const Each& each = {}) {
    request.plan.transfer = options_.source.clip.transfer;
    PictureRecipe recipe(recipe_sources(options_, of_));
    const CaptureFormat& capture = session.format();
    const std::size_t count = request.exposures.size();
    const sheet::SheetLayout layout =
        sheet::lay_out(capture.shown_shape(), static_cast<std::uint32_t>(count), request.wishes);
    const OutputFormat format_of_each = output_format(codes_, {}, code_type(capture), capture);
    sheet::ContactSheet sheet(layout, request.heading);
    {
      WarningsAtEnd warnings;
      const ReportedProgress progress = progress_bar("exposing", options_.quiet);
      for (std::size_t i = 0; i < count; ++i) {
        if (progress) progress(i, count);
        const auto& [label, functions] = request.exposures[i];
        const ExposedPicture exposed = session.render(functions, request.mask, request.plan, format_of_each);
        sheet.add(label, exposed.picture);
        tally_.add(exposed);
        warnings.add(label, exposure_warnings(exposed));
        if (each) each(i, exposed, warnings);
      }
    }
    // With `auto` each of its pictures has an arithmetic of its own.
    write_picture(output_, sheet.finished(), recipe.text(options_.text("precision", "auto")), file_wishes(codes_));
    const auto columns = layout.columns, rows = layout.rows;
    Answer answer{{{"sheet", output_.string()}, {"columns", columns}, {"rows", rows}}};
    answer.json[key] = std::move(exposures);
    answer.line = format("{}: {}, {}, {}", output_.string(), counted_as, counted(columns, "column"),
                         counted(rows, "row"));
    if (options_.each) {
      tally_.wrote(capture, written_shape(*options_.each, capture.shape, capture.pixel_aspect, file_wishes(codes_)),
                   *options_.each);
    }
    tally_.end(answer, session, options_.verbose);
    answer.tell_source(session);
    return tell(options_, output_, answer);
  }

 private:
  const Options& options_;
  RecipeOf of_;
  std::filesystem::path output_;
  std::vector<std::string> inputs_;
  OutputRequest codes_;
  ExposureTally tally_;
};

// Names for the single pictures; empty where none are asked for.
std::vector<std::filesystem::path> single_names(const Options& options, std::size_t count,
                                                std::span<const std::string> inputs,
                                                const std::filesystem::path& sheet) {
  std::vector<std::filesystem::path> names;
  if (!options.each) return names;
  const PictureNames numbered(*options.each, "--each");
  for (std::size_t i = 0; i < count; ++i) {
    names.push_back(numbered[i]);
    check_output(names.back(), OutputKind::picture, inputs, replacing(options));
    if (led_to(names.back()) == led_to(sheet)) {
      throw UsageError(
          format("--each names a picture {} and the sheet is {}; choose another name for one of them",
                 names.back().string(), sheet.string()));
    }
  }
  return names;
}

// `shift_ns`, `gain_factor`, and its value at a point.
std::pair<std::string, Json> varied_json(const SweepRange& range, std::uint64_t point) {
  if (range.parameter == SweepParameter::shift && !range.counts_pictures)
    return {"shift_ns", range.shift_ns(point)};
  const Rational value = range.value(point);
  if (range.parameter == SweepParameter::shift) return {"shift_samples", value.numerator};
  return {range.parameter == SweepParameter::gain ? "gain_factor" : "stretch_factor", value.value()};
}

sheet::SheetWishes sheet_wishes(const Options& options) {
  sheet::SheetWishes wishes;
  wishes.columns = options.columns;
  wishes.width = options.width;
  return wishes;
}

}  // namespace

int run_contact(const Options& options) {
  const ContactRequest contact{options.start.value_or(StatedTime()), options.every, options.exposure};
  SheetRequest request;
  request.wishes = sheet_wishes(options);
  SheetJob job(options, RecipeOf::contact, "-contact.png");
  Session session = open_session(options, {.besides = sheet_needs(request.wishes)});
  const Timeline& timeline = session.timeline();
  const std::vector<Exposure> exposures = exposures_of(contact, timeline);
  const std::vector<std::string> labels = labels_of(exposures, timeline);
  const std::string what =
      format("{} of {}", counted(exposures.size(), "exposure"), options.text("exposure", "one picture"));
  request.heading = job.heading(what);
  request.mask = Mask::uniform(session.format().shape.width, session.format().shape.height, 0);
  request.plan.function_name = "the exposure";
  Json json = Json::array();
  for (std::size_t i = 0; i < exposures.size(); ++i) {
    const auto& [start_ns, end_ns] = exposures[i];
    request.exposures.push_back({labels[i], {{0, GainFunction::boxcar(start_ns, end_ns)}}});
    json.push_back({{"start_ns", start_ns}, {"end_ns", std::min(end_ns, timeline.duration_ns())}});
  }
  return job.run(session, std::move(request), what, "exposures", std::move(json));
}

int run_sweep(const Options& options) {
  const SweepRequest sweep = sweep_request(options);
  const std::vector<SweepPoint> points = sweep.points();
  SheetRequest sheet;
  sheet.wishes = sheet_wishes(options);
  if (sweep.ranges.size() == 2) {
    if (sheet.wishes.columns)
      throw UsageError("two ranges make rows and columns by themselves; leave out --columns");
    sheet.wishes.columns = static_cast<std::uint32_t>(sweep.ranges.front().count());
  }
  if (options.operands.empty()) throw UsageError("an input is missing; see nutik-cl sweep --help");
  const ExposureRequest request = exposure_request(options);
  const std::string label = exposure_label(options);
  SheetJob job(options, RecipeOf::sweep, "-" + label + "-sweep.png");
  const std::vector<std::filesystem::path> singles =
      single_names(options, points.size(), job.inputs(), job.output());

  Session session = open_session(options, {.besides = sheet_needs(sheet.wishes)});
  const Timeline& timeline = session.timeline();
  const Shape& shape = session.format().shape;
  for (const std::filesystem::path& single : singles)
    check_picture_output(single, shape.channels, job.inputs(), replacing(options));
  const std::string what = counted(points.size(), "picture");
  const std::string shown =
      options.functions ? label : format("{} from {} on", options.text("exposure"), options.text("start", "0s"));
  sheet.heading = job.heading(format("{}, {}", shown, what));
  sheet.mask = mask_of(request, shape);
  sheet.plan = plan_options_of(request, shape);
  Json json = Json::array();
  for (std::size_t i = 0; i < points.size(); ++i) {
    sheet.exposures.push_back({sweep.label(points[i]), sweep.varied(request, points[i], timeline)});
    Json& picture = json.emplace_back(Json::object());
    for (std::size_t r = 0; r < sweep.ranges.size(); ++r) {
      const auto [key, value] = varied_json(sweep.ranges[r], points[i][r]);
      picture[key] = value;
    }
    if (!singles.empty()) picture["file"] = singles[i].string();
  }

  PictureRecipe recipe(singles.empty() ? std::nullopt : recipe_sources(options));  // of single pictures
  const auto write_single = [&](std::size_t i, const ExposedPicture& exposed, SharedWarnings& warnings) {
    if (singles.empty()) return;
    const auto own =
        own_exposure(sheet.exposures[i].functions, request, timeline, singles[i].stem().string() + ".fn");
    if (!own && !options.no_recipe) warnings.add(singles[i].string(), std::array{std::string(kNoRecipe)});
    write_picture(singles[i], exposed.picture,
                  own ? recipe.text(job.tally().precision(), own_recipe(*own), job.tally().error_bound()) : "",
                  file_wishes(job.wishes()));
  };
  return job.run(session, sheet, what, "pictures", std::move(json), write_single);
}

}  // namespace nutik::app
