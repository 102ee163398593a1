// What can be chosen: menus, tools, and the bar over the picture. Every action has a key or a menu's letter.
#include <QActionGroup>
#include <QApplication>
#include <QComboBox>
#include <QDialog>
#include <QGridLayout>
#include <QIconEngine>
#include <QLabel>
#include <QMenuBar>
#include <QMessageBox>
#include <QPainter>
#include <QSignalBlocker>
#include <QSpinBox>
#include <QTextBrowser>
#include <QToolBar>
#include <QVBoxLayout>

#include "studio/regions/region_edits.hpp"
#include "studio/regions/region_list.hpp"
#include "studio/window/appearance.hpp"
#include "studio/window/main_window.hpp"
#include "studio/window/started_work.hpp"

namespace nutik::studio {
namespace {

struct ToolRow {
  ToolKind kind;
  const char* object;
  const char* name;
  const char* tip;
  Qt::Key key;
};
constexpr ToolRow kTools[] = {
    {ToolKind::look, "tool_look", QT_TR_NOOP("Look"),
     QT_TR_NOOP("A click shows the light of a pixel; dragging pans"), Qt::Key_V},
    {ToolKind::brush, "tool_brush", QT_TR_NOOP("Brush"), QT_TR_NOOP("Paints the selected region; Alt erases"),
     Qt::Key_B},
    {ToolKind::rectangle, "tool_rectangle", QT_TR_NOOP("Rectangle"),
     QT_TR_NOOP("Shift: a square; Alt erases"), Qt::Key_R},
    {ToolKind::ellipse, "tool_ellipse", QT_TR_NOOP("Ellipse"), QT_TR_NOOP("Shift: a circle; Alt erases"),
     Qt::Key_E},
    {ToolKind::polygon, "tool_polygon", QT_TR_NOOP("Polygon"),
     QT_TR_NOOP("Corners by clicks; a double click or Enter closes it"), Qt::Key_P},
    {ToolKind::wand, "tool_wand", QT_TR_NOOP("Wand"),
     QT_TR_NOOP("Pixels that look like the one clicked and hang together with it"), Qt::Key_W}};

// Drawn in the colour of texts, whatever the appearance and the screen's scale; in 16 units to a side.
class ToolIcon : public QIconEngine {
 public:
  explicit ToolIcon(ToolKind kind) : kind_(kind) {}
  // A window with the panel that it folds.
  explicit ToolIcon(const QRectF& panel) : shape_(panel) {}
  explicit ToolIcon(const QPolygonF& shape) : shape_(shape), has_frame_(false) {}

  QIconEngine* clone() const override { return new ToolIcon(*this); }
  void paint(QPainter* painter, const QRect& place, QIcon::Mode mode, QIcon::State) override {
    const auto group = mode == QIcon::Disabled ? QPalette::Disabled : QPalette::Active;
    const QColor colour = QApplication::palette().color(group, QPalette::ButtonText);
    painter->save();
    painter->setRenderHint(QPainter::Antialiasing);
    painter->translate(place.topLeft());
    painter->scale(place.width() / 16.0, place.height() / 16.0);
    painter->setPen(QPen(colour, 1.4, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
    draw(*painter, colour);
    painter->restore();
  }
  QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State state) override {
    QPixmap drawn(size);
    drawn.fill(Qt::transparent);
    QPainter painter(&drawn);
    paint(&painter, drawn.rect(), mode, state);
    return drawn;
  }

 private:
  void draw(QPainter& painter, const QColor& colour) const {
    if (!shape_.isEmpty()) {
      if (has_frame_) painter.drawRect(QRectF(1.5, 2.5, 13, 11));
      painter.setPen(Qt::NoPen);
      painter.setBrush(colour);
      return painter.drawPolygon(shape_);
    }
    switch (kind_) {
      case ToolKind::look:
        painter.drawEllipse(QPointF(6.5, 6.5), 4.5, 4.5);
        return painter.drawLine(QPointF(10, 10), QPointF(14, 14));
      case ToolKind::brush:
        painter.drawLine(QPointF(14, 2), QPointF(7, 9));
        painter.setBrush(colour);
        return painter.drawEllipse(QPointF(4.5, 11.5), 2.5, 2.5);
      case ToolKind::rectangle: return painter.drawRect(QRectF(2, 4, 12, 8));
      case ToolKind::ellipse: return painter.drawEllipse(QRectF(1.5, 3.5, 13, 9));
      case ToolKind::polygon:
        return painter.drawPolygon(QPolygonF({{8, 2}, {14, 6.5}, {11, 14}, {3, 12}, {2, 5}}));
      case ToolKind::wand:
        painter.drawLine(QPointF(2, 14), QPointF(9, 7));
        for (const QPointF ray : {QPointF(3, 0), QPointF(0, 3), QPointF(2, 2), QPointF(2, -2)})
          painter.drawLine(QPointF(11, 5) - ray, QPointF(11, 5) + ray);
    }
  }

  ToolKind kind_ = ToolKind::look;
  QPolygonF shape_;  // in place of it
  bool has_frame_ = true;
};

// What keys and the mouse do where no menu says it.
constexpr std::pair<const char*, const char*> kElsewhere[] = {
    {QT_TR_NOOP("Picture: wheel, middle button"), QT_TR_NOOP("zooms to the pointer, pans")},
    {QT_TR_NOOP("Space, Escape"), QT_TR_NOOP("plays the interval as a film and stops it; stops it")},
    {QT_TR_NOOP("Picture: Return"), QT_TR_NOOP("takes a pixel, which arrows then move")},
    {QT_TR_NOOP("Picture with a tool: arrows, Space, Backspace"),
     QT_TR_NOOP("move the pointer; begin and end a stroke, one that erases")},
    {QT_TR_NOOP("Alt with a tool"), QT_TR_NOOP("erases")},
    {QT_TR_NOOP("H, M, A, held"),
     QT_TR_NOOP("hides outlines; magnifies round the pointer, with codes; shows snapshot A")},
    {QT_TR_NOOP("Time: wheel, Shift and wheel, F"), QT_TR_NOOP("zooms, pans, shows all")},
    {QT_TR_NOOP("Strip: Left, Right, Up, Down"),
     QT_TR_NOOP("the interval earlier and later, longer and shorter, by a sample")},
    {QT_TR_NOOP("Strip: I, O, X, Z"),
     QT_TR_NOOP("In and Out at its ends; exposes between them; shows what lies there")},
    {QT_TR_NOOP("Curve: click, right click"), QT_TR_NOOP("adds a point, takes it away")},
    {QT_TR_NOOP("Curve: Insert, Delete, Return"),
     QT_TR_NOOP("the same, and types numbers; arrows move a point")},
    {QT_TR_NOOP("Shift, Ctrl while dragging"), QT_TR_NOOP("a tenth as fast; not drawn to samples")},
    {QT_TR_NOOP("Escape"), QT_TR_NOOP("takes back what is not finished, closes a message")}};

// The words are of these tables.
QString said(const char* words) { return QCoreApplication::translate("nutik::studio", words); }

constexpr const char* kNormalizations[] = {"support", "integral", "absolute"};

}  // namespace

QAction* MainWindow::add_action(QMenu& menu, const QString& text, const QKeySequence& keys,
                                std::function<void()> run) {
  QAction* action = menu.addAction(text);
  action->setShortcut(keys);
  connect(action, &QAction::triggered, this, std::move(run));
  return action;
}

void MainWindow::offer(QMenu& menu, const QString& text, const QKeySequence& keys, std::function<void()> run) {
  needs_capture_ += add_action(menu, text, keys, std::move(run));
}

void MainWindow::build_menus() {
  build_file_menu();
  QMenu& edit = *menuBar()->addMenu(tr("&Edit"));
  QAction* undo = document_.undo_stack().createUndoAction(this, tr("&Undo"));
  undo->setShortcut(QKeySequence::Undo);
  QAction* redo = document_.undo_stack().createRedoAction(this, tr("&Redo"));
  redo->setShortcuts({QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_Z), QKeySequence(Qt::CTRL | Qt::Key_Y)});
  edit.addActions({undo, redo});
  build_region_menu();
  build_start_menu();
  build_view_menu();
  build_help_menu();
  auto* bar = new QToolBar(tr("Tools"));
  bar->setObjectName("tools");
  bar->setMovable(false);
  addToolBar(Qt::LeftToolBarArea, bar);
  build_tools(*bar);
  bar->addSeparator();
  bar->addAction(findChild<QAction*>("play"));
  bar->addSeparator();
  bar->addActions(folds_);
  const auto follow = [this] {
    for (QAction* action : std::as_const(needs_capture_)) action->setEnabled(document_.facts() != nullptr);
  };
  connect(&document_, &Document::capture_changed, this, follow);
  follow();
}

void MainWindow::build_file_menu() {
  QMenu& menu = *menuBar()->addMenu(tr("&File"));
  add_action(menu, tr("&Open…"), QKeySequence::Open, [this] {
    if (may_leave()) choose_file();
  });
  QMenu& recent = *menu.addMenu(tr("Open &recent"));
  connect(&recent, &QMenu::aboutToShow, this, [this, &recent] { fill_recent(recent); });
  QMenu& unsaved = *menu.addMenu(tr("Reco&ver unsaved work"));
  connect(&unsaved, &QMenu::aboutToShow, this, [this, &unsaved] { fill_unsaved(unsaved); });
  connect(&menu, &QMenu::aboutToShow, &unsaved,
          [&unsaved] { unsaved.setEnabled(!Autosave::found().empty()); });
  offer(menu, tr("Open a&gain"), QKeySequence::Refresh, [this] {
    if (!may_leave()) return;
    notice_->clear();
    if (!project_.isEmpty()) return open_project(project_);
    open_capture_file(document_.facts()->path, document_.facts()->stated, {});
  });
  offer(menu, tr("How &the clip is read…"), {}, [this] {
    if (!may_leave()) return;
    if (!project_.isEmpty()) return open_project(project_, {}, nullptr, true);
    ask_how_to_read(document_.facts()->path, document_.facts()->stated, tr("The clip is opened again."), {});
  });
  menu.addSeparator();
  offer(menu, tr("&Save project"), QKeySequence::Save, [this] { save(); });
  offer(menu, tr("Save project &as…"), Qt::CTRL | Qt::SHIFT | Qt::Key_S, [this] { save_as(); });
  offer(menu, tr("Load &functions…"), {}, [this] {
    ask_for_file(tr("Load functions"), tr("Function files (*.fn);;All files (*)"),
                 [this](const QString& path) { use_functions(path); });
  });
  offer(menu, tr("Load &mask…"), {}, [this] {
    ask_for_file(tr("Load mask"), tr("Masks (*.pgm *.png);;All files (*)"),
                 [this](const QString& path) { use_mask(path); });
  });
  offer(menu, tr("Save f&unctions as…"), {}, [this] {
    ask_for_name(tr("Save the functions"), ".fn", tr("Function files (*.fn)"),
                 [this](const QString& path) { write_functions(path); });
  });
  offer(menu, tr("Save mas&k as…"), {}, [this] {
    ask_for_name(tr("Save the mask"), ".pgm", tr("Masks (*.pgm *.png)"),
                 [this](const QString& path) { write_mask(path); });
  });
  menu.addSeparator();
  offer(menu, tr("&Export picture…"), Qt::CTRL | Qt::Key_E, [this] { choose_export(); });
  offer(menu, tr("Export f&ilm…"), Qt::CTRL | Qt::SHIFT | Qt::Key_E, [this] { choose_film(); });
  offer(menu, tr("&Copy as command"), Qt::CTRL | Qt::SHIFT | Qt::Key_C, [this] { copy_command(); });
  menu.addSeparator();
  add_action(menu, tr("&Quit"), QKeySequence::Quit, [this] { close(); });
}

void MainWindow::build_region_menu() {
  QMenu& menu = *menuBar()->addMenu(tr("&Regions"));
  offer(menu, tr("&Add region"), Qt::CTRL | Qt::SHIFT | Qt::Key_N, [this] { add_region(document_); });
  offer(menu, tr("&Remove region"), Qt::CTRL | Qt::SHIFT | Qt::Key_Backspace,
        [this] { remove_region(document_, document_.selected_tag()); });
  offer(menu, tr("Move &up"), Qt::CTRL | Qt::Key_PageUp,
        [this] { move_region(document_, document_.selected_tag(), Move::up); });
  offer(menu, tr("Move &down"), Qt::CTRL | Qt::Key_PageDown,
        [this] { move_region(document_, document_.selected_tag(), Move::down); });
  offer(menu, tr("&Expose over the interval"), Qt::CTRL | Qt::Key_I,
        [this] { expose_over_boxcar(document_, document_.selected_tag()); });
  offer(menu, tr("&Solo: darken the others"), Qt::CTRL | Qt::SHIFT | Qt::Key_O, [this] {
    const std::uint8_t tag = document_.selected_tag();
    document_.set_solo(document_.solo() == tag ? std::nullopt : std::optional(tag));
  });
  menu.addSeparator();
  offer(menu, tr("Select what &moves"), Qt::CTRL | Qt::Key_M, [this] { select_motion(); });
  offer(menu, tr("Select what di&ffers…"), Qt::CTRL | Qt::Key_D, [this] { choose_difference(); });
  offer_beside(*side_->findChild<QWidget*>("regions"), menu);
}

// As the menu of a right click.
void MainWindow::offer_beside(QWidget& widget, const QMenu& menu) {
  widget.addActions(menu.actions());
  widget.setContextMenuPolicy(Qt::ActionsContextMenu);
}

void MainWindow::build_help_menu() {
  QMenu& menu = *menuBar()->addMenu(tr("&Help"));
  add_action(menu, tr("&Keys and mouse"), QKeySequence::HelpContents, [this] { show_keys(); });
  add_action(menu, tr("&About nutik studio"), {}, [this] {
    QMessageBox::about(
        this, tr("About nutik studio"),
        tr("nutik studio %1\n\nTime and gain after filming: gain functions and masks are drawn while the "
           "picture follows. It writes what nutik-cl reads.")
            .arg(NUTIK_VERSION));
  });
}

// Lists what has a key in each menu, and what keys do elsewhere.
void MainWindow::show_keys() {
  QString rows;
  const auto add = [&rows](const QString& keys, const QString& what) {
    rows += QString("<tr><td><b>%1</b>&nbsp;&nbsp;</td><td>%2</td></tr>")
                .arg(keys.toHtmlEscaped(), what.toHtmlEscaped());
  };
  for (QAction* action : findChildren<QAction*>()) {
    const QString keys = action->shortcut().toString(QKeySequence::NativeText);
    if (!keys.isEmpty()) add(keys, action->text().remove('&').remove(QChar(0x2026)));
  }
  for (const auto& [keys, what] : kElsewhere) add(said(keys), said(what));
  auto* dialog = new QDialog(this);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setWindowTitle(tr("Keys and mouse"));
  auto* text = new QTextBrowser(dialog);
  text->setHtml("<table>" + rows + "</table>");
  text->setAccessibleName(dialog->windowTitle());
  auto* column = new QVBoxLayout(dialog);
  column->addWidget(text);
  dialog->resize(620, 560);
  dialog->show();
}

void MainWindow::build_start_menu() {
  QMenu& menu = *menuBar()->addMenu(tr("&Start from"));
  menu.setToolTipsVisible(true);
  for (const StartingPoint& point : starting_points()) {
    QAction* action = add_action(menu, Document::tr(point.name), {}, [this, &point] { start_from(point); });
    action->setToolTip(Document::tr(point.tip));
    needs_capture_ += action;
  }
  menu.addSeparator();
  offer(menu, tr("Study with &choices…"), {}, [this] { choose_study(); });
  offer(menu, tr("&Empty scene, as a picture…"), {}, [this] { save_plate(document_.marks()); });
}

void MainWindow::build_view_menu() {
  QMenu& menu = *menuBar()->addMenu(tr("&View"));
  constexpr double kStep = 1.5;
  add_action(menu, tr("Zoom &in"), QKeySequence::ZoomIn, [this] { canvas_->zoom_by(kStep); });
  add_action(menu, tr("Zoom &out"), QKeySequence::ZoomOut, [this] { canvas_->zoom_by(1 / kStep); });
  add_action(menu, tr("&Fit"), Qt::CTRL | Qt::Key_0, [this] { canvas_->fit(); });
  add_action(menu, tr("&Pixel for pixel"), Qt::CTRL | Qt::Key_1, [this] { canvas_->show_actual_size(); });
  offer_beside(*canvas_, menu);
  add_action(menu, tr("All of the &time"), Qt::CTRL | Qt::Key_T, [this] { axis_.show_all(); });
  QAction* play = add_action(menu, tr("Pla&y or stop"), {}, [this] { play_or_stop(); });
  play->setObjectName("play");
  play->setIcon(QIcon(new ToolIcon(QPolygonF({{3, 2}, {14, 8}, {3, 14}}))));
  play->setToolTip(tr("Plays the interval through the capture, or from In to Out (Space)"));
  needs_capture_ += play;
  menu.addSeparator();
  clipping_ = add_action(menu, tr("Mark &clipped light"), Qt::Key_C,
                         [this] { light_ ? mark_clipped() : measure_light(); });
  clipping_->setCheckable(true);
  offer(menu, tr("&Keep as snapshot A"), Qt::CTRL | Qt::Key_K, [this] { keep_snapshot(); });
  offer(menu, tr("S&wap with snapshot A"), Qt::CTRL | Qt::SHIFT | Qt::Key_K, [this] { swap_snapshot(); });
  menu.addSeparator();
  const auto fold = [&](const char* name, const QString& text, Qt::Key key, const QRectF& icon) {
    QAction* action = menu.addAction(QIcon(new ToolIcon(icon)), text);
    action->setObjectName(name);
    action->setShortcut(key);
    action->setCheckable(true);
    action->setChecked(true);
    action->setToolTip(tr("%1 (%2): shown or folded").arg(QString(text).remove('&'), action->shortcut().toString()));
    connect(action, &QAction::toggled, this, &MainWindow::follow_opening);
    folds_ += action;
    needs_capture_ += action;
  };
  fold("fold_time", tr("Time &strip"), Qt::Key_F7, {2, 7, 12, 2});
  fold("fold_curves", tr("C&urves"), Qt::Key_F8, {2, 9, 12, 4});
  fold("fold_side", tr("&Regions and exposure"), Qt::Key_F9, {10, 3, 4, 10});
  connect(folds_.back(), &QAction::toggled, this, [this] {
    if (!light_) measure_light();
  });
  QMenu& looks = *menu.addMenu(tr("&Appearance"));
  auto* group = new QActionGroup(this);
  const std::pair<Appearance, QString> rows[] = {{Appearance::dark, tr("&Dark")},
                                                 {Appearance::light, tr("&Light")},
                                                 {Appearance::system, tr("&System")}};
  for (const auto& [appearance, name] : rows) {
    QAction* action = add_action(looks, name, {}, [chosen = appearance] {
      set_appearance(chosen);
      keep_appearance(chosen);
    });
    action->setCheckable(true);
    action->setChecked(kept_appearance() == appearance);
    group->addAction(action);
  }
}

void MainWindow::build_tools(QToolBar& bar) {
  tools_ = new QActionGroup(this);
  for (const ToolRow& row : kTools) {
    QAction* action = bar.addAction(said(row.name));
    action->setObjectName(row.object);
    action->setCheckable(true);
    action->setChecked(row.kind == ToolKind::look);
    action->setShortcut(row.key);
    action->setIcon(QIcon(new ToolIcon(row.kind)));
    action->setToolTip(tr("%1 (%2): %3").arg(said(row.name), action->shortcut().toString(), said(row.tip)));
    tools_->addAction(action);
    connect(action, &QAction::toggled, this, [this, kind = row.kind](bool is_chosen) {
      if (is_chosen) use_tool(kind);
    });
    needs_capture_ += action;
  }
}

QWidget* MainWindow::build_exposure() {
  radius_ = new NumberBox;
  describe(*radius_, "brush_radius", tr("Radius of the brush, in pixels"));
  radius_->setRange(0.5, 500);
  radius_->setDecimals(1);
  radius_->setValue(tool_settings_.brush_radius);
  radius_->setPrefix(tr("Brush "));
  radius_->setSuffix(tr(" px"));
  connect(radius_, &QDoubleSpinBox::valueChanged, this, [this](double value) {
    tool_settings_.brush_radius = value;
    canvas_->update();
  });
  codes_ = new QSpinBox;
  describe(*codes_, "wand_codes",
           tr("How many codes of 255 a pixel may differ by from the one that the wand clicked"));
  codes_->setRange(0, 255);
  codes_->setValue(tool_settings_.wand_codes);
  codes_->setPrefix(tr("Wand ± "));
  connect(codes_, &QSpinBox::valueChanged, this, [this](int value) { tool_settings_.wand_codes = value; });
  mode_ = new QComboBox;
  describe(*mode_, "mode", tr("What is exposed: the interval everywhere, or each region's function"));
  mode_->addItems({tr("One interval for all"), tr("Each region its own")});
  connect(mode_, &QComboBox::activated, this, [this](int index) {
    document_.set_mode(index == 0 ? ExposureMode::boxcar : ExposureMode::functions);
  });
  normalization_ = new QComboBox;
  normalization_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  normalization_->addItems({tr("Average while open, as a camera"), tr("Still things keep their brightness"),
                            tr("Average, whatever the gain's sign")});
  describe(*normalization_, "normalization", tr("Brightness: what the exposure is divided by"),
           tr("What the exposure is divided by: the time with a gain; its integral, so that what rests keeps its "
              "brightness; that of its magnitude"));
  connect(normalization_, &QComboBox::activated, this, [this](int index) {
    DocumentState state = document_.state();
    state.normalization = Normalization::parse(kNormalizations[index]);
    document_.apply(std::move(state), tr("Normalize"));
  });
  brightness_ = new NumberBox;
  describe(*brightness_, "brightness", tr("Brightness, in stops"));
  brightness_->setRange(-kMostBrightnessEv, kMostBrightnessEv);
  brightness_->setSingleStep(0.25);
  brightness_->setKeyboardTracking(false);  // 2.5 is one step, and not 2 first
  brightness_->setPrefix(tr("EV "));
  connect(brightness_, &QDoubleSpinBox::valueChanged, this, [this](double stops) {
    DocumentState state = document_.state();
    state.brightness_ev = stops;
    document_.apply(std::move(state), tr("Brightness"));
  });
  const auto film_box = [this](QDoubleSpinBox*& box, const char* name, double least, double most,
                               const QString& tip) {
    box = new NumberBox;
    describe(*box, name, tip);
    box->setRange(least, most);
    box->setStepType(QAbstractSpinBox::AdaptiveDecimalStepType);
    box->setKeyboardTracking(false);
    connect(box, &QDoubleSpinBox::valueChanged, this, [this] {
      if (!playing_.isActive()) return;
      stop_playing();
      play_or_stop();
    });
  };
  film_box(speed_, "film_speed", 0.001, 1000, tr("Speed of the film: 0.25 is four times slower than life"));
  speed_->setDecimals(3);
  speed_->setPrefix(tr("Film "));
  speed_->setSuffix(QStringLiteral("×"));
  film_box(angle_, "film_angle", 1, 3600, tr("Shutter angle of the film: 360° is all of the time to the next frame"));
  angle_->setDecimals(0);
  angle_->setSuffix(QStringLiteral("°"));
  connect(&playing_, &QTimer::timeout, this, &MainWindow::play_on);
  auto* exposure = new QWidget;
  auto* grid = new QGridLayout(exposure);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->addWidget(mode_, 0, 0);
  grid->addWidget(brightness_, 0, 1);
  grid->addWidget(normalization_, 1, 0, 1, 2);
  grid->addWidget(radius_, 2, 0);
  grid->addWidget(codes_, 2, 1);
  grid->addWidget(speed_, 3, 0);
  grid->addWidget(angle_, 3, 1);
  return exposure;
}

void MainWindow::follow_exposure() {
  const DocumentState& state = document_.state();
  const QSignalBlocker quiet(brightness_);
  mode_->setCurrentIndex(state.mode == ExposureMode::boxcar ? 0 : 1);
  normalization_->setPlaceholderText(QString::fromStdString(state.normalization.text()));  // where it is none of these
  normalization_->setCurrentIndex(-1);
  for (int index = 0; index < static_cast<int>(std::size(kNormalizations)); ++index)
    if (state.normalization.text() == kNormalizations[index]) normalization_->setCurrentIndex(index);
  brightness_->setValue(state.brightness_ev);
  for (QWidget* widget : std::initializer_list<QWidget*>{mode_, normalization_, brightness_})
    widget->setEnabled(document_.facts() != nullptr);
}

}  // namespace nutik::studio
