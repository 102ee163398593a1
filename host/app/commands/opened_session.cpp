#include "app/commands/opened_session.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "app/output/console.hpp"
#include "app/output/progress.hpp"
#include "app/requests/requests.hpp"
#include "app/text/timing_text.hpp"
#include "session/format.hpp"

namespace nutik::app {

Session open_session(const Options& options, Session::Terms terms) {
  const std::shared_ptr<Devices> devices = make_devices(options);
  devices->start();
  return open_session(options.operands.front(), options, devices, std::move(terms));
}

Session open_session(const std::string& name, const Options& options, std::shared_ptr<Devices> devices,
                     Session::Terms terms) {
  terms.progress = progress_bar("reading", options.quiet);
  Session session(source_request(options, name), std::move(devices), terms);
  print_warnings(session.warnings());
  return session;
}

std::vector<std::string> source_lines(const Session& session) {
  if (!session.is_clip()) return {};
  std::vector<std::string> lines = fact_lines(session.facts());
  std::ranges::move(note_lines(session.notes(), session.timeline(), session.source()),
                    std::back_inserter(lines));
  return lines;
}

std::vector<std::string> camera_notes(const std::optional<MovedCamera>& moved) {
  if (!moved) return {};
  return {format("note: {}; --align rigid moves the clip's pictures back when it is read or encoded", moved->text())};
}

void print_source(const Session& session, const Options& options) {
  if (!options.quiet) print_notes(source_lines(session));
}

}  // namespace nutik::app
