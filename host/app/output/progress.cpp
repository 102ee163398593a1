#include "app/output/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "capture/format.hpp"

namespace nutik::app {
namespace {

constexpr auto kFirst = std::chrono::milliseconds(400);
constexpr auto kEvery = std::chrono::milliseconds(100);
constexpr std::uint64_t kBarWidth = 30;

}  // namespace

Progress::Progress(std::string what, std::uint64_t total, bool quiet)
    : what_(std::move(what)),
      total_(total),
      enabled_(!quiet && isatty(STDERR_FILENO) == 1),
      next_(start_ + kFirst) {}

Progress::~Progress() {
  if (shown_) std::fputs("\r\x1b[K", stderr);
}

void Progress::show(std::uint64_t done) {
  if (!enabled_) return;
  const Clock::time_point now = Clock::now();
  if (now < next_) return;
  next_ = now + kEvery;
  shown_ = true;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  std::string line = what_;
  if (total_ > 0) {
    const std::uint64_t filled = std::min(kBarWidth, done * kBarWidth / total_);
    const double left =
        done > 0 ? seconds / static_cast<double>(done) * static_cast<double>(total_ - std::min(done, total_))
                 : 0.0;
    line += format(" [{}{}] {}/{}, {:.0f} s left", std::string(filled, '#'),
                   std::string(kBarWidth - filled, '.'), done, total_, left);
  } else {
    line += format(" {}", done);
  }
  std::fprintf(stderr, "\r%s\x1b[K", line.c_str());
  std::fflush(stderr);
}

}  // namespace nutik::app
