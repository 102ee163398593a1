#include <utility>

#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/report.hpp"
#include "app/words/stated_requests.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "features/schema/options.hpp"
#include "media/writers/picture_writer.hpp"
#include "session/clips/encoding.hpp"
#include "session/text/number_text.hpp"
#include "session/text/shell_text.hpp"
#include "system/is_absent.hpp"
#include "system/output_file.hpp"

namespace nutik::app {
namespace {

// A folder that was made, and goes again if nothing is written to it.
struct MadeFolder {
  MadeFolder() = default;
  MadeFolder(const MadeFolder&) = delete;
  MadeFolder& operator=(const MadeFolder&) = delete;
  ~MadeFolder() {
    std::error_code error;
    if (!folder.empty()) std::filesystem::remove(folder, error);
  }

  std::filesystem::path folder = {};
};

// What is written of a camera's path beside a capture.
class CameraFiles {
 public:
  // Throws UsageError where one of them may not be written.
  CameraFiles(const Options& options, const std::filesystem::path& capture, std::vector<std::string> inputs)
      : folder_(options.align_report),
        table_(options.camera_path),
        plot_(options.camera_plot),
        coverage_(options.coverage) {
    if (folder_) {
      const std::filesystem::path folder = *folder_;
      std::error_code error;
      // What is written there says where it is not.
      if (std::filesystem::create_directory(folder, error)) made_.folder = folder;
      if (!table_) table_ = (folder / "path.csv").string();
      if (!plot_) plot_ = (folder / "plot.png").string();
      if (!coverage_) coverage_ = (folder / "coverage.png").string();
    }
    constexpr std::uint32_t kColour = 3;
    inputs.push_back(capture.string());  // no two outputs of one name either
    if (table_) check_output(*table_, OutputKind::table, inputs, replacing(options));
    if (plot_) check_picture_output(*plot_, kColour, inputs, replacing(options));
    if (plot_) inputs.push_back(*plot_);
    if (coverage_) check_picture_output(*coverage_, 1, inputs, replacing(options));
  }

  // Writes what was asked for, and adds the path to an answer.
  void write(const CameraPath& path, const Timeline& timeline, const std::string& heading, Answer& answer) const {
    const std::string named[] = {table_.value_or(""), plot_.value_or(""), coverage_.value_or("")};
    if (table_) write_text(*table_, camera_path_text(path));
    if (plot_) write_picture(*plot_, camera_chart(heading, path, timeline));
    if (coverage_) write_picture(*coverage_, coverage_of(path));
    const CameraPath::Furthest furthest = path.furthest();
    const auto residual = path.residual_pixels();
    answer.json["camera"] = {{"motion", to_text(path.motion)},
                             {"reference", path.reference},
                             {"furthest_picture", furthest.picture},
                             {"furthest_pixels", {furthest.way.x, furthest.way.y}},
                             {"turned_degrees", path.step(path.max_turned()).degrees},
                             {"residual_pixels", residual ? Json(*residual) : Json()}};
    const char* const keys[] = {"path", "plot", "coverage"};
    for (std::size_t i = 0; i < std::size(keys); ++i) {
      if (!named[i].empty()) answer.json["camera"][keys[i]] = named[i];
    }
  }

 private:
  std::optional<std::string> folder_, table_, plot_, coverage_;
  MadeFolder made_;
};

}  // namespace

int run_encode(const Options& options) {
  const Stopwatch stopwatch;
  const std::filesystem::path output = output_name(options, "encode", ".tik");
  const std::string& input = options.operands.front();
  const SourceRequest source = clip_request(options, input);
  if (!is_absent(input) && is_tik(input)) {
    throw UsageError(
        format("{} is a capture already; to expose a picture from it: nutik-cl --start 0s "
               "--exposure 10ms {} picture.png",
               input, shell_word(input)));
  }
  check_output(output, OutputKind::tik, input_files(options), replacing(options));
  const CameraFiles camera_files(options, output, input_files(options));

  const EncodedCapture encoded = encode(source, {output, options.codec}, memory_budget(options),
                                        progress_bar("encoding", options.quiet, progress_lines(options)));
  print_warnings(encoded.warnings);
  const Shape& shape = encoded.capture.shape;
  const Timeline& timeline = encoded.timeline;
  const std::uint64_t raw_bytes = encoded.capture.sample_bytes() * timeline.sample_count();
  const double seconds = stopwatch.seconds();
  Answer answer{{{"capture", output.string()}}};
  answer.json.update(shape_json(shape));
  answer.json.update({{"samples", timeline.sample_count()},
                      {"samples_a_second", timeline.rate().text()},
                      {"shutter_angle_degrees", timeline.shutter_angle().text()},
                      {"duration_ns", timeline.duration_ns()},
                      {"file_bytes", encoded.file_bytes},
                      {"raw_bytes", raw_bytes},
                      {"seconds", seconds}});
  answer.line = format("{}: {}, {}, {}, {} of {} raw, {:.2f} s", output.string(), shape_text(shape),
                       counted(timeline.sample_count(), "sample"), timing_text(encoded.facts),
                       bytes_text(encoded.file_bytes), bytes_text(raw_bytes), seconds);
  answer.tell_source(encoded.facts, encoded.notes);
  answer.source.erase(answer.source.begin());  // of times, which the line above has
  answer.details = std::exchange(answer.source, {});
  if (encoded.camera) camera_files.write(**encoded.camera, timeline, input, answer);
  return tell(options, output, answer);
}

}  // namespace nutik::app
