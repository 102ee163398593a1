#include <algorithm>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <set>
#include <sstream>
#include <utility>

#include "app/command_line/command_line.hpp"
#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/report.hpp"
#include "app/run.hpp"
#include "app/words/stated_requests.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "features/schema/option.hpp"
#include "features/schema/options.hpp"
#include "features/series/picture_queue.hpp"
#include "features/series/series_making.hpp"
#include "session/text/number_text.hpp"
#include "session/text/shell_text.hpp"
#include "system/input_bytes.hpp"

namespace nutik::app {
namespace {

// A line of the list: an exposure as it would be asked for on the command line.
struct ListedExposure {
  std::size_t line;  // from 1 on
  std::string text;
};

std::vector<ListedExposure> read_list(const std::string& name) {
  constexpr std::size_t kMaxBytes = 16 << 20;  // some hundred thousand lines
  std::vector<ListedExposure> exposures;
  std::istringstream lines(text_up_to(name, kMaxBytes));
  std::string text;
  for (std::size_t line = 1; std::getline(lines, text); ++line) {
    if (line == 1 && text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);  // Windows' editors write it
    if (!text.empty() && text.back() == '\r') text.pop_back();
    const auto start = text.find_first_not_of(" \t");
    if (start != std::string::npos && text[start] != '#') exposures.push_back({line, text});
  }
  return exposures;
}

// The options of one line, with those of the whole batch. `capture`, if any, is the operand that lines leave out.
Options line_options(const std::string& text, const Options& batch, const std::optional<std::string>& capture) {
  std::vector<std::string> words = shell_words(text);
  for (const std::string& word : words) {
    if (word == "--help" || word == "-h" || word == "--version" || word == "-V" || word.starts_with("--help=")) {
      throw UsageError(format("{} is no exposure; see nutik-cl expose --help", word));
    }
  }
  words.insert(words.begin(), "expose");
  Options options = parse_command_line(words).options;
  if (options.frames) throw UsageError("--frames chooses lines of the list: nutik-cl batch --frames 1-100 …");
  const bool stated_transfer = options.has("transfer");
  for (const Option& option : schema()) {
    if (option.is_shared_by_batch() && option.is_in(options)) {
      const std::string* value = option.stated(options);
      throw UsageError(format("{0} holds for all exposures: nutik-cl batch {0}{1} …", option.name(),
                              value != nullptr ? " " + *value : ""));
    }
    // What a line leaves open.
    if (option.is_in(batch) && !option.is_in(options))
      option.state(options, option.name(), batch.find(option.long_name)->words);
  }
  if (stated_transfer && batch.noise) {
    throw UsageError(format("--transfer holds for all exposures where --noise does, whose light it tells: "
                            "nutik-cl batch --transfer {} …", options.text("transfer")));
  }
  if (options.every || options.count) {
    throw UsageError("--every and --count make a series; a line of a batch is one picture");
  }
  if (capture) {
    if (options.operands.size() > 1) {
      throw UsageError(format("'{}' is one file too many: all lines expose {}, and name a picture only",
                              options.operands[1], *capture));
    }
    options.operands.insert(options.operands.begin(), *capture);
  }
  return options;
}

// Tells what is wrong with one picture, and goes on.
template <typename Work, typename Tell>
void unless_wrong(const Work& work, const Tell& tell) {
  try {
    work();
  } catch (const UsageError& error) {
    tell(error);
  } catch (const InputError& error) {
    tell(error);
  } catch (const ImpreciseError& error) {
    tell(error);
  }
}

class Batch {
 public:
  Batch(const Options& options, const std::string& list_name, std::size_t exposures)
      : options_(options),
        list_title_(input_title(list_name)),
        reads_list_from_input_(is_standard_input(list_name)),
        devices_(make_devices(options)),
        exposures_(exposures),
        pictures_([this](Channel<PictureJob>& jobs) {
          while (const auto job = jobs.pop()) {
            try {
              job->write();
            } catch (const OutputError& error) {
              report(job->number, error);
            } catch (const UsageError& error) {
              report(job->number, error);
            }
          }
        }) {
    devices_->start();
  }

  // Takes the inputs of all lines before the first of them is exposed: no picture replaces what another line reads.
  void know_inputs(const ListedExposure& listed, const std::optional<std::string>& capture_name) {
    try {
      Options line = line_options(listed.text, options_, capture_name);
      const std::string capture = line.operands.empty() ? std::string() : line.operands.front();
      if (std::exchange(last_capture_, capture) == capture) line.operands.clear();  // it may be a folder of many stills
      for (const std::string& input : input_files(line)) line_of_input_.try_emplace(led_to(input), listed.line);
    } catch (const Error&) {  // reported when the line is exposed
    }
  }

  void expose(const ListedExposure& listed, const std::optional<std::string>& capture_name) {
    reported(listed.line, [&] {
      Options line = line_options(listed.text, options_, capture_name);
      if (reads_list_from_input_ && reads_standard_input(line)) {
        throw UsageError("standard input holds the list already; name a file for functions and mask");
      }
      const ExposureRequest request = exposure_request(line);
      const std::filesystem::path output = output_name(line, "expose", "-" + exposure_label(line) + ".png");
      if (names_standard_output(output)) {
        throw UsageError("standard output takes one picture, and a batch makes many; name a file");
      }
      const auto check = [&] { check_output(output, OutputKind::picture, input_files(line), replacing(line)); };
      if (!is_writable(listed.line, check)) return;
      if (const auto reader = line_of_input_.find(led_to(output)); reader != line_of_input_.end()) {
        throw UsageError(format("{} is an input of line {}; choose another name", output.string(), reader->second));
      }
      const auto [earlier, is_new] = line_of_output_.try_emplace(led_to(output), listed.line);
      if (!is_new) throw UsageError(format("{} is written by line {} already", output.string(), earlier->second));
      const BoundsMaps maps(line, false, "a picture");
      if (maps.are_asked()) {
        const auto [its, is_first] = line_of_output_.try_emplace(led_to(maps.of(0)), listed.line);
        if (!is_first && its->second != listed.line)
          throw UsageError(format("{} is written by line {} already", maps.of(0).string(), its->second));
      }
      if (line.skip_existing) {
        require_recipes(line, output);
        if (is_made(output, stated_precision(line), maps.of(0),
                    [&](const std::string& precision) { return recipe_text(line, precision); })) {
          ++skipped_;
          return;
        }
      }
      const auto check_map = [&] { maps.check(0, input_files(line), output, replacing(line)); };
      if (!is_writable(listed.line, check_map)) return;
      Session& session = session_of(line.operands.front());
      const OutputFormat format = output_format(line.picture, output, session.format());
      waiting_.push_back({listed.line, line, output, maps});
      line_->add([&session, request, format](const RenderControl& control) {
        Made made;
        unless_wrong([&] { made.exposed = session.render(request, format, control); },
                     [&](const Error&) { made.error = std::current_exception(); });
        return made;
      });
      if (line_->is_full()) hand_on();
    });
  }

  // After the last one: how many of the exposures failed.
  [[nodiscard]] std::size_t finish() {
    hand_on_all();
    pictures_.finish();
    return failed_lines_.size();
  }

  [[nodiscard]] const ExposureTally& tally() const { return tally_; }
  // How many were there already, and whether one could not be written.
  [[nodiscard]] std::size_t skipped() const { return skipped_; }
  [[nodiscard]] bool failed_to_write() const { return failed_to_write_; }
  // Whether one may err by more than --strict allows.
  [[nodiscard]] bool was_imprecise() const { return was_imprecise_; }
  // The lines whose pictures are missing. After finish().
  [[nodiscard]] const std::set<std::size_t>& failed_lines() const { return failed_lines_; }
  // Those that were made, in the order of the list.
  [[nodiscard]] const Json& pictures() const { return exposures_told_; }
  // What each clip was taken for.
  [[nodiscard]] const Json& clips() const { return clips_; }
  // After an exposure that did not fail.
  [[nodiscard]] std::string renderer_name() const { return devices_->renderer().name(); }

 private:
  // A line whose picture is being made.
  struct Waiting {
    std::size_t number;
    Options line;
    std::filesystem::path output;
    BoundsMaps maps;
  };
  // Its picture, or what is wrong with it, which stops no other.
  struct Made {
    std::optional<ExposedPicture> exposed;
    std::exception_ptr error;
  };

  // The oldest. Throws what ends the list: DeviceError, Interrupted …
  void hand_on() {
    const Waiting oldest = std::move(waiting_.front());
    waiting_.pop_front();
    Made made = line_->take();
    reported(oldest.number, [&] {
      if (made.error) std::rethrow_exception(made.error);
      write(oldest, std::move(*made.exposed));
    });
  }
  void hand_on_all() {
    while (!waiting_.empty()) hand_on();
  }

  void write(const Waiting& waiting, ExposedPicture exposed) {
    const auto& [number, line, output, maps] = waiting;
    std::optional<Recipe::Input> map;
    if (!is_writable(number, [&] { map = waiting.maps.write(0, exposed); })) return;
    tally_.add(exposed);
    Json told{{"line", number}, {"picture", output.string()}};
    if (maps.are_asked()) told["bounds_map"] = maps.of(0).string();
    told["precision"] = tally_.precision();
    told.update(uncertainty_json(exposed.uncertainty, exposed.output));
    exposures_told_.push_back(std::move(told));
    for (const std::string& warning : exposure_warnings(exposed))
      print_warning(format("{}:{}: {}", list_title_, number, warning));
    if (options_.verbose && !options_.json) print_line(format("{}: {}", output.string(), tally_.report()));
    const FileWishes wishes = file_wishes(line.picture);
    tally_.wrote(exposed.figures.capture,
                 written_shape(output, exposed.picture.shape, exposed.picture.pixel_aspect, wishes), output);
    if (!pictures_.push({number, output, std::move(exposed.picture),
                         recipe_text(line, tally_.precision(), tally_.error_bound(), map), wishes}))
      pictures_.finish();  // throws
  }

  std::string recipe_text(const Options& line, const std::string& precision, const std::string& error_bound = {},
                          const std::optional<Recipe::Input>& bounds_map = {}) {
    auto sources = recipe_sources(line);
    if (!sources) return {};
    const std::string& name = sources->capture;
    if (!capture_checksum_ || capture_checksum_->first != name)
      capture_checksum_ = {name, capture_checksum(name, sources->made)};
    sources->capture_checksum = capture_checksum_->second;
    return PictureRecipe(std::move(sources)).text(precision, {}, error_bound, bounds_map);
  }

  // Any line may ask for floating point.
  static constexpr auto widest = [](const CaptureFormat&) { return ValueType::light32; };

  // Lines mostly expose one capture, or one after another: the last one stays open.
  Session& session_of(const std::string& name) {
    if (!session_ || session_->source().path != name) {
      hand_on_all();
      line_.reset();
      session_.reset();
      session_.emplace(open_session(name, options_, devices_, {.besides = PictureQueue::needs(widest)}));
      line_.emplace(session_->pictures_at_once(widest({}), exposures_));
      Answer source{{{"capture", name}}};
      source.tell_source(*session_);
      source.json["notes"] = source.notes;
      if (session_->is_clip()) clips_.push_back(source.json);
      if (!options_.json) tell(options_, name, source, true);
    }
    return *session_;
  }

  // Reports a line's file that cannot be written, which stops no other.
  bool is_writable(std::size_t line, const std::function<void()>& work) {
    try {
      work();
      return true;
    } catch (const OutputError& error) {
      report(line, error);
      return false;
    }
  }
  void reported(std::size_t line, const std::function<void()>& work) {
    unless_wrong(work, [&](const Error& error) { report(line, error); });
  }
  // From either thread.
  void report(std::size_t line, const Error& error) {
    const std::lock_guard lock(reporting_);
    failed_lines_.insert(line);
    failed_to_write_ |= dynamic_cast<const OutputError*>(&error) != nullptr;
    was_imprecise_ |= dynamic_cast<const ImpreciseError*>(&error) != nullptr;
    print_error(format("{}:{}: {}", list_title_, line, message_text(error, Dialect::command_line)));
  }

  const Options& options_;
  std::string list_title_;
  bool reads_list_from_input_;
  std::shared_ptr<Devices> devices_;
  ExposureTally tally_;
  std::optional<std::pair<std::string, std::string>> capture_checksum_;  // of the capture that a recipe was last for
  std::size_t skipped_ = 0;
  bool failed_to_write_ = false, was_imprecise_ = false;
  std::size_t exposures_;
  std::optional<Session> session_;
  std::deque<Waiting> waiting_;  // what is in line
  std::optional<PictureLine<Made>> line_;
  Json clips_ = Json::array(), exposures_told_ = Json::array();
  std::map<std::filesystem::path, std::size_t> line_of_input_, line_of_output_;
  std::string last_capture_;
  std::mutex reporting_;
  std::set<std::size_t> failed_lines_;
  PictureQueue pictures_;
};

}  // namespace

int run_batch(const Options& options) {
  if (options.operands.empty() || options.operands.size() > 2) {
    throw UsageError(
        "batch takes a list of exposures and, if they share one, a capture: nutik-cl batch list.txt clip.tik");
  }
  const std::string& list = options.operands.front();
  const auto capture = options.operands.size() == 2 ? std::optional(options.operands[1]) : std::nullopt;
  std::vector<ListedExposure> exposures = read_list(list);
  if (exposures.empty()) throw InputError(format("{} lists no exposure", list));
  if (options.frames) {
    const FrameRanges& lines = *options.frames;
    const std::vector<std::uint64_t> chosen = lines.below(exposures.back().line + 1);
    std::erase_if(exposures, [&](const ListedExposure& each) {
      return !std::ranges::binary_search(chosen, static_cast<std::uint64_t>(each.line));
    });
    if (exposures.empty()) throw UsageError(format("{} lists no exposure in lines {}", list, lines.text()));
  }

  Batch batch(options, list, exposures.size());
  for (const ListedExposure& each : exposures) batch.know_inputs(each, capture);
  Progress progress("exposing", exposures.size(), options.quiet, progress_lines(options));
  for (std::size_t i = 0; i < exposures.size(); ++i) {
    progress.show(i);
    batch.expose(exposures[i], capture);
  }
  const std::size_t failed = batch.finish();
  const std::size_t done = exposures.size() - failed;
  const double seconds = batch.tally().seconds();
  if (options.json) {
    Json json{{"exposures", exposures.size()}, {"failed_lines", batch.failed_lines()}, {"skipped", batch.skipped()}};
    json.update(batch.tally().saturation_json());
    json.update(batch.tally().uncertainty_json());
    json.update({{"pictures", batch.pictures()},
                 {"clips", batch.clips()},
                 {"seconds", seconds},
                 {"notes", batch.tally().notes()},
                 {"warnings", printed_warnings()}});
    print_json(json);
  } else if (!options.quiet) {
    const std::size_t made = done - batch.skipped();
    print_line(format("{} of {}{}{}, {:.2f} s, {:.1f} exposures a second{}", done,
                      counted(exposures.size(), "picture"),
                      batch.skipped() > 0 ? format(", {} there already", batch.skipped()) : "",
                      batch.tally().saturation_text(), seconds, static_cast<double>(made) / seconds,
                      made > 0 ? " on " + batch.renderer_name() : std::string()));
    print_notes(batch.tally().notes());
  }
  return failed == 0               ? ExitStatus::ok
         : batch.failed_to_write() ? ExitStatus::output
         : batch.was_imprecise()   ? ExitStatus::imprecise
                                   : ExitStatus::other;
}

}  // namespace nutik::app
