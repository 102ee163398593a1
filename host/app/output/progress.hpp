// A progress bar on stderr, shown only where that is a terminal and a command takes longer than a moment.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "session/reported_progress.hpp"

namespace nutik::app {

class Progress {
 public:
  // `total` steps, 0 where it is not known; `what` stands before the bar.
  Progress(std::string what, std::uint64_t total, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(std::uint64_t done);

 private:
  using Clock = std::chrono::steady_clock;

  std::string what_;
  std::uint64_t total_;
  bool enabled_;
  bool shown_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_;
};

// The same for what the session does: the bar is there from the first report on, and gone with the last copy of this.
[[nodiscard]] ReportedProgress progress_bar(std::string what, bool quiet);

}  // namespace nutik::app
