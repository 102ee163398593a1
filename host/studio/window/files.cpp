// What the window does with files: open, save, export.
#include <QClipboard>
#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QGuiApplication>
#include <QLocale>
#include <QMenu>
#include <QMessageBox>
#include <QPushButton>
#include <QSettings>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/function_text.hpp"
#include "session/output_check.hpp"
#include "studio/document/document.hpp"
#include "studio/window/main_window.hpp"
#include "studio/window/options_dialog.hpp"
#include "studio/window/project_file.hpp"
#include "studio/window/start_page.hpp"
#include "studio/window/started_work.hpp"
#include "tik/reader.hpp"

namespace nutik::studio {

constexpr const char* kWrittenKey = "written";  // while no window was open

FileTimes times_of(const QStringList& files) {
  FileTimes times;
  for (const QString& file : files) times[file] = QFileInfo(file).lastModified();
  return times;
}

// Errors are said above the picture.
bool MainWindow::try_to(const std::function<void()>& what) {
  try {
    what();
    return true;
  } catch (...) {
    notice_->say(Notice::Kind::error, sentence_of(std::current_exception()));
    return false;
  }
}

void MainWindow::ask_for_file(const QString& title, const QString& filter, const Use& use) {
  const QString path = QFileDialog::getOpenFileName(this, title, {}, filter);
  if (!path.isEmpty()) use(path);
}

void MainWindow::ask_for_name(const QString& title, const QString& ending, const QString& filter, const Use& use) {
  const QString path = named_file(title, ending, filter);
  if (!path.isEmpty()) use(path);
}

// Empty where none is given. A name without an ending gets its own, of which the dialog did not know.
QString MainWindow::named_file(const QString& title, const QString& ending, const QString& filter) {
  QString path = QFileDialog::getSaveFileName(this, title, suggested(ending), filter);
  const QString suffix = ending.mid(ending.lastIndexOf('.'));
  const bool has_ending =
      suffix == kProjectExtension ? path.endsWith(suffix) : !QFileInfo(path).suffix().isEmpty();
  if (path.isEmpty() || has_ending) return path;
  path += suffix;
  const bool is_free = !QFileInfo::exists(path) ||
                       is_wanted(this, title, tr("%1 is there already. Replace it?").arg(path));
  return is_free ? path : QString();
}

bool MainWindow::save_project(const QString& path) {
  if (document_.facts() == nullptr) return false;
  const CommandFiles files =
      path == project_ && !files_.functions.isEmpty() ? files_ : free_files_beside(path, document_.facts()->path);
  if (document_.state().mask && !QFileInfo::exists(files.mask) &&
      !try_to([&] { clip_files(document_.facts()->path, files.mask); }))
    return false;
  const bool is_saved = try_to([&] { nutik::studio::save_project(path, document_, files); });
  if (is_saved || path == project_) {  // what a save that failed has written is ours as well
    FileTimes capture{*known_.find(document_.facts()->path)};
    known_ = times_of({path, files.functions, files.mask});
    known_.merge(capture);
    told_changes_.clear();
    note_written(path);
  }
  if (!is_saved) return false;
  project_ = path;
  files_ = files;
  autosave_.begin();
  document_.set_saved();
  remember_file(path);
  if (!canvas_->shows_first_look()) remember_picture(path, canvas_->image());
  follow_title();
  return true;
}

bool MainWindow::save(const QString& why) {
  if (project_.isEmpty()) return save_as(why);
  const QStringList changed = changed_outside();
  QStringList lines;
  for (const QString& file : changed)
    lines += tr("%1 was changed by another program since it was read.").arg(file);
  CommandFiles written = files_;
  if (!document_.state().mask) written.mask.clear();
  for (const QString& file : foreign_files(project_, written))
    if (!changed.contains(file)) lines += tr("%1 was not written for this project.").arg(file);
  lines += tr("Replace what is there? Save project as… writes new files.");
  if (lines.size() > 1 && !is_wanted(this, tr("Files of others"), lines.join('\n'))) return false;
  return save_project(project_);
}

void MainWindow::note_capture() {
  known_[document_.facts()->path] = QFileInfo(document_.facts()->path).lastModified();
  told_changes_.clear();
}

// A clip's folder is another one with what the window writes into it.
void MainWindow::note_written(const QString& path) {
  if (document_.facts() && QFileInfo(QFileInfo(path).path()) == QFileInfo(document_.facts()->path)) note_capture();
}

QStringList MainWindow::changed_outside() const {
  QStringList changed;
  for (const auto& [file, time] : known_) {
    const QFileInfo info(file);
    const bool is_written = document_.facts() == nullptr || file != document_.facts()->path;
    if (is_written && info.exists() && info.lastModified() != time) changed += file;
  }
  return changed;
}

// Whoever comes back to the window hears at once what happened to its files, and once.
void MainWindow::tell_changes() {
  const QString capture = document_.facts() == nullptr ? QString() : document_.facts()->path;
  QStringList lines;
  for (const auto& [file, time] : known_) {
    const QFileInfo info(file);
    const bool is_gone = time.isValid() && !info.exists();
    if (!is_gone && (!info.exists() || info.lastModified() == time)) continue;
    const QString what =
        is_gone ? tr("%1 is gone").arg(file) : tr("%1 was changed by another program").arg(file);
    if (file == capture)
      lines += tr("%1: the window goes on with what it read.").arg(what);
    else if (is_gone)
      lines += tr("%1: saving the project writes it again.").arg(what);
    else
      lines += tr("%1: File, Open again (F5) takes the change; saving replaces it.").arg(what);
  }
  const QString text = lines.join('\n');
  if (text == told_changes_) return;
  told_changes_ = text;
  if (!text.isEmpty()) notice_->say(Notice::Kind::note, text);
}

void MainWindow::recover(const QString& kept) {
  if (!may_leave()) return;
  notice_->clear();
  offer_->clear();
  try_to([&] { open_project(kept, std::make_shared<KeptProject>(kept)); });  // saved where a person says
}

void MainWindow::remove_unsaved() {
  const auto found = Autosave::found();
  const auto count = static_cast<int>(found.size());
  if (!is_wanted(this, tr("Unsaved work"), tr("Remove unsaved work of %n window(s) for good?", nullptr, count))) return;
  offer_->clear();
  for (const Autosave::Found& each : found) try_to([&] { KeptProject(each.path).remove(); });
}

void MainWindow::fill_unsaved(QMenu& menu) {
  menu.clear();
  for (const Autosave::Found& each : Autosave::found()) {
    const QString time = QLocale().toString(each.time, QLocale::ShortFormat);
    const QString name = QString(each.capture).replace('&', "&&");  // no letter to press
    menu.addAction(tr("%1, %2").arg(name, time), this, [this, path = each.path] { recover(path); });
  }
  menu.addSeparator();
  menu.addAction(tr("&Remove all of these…"), this, &MainWindow::remove_unsaved);
}

bool MainWindow::save_as(const QString& why) {
  if (document_.facts() == nullptr) return false;
  const QString path =
      named_file(why.isEmpty() ? tr("Save the project") : why, kProjectExtension,
                 tr("Projects (*%1)").arg(kProjectExtension));
  if (path.isEmpty()) return false;
  return path == project_ ? save() : save_project(path);
}

bool MainWindow::may_leave() {
  if (document_.is_saved()) return true;
  const auto answer = QMessageBox::question(
      this, tr("Unsaved changes"), tr("Regions, functions or marks were changed and not saved. Save them?"),
      QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, QMessageBox::Save);
  if (answer == QMessageBox::Save) return save();
  return answer == QMessageBox::Discard;
}

bool MainWindow::may_leave_writing() {
  if (!writing_.is_busy()) return true;
  QMessageBox question(QMessageBox::Question, tr("Files are being written"),
                       tr("Still at work: %1\n\nWhat is stopped leaves no file, but for the numbered pictures that "
                          "are there already.")
                           .arg(writing_.open().join('\n')),
                       QMessageBox::Cancel, this);
  question.setTextFormat(Qt::PlainText);
  const QAbstractButton* finish = question.addButton(tr("&Finish in the background"), QMessageBox::AcceptRole);
  const QAbstractButton* stop = question.addButton(tr("&Stop"), QMessageBox::DestructiveRole);
  connect(&writing_, &Jobs::failed, &question, &QDialog::reject);  // which is to be read first
  question.exec();
  if (question.clickedButton() == stop) {
    writing_.cancel();
    being_written_.keep({});  // a person knows
  }
  return question.clickedButton() == stop || question.clickedButton() == finish;
}

void MainWindow::write(const QString& what, Jobs::Work work) {
  writing_.start(what, std::move(work));
  being_written_.keep(writing_.open());
}

Told MainWindow::told_written(const QString& path) {
  return [this, path](const QString& line) {
    note_written(path);
    notice_->say(Notice::Kind::note, line);
    QSettings kept;
    if (!isVisible()) kept.setValue(kWrittenKey, kept.value(kWrittenKey).toStringList() + QStringList(line));
  };
}

// What was written since all windows were closed, and what was to be written by programs that are gone.
QStringList MainWindow::written_meanwhile() {
  QSettings kept;
  QStringList lines = kept.value(kWrittenKey).toStringList();
  kept.remove(kWrittenKey);
  for (const QString& what : WritingList::left()) lines += tr("%1: the program ended before it was done.").arg(what);
  return lines;
}

bool MainWindow::has_files() const {
  return document_.mode() == ExposureMode::boxcar ||
         (!project_.isEmpty() && document_.undo_stack().isClean() && changed_outside().isEmpty());
}

bool MainWindow::has_capture() {
  const QString& path = document_.facts()->path;
  if (known_[path] == QFileInfo(path).lastModified()) return true;
  notice_->say(Notice::Kind::error,
               tr("%1 is not what was read any more: File, Open again (F5) reads what recipes would name.").arg(path));
  return false;
}

// A command names files: they have to hold what is shown.
bool MainWindow::ensure_files() {
  return document_.facts() != nullptr && has_capture() &&
         (has_files() || save(tr("Save the project first: recipes name its files")));
}

QString MainWindow::command_for(const QString& picture) const {
  return command_line(document_, files_, picture, written_);
}

void MainWindow::copy_command() {
  if (!ensure_files()) return;
  const QString line = command_for(suggested_picture());
  QGuiApplication::clipboard()->setText(line);
  notice_->say(Notice::Kind::note, tr("Copied: %1").arg(line));
}

void MainWindow::use_functions(const QString& path) {
  try_to([&] {
    DocumentState state = document_.state();
    state.functions = load_functions(path);
    if (state.mask) {
      // Pixels whose function is not in the file keep the one they have.
      for (const MaskRegion& region : (*state.mask)->regions)
        if (!state.functions.contains(region.tag))
          state.functions.emplace(region.tag, document_.functions().at(region.tag));
    }
    state.mode = ExposureMode::functions;
    document_.apply(std::move(state), tr("Load functions"));
  });
}

void MainWindow::use_mask(const QString& path) {
  try_to([&] {
    DocumentState state = document_.state();
    const Shared<MaskWithRegions> mask = load_mask(path);
    const Shape& shape = document_.facts()->format.shape;
    if (mask->mask.width != shape.width || mask->mask.height != shape.height)
      throw InputError(format("{} is {} x {} pixels large, the capture {} x {}", path.toStdString(),
                              mask->mask.width, mask->mask.height, shape.width, shape.height));
    // Regions without a function are exposed over the interval.
    const GainFunction function = with_steps(
        GainFunction::boxcar(state.boxcar.start_ns, state.boxcar.start_ns + state.boxcar.length_ns));
    for (const MaskRegion& region : mask->regions) state.functions.try_emplace(region.tag, function);
    state.mask = mask;
    state.covered.clear();
    state.mode = ExposureMode::functions;
    document_.apply(std::move(state), tr("Load mask"));
  });
}

void MainWindow::write_functions(const QString& path) {
  if (document_.facts() == nullptr) return;
  try_to([&] {
    check_output(path.toStdString(), OutputKind::functions,
                 std::vector{document_.facts()->path.toStdString()});
    save_functions(path, document_.functions());
    note_written(path);
    notice_->say(Notice::Kind::note, tr("Written: %1").arg(path));
  });
}

void MainWindow::write_mask(const QString& path) {
  if (document_.facts() == nullptr) return;
  try_to([&] {
    if (!document_.state().mask)
      throw InputError("there is no mask yet: all of the picture is the background, M0. Add a region first");
    check_mask_output(path.toStdString(), clip_files(document_.facts()->path, path));
    save_mask(path, (*document_.state().mask)->mask);
    const Feather feather = feather_of(document_.state());
    const QString soft = feather == Feather()
                             ? QString()
                             : tr(" Its edges are hard; their feather, %1, is not in the file.")
                                   .arg(QString::fromStdString(feather_text(feather)));
    notice_->say(Notice::Kind::note, tr("Written: %1.%2").arg(path, soft));
  });
}

void MainWindow::write_plate(const QString& path, const Marks& marks) {
  try_to([&] {
    jobs_.start(tr("Looking for the empty scene"), writing_plate(marks, session_, path, told()));
  });
}

// Saves the whole blocks of a capture that was cut off as a new one, which is then opened.
void MainWindow::save_whole_part(const QString& path, const Origin& origin) {
  const QFileInfo from(path);
  const QString whole = QFileDialog::getSaveFileName(
      this, tr("Save what is whole"), from.dir().filePath(from.completeBaseName() + "-whole.tik"),
      tr("Captures (*.tik)"));
  if (whole.isEmpty()) return;
  const auto save = [damaged = path.toStdString(), whole](const Job&) {
    check_output(whole.toStdString(), OutputKind::tik, std::vector{damaged});
    return tik::recover(damaged, whole.toStdString());
  };
  jobs_.start(tr("Saving what is whole"), save, [this, whole, origin](const tik::Recovery& saved) {
    notice_->say(Notice::Kind::note, tr("%1: %2 samples were saved").arg(whole, QString::number(saved.sample_count)));
    Origin elsewhere = origin;
    elsewhere.is_elsewhere = true;
    elsewhere.duration_ns = 0;
    open_capture_file(whole, {}, std::move(elsewhere));
  });
}

// Beside the project, else beside the capture: its file, or the folder of its stills.
QString MainWindow::suggested(const QString& ending) const {
  QFileInfo from(project_.isEmpty() ? document_.facts()->path : project_);
  if (is_pattern(from.filePath())) from.setFile(from.path());
  return from.dir().filePath(from.completeBaseName() + ending);
}

QString MainWindow::suggested_picture() const {
  return suggested("." + (exported_.isEmpty() ? QString("png") : QFileInfo(exported_).suffix()));
}

void MainWindow::fill_recent(QMenu& menu) {
  menu.clear();
  for (const RecentFile& file : recent_files()) {
    QAction* action = menu.addAction(QString(file.path).replace('&', "&&"));
    action->setEnabled(QFileInfo::exists(file.path) || is_pattern(file.path));
    connect(action, &QAction::triggered, this, [this, path = file.path] {
      if (may_leave()) open(path);
    });
  }
  if (menu.isEmpty()) menu.addAction(tr("None yet"))->setEnabled(false);
}

}  // namespace nutik::studio
