#include "system/interruption.hpp"

#include <atomic>
#include <csignal>

namespace nutik {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};

// The only mutable global of the program: a signal handler can reach nothing else. It is written in the
// handler and read in every thread, which needs an atomic without a lock.
std::atomic<int> noted_signal{0};
static_assert(std::atomic<int>::is_always_lock_free);

void note(int number) {
  noted_signal.store(number, std::memory_order_relaxed);
  // Whoever asks twice means now. A signal that was ignored before stays ignored.
  for (const int signal : kSignals) {
    struct sigaction now {};
    if (sigaction(signal, nullptr, &now) == 0 && now.sa_handler == note) std::signal(signal, SIG_DFL);
  }
}

const char* name_of(int number) {
  switch (number) {
    case SIGINT: return "interrupted";
    case SIGTERM: return "terminated";
    default: return "hung up";
  }
}

}  // namespace

Interrupted::Interrupted(int number) : Error(name_of(number)), signal(number) {}

void catch_interruptions() {
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

void check_interruption() {
  if (const int number = noted_signal.load(std::memory_order_relaxed)) throw Interrupted(number);
}

void clear_interruption() { noted_signal.store(0, std::memory_order_relaxed); }

}  // namespace nutik
