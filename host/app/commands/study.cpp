#include <algorithm>
#include <iterator>

#include "app/commands/commands.hpp"
#include "app/commands/opened_session.hpp"
#include "app/output/console.hpp"
#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/report.hpp"
#include "app/requests/requests.hpp"
#include "app/text/message_text.hpp"
#include "session/below/error.hpp"
#include "session/below/format.hpp"
#include "session/below/functions.hpp"
#include "session/below/pictures.hpp"
#include "session/clips/clip_source.hpp"
#include "session/making/plate_request.hpp"
#include "session/making/study_shot.hpp"
#include "session/text/shell_text.hpp"
#include "session/text/size_text.hpp"
#include "session/text/time_text.hpp"
#include "system/output_file.hpp"

namespace nutik::app {
namespace {

constexpr std::string_view kAboutCommands = "# What makes the same study by hand.";
constexpr std::string_view kAboutFunctions =
    "# The light of each part of the picture: M0, M1 and so on are values of the mask.";

// The files of a study: its picture, and beside it what that was made with.
struct StudyFiles {
  explicit StudyFiles(const std::filesystem::path& output)
      : picture(output), mask(beside(".pgm")), functions(beside(".fn")), commands(beside(".txt")) {}

  [[nodiscard]] std::filesystem::path beside(const char* extension) const {
    std::filesystem::path path = picture;
    path.replace_extension(extension);
    if (path == picture) path.replace_filename(picture.stem().string() + "-mask" + extension);
    return path;
  }

  std::filesystem::path picture, mask, functions, commands;
};

std::string functions_text(const FunctionSet& functions) {
  std::string text;
  for (const auto& [tag, function] : functions) text += function_text(tag, function) + "\n";
  return text;
}

// The exposure by hand.
Options exposing(const Options& options, const StudyFiles& files, StudyStyle style) {
  Options by_hand = options;
  by_hand.mask = files.mask.string();
  by_hand.functions = files.functions.string();
  if (style != StudyStyle::slit) by_hand.feather = kStudyFeather;
  by_hand.normalize = "integral";
  return by_hand;
}

// What makes the same by hand.
std::string commands_text(const Options& options, const StudyFiles& files, const Study& study,
                          StudyStyle style) {
  const auto name = [](const std::filesystem::path& path) { return shell_word(path.string()); };
  const std::string capture = shell_word(options.operands.front());
  if (style == StudyStyle::clean) {
    return format("{}\nnutik-cl plate{} \\\n  {} {}\n", kAboutCommands,
                  stated_words(options, CommandId::plate), capture, name(files.picture));
  }
  std::string regions;
  for (const MaskStep& step : study.mask.steps) {
    if (const auto* grid = std::get_if<select::Grid>(&step.selection)) {
      regions += format(" --grid {}x{}", grid->columns, grid->rows);
    } else {
      regions += format(" \\\n  --tag {} --subject {}f", step.tag, study.moments[step.tag - 1U]);
    }
    for (const RegionChange& change : step.changes) regions += " " + change_words(change);
  }
  return format("{}\nnutik-cl mask{}{} \\\n  {} {}\nnutik-cl{} \\\n  {} {}\n", kAboutCommands,
                stated_words(options, CommandId::mask), regions, capture, name(files.mask),
                stated_words(exposing(options, files, style), CommandId::expose), capture,
                name(files.picture));
}

// What is written as text replaces an earlier study's, and nothing else.
void check_text(const std::filesystem::path& file, std::string_view begins,
                std::span<const std::string> inputs) {
  const bool is_input = std::ranges::find(inputs, file.string()) != inputs.end();
  if (!is_input && (!std::filesystem::exists(file) || begins.starts_with(first_bytes(file)))) return;
  throw UsageError(format("{} {}; it is not replaced. Choose another name for the picture", file.string(),
                          is_input ? "is also an input" : "exists and is of no study"));
}

void add_notes(Answer& answer, const PlannedStudy& planned) {
  answer.tell_source(planned.session);
  std::ranges::move(camera_notes(planned.moved), std::back_inserter(answer.notes));
  std::ranges::copy(planned.study.notes, std::back_inserter(answer.notes));
  std::ranges::move(note_texts(planned.notes), std::back_inserter(answer.notes));
}

// `options` get what the clip is read with beside what was stated.
PlannedStudy planned_study(Options& options, const StudyRequest& request) {
  const std::shared_ptr<Devices> devices = make_devices(options);
  devices->start();
  PlannedStudy planned = plan_study(source_request(options, options.operands.front()), request,
                                    {devices, output_request(options), [&](std::string what) {
                                       return progress_bar(std::move(what), options.quiet);
                                     }});
  print_warnings(planned.session.warnings());
  if (planned.shot) {
    options.clip_from = format("{}f", planned.shot->first);
    options.clip_to = format("{}f", planned.shot->last);
  }
  if (planned.aligned_to) {
    options.align = to_text(kStudyMotion);
    if (*planned.aligned_to > 0) options.align_to = format("{}f", *planned.aligned_to);
  }
  return planned;
}

}  // namespace

int run_study(const Options& stated) {
  Options options = stated;
  ExposureTally tally;
  const StudyRequest request = study_request(options);
  const StudyFiles files(output_name(options, "study", "-study.png"));
  std::vector<std::string> inputs = input_files(options);
  check_output(files.picture, OutputKind::picture, inputs);
  inputs.push_back(files.picture.string());
  check_mask_output(files.mask, inputs);
  check_text(files.functions, kAboutFunctions, inputs);
  check_text(files.commands, kAboutCommands, inputs);

  const std::string capture_name = options.operands.front();
  // A camera that corrects its exposure changes the whole scene, and nothing of it rests.
  options.deflicker |= !is_tik(capture_name);
  PlannedStudy planned = planned_study(options, request);
  Session& session = planned.session;
  Study& study = planned.study;
  if (request.style == StudyStyle::clean) {
    const MadePlate plate =
        make_plate(session.capture(), capture_name, {},
                   output_format(output_request(options), files.picture, session.format()),
                   session.devices().request().memory, progress_bar("reading", options.quiet));
    write_text(files.commands, commands_text(options, files, study, request.style));
    write_picture(files.picture, plate.picture, {}, file_wishes(output_request(options)));
    Answer answer{{{"picture", files.picture.string()}, {"commands", files.commands.string()}}};
    answer.line = format("{}: {}, the scene without moving things; {}: the command", files.picture.string(),
                         shape_text(plate.picture.shape), files.commands.string());
    add_notes(answer, planned);
    return tell(options, files.picture, answer);
  }
  const MadeMask made = make_regions(study, session.capture(), capture_name);
  const bool is_slit = request.style == StudyStyle::slit;
  const ExposedPicture exposed =
      session.render(study_exposure(study, request.style, made.mask),
                     output_format(output_request(options), files.picture, session.format()));
  tally.add(exposed);
  print_warnings(exposure_warnings(exposed));
  write_picture(files.mask, made.mask.to_picture());
  write_text(files.functions, format("{}\n{}", kAboutFunctions, functions_text(study.functions)));
  write_text(files.commands, commands_text(options, files, study, request.style));
  PictureRecipe recipe(recipe_sources(exposing(options, files, request.style)));
  write_picture(files.picture, exposed.picture, recipe.text(tally.precision()),
                file_wishes(output_request(options)));

  const Timeline& timeline = session.timeline();
  Answer answer{{{"picture", files.picture.string()},
                 {"mask", files.mask.string()},
                 {"functions", files.functions.string()},
                 {"commands", files.commands.string()},
                 {"moments", Json::array()},
                 {"trail_strength", study.trail_strength}}};
  std::string moments;
  for (const std::uint64_t sample : study.moments) {
    answer.json["moments"].push_back({{"sample", sample}, {"start_ns", timeline.start_ns(sample)}});
    moments +=
        format("{} {} ({}f)", moments.empty() ? "" : ",", duration_text(timeline.start_ns(sample)), sample);
  }
  if (is_slit) moments = format(" {} moments, one in each strip", study.moments.size());
  answer.line = format("{}: {}, {}{}", files.picture.string(), shape_text(exposed.picture.shape),
                       is_slit ? "the scene at" : "the subject at", moments);
  answer.details.push_back(
      format("  {}, {}: the mask and the functions, to be changed by hand; {}: the commands",
             files.mask.string(), files.functions.string(), files.commands.string()));
  tally.end(answer, session, options.verbose);
  add_notes(answer, planned);
  return tell(options, files.picture, answer);
}

}  // namespace nutik::app
