#include "working.hpp"

#include <unistd.h>

#include <condition_variable>
#include <mutex>
#include <thread>

namespace nutik::python {

namespace {

// All threads' work.
std::mutex working;
std::condition_variable has_ended;
std::size_t unlocked = 0;
std::optional<std::thread::id> ending;
const std::thread::id importing = std::this_thread::get_id();
bool others_work = false;  // threads but the one that loaded this

bool is_over() {
  const std::scoped_lock lock(working);
  return ending && *ending != std::this_thread::get_id();
}

}  // namespace

Unlocked::Unlocked() {
  released_.emplace();
  const std::scoped_lock lock(working);
  ++unlocked;
  others_work |= std::this_thread::get_id() != importing;
}

Unlocked::~Unlocked() {
  const auto leave = [] {
    const std::scoped_lock lock(working);
    --unlocked;
    has_ended.notify_all();
  };
  if (is_over()) {
    leave();
    while (true) pause();
  }
  released_.reset();
  leave();
}

void end_work() {
  constexpr std::chrono::seconds kLongest(10);  // for work that asks for no stop
  const py::gil_scoped_release released;
  std::unique_lock lock(working);
  ending = std::this_thread::get_id();
  has_ended.wait_for(lock, kLongest, [] { return unlocked == 0; });
  const bool waits = others_work;
  lock.unlock();
  // Threads between two calls come to their next one, where they sleep: Python ends those that wait for its lock within
  // its own frames, and may read there what it has freed.
  constexpr std::chrono::milliseconds kBetweenCalls(50);
  if (waits) std::this_thread::sleep_for(kBetweenCalls);
}

ReportedProgress Stopping::progress() const {
  return [stop = stop, steps = steps](std::uint64_t done, std::uint64_t total) {
    if (stop.stop_requested()) throw Cancelled();
    steps->total = total;
    steps->done = done;
  };
}

void wait_for(const std::function<bool()>& is_done, std::stop_source& stopping, const Steps& steps,
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
    const Unlocked released;
    while (!is_done()) {
      if (is_over()) {
        stopping.request_stop();
        continue;
      }
      const py::gil_scoped_acquire locked;
      if (!raised && PyErr_CheckSignals() != 0) {
        raised.emplace();
        stopping.request_stop();
      }
      tell();
    }
    // While the end waits for this thread: Python would end it within what it calls, and our frames with it.
    if (!is_over()) {
      const py::gil_scoped_acquire locked;
      tell();
    }
  }
  if (raised) throw *raised;
}

}  // namespace nutik::python
