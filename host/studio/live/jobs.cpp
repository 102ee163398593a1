#include "studio/live/jobs.hpp"

#include <chrono>
#include <utility>

#include "capture/error.hpp"

namespace nutik::studio {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kBetweenReports = std::chrono::milliseconds(40);

}  // namespace

Jobs::Jobs(QObject* parent) : QObject(parent), worker_([this](const std::stop_token& stop) { run(stop); }) {}

Jobs::~Jobs() {
  cancel();
  worker_.request_stop();
  worker_.join();
}

void Jobs::start(const QString& what, Work work) {
  open_ += what;
  const std::scoped_lock lock(mutex_);
  waiting_.push_back({what, std::move(work), round_});
  changed_.notify_all();
}

void Jobs::cancel() {
  ++round_;
  std::deque<Waiting> dropped;
  {
    const std::scoped_lock lock(mutex_);
    dropped = std::exchange(waiting_, {});
    current_.request_stop();
  }
  for (const Waiting& each : dropped) open_.removeOne(each.what);
  if (!dropped.empty()) Q_EMIT ended();
}

void Jobs::cancel_current() {
  const std::scoped_lock lock(mutex_);
  if (std::cmp_greater(open_.size(), waiting_.size()))
    current_.request_stop();
  else if (!waiting_.empty())
    waiting_.front().stop.request_stop();
}

void Jobs::run(const std::stop_token& stop) {
  for (;;) {
    Waiting next;
    {
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, stop, [&] { return !waiting_.empty(); })) return;
      next = std::move(waiting_.front());
      waiting_.pop_front();
      current_ = next.stop;
    }
    run(next);
  }
}

void Jobs::run(Waiting& waiting) {
  const std::stop_token stop = waiting.stop.get_token();
  const auto report = [&](std::uint64_t done, std::uint64_t total) {
    QMetaObject::invokeMethod(
        this, [this, what = waiting.what, done, total] { Q_EMIT progressed(what, done, total); },
        Qt::QueuedConnection);
  };
  report(0, 0);  // it may take long until it knows more
  Clock::time_point last_report{};
  const auto progress = [&](std::uint64_t done, std::uint64_t total) {
    if (stop.stop_requested()) throw Cancelled();
    const Clock::time_point now = Clock::now();
    if (now - last_report < kBetweenReports && done != total) return;
    last_report = now;
    report(done, total);
  };
  Finish finish;
  QString error;
  try {
    finish = waiting.work({stop, progress});
  } catch (const Cancelled&) {
  } catch (...) {
    error = sentence_of(std::current_exception());
  }
  QMetaObject::invokeMethod(
      this,
      [this, finish, error, stop, what = waiting.what, round = waiting.round] {
        open_.removeOne(what);
        const bool is_wanted = round == round_ && !stop.stop_requested();
        if (is_wanted && finish) finish();
        if (is_wanted && !error.isEmpty()) Q_EMIT failed(what, error);
        Q_EMIT ended();
      },
      Qt::QueuedConnection);
}

QString sentence(const std::string& text) {
  QString said = QString::fromStdString(text);
  // A path keeps its letters.
  const bool begins_with_word = said.size() > 1 && said[0].isLetter() &&
                                !said.section(' ', 0, 0).contains('/') &&
                                !said.section(' ', 0, 0).contains('.');
  if (begins_with_word) said[0] = said[0].toUpper();
  return said;
}

QString sentence_of(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const std::bad_alloc&) {
    return Jobs::tr("There is not enough memory for this.");
  } catch (const std::exception& known) {
    return sentence(known.what());
  } catch (...) {
    return Jobs::tr("It failed, and nothing is known of why.");
  }
}

}  // namespace nutik::studio
