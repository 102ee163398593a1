#include "app/run.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "app/command_line/command_line.hpp"
#include "app/output/console.hpp"
#include "app/output/output_name.hpp"
#include "capture/error.hpp"
#include "features/schema/option.hpp"
#include "system/interruption.hpp"
#include "system/mapped_file.hpp"
#include "system/output_file.hpp"
#include "system/own_folders.hpp"

namespace nutik::app {
namespace {

int fail(const std::exception& error, int status) {
  print_error(message_text(error, Dialect::command_line));
  return status;
}

// What seems damaged may be a file that changed under our hands.
int fail_input(const InputError& error) {
  try {
    check_mapped_files();
  } catch (const InputError& lost) {
    return fail(lost, ExitStatus::input);
  }
  return fail(error, ExitStatus::input);
}

// Drivers and decoders take more than 64 kB; without it they crash.
bool has_stack() {
  constexpr rlim_t kLeastStack = 256 << 10;
  rlimit stack{};
  return getrlimit(RLIMIT_STACK, &stack) != 0 || stack.rlim_cur >= kLeastStack;
}

// The next file that is opened gets the number of a closed standard stream, and then what is printed, too. What takes
// its place fails as a closed one does.
void hold_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) < 0) static_cast<void>(open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY));
  }
}

}  // namespace

int run(std::span<const char* const> words) {
  try {
    expect_anything();
    ParsedCommandLine parsed = parse_command_line(std::vector<std::string>(words.begin() + 1, words.end()));
    parsed.options.program = words.front();
    keep_lines_from_output(writes_to_standard_output(parsed.options));
    const int status = parsed.command == nullptr ? ExitStatus::ok : parsed.command->run(parsed.options);
    // Files are checked before they get their names; printed text can only be called wrong afterwards.
    if (!has_kept_output()) check_mapped_files();
    flush_output();
    return status;
  } catch (const UsageError& error) {
    return fail(error, ExitStatus::usage);
  } catch (const InputError& error) {
    return fail_input(error);
  } catch (const DeviceError& error) {
    return fail(error, ExitStatus::device);
  } catch (const OutputError& error) {
    return fail(error, ExitStatus::output);
  } catch (const ImpreciseError& error) {
    return fail(error, ExitStatus::imprecise);
  } catch (const Interrupted& interruption) {
    print_error(interruption.what());
    return ExitStatus::signal + interruption.signal;
  } catch (const std::bad_alloc&) {
    print_error("out of memory");
    return ExitStatus::memory;
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::resource_unavailable_try_again) return fail(error, ExitStatus::other);
    print_error(
        "the system starts no more threads; raise the limit of processes (ulimit -u, or that of the "
        "container), or end other programs");
    return ExitStatus::memory;
  } catch (const std::exception& error) {
    return fail(error, ExitStatus::other);
  }
}

int run_process(std::span<const char* const> words) {
  hold_standard_streams();
  if (!has_stack()) {
    print_error("the stack may have less than 256 kB; raise its limit: ulimit -s 8192");
    return ExitStatus::memory;
  }
  catch_interruptions();
  catch_limits();
  watch_mapped_files();
  do_one_work();
  prepare_for_pocl();
  use_own_fonts();
  return run(words);
}

}  // namespace nutik::app
