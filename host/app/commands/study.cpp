#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "app/output/console.hpp"
#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/report.hpp"
#include "app/words/stated_requests.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"
#include "exposure/function_text.hpp"
#include "exposure/mask.hpp"
#include "features/plate/plate.hpp"
#include "features/schema/option.hpp"
#include "features/schema/options.hpp"
#include "features/study/study_shot.hpp"
#include "media/stills/netpbm.hpp"
#include "media/writers/picture_writer.hpp"
#include "media/writers/recipe.hpp"
#include "render/render_plan.hpp"
#include "session/output_check.hpp"
#include "session/requests/stated_moments.hpp"
#include "session/text/number_text.hpp"
#include "session/text/shell_text.hpp"
#include "system/checksum.hpp"
#include "system/input_bytes.hpp"
#include "system/is_absent.hpp"
#include "system/mapped_file.hpp"
#include "system/output_file.hpp"

namespace nutik::app {
namespace {

constexpr std::string_view kAboutCommands = "# What makes the same study by hand.\n";
constexpr std::string_view kAboutFunctions =
    "# The light of each part of the picture: M0, M1 and so on are values of the mask.\n";
constexpr std::string_view kAboutSums =
    "# As the study left them. Another one replaces none of these that was changed.\n";
constexpr std::string_view kUnfinished = "# This study was not finished: run it again.\n";
constexpr std::string_view kBeforeName = "# ";
constexpr std::string_view kPicture = "# the picture ";

std::string content_of(const std::filesystem::path& file) {
  return std::string(as_text(MappedFile(file).bytes()));
}

std::string sum_of(std::string_view content) { return format("{:016x}", checksum(content)); }

std::string name_of(const std::filesystem::path& file) { return shell_word(file.filename().string()); }

// Files' names, and what they may hold: of a study that was ended, as before or as after it.
using Sums = std::set<std::pair<std::string, std::string>>;

std::string notes_text(const Sums& sums, const std::string& picture) {
  std::string text = format("{}{}{}\n", kAboutSums, kPicture, picture);
  for (const auto& [name, sum] : sums) text += format("{}{} {}\n", kBeforeName, name, sum);
  return text;
}

// What the commands' text of an earlier study notes.
struct Noted {
  std::string text;     // of the commands
  std::string picture;  // its name
  Sums sums;

  // Notes nothing where there is no such text.
  explicit Noted(const std::filesystem::path& commands) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(commands, error)) return;
    const std::string all(InputBytes(commands.string()).text());
    const std::size_t notes = all.find(kAboutSums);
    if (!all.starts_with(kAboutCommands) || notes == std::string::npos) return;
    for (const std::string& line : parts_of(std::string_view(all).substr(notes + kAboutSums.size()), '\n')) {
      const std::size_t space = line.rfind(' ');
      if (line.starts_with(kPicture)) {
        picture = line.substr(kPicture.size());
      } else if (line.starts_with(kBeforeName) && space > kBeforeName.size()) {
        sums.emplace(line.substr(kBeforeName.size(), space - kBeforeName.size()), line.substr(space + 1));
      }
    }
    text = all.substr(0, notes);
    is_whole_ = sums.contains({name_of(commands), sum_of(text)}) && all == text + notes_text(sums, picture);
  }

  [[nodiscard]] bool knows(const std::filesystem::path& file) const {
    const auto found = sums.lower_bound({name_of(file), ""});
    return found != sums.end() && found->first == name_of(file);
  }
  [[nodiscard]] bool is_as_it_was(const std::filesystem::path& file, bool is_commands) const {
    return is_commands ? is_whole_ : sums.contains({name_of(file), sum_of(content_of(file))});
  }

 private:
  bool is_whole_ = false;  // the text itself
};

// The files of a study: its picture, and beside it what that was made with, to be changed by hand.
//
//   always:  what was changed by hand since, or is of no study, is not replaced unless asked. The commands' text knows
//            the others by their checksums, while a study is being written those of the study before as well: what a
//            process that was ended has left is replaced by the next
class StudyFiles {
 public:
  explicit StudyFiles(std::filesystem::path output)
      : picture(std::move(output)),
        mask(beside(".pgm")),
        functions(beside(".fn")),
        commands(beside(".txt")),
        is_alone_(names_standard_output(picture)) {}

  // A picture on standard output has nothing beside it.
  [[nodiscard]] bool is_alone() const { return is_alone_; }

  // Throws UsageError where a file is an input too, or may not be replaced.
  void check(std::span<const std::string> inputs, Replacing replacing) const {
    const Noted noted(is_alone_ ? std::filesystem::path() : commands);
    std::error_code error;
    const bool is_own = std::filesystem::is_regular_file(picture, error) && noted.is_as_it_was(picture, false);
    check_output(picture, OutputKind::picture, inputs, is_own ? Replacing::all : replacing);
    if (is_alone_) return;
    check_output(mask, OutputKind::mask, inputs);
    if (replacing == Replacing::all) check_output(functions, OutputKind::functions, {});
    for (const std::filesystem::path* file : {&mask, &functions, &commands}) {
      const std::string name = file->string();
      if (std::ranges::find(inputs, name) != inputs.end()) {
        throw UsageError(
            format("{} is also an input; it is not replaced. Choose another name for the picture", name));
      }
      if (is_absent(*file)) continue;
      if (replacing == Replacing::all && (file != &commands || !noted.text.empty())) continue;
      if (!std::filesystem::is_regular_file(*file, error) || !noted.knows(*file)) {
        throw UsageError(format(
            "{} exists and is of no study; it is not replaced. Choose another name for the picture, or {}", name,
            file == &commands ? "move it away" : "replace all with --overwrite"));
      }
      if (!noted.is_as_it_was(*file, file == &commands)) {
        throw UsageError(
            format("{} was changed since its study was made; it is not replaced. Choose another name for "
                   "the picture, or replace all with --overwrite",
                   name));
      }
    }
    const std::filesystem::path other = picture.parent_path() / noted.picture;
    if (replacing != Replacing::all && !noted.picture.empty() && noted.picture != name_of(picture) &&
        !is_absent(other)) {
      throw UsageError(
          format("{}, {} and {} are those of {}; they are not replaced. Choose another name for the picture, or "
                 "replace them with --overwrite",
                 mask.string(), functions.string(), commands.string(), other.string()));
    }
  }

  // Mask and functions, which the commands' text knows before they are there.
  void write_regions(const Picture& regions, std::string_view light) {
    const Noted noted(commands);
    const std::string mask_bytes = netpbm_text(regions);
    const std::string function_text = format("{}{}", kAboutFunctions, light);
    sums_ = {{name_of(mask), sum_of(mask_bytes)}, {name_of(functions), sum_of(function_text)}};
    // Known before they are there: whoever ends this in the middle leaves files of the old study or of this one.
    Sums both(sums_.begin(), sums_.end());
    both.insert(noted.sums.begin(), noted.sums.end());
    std::string text = noted.text.empty() ? std::string(kAboutCommands) : noted.text;
    if (!text.ends_with(kUnfinished)) text += kUnfinished;
    both.emplace(name_of(commands), sum_of(text));
    write_text(commands, text + notes_text(both, name_of(picture)));
    write_text(mask, mask_bytes);
    write_text(functions, function_text);
  }

  // The last, once the picture is there.
  void write_commands(std::string_view text) const {
    const std::string all = format("{}{}", kAboutCommands, text);
    Sums sums(sums_.begin(), sums_.end());
    if (sums.empty()) {  // no regions: those of an earlier study stay known
      sums = Noted(commands).sums;
      std::erase_if(sums, [&](const auto& sum) {
        return sum.first == name_of(commands) || sum.first == name_of(picture);
      });
    }
    sums.emplace(name_of(picture), sum_of(content_of(picture)));
    sums.emplace(name_of(commands), sum_of(all));
    write_text(commands, all + notes_text(sums, name_of(picture)));
  }

  std::filesystem::path picture, mask, functions, commands;

 private:
  [[nodiscard]] std::filesystem::path beside(const char* extension) const {
    std::filesystem::path path = picture;
    path.replace_extension(extension);
    if (path == picture) path.replace_filename(picture.stem().string() + "-mask" + extension);
    return path;
  }

  bool is_alone_;
  std::vector<std::pair<std::string, std::string>> sums_;  // of mask and functions, by name
};

std::string functions_text(const FunctionSet& functions) {
  std::string text;
  for (const auto& [tag, function] : functions) text += function_text(tag, function) + "\n";
  return text;
}

// Options that expose the same from the written files.
Options options_by_hand(const Options& options, const StudyFiles& files, StudyStyle style) {
  Options by_hand = options;
  const auto state = [&](std::string_view option, std::string word) {
    option_of(CommandId::expose, option)->restate(by_hand, {std::move(word)});
  };
  state("mask", not_an_option(files.mask.string()));
  state("functions", not_an_option(files.functions.string()));
  if (style != StudyStyle::slit && !options.feather) state("feather", format("{}px", kStudyFeatherCentipixels / 100));
  state("normalize", "integral");
  return by_hand;
}

// As if no samples were to be made between pictures.
void take_back_between(Options& options) {
  options.source.between.reset();
  std::erase_if(options.said, [](const Said& said) { return said.option == "between"; });
}

// What makes the same by hand.
std::string commands_text(const Options& options, const StudyFiles& files, const Study& study,
                          StudyStyle style) {
  const auto name = [](const std::filesystem::path& path) {
    return shell_word(not_an_option(path.string()));
  };
  const std::string capture = shell_word(not_an_option(options.operands.front()));
  if (style == StudyStyle::clean) {
    return format("nutik-cl background{} --overwrite \\\n  {} {}\n", stated_words(options, CommandId::background),
                  capture, name(files.picture));
  }
  std::string regions;
  const auto pixels = study.regions.mask.pixels_per_tag();
  for (const MaskStep& step : study.mask.steps) {
    if (const auto* grid = std::get_if<select::Grid>(&step.selection)) {
      regions += format(" --grid {}x{}", grid->columns, grid->rows);
    } else if (std::holds_alternative<select::Whole>(step.selection)) {
      regions += format(" --tag {} --fill", step.tag);
    } else if (pixels[step.tag] == 0) {
      continue;  // later ones cover it
    } else {
      regions += format(" \\\n  --tag {}", step.tag);
      if (const auto* both = std::get_if<select::Difference>(&step.selection)) {
        regions += format(" --difference {} {}", std::get<StatedTime>(both->before).text(),
                          std::get<StatedTime>(both->after).text());
      } else {
        const auto& subject = std::get<select::Subject>(step.selection);
        regions += format(" --{} {}", subject.is_without_shadow ? "body" : "subject", subject.at.text());
      }
      if (step.by_codes) regions += format(" --by {}", *step.by_codes);
    }
    for (const RegionChange& change : step.changes) regions += " " + change_words(change);
  }
  Options of_filmed = options;
  take_back_between(of_filmed);
  // A mask that is there may have been changed by hand.
  return format("[ -e {} ] || nutik-cl mask{}{} \\\n  {} {}\nnutik-cl{} --overwrite \\\n  {} {}\n", name(files.mask),
                stated_words(of_filmed, CommandId::mask), regions, capture, name(files.mask),
                stated_words(options_by_hand(options, files, style), CommandId::expose), capture,
                name(files.picture));
}

// Whose moment each is, and the mask's value of its region.
Json moments_json(const Study& study, const Timeline& timeline) {
  Json moments = Json::array();
  for (std::size_t i = 0; i < study.moments.size(); ++i) {
    const std::uint64_t sample = study.moments[i];
    Json moment{{"sample", sample}, {"start_ns", timeline.start_ns(sample)}};
    moment["mask"] = study.subjects.empty() ? i : i + 1;
    if (!study.subjects.empty()) moment["subject"] = study.subjects[i] + 1;
    moments.push_back(std::move(moment));
  }
  return moments;
}

// `the subject at 0 ns (0f), 1 s (30f)`; with several, `subject 1 at …; subject 2 at …`.
std::string moments_text(const Study& study, const Timeline& timeline) {
  if (study.moments.empty()) return "all of the time, exposed as one";
  if (study.subjects.empty()) {
    return format("the scene at {} moments, one in each strip", study.moments.size());
  }
  const bool is_single = study.subjects.back() == 0;
  std::string text;
  for (std::size_t i = 0; i < study.moments.size(); ++i) {
    const std::uint64_t sample = study.moments[i];
    if (i > 0 && study.subjects[i] == study.subjects[i - 1]) {
      text += ", ";
    } else {
      text += is_single ? "the subject at "
                        : format("{}subject {} at ", i == 0 ? "" : "; ", study.subjects[i] + 1);
    }
    text += format("{} ({})", duration_text(timeline.start_ns(sample)), stated_sample(sample, timeline).text());
  }
  return text;
}

void add_notes(Answer& answer, const PlannedStudy& planned, const Options& stated) {
  answer.tell_source(planned.session, stated);
  std::ranges::move(camera_notes(planned.moved), std::back_inserter(answer.notes));
  std::ranges::copy(planned.study.notes, std::back_inserter(answer.notes));
  std::ranges::move(note_texts(planned.notes, Dialect::command_line), std::back_inserter(answer.notes));
}

// `options` get what the clip is read with beside what was stated.
PlannedStudy planned_study(Options& options, const StudyRequest& request) {
  const std::shared_ptr<Devices> devices = make_devices(options);
  devices->start();
  PlannedStudy planned = plan_study(source_request(options, options.operands.front()), request,
                                    {devices, options.picture, [&](std::string what) {
                                       return progress_bar(std::move(what), options.quiet);
                                     }});
  print_warnings(planned.session.warnings());
  const auto state = [&](std::string_view option, std::string word) {
    option_of(CommandId::study, option)->restate(options, {std::move(word)});
  };
  if (planned.part) {
    state("from", format("{}f", planned.part->first));
    state("to", format("{}f", planned.part->last));
  }
  if (planned.aligned_to) {
    state("align", planned.session.capture().header().alignment->motion);
    if (*planned.aligned_to > 0) state("align-to", format("{}f", *planned.aligned_to));
  }
  if (planned.between) state("between", *planned.between);
  if (!planned.session.source().between) take_back_between(options);
  return planned;
}

}  // namespace

int run_study(const Options& stated) {
  Options options = stated;
  ExposureTally tally;
  const StudyRequest request = study_request(options);
  StudyFiles files(output_name(options, "study", "-study.png"));
  files.check(input_files(options), replacing(options));

  const std::string capture_name = options.operands.front();
  // A camera that corrects its exposure changes the whole scene, and nothing of it rests.
  if (!is_tik(capture_name)) option_of(CommandId::study, "deflicker")->restate(options, {});
  PlannedStudy planned = planned_study(options, request);
  Session& session = planned.session;
  const Study& study = planned.study;
  if (request.style == StudyStyle::clean) {
    const MadePlate plate =
        make_plate(session.capture(), capture_name, {},
                   output_format(options.picture, files.picture, session.format()),
                   session.devices().request().memory, progress_bar("reading", options.quiet));
    const FileWishes wishes = file_wishes(options.picture);
    write_picture(files.picture, plate.picture, {}, wishes);
    const Shape shape = written_shape(files.picture, plate.picture.shape, plate.picture.pixel_aspect, wishes);
    Answer answer{{{"picture", files.picture.string()}}};
    answer.json.update(shape_json(shape));
    answer.line = format("{}: {}, the scene without moving things, {} of the pixels uncertain", files.picture.string(),
                         shape_text(shape),
                         percent_text(plate.uncertain.pixel_count(), session.format().shape.pixel_count()));
    if (!files.is_alone()) {
      files.write_commands(commands_text(options, files, study, request.style));
      answer.json["commands"] = files.commands.string();
      answer.line += format("; {}: the command", files.commands.string());
    }
    answer.notes = square_notes(session.format(), shape);
    add_notes(answer, planned, stated);
    return tell(options, files.picture, answer);
  }
  const ExposedPicture exposed =
      session.render(study_exposure(study, request),
                     output_format(options.picture, files.picture, session.format()));
  tally.add(exposed);
  print_warnings(exposure_warnings(exposed));
  std::string recipe;  // names the files, where there are some
  if (!files.is_alone()) {
    files.write_regions(study.regions.mask.to_picture(), functions_text(study.functions));
    PictureRecipe by_hand(recipe_sources(options_by_hand(options, files, request.style)));
    recipe = by_hand.text(tally.precision(), {}, tally.error_bound());
  }
  const FileWishes wishes = file_wishes(options.picture);
  write_picture(files.picture, exposed.picture, recipe, wishes);
  const Shape shape = written_shape(files.picture, exposed.picture.shape, exposed.picture.pixel_aspect, wishes);
  tally.wrote(session.format(), shape, files.picture);

  Answer answer{{{"picture", files.picture.string()}}};
  answer.json.update(shape_json(shape));
  if (!files.is_alone()) {
    files.write_commands(commands_text(options, files, study, request.style));
    answer.json["mask"] = files.mask.string();
    answer.json["functions"] = files.functions.string();
    answer.json["commands"] = files.commands.string();
    answer.details.push_back(
        format("  {}, {}: the mask and the functions, to be changed by hand; {}: the commands",
               files.mask.string(), files.functions.string(), files.commands.string()));
  }
  answer.json["moments"] = moments_json(study, planned.timeline());
  answer.json["trail_strength"] = study.trail_strength;
  answer.line = format("{}: {}, {}", files.picture.string(), shape_text(shape),
                       moments_text(study, planned.timeline()));
  tally.end(answer, session, options.verbose);
  add_notes(answer, planned, stated);
  return tell(options, files.picture, answer);
}

}  // namespace nutik::app
