#include "app/output/ending.hpp"

#include "app/output/console.hpp"

namespace nutik::app {

bool ended_quietly(const Options& options, const std::filesystem::path& output) {
  return ended_quietly(options, output, options.output.has_value() || options.operands.size() > 1);
}

bool ended_quietly(const Options& options, const std::filesystem::path& output, bool was_named) {
  if (options.quiet && !was_named) print_line(output.string());
  return options.quiet;
}

void print_details(const Options& options, const Exposer& exposer, std::span<const std::string> notes) {
  if (const std::string report = exposer.report(); options.verbose && !report.empty()) print_line(report);
  for (const std::string& note : notes) print_note(note);
}

void add_rendering(Json& json, const Exposer& exposer, const Stopwatch& stopwatch) {
  json["precision"] = exposer.precision();
  json["renderer"] = exposer.renderer_name();
  json["seconds"] = stopwatch.seconds();
}

}  // namespace nutik::app
