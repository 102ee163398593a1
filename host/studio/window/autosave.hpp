// Keeps what is not saved, so that a crash loses little.
//
//   always:  a change is kept within kDelay, beside nothing of the user's, in a file of this window and this capture.
//            Only the window that has it locked removes it, once that was saved or given up. What a window leaves that
//            did not end well is found at every start, until it is taken over by another or removed
#pragma once

#include <QDateTime>
#include <QFile>
#include <QObject>
#include <QStringList>
#include <QTimer>
#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "studio/document/document.hpp"
#include "system/interruption.hpp"

namespace nutik::studio {

// A project that is kept. Its lock lives as long as this does, and ends with the process, however that ends.
class KeptProject {
 public:
  // A new one.
  KeptProject();
  // Takes over that of a window that is gone. Throws InputError if it is there no more, or another window has it.
  explicit KeptProject(QString path);
  ~KeptProject();
  KeptProject(const KeptProject&) = delete;
  KeptProject& operator=(const KeptProject&) = delete;

  [[nodiscard]] const QString& path() const { return path_; }
  void remove() const;

 private:
  QString path_;
  int lock_;  // a descriptor
};

// What a window is writing, for the next one to tell should the program end before that: in a file that is locked as
// long as it runs.
class WritingList {
 public:
  void keep(const QStringList& what);
  // What programs that are gone left behind; the list is then taken away.
  [[nodiscard]] static QStringList left();

 private:
  QFile file_;
};

class Autosave : public QObject {
  Q_OBJECT

 public:
  static constexpr std::chrono::seconds kDelay{10};

  struct Found {
    QString path, capture;
    QDateTime time;
  };

  explicit Autosave(Document& document, QObject* parent = nullptr);

  // What is kept of windows that are gone, the newest first.
  [[nodiscard]] static std::vector<Found> found();
  void keep();
  // From now on whoever asks the program to end (SIGTERM, at a shutdown for example) gets no question for an answer.
  void keep_at_signals();
  // Keeps what there is, and ends the program as that signal asks.
  void end(int signal);
  // What this window kept was saved or given up. From now on this is kept: nothing yet, or what it has taken over.
  void begin(std::shared_ptr<const KeptProject> kept = {});

 private:
  Document& document_;
  QTimer timer_;
  std::shared_ptr<const KeptProject> kept_;
  std::optional<TimeToEnd> time_to_keep_;
};

}  // namespace nutik::studio
