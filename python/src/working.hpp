// Work that takes long, away from Python's lock.
//
//   in:      what is to be done, on a thread of its own
//   out:     what it returns or throws
//   always:  Python's other threads go on meanwhile. At the interpreter's end work is stopped. Ctrl-C stops it and
//            becomes KeyboardInterrupt, which only Python's main thread hears; nothing of a stopped piece of work is
//            left running. Python's code is called on the thread that waits, as the caller's own: who wants to be told
//            of progress, and an iterable. What that raises stops the work, too
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <utility>

#include "capture/error.hpp"
#include "system/channel.hpp"
#include "system/interruption.hpp"
#include "system/mapped_file.hpp"

namespace nutik::python {

namespace py = pybind11;

// How far a piece of work has come, of how many steps (0: not known).
struct Steps {
  std::atomic<std::uint64_t> done = 0, total = 0;
};

// Python's code that a piece of work needs while a thread waits for it.
class Calls {
 public:
  // On the work's threads: has that thread call it, with Python's lock. Throws Cancelled where the work is stopped.
  void make(const std::function<void()>& call, const std::stop_token& stop);
  // On the thread that waits, without Python's lock: makes calls for 50 ms. Whether the work has ended. What a call
  // throws stops the work and comes through.
  bool serve(std::stop_source& stopping);
  // The work has ended.
  void close();

 private:
  std::mutex mutex_;
  std::condition_variable_any changed_;
  const std::function<void()>* wanted_ = nullptr;
  bool is_closed_ = false;
};

// What a piece of work looks at to end early, tells how far it is, and has called.
struct Stopping {
  std::stop_token stop;
  std::shared_ptr<Steps> steps;
  std::shared_ptr<Calls> calls;
  // Throws Cancelled where it is told of progress after Ctrl-C.
  [[nodiscard]] ReportedProgress progress() const;
};

// Without Python's lock for as long as it lives. Once the interpreter ends, no thread but the ending one comes back:
// Python would end the thread within our frames, and with it the process. It sleeps until the process is gone.
class Unlocked {
 public:
  Unlocked();
  ~Unlocked();
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

 private:
  std::optional<py::gil_scoped_release> released_;
};
// Python calls it at its end, before it takes threads their lock: asks all work to stop, and waits for it.
void end_work();

// Waits without Python's lock until the work has ended, and makes its calls; asks for a stop at Ctrl-C. Calls
// told(done, total), unless that is None, when steps were done, and at the end. Throws what a signal's handler or one
// of these calls raised.
void wait_for(const Stopping& work, std::stop_source& stopping, const py::object& told);
// Calls work(Stopping) and returns what that does.
template <typename Work>
auto without_lock(Work work, const py::object& progress = py::none()) {
  { const Unlocked sleeps_at_the_end; }
  if (!progress.is_none()) py::module_::import("nutik._words").attr("check_progress")(progress);
  const MappedLosses losses = losses_so_far();
  std::stop_source source;
  const Stopping stopping{source.get_token(), std::make_shared<Steps>(), std::make_shared<Calls>()};
  auto future = std::async(std::launch::async, [&] {
    const ClosedAtEnd ended(*stopping.calls);
    return work(stopping);
  });
  wait_for(stopping, source, progress);
  check_mapped_files(losses);  // what it made, or seems damaged, may be of a file that changed under our hands
  return future.get();
}

}  // namespace nutik::python
