#include "studio/window/autosave.hpp"

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QStandardPaths>

#include "session/below/error.hpp"
#include "studio/window/project_file.hpp"

namespace nutik::studio {
namespace {

QString place() {
  return QDir(QStandardPaths::writableLocation(QStandardPaths::AppDataLocation)).filePath("unsaved.nutik");
}

}  // namespace

Autosave::Autosave(Document& document, QObject* parent) : QObject(parent), document_(document) {
  timer_.setSingleShot(true);
  timer_.setInterval(kDelay);
  connect(&timer_, &QTimer::timeout, this, &Autosave::keep);
  connect(&document_, &Document::changed, this, [this] {
    if (!timer_.isActive()) timer_.start();
  });
}

QString Autosave::found() { return QFileInfo::exists(place()) ? place() : QString(); }

void Autosave::keep() {
  if (document_.facts() == nullptr || document_.undo_stack().isClean()) return;
  QDir().mkpath(QFileInfo(place()).path());
  try {
    save_project(place(), document_, files_beside(place()));
  } catch (const Error&) {
    // Nothing was asked for; saving by hand says what is wrong with the disk.
  }
}

void Autosave::forget() {
  const CommandFiles files = files_beside(place());
  for (const QString& file : {place(), files.mask, files.functions}) QFile::remove(file);
}

}  // namespace nutik::studio
