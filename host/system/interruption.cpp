#include "system/interruption.hpp"

#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstring>

#include "system/output_file.hpp"
#include "system/shared_state.hpp"

namespace nutik {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};

// Whether end_now() is in place. A timer calls it some time after the first signal, unless it was cleared.
std::atomic<bool> has_timer{false};

const char* name_of(int number) {
  switch (number) {
    case SIGINT: return "interrupted";
    case SIGTERM: return "terminated";
    default: return "hung up";
  }
}

void set_timer(long milliseconds) {
  if (!has_timer.load()) return;
  struct itimerval after {};
  after.it_value.tv_usec = milliseconds * 1000;
  setitimer(ITIMER_REAL, &after, nullptr);  // in a handler, too: here it only calls the system
}

// In a handler, too; below a progress bar.
void tell(const char* text) {
  for (const char* const part : {isatty(STDERR_FILENO) == 1 ? "\n" : "", text, "\n"})
    [[maybe_unused]] const auto told = write(STDERR_FILENO, part, std::strlen(part));
}

// Nobody has looked. What a signal handler may do is little, and enough.
void end_now(int) {
  const int number = shared_state().noted_signal.load();
  if (number == 0) return;
  if (shared_state().takes_its_time.load() > 0)
    return tell("what is done is kept, which takes a while; again: end now");
  remove_temporary_files();
  tell(name_of(number));
  constexpr int kSignalStatus = 128;
  _exit(kSignalStatus + number);
}

// Delivered once this has returned, with its usual end.
void end_without_temporaries(int number) {
  remove_temporary_files();
  std::signal(number, SIG_DFL);
  raise(number);
}

void note(int number) {
  constexpr long kPatienceMs = 800;
  shared_state().noted_signal.store(number, std::memory_order_relaxed);
  set_timer(kPatienceMs);
  // Whoever asks twice means now. A signal that was ignored before stays ignored.
  for (const int signal : kSignals) {
    struct sigaction now {};
    if (sigaction(signal, nullptr, &now) == 0 && now.sa_handler == note) std::signal(signal, SIG_DFL);
  }
}

}  // namespace

Interrupted::Interrupted(int number) : Error(name_of(number)), signal(number) {}

void catch_interruptions() {
  struct sigaction when_late {};
  when_late.sa_handler = end_now;
  when_late.sa_flags = SA_RESTART;
  sigemptyset(&when_late.sa_mask);
  has_timer = sigaction(SIGALRM, &when_late, nullptr) == 0;
  for (const int signal : kSignals) {
    struct sigaction before {};
    if (sigaction(signal, nullptr, &before) != 0 || before.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = note;
    action.sa_flags = SA_RESTART;  // what is read or written at that moment goes on
    sigemptyset(&action.sa_mask);
    for (const int other : kSignals) sigaddset(&action.sa_mask, other);
    sigaction(signal, &action, nullptr);
  }
}

void catch_limits() {
  shared_state().heeds_limits = true;
  // Where both limits of time are the same (ulimit -t), the system ends the process by the hard one, without a word.
  rlimit time{};
  if (getrlimit(RLIMIT_CPU, &time) == 0 && time.rlim_cur == time.rlim_max && time.rlim_max != RLIM_INFINITY &&
      time.rlim_max > 1) {
    --time.rlim_cur;
    setrlimit(RLIMIT_CPU, &time);
  }
  std::signal(SIGXFSZ, SIG_IGN);
  for (const int signal : {SIGPIPE, SIGXCPU}) {
    struct sigaction before {};
    if (sigaction(signal, nullptr, &before) != 0 || before.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = end_without_temporaries;
    sigemptyset(&action.sa_mask);
    sigaction(signal, &action, nullptr);
  }
}

void check_interruption() {
  if (const int number = shared_state().noted_signal.load(std::memory_order_relaxed))
    throw Interrupted(number);
}

void clear_interruption() {
  shared_state().noted_signal.store(0, std::memory_order_relaxed);
  set_timer(0);
}

TimeToEnd::TimeToEnd() { ++shared_state().takes_its_time; }
TimeToEnd::~TimeToEnd() { --shared_state().takes_its_time; }

}  // namespace nutik
