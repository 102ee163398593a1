// Work that takes long, one after another on a thread of its own, so that the window never waits.
//
//   in:      work, and a name for it that people read
//   out:     signals, and what the work returns to be done on the window's thread
//   always:  a job that throws Cancelled ends without a word; any other error comes as failed()
#pragma once

#include <QObject>
#include <QStringList>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "system/interruption.hpp"

namespace nutik::studio {

// What work is given. Its progress throws Cancelled once it is to stop.
struct Job {
  std::stop_token stop;
  ReportedProgress progress;
};

class Jobs : public QObject {
  Q_OBJECT

 public:
  using Finish = std::function<void()>;            // on the window's thread; may be empty
  using Work = std::function<Finish(const Job&)>;  // on the jobs' thread

  explicit Jobs(QObject* parent = nullptr);
  ~Jobs() override;  // cancels

  void start(const QString& what, Work work);
  // `finish` gets what `work` returns.
  template <typename Making, typename Using>
  void start(const QString& what, Making work, Using finish) {
    start(what, [work, finish](const Job& job) -> Finish {
      return [finish, made = std::make_shared<decltype(work(job))>(work(job))] { finish(std::move(*made)); };
    });
  }
  // The one that runs and those that wait. What the one that runs would have returned is dropped.
  void cancel();
  void cancel_current();  // or the one that begins next; others go on
  [[nodiscard]] bool is_busy() const { return !open_.isEmpty(); }
  [[nodiscard]] const QStringList& open() const { return open_; }  // what was started and has not ended

 Q_SIGNALS:
  void progressed(const QString& what, quint64 done, quint64 total);  // total 0: not known
  void failed(const QString& what, const QString& why);
  void ended();  // after each job, also a cancelled one

 private:
  struct Waiting {
    QString what;
    Work work;
    std::uint64_t round;
    std::stop_source stop = {};
  };

  void run(const std::stop_token& stop);
  void run(Waiting& waiting);

  QStringList open_;         // the window's
  std::uint64_t round_ = 0;  // counts cancellations; the window's

  std::mutex mutex_;  // guards what follows
  std::condition_variable_any changed_;
  std::deque<Waiting> waiting_;
  std::stop_source current_;

  std::jthread worker_;  // last: it uses everything else
};

// Gets a line, or several, about what came of a job, on the window's thread.
using Told = std::function<void(const QString&)>;

// With a capital letter.
[[nodiscard]] QString sentence(const std::string& text);
// An error in the words of its message.
[[nodiscard]] QString sentence_of(const std::exception_ptr& error);

}  // namespace nutik::studio
