#include "working.hpp"

#include "session/below/error.hpp"
#include "system/mapped_file.hpp"

namespace nutik::python {

ReportedProgress Stopping::progress() const {
  return [stop = stop](std::uint64_t, std::uint64_t) {
    if (stop.stop_requested()) throw Cancelled();
  };
}

std::optional<py::error_already_set> wait_for(const std::function<bool()>& is_done,
                                              std::stop_source& stopping) {
  std::optional<py::error_already_set> raised;
  const py::gil_scoped_release released;
  while (!is_done()) {
    const py::gil_scoped_acquire locked;
    if (!raised && PyErr_CheckSignals() != 0) {
      raised.emplace();
      stopping.request_stop();
    }
  }
  return raised;
}

void check_files() { check_mapped_files(); }

}  // namespace nutik::python
