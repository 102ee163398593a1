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

void print_details(const Options& options, const ExposureTally& tally, std::span<const std::string> notes) {
  if (options.verbose && !tally.report().empty()) print_line(tally.report());
  for (const std::string& note : notes) print_note(note);
}

void add_rendering(Json& json, const Session& session, const ExposureTally& tally,
                   const Stopwatch& stopwatch) {
  json["precision"] = tally.precision();
  json["renderer"] = session.devices().renderer().name();
  json["seconds"] = stopwatch.seconds();
}

}  // namespace nutik::app
