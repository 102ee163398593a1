// Which call a preloaded library lets fail.
//
//   NUTIK_FAIL_CALL     the kind of call
//   NUTIK_FAIL_AT       which of them, from 1 on; 0: none
//   NUTIK_FAIL_ERROR    with which error; "kill": the process ends there, by SIGKILL
//   NUTIK_FAIL_AFTER    "on": all that follow fail as well, as on a full disk
//   NUTIK_FAIL_REPORT   a file that the number of calls so far is written to
#pragma once

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace nutik::test {

// Nothing here allocates: malloc() may be the call that asks.
struct FaultSettings {
  const char* call = std::getenv("NUTIK_FAIL_CALL");
  const char* report = std::getenv("NUTIK_FAIL_REPORT");
  const char* at = std::getenv("NUTIK_FAIL_AT");
  const char* error = std::getenv("NUTIK_FAIL_ERROR");
  const char* after = std::getenv("NUTIK_FAIL_AFTER");
};

// The program may end without its destructors: so the number is written at every call, past the functions that a
// library puts in the place of others.
inline void report_calls(const char* path, long number) {
  const auto file = static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, O_CREAT | O_WRONLY, 0666));
  char text[24];
  const int length = std::snprintf(text, sizeof text, "%20ld\n", number);
  syscall(SYS_pwrite64, file, text, length, 0);
  syscall(SYS_close, file);
}

// Counts a call. Returns the error that it is to fail with, `usual` where none was chosen; 0: it is not to fail.
inline int fault_of(const char* call, int usual) {
  static const FaultSettings wanted;
  static constinit std::atomic<long> calls{0};
  if (wanted.call == nullptr || std::strcmp(call, wanted.call) != 0) return 0;
  const long number = ++calls;
  if (wanted.report != nullptr) report_calls(wanted.report, number);
  const long at = wanted.at == nullptr ? 0 : std::atol(wanted.at);
  const bool goes_on = wanted.after != nullptr && std::strcmp(wanted.after, "on") == 0;
  if (at == 0 || number < at || (number > at && !goes_on)) return 0;
  if (wanted.error != nullptr && std::strcmp(wanted.error, "kill") == 0) kill(getpid(), SIGKILL);
  return wanted.error == nullptr ? usual : std::atoi(wanted.error);
}

}  // namespace nutik::test
