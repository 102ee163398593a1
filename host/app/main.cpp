// nutik-cl: the one place that turns errors into messages and exit statuses.
#include <sys/resource.h>

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
#include "session/devices.hpp"
#include "system/interruption.hpp"
#include "system/mapped_file.hpp"
#include "system/output_file.hpp"

namespace {

enum ExitStatus { kOk = 0, kOther = 1, kUsage = 2, kInput = 3, kDevice = 4, kOutput = 5, kMemory = 6, kSignal = 128 };

int fail(const std::exception& error, ExitStatus status) {
  nutik::app::print_error(nutik::message_text(error, nutik::Dialect::command_line));
  return status;
}

// What seems damaged may be a file that changed under our hands.
int fail_input(const nutik::InputError& error) {
  try {
    nutik::check_mapped_files();
  } catch (const nutik::InputError& lost) {
    return fail(lost, kInput);
  }
  return fail(error, kInput);
}

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
    return kMemory;
  }
  nutik::catch_interruptions();
  nutik::catch_limits();
  nutik::watch_mapped_files();
  nutik::do_one_work();
  nutik::prepare_for_pocl();
  try {
    const std::vector<std::string> words(argv + 1, argv + argc);
    nutik::app::ParsedCommandLine parsed = nutik::app::parse_command_line(words);
    parsed.options.program = argv[0];
    if (nutik::app::writes_to_standard_output(parsed.options)) nutik::app::keep_lines_from_output();
    const int status = parsed.command == nullptr ? kOk : parsed.command->run(parsed.options);
    // A file was looked at before it got its name. Text that was printed is told to be wrong now.
    if (!nutik::has_kept_output()) nutik::check_mapped_files();
    nutik::app::flush_output();
    return status;
  } catch (const nutik::UsageError& error) {
    return fail(error, kUsage);
  } catch (const nutik::InputError& error) {
    return fail_input(error);
  } catch (const nutik::DeviceError& error) {
    return fail(error, kDevice);
  } catch (const nutik::OutputError& error) {
    return fail(error, kOutput);
  } catch (const nutik::Interrupted& interruption) {
    nutik::app::print_error(interruption.what());
    return kSignal + interruption.signal;
  } catch (const std::bad_alloc&) {
    nutik::app::print_error("out of memory");
    return kMemory;
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::resource_unavailable_try_again) return fail(error, kOther);
    nutik::app::print_error("the system starts no more threads; raise the limit of processes (ulimit -u, or that of the "
                            "container), or end other programs");
    return kMemory;
  } catch (const std::exception& error) {
    return fail(error, kOther);
  }
}
