#include "system/interruption.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>

namespace nutik {
namespace {

bool is_now(int signal, void (*handler)(int)) {
  struct sigaction now {};
  return sigaction(signal, nullptr, &now) == 0 && now.sa_handler == handler;
}

// As under nohup: a Ctrl-C must not make the program one that a hang-up ends. In a process of its own, for signals
// are the whole process's.
TEST(Interruption, LeavesIgnoredSignalsIgnoredAfterAnother) {
  const auto interrupted_under_nohup = [] {
    std::signal(SIGHUP, SIG_IGN);
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    catch_interruptions();
    std::raise(SIGINT);
    const bool asked_twice = is_now(SIGINT, SIG_DFL) && is_now(SIGTERM, SIG_DFL);
    _exit(!asked_twice ? 1 : is_now(SIGHUP, SIG_IGN) ? 0 : 2);
  };
  EXPECT_EXIT(interrupted_under_nohup(), testing::ExitedWithCode(0), "");
}

// Nobody looks while an encoder finishes a film.
TEST(Interruption, SaysThatItTakesAWhile) {
  const auto interrupted_while_busy = [] {
    catch_interruptions();
    const TimeToEnd is_kept;
    std::raise(SIGINT);
    pause();  // until the timer is up
    _exit(0);
  };
  EXPECT_EXIT(interrupted_while_busy(), testing::ExitedWithCode(0), "^what is done is kept.*again: end now\n$");
}

}  // namespace
}  // namespace nutik
