#include "studio/window/main_window.hpp"

#include <QActionGroup>
#include <QComboBox>
#include <QDir>
#include <QDragEnterEvent>
#include <QDropEvent>
#include <QFileInfo>
#include <QGridLayout>
#include <QLineEdit>
#include <QMimeData>
#include <QScreen>
#include <QSettings>
#include <QSpinBox>
#include <QSplitter>
#include <QUrl>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "capture/error.hpp"
#include "session/live/live_pictures.hpp"
#include "session/live/session_of_part.hpp"
#include "studio/curves/curve_editor.hpp"
#include "studio/live/opening.hpp"
#include "studio/regions/difference_dialog.hpp"
#include "studio/regions/region_edits.hpp"
#include "studio/regions/region_list.hpp"
#include "studio/time/time_fields.hpp"
#include "studio/time/time_strip.hpp"
#include "studio/time/times.hpp"
#include "studio/window/options_dialog.hpp"
#include "studio/window/project_file.hpp"
#include "studio/window/start_page.hpp"
#include "studio/window/started_work.hpp"
#include "tik/reader.hpp"

namespace nutik::studio {
namespace {

constexpr const char* kWindowKey = "window";

struct OfAnotherClip : InputError {
  using InputError::InputError;
};

// A project is not shown without its mask, over which the next save would write.
void check_mask(const std::optional<DocumentState>& state, const Shape& shape) {
  if (!state || !state->mask) return;
  const Mask& mask = (*state->mask)->mask;
  if (mask.width == shape.width && mask.height == shape.height) return;
  throw OfAnotherClip(MainWindow::tr("its pictures are %3 × %4 pixels large, and the project's mask %1 × %2")
                          .arg(mask.width).arg(mask.height).arg(shape.width).arg(shape.height).toStdString());
}

}  // namespace

MainWindow::MainWindow(const ComputingRequest& computing)
    : live_(document_, quick_), autosave_(document_), devices_(std::make_shared<Devices>(computing)) {
  devices_->start();
  build_window();
  build_menus();
  connect_parts();
  restore_window();
  follow_opening();
  follow_exposure();
}

// Jobs tell widgets that they ended, and widgets know the document: they go in that order.
MainWindow::~MainWindow() {
  writing_.disconnect(this);  // the next window is to tell what was not written
  for (Jobs* jobs : {&jobs_, &quick_, &measuring_, &writing_}) jobs->cancel();
  delete takeCentralWidget();
}

void MainWindow::build_window() {
  setAcceptDrops(true);
  notice_ = new Notice;
  offer_ = new Notice;
  QStringList told = written_meanwhile();
  if (!Autosave::found().empty())
    told += tr("There is unsaved work of a window that did not end well: File, Recover unsaved work.");
  offer_->say(Notice::Kind::note, told.join('\n'));
  canvas_ = new Canvas(document_);
  canvas_->setObjectName("canvas");
  // Over the picture, which stays where it is whatever is said.
  auto* said = new QWidget;
  auto* said_column = new QVBoxLayout(said);
  auto* picture = new QWidget;
  auto* stack = new QGridLayout(picture);
  for (QLayout* layout : std::initializer_list<QLayout*>{said_column, stack}) {
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(0);
  }
  said_column->addWidget(offer_);
  said_column->addWidget(notice_);
  stack->addWidget(canvas_, 0, 0);
  start_ = new StartPage;
  connect(start_, &StartPage::asked_for_clip, this, [this] { choose_file(); });
  connect(start_, &StartPage::chosen, this, [this](const QString& path) { open(path); });
  connect(start_, &StartPage::started, this, &MainWindow::start_from);
  stack->addWidget(start_, 0, 0);
  stack->addWidget(said, 0, 0, Qt::AlignTop);

  auto* strip = new TimeStrip(document_, axis_);
  strip->setObjectName("time_strip");
  curves_ = new CurveEditor(document_, axis_);
  curves_->setObjectName("curves");
  time_ = new QWidget;
  auto* time_column = new QVBoxLayout(time_);
  time_column->setContentsMargins(0, 0, 0, 0);
  time_column->setSpacing(1);
  auto* fields = new TimeFields(document_);
  connect(fields, &TimeFields::refused, this, [this, last = QString()](const QString& mistake) mutable {
    if (!mistake.isEmpty()) {
      notice_->say(Notice::Kind::error, mistake);
    } else if (!last.isEmpty() && notice_->text() == last) {
      notice_->clear();
    }
    last = mistake;
  });
  time_column->addWidget(fields);
  time_column->addWidget(strip);
  time_->setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Fixed);

  auto* column = new QSplitter(Qt::Vertical);
  column->setObjectName("panes");  // "column" was kept of two
  column->addWidget(picture);
  column->addWidget(time_);
  column->addWidget(curves_);
  column->setStretchFactor(0, 1);
  column->setChildrenCollapsible(false);
  column->setSizes({10'000, 120, 100});  // the picture has what the others leave
  auto* row = new QSplitter(Qt::Horizontal);
  row->setObjectName("row");
  row->addWidget(column);
  regions_ = new RegionList(document_);
  histogram_ = new LightHistogram(document_);
  side_ = new QWidget;
  side_->setObjectName("side");
  auto* side_column = new QVBoxLayout(side_);
  side_column->setContentsMargins(4, 4, 4, 4);
  side_column->addWidget(histogram_);
  side_column->addWidget(build_exposure());
  side_column->addWidget(regions_, 1);
  row->addWidget(side_);
  row->setStretchFactor(0, 1);
  row->setChildrenCollapsible(false);
  row->setSizes({10'000, 262});
  setCentralWidget(row);
  status_ = new StatusLine({&jobs_, &writing_});
  setStatusBar(status_);
}

// As it was closed last; at first as large as the screen takes, with its frame.
void MainWindow::restore_window() {
  constexpr QSize kUsual(1280, 800), kFrame(16, 48);
  resize(kUsual.boundedTo(screen()->availableSize() - kFrame));
  QSettings kept;
  kept.beginGroup(kWindowKey);
  restoreGeometry(kept.value("geometry").toByteArray());
  for (QAction* fold : folds_) fold->setChecked(kept.value(fold->objectName(), true).toBool());
  for (auto* splitter : findChildren<QSplitter*>())
    splitter->restoreState(kept.value(splitter->objectName()).toByteArray());
  speed_->setValue(kept.value("speed", 1).toDouble());
  angle_->setValue(kept.value("angle", 180).toDouble());
  radius_->setValue(kept.value("radius", tool_settings_.brush_radius).toDouble());
  codes_->setValue(kept.value("codes", tool_settings_.wand_codes).toInt());
  const QString tool = kept.value("tool").toString();
  for (QAction* action : tools_->actions())
    if (action->objectName() == tool) action->setChecked(true);
}

void MainWindow::keep_window() {
  QSettings kept;
  kept.beginGroup(kWindowKey);
  kept.setValue("geometry", saveGeometry());
  for (const QAction* fold : folds_) kept.setValue(fold->objectName(), fold->isChecked());
  for (const auto* splitter : findChildren<QSplitter*>())
    kept.setValue(splitter->objectName(), splitter->saveState());
  kept.setValue("speed", speed_->value());
  kept.setValue("angle", angle_->value());
  kept.setValue("radius", radius_->value());
  kept.setValue("codes", codes_->value());
  kept.setValue("tool", tools_->checkedAction()->objectName());
}

void MainWindow::connect_parts() {
  for (auto* field : findChildren<QWidget*>()) {
    const bool has_wheel = qobject_cast<QAbstractSpinBox*>(field) || qobject_cast<QComboBox*>(field);
    if (has_wheel || qobject_cast<QLineEdit*>(field)) field->installEventFilter(this);
    if (has_wheel) field->setFocusPolicy(Qt::StrongFocus);  // not by the wheel
  }
  connect(&live_, &LiveView::pictured, this, [this](const ShownPicture& picture) {
    canvas_->show_picture(picture);
    status_->tell(picture);
    if (picture.is_full) measure_light();
    if (!picture.is_full || snapshot_ || canvas_->shows_first_look()) return;
    keep_snapshot();
    remember_picture(project_.isEmpty() ? document_.facts()->path : project_, canvas_->image());
  });
  connect(&live_, &LiveView::failed, this, [this](const QString& why) {
    if (canvas_->shows_first_look()) canvas_->clear();
    notice_->say(Notice::Kind::error, why);
  });
  for (Jobs* jobs : {&jobs_, &quick_, &writing_}) {
    connect(jobs, &Jobs::failed, this, [this, jobs](const QString& what, const QString& why) {
      if (jobs == &writing_ && !isVisible()) show();  // it was closed
      notice_->say(Notice::Kind::error, tr("%1: %2").arg(what, why));
    });
  }
  // The picture itself fails likewise, and that is said.
  connect(&measuring_, &Jobs::failed, this, [this] { histogram_->show_light(nullptr); });
  connect(&jobs_, &Jobs::ended, this, [this] {
    if (!opening_.isEmpty() && !jobs_.is_busy()) stay();
  });
  connect(&writing_, &Jobs::ended, this, [this] {
    being_written_.keep(writing_.open());
    if (!writing_.is_busy()) writes_on_.reset();
  });
  connect(canvas_, &Canvas::visible_changed, &live_, &LiveView::set_visible);
  connect(canvas_, &Canvas::visible_changed, this, &MainWindow::follow_opening);
  connect(canvas_, &Canvas::visible_changed, status_,
          [this](QRect, double screen_pixels) { status_->tell_zoom(document_.facts() ? screen_pixels : 0); });
  connect(canvas_, &Canvas::pointed, this,
          [this](std::optional<QPoint> pixel) { status_->tell(pixel, canvas_->image()); });
  connect(&document_, &Document::probe_changed, this, &MainWindow::look_at_pixel);
  connect(&document_, &Document::mark_taken_away, this, [this](bool is_out) {
    told()(is_out ? tr("Out lay before In and was taken away.") : tr("In lay behind Out and was taken away."));
  });
  connect(&document_, &Document::changed, this, [this] {
    follow_exposure();
    forget_light();
  });
  connect(&document_, &Document::capture_changed, this, &MainWindow::follow_exposure);
  connect(&document_.undo_stack(), &QUndoStack::cleanChanged, this, &MainWindow::follow_title);
  connect(&document_, &Document::marks_changed, this, &MainWindow::follow_title);
}

void MainWindow::open(const QString& path, const QString& rate, const StartingPoint* then) {
  notice_->clear();
  const QString file = QDir::cleanPath(QFileInfo(path).absoluteFilePath());  // `frames/` is a name like `frames`
  if (file.endsWith(QLatin1String(kProjectExtension), Qt::CaseInsensitive)) {
    open_project(file, {}, then);
    if (!rate.isEmpty() && notice_->text().isEmpty())
      told()(tr("The project says how its clip is read: -f %1 is not heeded.").arg(rate));
    return;
  }
  Stated stated;
  if (!rate.isEmpty()) stated.emplace("fps", rate.toStdString());
  Origin origin;
  origin.then = then;
  open_capture_file(file, stated, std::move(origin));
}

void MainWindow::open_first(const QStringList& paths, const QString& rate) {
  if (paths.isEmpty()) return;
  open(paths.front(), rate);
  if (paths.size() > 1 && notice_->text().isEmpty())
    told()(tr("A window shows one clip: %1 is opened, not %2.").arg(paths.front(), paths.mid(1).join(", ")));
}

void MainWindow::open_project(const QString& path, std::shared_ptr<const KeptProject> kept,
                              const StartingPoint* then, bool asks) {
  try_to([&] {
    Project project = load_project(path);
    Origin origin{.kind = Origin::Kind::recovered,
                  .state = std::move(project.state),
                  .marks = project.marks,
                  .duration_ns = project.duration_ns,
                  .kept = std::move(kept),
                  .then = then};
    if (!origin.kept) {
      origin.kind = Origin::Kind::project;
      origin.project = path;
      origin.files = project.files;
      origin.is_unwritten = project.is_unwritten;
      origin.known = times_of({path, project.files.functions, project.files.mask});
    }
    if (!asks) return open_capture_file(project.capture, project.stated, std::move(origin));
    origin.is_elsewhere = true;
    origin.duration_ns = 0;
    ask_how_to_read(project.capture, project.stated, tr("The clip is opened again."), origin);
  });
}

void MainWindow::open_capture_file(const QString& path, const Stated& stated, Origin origin) {
  opening_.clear();  // what is cancelled here gives way to this file, not to what is open
  jobs_.cancel();
  opening_ = path;
  follow_opening();
  if (document_.facts() != nullptr) origin.left.emplace(document_.state(), document_.marks());
  const auto first_look = [this](QImage image) {
    QMetaObject::invokeMethod(
        this, [this, image] { canvas_->show_first_look(image); }, Qt::QueuedConnection);
  };
  jobs_.start(tr("Opening %1").arg(QFileInfo(path).fileName()),
              [this, path, stated, origin = std::move(origin), devices = devices_,
               first_look](const Job& job) -> Jobs::Finish {
                try {
                  auto opened =
                      std::make_shared<Opened>(open_capture(path, stated, devices, job, first_look));
                  check_mask(origin.state, opened->facts.format.shape);
                  return [this, opened, origin] { take(std::move(*opened), origin); };
                } catch (const Error&) {
                  return [this, path, stated, origin, error = std::current_exception()] {
                    tell_way_out(path, stated, origin, error);
                  };
                }
              });
}

void MainWindow::tell_way_out(const QString& path, const Stated& stated, const Origin& origin,
                              const std::exception_ptr& error) {
  const QString why = sentence_of(error);
  const QFileInfo file(path);
  std::vector<Setting> settings;
  bool is_cut_off = false, is_other = false;
  try {
    std::rethrow_exception(error);
  } catch (const Error& known) {
    settings = known.settings();
    is_cut_off = dynamic_cast<const tik::Recoverable*>(&known) != nullptr;
    is_other = dynamic_cast<const OfAnotherClip*>(&known) != nullptr;
  }
  const auto helps = [&](Setting setting) { return std::ranges::find(settings, setting) != settings.end(); };
  if (!stated.contains("fps") && helps(Setting::frame_rate)) {
    return ask_how_to_read(path, stated, tr("%1\n\nHow many pictures a second was it filmed with?").arg(why), origin);
  }
  QString label;
  std::function<void()> way;
  if (is_other || (!file.exists() && !is_pattern(path))) {
    label = tr("Locate…");
    way = [this, stated, origin] {
      ask_for_file(tr("Where is it?"), tr("All files (*)"), [&](const QString& found) {
        Origin elsewhere = origin;
        elsewhere.is_elsewhere = true;
        open_capture_file(found, stated, std::move(elsewhere));
      });
    };
  } else if (helps(Setting::end_at_damage)) {
    label = tr("Open that part");
    way = [this, path, stated, part = origin]() mutable {
      Stated until_damage = stated;
      until_damage.emplace("ignore-errors", "");
      part.duration_ns = 0;
      open_capture_file(path, until_damage, part);
    };
  } else if (is_cut_off) {
    label = tr("Save what is whole…");
    way = [this, path, origin] { save_whole_part(path, origin); };
  }
  notice_->say(Notice::Kind::error, tr("Opening %1: %2").arg(file.fileName(), why), label, std::move(way));
}

void MainWindow::ask_how_to_read(const QString& path, const Stated& stated, const QString& why, const Origin& origin) {
  Asked asked{CommandId::encode, tr("How the clip is read"), {"fps", "align", "deflicker", "between"}, {{}, stated}, {},
              {}, why};
  asked.words = {{"align", tr("no: it stood still")},
                 {"translation", tr("it shifted")},
                 {"rigid", tr("it shifted and turned")},
                 {"homography", tr("it tilted, too")},
                 {"auto", tr("find out")}};
  const auto wanted = ask_options(this, asked);
  if (!wanted) return;
  notice_->clear();
  open_capture_file(path, wanted->options, origin);
}

void MainWindow::take(Opened opened, Origin origin) {
  // What was changed while this was opened was not asked for yet.
  if (origin.left && *origin.left != std::pair(document_.state(), document_.marks()) && !may_leave()) return;
  const std::int64_t duration_ns = opened.facts.timeline.duration_ns();
  if (origin.duration_ns != 0 && duration_ns != origin.duration_ns) {
    const QString path = opened.facts.path;
    const QString why = tr("it lasts %1, and the project's clip %2")
                            .arg(exact_time_text(duration_ns), exact_time_text(origin.duration_ns));
    const QString question = tr("Opening %1: %2").arg(QFileInfo(path).fileName(), why) +
                             tr("\n\nUse it all the same? Functions and marks keep their times.");
    if (!is_wanted(this, tr("Another clip"), question))
      return tell_way_out(path, opened.facts.stated, origin, std::make_exception_ptr(OfAnotherClip(why.toStdString())));
  }
  opening_.clear();
  std::optional<DocumentState>& state = origin.state;
  project_ = origin.project;
  files_ = origin.files;
  known_ = std::move(origin.known);
  remember_file(project_.isEmpty() ? opened.facts.path : project_);
  autosave_.begin(std::move(origin.kept));
  canvas_->await_picture();
  stop_playing();
  live_.show(nullptr);
  snapshot_.reset();
  written_.clear();
  exported_.clear();
  forget_light();
  session_ = opened.session;
  document_.start(std::move(opened.facts), std::move(state), origin.marks);
  if (origin.kind == Origin::Kind::recovered || origin.is_unwritten || (origin.is_elsewhere && origin.state))
    document_.undo_stack().resetClean();
  if (origin.is_unwritten && notice_->text().isEmpty())
    notice_->say(
        Notice::Kind::note,
        tr("The project's last save did not come to its end. It is shown as it was to be; its functions "
           "and mask may be as they were before. Saving it writes them."));
  axis_.set_duration(document_.duration_ns());
  note_capture();
  live_.show(session_);
  follow_opening();
  if (!opened.notes.isEmpty() && notice_->text().isEmpty())
    notice_->say(Notice::Kind::note, opened.notes.join('\n'));
  look_at_capture();
  if (origin.then != nullptr) start_from(*origin.then);
}

// With what is open: another file was not opened, after all.
void MainWindow::stay() {
  opening_.clear();
  if (canvas_->shows_first_look()) {
    canvas_->clear();
    live_.show(session_);
  }
  follow_opening();
  if (session_) look_at_capture();  // which opening may have broken off
}

// What the time strip shows behind the interval, and what previews are made of.
void MainWindow::look_at_capture() {
  if (document_.overview().changed_share.empty()) look_along_capture();
  if (!live_.has_reduced()) reduce_capture();
}

void MainWindow::look_along_capture() {
  jobs_.start(
      tr("Making thumbnails"), [session = session_](const Job& job) { return thumbnails_of(*session, job); },
      [this](CaptureOverview overview) { document_.set_overview(std::move(overview)); });
  jobs_.start(
      tr("Looking for motion"), [session = session_](const Job& job) { return changed_shares_of(*session, job); },
      [this](std::vector<double> shares) {
        CaptureOverview both = document_.overview();
        both.changed_share = std::move(shares);
        document_.set_overview(std::move(both));
      });
}

// What is seen while something is dragged: no more pixels than the screen has, nor than are exposed in no time; full
// resolution follows. Without it, for want of room, previews take longer.
void MainWindow::reduce_capture() {
  const Shape& shape = document_.facts()->format.shape;
  const QSizeF screen = QSizeF(canvas_->size()) * canvas_->devicePixelRatioF();
  const double ratio = std::max(shape.width / screen.width(), shape.height / screen.height());
  constexpr double kQuickPixels = 600'000;
  const double quick = std::ceil(std::sqrt(static_cast<double>(shape.pixel_count()) / kQuickPixels));
  const auto divisor = std::min({static_cast<std::uint32_t>(std::max(ratio, quick)), shape.width, shape.height});
  if (divisor < 2) return;
  add_reduced(session_, divisor, static_cast<int>(divisor));
}

// And once it is there a coarser one, for drags that it is too slow for.
void MainWindow::add_reduced(std::shared_ptr<Session> from, std::uint32_t by, int divisor) {
  jobs_.start(tr("Making smaller pictures for the screen"),
              [this, of = session_, from = std::move(from), by, divisor](const Job& job) -> Jobs::Finish {
                try {
                  const auto reduced = session_of_part(*from, {.scale = ClipScale{by}}, job.progress, job.stop);
                  return [this, of, from, reduced, divisor] {
                    if (of != session_) return;
                    live_.add_reduced(reduced, divisor);
                    const Shape& shape = reduced->format().shape;
                    if (from == of && shape.width > 1 && shape.height > 1) add_reduced(reduced, 2, 2 * divisor);
                  };
                } catch (const MemoryTooLittle&) {
                } catch (const OutputError&) {
                }
                return {};
              });
}

void MainWindow::look_at_pixel() {
  if (!document_.probe() || document_.waveform() || !session_) return;
  quick_.start(
      tr("Reading a pixel"),
      [session = session_, pixel = *document_.probe()](const Job&) { return waveform_of(*session, pixel); },
      [this, session = session_](Waveform waveform) {
        if (session == session_) document_.set_waveform(std::move(waveform));
      });
}

bool MainWindow::has_region() {
  if (document_.selected_tag() != kBackground) return true;
  notice_->say(Notice::Kind::error,
               tr("Select a region first, or add one: the background is what no region has."));
  return false;
}

void MainWindow::select_motion() {
  if (!session_ || !has_region()) return;
  jobs_.start(tr("Looking for what moves"), selecting_motion(document_, session_, told()));
}

void MainWindow::choose_difference() {
  if (!session_ || !has_region()) return;
  const Difference first{document_.mark_in().value_or(0), document_.boxcar().start_ns, {}};
  ask_difference(this, document_.facts()->timeline, first, [this, session = session_](const Difference& chosen) {
    if (session == session_)
      jobs_.start(tr("Looking for what differs"), selecting_difference(document_, session_, chosen, told()));
  });
}

void MainWindow::use_tool(ToolKind kind) {
  canvas_->set_tool(nullptr);
  tool_ = make_tool(kind, document_, tool_settings_, [this]() -> const QImage& { return canvas_->image(); });
  canvas_->set_tool(tool_.get());
}

bool MainWindow::is_settled() const {
  return !jobs_.is_busy() && !quick_.is_busy() && !measuring_.is_busy() && !writing_.is_busy() && !live_.is_busy();
}

void MainWindow::follow_title() {
  const CaptureFacts* facts = document_.facts();
  const bool is_another = !opening_.isEmpty() && (facts == nullptr || canvas_->shows_first_look());
  const QString name = is_another            ? opening_
                       : !project_.isEmpty() ? project_
                       : facts != nullptr    ? facts->path
                                             : QString();
  setWindowTitle(name.isEmpty() ? tr("nutik studio")
                                : tr("%1[*] – nutik studio").arg(QFileInfo(name).fileName()));
  setWindowModified(!document_.is_saved());
}

// Whose picture is shown: what stands round it says nothing of another capture.
void MainWindow::follow_opening() {
  const bool is_another = canvas_->shows_first_look() && !opening_.isEmpty();
  QWidget* const panels[] = {time_, curves_, side_};
  for (qsizetype panel = 0; panel < folds_.size(); ++panel) {
    panels[panel]->setEnabled(!is_another);
    panels[panel]->setVisible(folds_[panel]->isChecked() && document_.facts() != nullptr);
  }
  start_->setVisible(document_.facts() == nullptr && opening_.isEmpty());
  follow_title();
}

bool MainWindow::event(QEvent* event) {
  if (event->type() == QEvent::WindowActivate) tell_changes();
  if (event->type() == QEvent::WindowDeactivate) let_go();
  return QMainWindow::event(event);
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (may_leave() && may_leave_writing()) {
    keep_window();
    autosave_.begin();
    stop_playing();
    opening_.clear();
    for (Jobs* jobs : {&jobs_, &quick_, &measuring_}) jobs->cancel();
    if (writing_.is_busy()) writes_on_ = std::make_unique<QEventLoopLocker>();
    event->accept();
  } else {
    event->ignore();
  }
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  if (event->mimeData()->hasUrls()) event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
  QStringList paths;
  for (const QUrl& url : event->mimeData()->urls())
    if (url.isLocalFile()) paths += url.toLocalFile();
  if (paths.isEmpty()) return;
  event->acceptProposedAction();
  if (may_leave()) open_first(paths);
}

}  // namespace nutik::studio
