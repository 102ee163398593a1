#include "app/output/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>

#include "capture/format.hpp"

namespace nutik::app {
namespace {

constexpr auto kFirst = std::chrono::milliseconds(400);
constexpr auto kEvery = std::chrono::milliseconds(100);
constexpr auto kEveryLine = std::chrono::milliseconds(1000);
constexpr std::uint64_t kBarWidth = 30;

// `12 s`, `3:05 min`, `1:02 h`.
std::string time_left_text(double seconds) {
  const auto whole = static_cast<std::uint64_t>(seconds + 0.5);
  if (whole < 60) return format("{} s", whole);
  if (whole < 3600) return format("{}:{:02} min", whole / 60, whole % 60);
  return format("{}:{:02} h", whole / 3600, whole / 60 % 60);
}

}  // namespace

Progress::Progress(std::string what, std::uint64_t total, bool quiet, ProgressLines lines)
    : what_(std::move(what)),
      total_(total),
      enabled_(!quiet && isatty(STDERR_FILENO) == 1),
      lines_(isatty(STDERR_FILENO) == 1 ? ProgressLines::none : lines),
      next_(lines_ == ProgressLines::none ? start_ + kFirst : start_) {}

Progress::~Progress() {
  if (shown_) std::fputs("\r\x1b[K", stderr);
}

std::string Progress::rate_text(std::uint64_t done) const {
  const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  const double left =
      done > 0 ? seconds / static_cast<double>(done) * static_cast<double>(total_ - std::min(done, total_)) : 0.0;
  return format("{:.3g} a second, {} left", static_cast<double>(done) / seconds, time_left_text(left));
}

// `Progress: 45% exposing 54 of 120, 3.2 a second, 21 s left`.
std::string Progress::line_text(std::uint64_t done) const {
  std::string line;
  if (lines_ == ProgressLines::main && total_ > 0) line = format("Progress: {}% ", done * 100 / total_);
  line += format("{} {}", what_, done);
  if (total_ > 0) line += format(" of {}", total_);
  // In the first moment a rate says nothing.
  if (total_ > 0 && done > 0 && Clock::now() - start_ >= kFirst) line += ", " + rate_text(done);
  return line;
}

void Progress::show(std::uint64_t done) {
  if (!enabled_ && lines_ == ProgressLines::none) return;
  const Clock::time_point now = Clock::now();
  if (now < next_) return;
  next_ = now + (enabled_ ? kEvery : kEveryLine);
  if (!enabled_) {
    std::fprintf(stderr, "%s\n", line_text(done).c_str());
    return;
  }
  shown_ = true;
  std::string line = what_;
  if (total_ > 0) {
    const std::uint64_t filled = std::min(kBarWidth, done * kBarWidth / total_);
    line += format(" [{}{}] {}/{}, {}", std::string(filled, '#'), std::string(kBarWidth - filled, '.'), done,
                   total_, rate_text(done));
  } else {
    line += format(" {}", done);
  }
  std::fprintf(stderr, "\r%s\x1b[K", line.c_str());
  std::fflush(stderr);
}

ReportedProgress progress_bar(std::string what, bool quiet, ProgressLines lines) {
  return [what = std::move(what), quiet, lines, bar = std::shared_ptr<Progress>(), of = std::uint64_t{0}](
             std::uint64_t done, std::uint64_t total) mutable {
    // Work of several parts counts something else in each, or does not know yet how much there is.
    if (!bar || of != total) {
      bar.reset();
      bar = std::make_shared<Progress>(what, of = total, quiet, lines);
    }
    bar->show(done);
  };
}

}  // namespace nutik::app
