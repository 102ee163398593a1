// What commands tell at their end: people in lines, scripts with --json in one JSON object on standard output.
//
// Keys are in snake_case with the unit in the name (`live_start_ns`), and keep the order in which they were added.
#pragma once

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "app/output/console.hpp"
#include "features/schema/options.hpp"
#include "session/session.hpp"
#include "session/text/shared_warnings.hpp"

namespace nutik::app {

using Json = nlohmann::ordered_json;

// Text that is no UTF-8, a file name for example, is shown with U+FFFD in place of its bytes.
void print_json(const Json& json);

[[nodiscard]] Json shape_json(const Shape& shape);  // `width`, `height`, `channels`
// A capture's facts: `fact`, and `option`, the one of retime that states otherwise, where there is one.
[[nodiscard]] Json facts_json(const std::vector<std::string>& lines);

class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// `120 pictures a second (--fps), shutter 180 degrees (--shutter-angle)`: what times were made from.
[[nodiscard]] std::string timing_text(std::span<const Fact> facts);

struct Answer {
  Json json;
  std::string line = {};
  std::vector<std::string> details = {};  // more lines
  std::vector<std::string> source = {};   // lines of what a clip was taken for, which json has as `facts`
  std::vector<std::string> notes = {};    // whole sentences

  // What a clip was taken for, each with who said it, and what else a person should know of it.
  void tell_source(const std::vector<Fact>& facts, const std::vector<Note>& more);
  void tell_source(const Session& session);  // where it was made from a clip
  // The same; what `stated` lacks the command has chosen.
  void tell_source(const Session& session, const Options& stated);
};

// Prints it as --json and -q ask; returns the exit status. With -q only an output's name that nobody stated is printed;
// `was_named` says so where neither -o nor a second operand tells.
int tell(const Options& options, const std::filesystem::path& output, const Answer& answer);
int tell(const Options& options, const std::filesystem::path& output, const Answer& answer, bool was_named);

// `uncertainty`, of a picture in this format.
[[nodiscard]] Json uncertainty_json(const Uncertainty& uncertainty, const OutputFormat& output);

// What is said of one exposure, or of many together, since it is there.
class ExposureTally {
 public:
  void add(const ExposedPicture& exposed);
  // The size that its pictures were written in, and the name of the last one; empty: they are a film's.
  void wrote(const CaptureFormat& capture, const Shape& written, const std::filesystem::path& picture);

  // The last one's arithmetic, by the name that asks for it, and what rendering it did and took, in lines.
  [[nodiscard]] const std::string& precision() const { return precision_; }
  [[nodiscard]] const std::string& report() const { return report_; }
  // What that may be off by; empty of the reference.
  [[nodiscard]] const std::string& error_bound() const { return error_bound_; }
  [[nodiscard]] double seconds() const { return stopwatch_.seconds(); }

  // `, no pixel below 0 or above 1`, and so on; `saturated_below_pixels` and `saturated_above_pixels`. Nothing where
  // all pictures hold light.
  [[nodiscard]] std::string saturation_text() const;
  [[nodiscard]] Json saturation_json() const;
  // That of the picture whose bounds are the largest.
  [[nodiscard]] Json uncertainty_json() const { return app::uncertainty_json(worst_, worst_output_); }
  // That codes to be seen end at white, where those of the capture go on behind it; square_notes() of the last one;
  // what a picture's file does not name.
  [[nodiscard]] std::vector<std::string> notes() const;

  // Ends an answer with that and with what the exposures were made with; `rate` is put before the seconds.
  void end(Answer& answer, Session& session, bool verbose, const std::string& rate = {}) const;

 private:
  Stopwatch stopwatch_;
  Saturation saturation_;
  bool has_codes_ = false;
  std::optional<Transfer> brighter_than_white_;  // what the capture may hold, if codes cut that off, or light keeps it
  std::vector<std::string> squared_;
  std::string unnamed_;
  std::string precision_, renderer_, report_, error_bound_;
  Uncertainty worst_;
  OutputFormat worst_output_, output_;  // of the last one
};

// That pixels were made square, where the size that was written is not the capture's.
[[nodiscard]] std::vector<std::string> square_notes(const CaptureFormat& capture, const Shape& written);

// Warnings of many exposures, printed when this goes: of those that were made before an error, too.
struct WarningsAtEnd : SharedWarnings {
  ~WarningsAtEnd() { print_warnings(lines()); }
};

// What to tell about an exposure, whole sentences: its warnings, and what codes cannot hold.
[[nodiscard]] std::vector<std::string> exposure_warnings(const ExposedPicture& exposed);

// `, still gain M0 1, M128 0.25`, or without a tag for a plain interval.
[[nodiscard]] std::string still_gains_text(const ExposureFigures& figures, bool plain);

// What an exposure reads and leaves out, and why, for -v: whole lines, without a line end behind the last.
[[nodiscard]] std::string plan_text(const ExposureFigures& figures);

// The functions for scripts.
[[nodiscard]] Json functions_json(const ExposureFigures& figures);

}  // namespace nutik::app
