// nutik-cl: a process that runs one command line.
#include <sys/resource.h>

#include <cstddef>

#include "app/output/console.hpp"
#include "app/run.hpp"
#include "session/devices.hpp"
#include "system/interruption.hpp"
#include "system/mapped_file.hpp"
#include "system/output_file.hpp"
#include "system/own_folders.hpp"

namespace {

// Drivers and decoders take more than 64 kB; without it they crash.
bool has_stack() {
  constexpr rlim_t kLeastStack = 256 << 10;
  rlimit stack{};
  return getrlimit(RLIMIT_STACK, &stack) != 0 || stack.rlim_cur >= kLeastStack;
}

}  // namespace

int main(int argc, char** argv) {
  if (!has_stack()) {
    nutik::app::print_error("the stack may have less than 256 kB; raise its limit: ulimit -s 8192");
    return nutik::app::ExitStatus::memory;
  }
  nutik::catch_interruptions();
  nutik::catch_limits();
  nutik::watch_mapped_files();
  nutik::do_one_work();
  nutik::prepare_for_pocl();
  nutik::use_own_fonts();
  return nutik::app::run({argv, static_cast<std::size_t>(argc)});
}
