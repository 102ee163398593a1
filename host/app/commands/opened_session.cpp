#include "app/commands/opened_session.hpp"

#include <utility>

#include "app/output/console.hpp"
#include "app/output/progress.hpp"
#include "app/requests/requests.hpp"
#include "session/below/format.hpp"

namespace nutik::app {

Session open_session(const Options& options, Session::Terms terms) {
  const std::shared_ptr<Devices> devices = make_devices(options);
  devices->start();
  return open_session(options.operands.front(), options, devices, std::move(terms));
}

Session open_session(const std::string& name, const Options& options, std::shared_ptr<Devices> devices,
                     Session::Terms terms) {
  terms.progress =
      progress_bar("reading", options.quiet, options.progress ? ProgressLines::before : ProgressLines::none);
  Session session(source_request(options, name), std::move(devices), terms);
  print_warnings(session.warnings());
  return session;
}

std::vector<std::string> camera_notes(const std::optional<MovedCamera>& moved) {
  if (!moved) return {};
  return {
      format("{}; --align rigid moves the clip's pictures back when it is read or encoded", moved->text())};
}

}  // namespace nutik::app
