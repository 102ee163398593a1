#include "working.hpp"

#include <unistd.h>

#include <exception>
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

void Calls::make(const std::function<void()>& call, const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, stop, [&] { return wanted_ == nullptr; });
  if (stop.stop_requested()) throw Cancelled();
  wanted_ = &call;
  changed_.notify_all();
  changed_.wait(lock, stop, [&] { return wanted_ != &call; });
  if (stop.stop_requested()) throw Cancelled();
}

bool Calls::serve(std::stop_source& stopping) {
  constexpr std::chrono::milliseconds kAtOnce(50);
  const auto until = std::chrono::steady_clock::now() + kAtOnce;
  const auto is_wanted = [&] { return wanted_ != nullptr && !stopping.stop_requested(); };
  std::unique_lock lock(mutex_);
  while (std::chrono::steady_clock::now() < until && !is_over() &&
         changed_.wait_until(lock, until, [&] { return is_closed_ || is_wanted(); }) && !is_closed_) {
    lock.unlock();
    try {
      const py::gil_scoped_acquire locked;
      (*wanted_)();
    } catch (...) {
      stopping.request_stop();
      throw;
    }
    lock.lock();
    wanted_ = nullptr;
    changed_.notify_all();
  }
  return is_closed_;
}

void Calls::close() {
  const std::scoped_lock lock(mutex_);
  is_closed_ = true;
  changed_.notify_all();
}

void wait_for(const Stopping& work, std::stop_source& stopping, const py::object& told) {
  std::exception_ptr raised;
  const auto guarded = [&](const auto& call) {
    try {
      call();
    } catch (...) {
      raised = std::current_exception();
      stopping.request_stop();
    }
  };
  std::uint64_t last = 0;
  const auto tell = [&] {
    const std::uint64_t done = work.steps->done;
    if (raised || told.is_none() || done == last) return;
    last = done;
    guarded([&] { told(done, work.steps->total.load()); });
  };
  {
    const Unlocked released;
    for (bool has_ended = false; !has_ended;) {
      guarded([&] { has_ended = work.calls->serve(stopping); });
      // While the end waits for this thread: Python would end it within what it calls, and our frames with it.
      if (is_over()) {
        stopping.request_stop();
        continue;
      }
      const py::gil_scoped_acquire locked;
      if (!raised && !has_ended) guarded([] { if (PyErr_CheckSignals() != 0) throw py::error_already_set(); });
      tell();
    }
  }
  if (raised) std::rethrow_exception(raised);
}

}  // namespace nutik::python
