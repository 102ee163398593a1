#include "app/commands/opened_session.hpp"

#include <utility>

#include "app/output/console.hpp"
#include "app/output/progress.hpp"
#include "app/requests/computing_words.hpp"
#include "app/requests/source_words.hpp"
#include "app/text/timing_text.hpp"
#include "session/format.hpp"

namespace nutik::app {

Session open_session(const std::string& name, const Options& options, std::shared_ptr<Devices> devices,
                     Reading reading) {
  Session session(source_request(options, name), std::move(devices),
                  {reading, progress_bar("reading", options.quiet), {}});
  for (const std::string& warning : session.warnings()) print_warning(warning);
  return session;
}

Session open_session(const std::string& name, const Options& options) {
  return open_session(name, options, make_devices(options));
}

std::vector<std::string> source_lines(const Session& session) {
  if (!session.is_clip()) return {};
  std::vector<std::string> lines = note_lines(session.notes(), session.timeline(), session.source());
  lines.insert(lines.begin(), format("source: {}", timing_text(session.timeline(), session.source())));
  return lines;
}

}  // namespace nutik::app
