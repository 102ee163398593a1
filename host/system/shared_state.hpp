// What signal handlers look at, whoever tells them, what outputs may replace, and whether one was kept: the only
// mutable globals. A program and the modules that it loads are each linked with a copy of this room, and use the
// program's.
#pragma once

#include <sys/stat.h>

#include <atomic>
#include <csignal>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace nutik {

struct KnownTemporary;
struct WatchedMapping;

struct SharedState {
  // A signal handler writes and every thread reads them, which needs atomics without locks.
  std::atomic<int> noted_signal{0};
  std::atomic<int> takes_its_time{0};  // works that must not be cut short
  std::atomic<bool> heeds_limits{false};  // catch_limits() was called

  // Lists that never get shorter, whose entries are used again. Who is no signal handler adds to them under a lock.
  std::atomic<WatchedMapping*> mappings{nullptr};
  std::mutex registering_mappings;  // guards both that follow
  std::uint64_t mapped_losses = 0;
  std::string last_lost_file;
  std::atomic<bool> is_one_work{false};
  std::atomic<bool> is_watching{false};  // an application has asked for it
  struct sigaction bus_action_before {};  // what is done where no file of ours was lost
  std::atomic<KnownTemporary*> temporaries{nullptr};
  std::mutex registering_temporaries;

  std::mutex expecting_outputs;
  std::map<std::string, std::optional<struct stat>> expected_outputs;  // by led_to() (system/output_file.hpp)
  std::atomic<bool> has_kept_output{false};
};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<WatchedMapping*>::is_always_lock_free);

[[nodiscard]] SharedState& shared_state();

// For a module, before anything else is asked of it.
void use_shared_state(SharedState& of_program);

}  // namespace nutik
