// Long work: it tells how far it is, and ends at a signal in good order. SIGINT (Ctrl-C), SIGTERM and SIGHUP set a
// flag, long loops look at it and throw, and what is thrown passes destructors that remove temporary files.
//
//   in:      a program's wishes to be interruptible and to leave nothing where it meets a limit, once, at its start
//   always:  without these wishes nothing here has any effect; a second signal ends the program at once. So does the
//            first where nobody looks for a while, inside a library for example; temporary files are removed all the
//            same
#pragma once

#include <cstdint>
#include <functional>

#include "capture/error.hpp"

namespace nutik {

// Called with how many steps are done of how many, 0 where that is not known, on any of the threads that do the work,
// never on two at once. May be empty. What it throws ends the work and comes back to the caller. Must not ask the
// devices that do the work: they wait for it.
using ReportedProgress = std::function<void(std::uint64_t done, std::uint64_t total)>;

struct Interrupted : Error {
  explicit Interrupted(int number);
  int signal;  // its number: a program ends with 128 + it
};

// From now on the first of these signals is noted instead of ending the program. One that is ignored
// (nohup, a shell's background job) stays ignored.
void catch_interruptions();

// From now on a file that grows past the limit of the shell (ulimit -f) is an error of who writes it, as on a full
// disk, instead of the end of the process by SIGXFSZ. Where nobody reads our output any more (SIGPIPE), or the time is
// up (SIGXCPU), the process ends by that signal as before, and leaves no temporary file. SIGPIPE that is ignored stays
// so.
void catch_limits();

// Throws Interrupted where a signal was noted. Costs one read of memory, so every loop may call it.
void check_interruption();

// Forgets a signal that was noted, for who has caught Interrupted and still has work to finish.
void clear_interruption();

// While one lives, a signal is answered when somebody looks, however long that takes: for work that is worth more
// than a quick answer.
class TimeToEnd {
 public:
  TimeToEnd();
  ~TimeToEnd();
  TimeToEnd(const TimeToEnd&) = delete;
  TimeToEnd& operator=(const TimeToEnd&) = delete;
};

}  // namespace nutik
