#include "studio/window/autosave.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <QCoreApplication>
#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QStandardPaths>
#include <QUuid>
#include <cerrno>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "studio/window/project_file.hpp"

namespace nutik::studio {
namespace {

QDir folder() { return QDir(QStandardPaths::writableLocation(QStandardPaths::AppDataLocation)); }

QString new_path(const QString& kind) {
  folder().mkpath(".");
  return folder().filePath(kind + QUuid::createUuid().toString(QUuid::WithoutBraces));
}

// The project itself is another file each time that it is kept.
QByteArray lock_beside(const QString& project) { return QFile::encodeName(project + ".lock"); }

// Where a file system knows no locks none is held.
bool is_locked(int descriptor, int kind) {
  return flock(descriptor, kind | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

bool is_of_a_living_window(const QString& project) {
  const int descriptor = open(lock_beside(project).constData(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor < 0) return false;
  const bool is_owned = is_locked(descriptor, LOCK_SH);
  close(descriptor);
  return is_owned;
}

int lock(const QString& project) {
  const int descriptor =
      open(lock_beside(project).constData(), O_CREAT | O_RDWR | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (descriptor >= 0 && is_locked(descriptor, LOCK_EX)) {
    close(descriptor);
    throw InputError("another window has taken this unsaved work over");
  }
  return descriptor;
}

}  // namespace

KeptProject::KeptProject() : path_(new_path("unsaved-") + kProjectExtension), lock_(lock(path_)) {}

KeptProject::KeptProject(QString path) : path_(std::move(path)), lock_(lock(path_)) {
  if (QFileInfo::exists(path_)) return;
  remove();  // the lock
  close(lock_);
  throw InputError(format("{} is gone: another window has saved it or given it up", path_.toStdString()));
}

KeptProject::~KeptProject() {
  if (lock_ >= 0) close(lock_);
}

void KeptProject::remove() const {
  QFile::remove(path_);
  unlink(lock_beside(path_).constData());
}

void WritingList::keep(const QStringList& what) {
  if (what.isEmpty() && file_.isOpen()) file_.remove();
  if (what.isEmpty()) return;
  if (!file_.isOpen()) {
    file_.setFileName(new_path("writing-"));
    if (!file_.open(QFile::ReadWrite)) return;
    is_locked(file_.handle(), LOCK_EX);
  }
  file_.resize(0);
  file_.seek(0);
  file_.write(what.join('\n').toUtf8());
  file_.flush();
}

QStringList WritingList::left() {
  QStringList left;
  for (const QFileInfo& info : folder().entryInfoList({"writing-*"}, QDir::Files | QDir::NoSymLinks)) {
    QFile file(info.filePath());
    if (info.size() == 0 || !file.open(QFile::ReadOnly) || is_locked(file.handle(), LOCK_SH)) continue;
    left += QString::fromUtf8(file.readAll()).split('\n');
    file.remove();
  }
  return left;
}

Autosave::Autosave(Document& document, QObject* parent) : QObject(parent), document_(document) {
  timer_.setSingleShot(true);
  timer_.setInterval(kDelay);
  connect(&timer_, &QTimer::timeout, this, &Autosave::keep);
  const auto keep_soon = [this] {
    if (!timer_.isActive()) timer_.start();
  };
  connect(&document_, &Document::changed, this, keep_soon);
  connect(&document_, &Document::marks_changed, this, keep_soon);
}

std::vector<Autosave::Found> Autosave::found() {
  std::vector<Found> found;
  const QString all = QString("unsaved*") + kProjectExtension;
  for (const QFileInfo& info : folder().entryInfoList({all}, QDir::Files, QDir::Time)) {
    if (!is_of_a_living_window(info.filePath()))
      found.push_back({info.filePath(), capture_name_in(info.filePath()), info.lastModified()});
  }
  return found;
}

void Autosave::keep() {
  if (document_.facts() == nullptr || document_.is_saved()) return;
  try {
    if (!kept_) kept_ = std::make_shared<KeptProject>();
    keep_project(kept_->path(), document_);
  } catch (const Error&) {
    // Nothing was asked for; saving by hand says what is wrong with the disk.
  }
}

void Autosave::keep_at_signals() {
  catch_interruptions();
  time_to_keep_.emplace();
  auto* looking = new QTimer(this);
  connect(looking, &QTimer::timeout, this, [this] {
    try {
      check_interruption();
    } catch (const Interrupted& asked) {
      clear_interruption();
      end(asked.signal);
    }
  });
  looking->start(std::chrono::milliseconds(200));
}

void Autosave::end(int signal) {
  constexpr int kSignalStatus = 128;
  keep();
  QCoreApplication::exit(kSignalStatus + signal);
}

void Autosave::begin(std::shared_ptr<const KeptProject> kept) {
  timer_.stop();
  if (kept_) kept_->remove();
  kept_ = std::move(kept);
}

}  // namespace nutik::studio
