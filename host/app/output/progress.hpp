// How far a command is, on stderr: a bar where that is a terminal and the command takes longer than a moment; elsewhere
// a line every second, where that was asked for.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "features/schema/options.hpp"
#include "system/interruption.hpp"

namespace nutik::app {

// What is shown where stderr is no terminal. `Progress: 45%` begins a line of what a command is asked to do, for render
// farms to read; what it does before that has no such share.
enum class ProgressLines { none, before, main };

class Progress {
 public:
  // `total` steps, 0 where it is not known; `what` stands before the bar.
  Progress(std::string what, std::uint64_t total, bool quiet, ProgressLines lines = ProgressLines::none);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(std::uint64_t done);

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] std::string line_text(std::uint64_t done) const;
  [[nodiscard]] std::string rate_text(std::uint64_t done) const;

  std::string what_;
  std::uint64_t total_;
  bool enabled_;
  ProgressLines lines_;
  bool shown_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_;
};

// The same for what the session does: the bar is there from the first report on, and gone with the last copy of this.
[[nodiscard]] ReportedProgress progress_bar(std::string what, bool quiet,
                                            ProgressLines lines = ProgressLines::none);
// What --progress asks for.
[[nodiscard]] inline ProgressLines progress_lines(const Options& options) {
  return options.progress ? ProgressLines::main : ProgressLines::none;
}

}  // namespace nutik::app
