#include "working.hpp"

namespace nutik::python {

ReportedProgress Stopping::progress() const {
  return [stop = stop, steps = steps](std::uint64_t done, std::uint64_t total) {
    if (stop.stop_requested()) throw Cancelled();
    steps->total = total;
    steps->done = done;
  };
}

std::optional<py::error_already_set> wait_for(const std::function<bool()>& is_done,
                                              std::stop_source& stopping, const Steps& steps,
                                              const py::object& told) {
  std::optional<py::error_already_set> raised;
  std::uint64_t last = 0;
  const auto tell = [&] {
    const std::uint64_t done = steps.done;
    if (raised || told.is_none() || done == last) return;
    last = done;
    try {
      told(done, steps.total.load());
    } catch (py::error_already_set& error) {
      raised.emplace(std::move(error));
      stopping.request_stop();
    }
  };
  {
    const py::gil_scoped_release released;
    while (!is_done()) {
      const py::gil_scoped_acquire locked;
      if (!raised && PyErr_CheckSignals() != 0) {
        raised.emplace();
        stopping.request_stop();
      }
      tell();
    }
  }
  tell();
  return raised;
}

}  // namespace nutik::python
