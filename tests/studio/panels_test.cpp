// What stands round the picture: regions, status, menus, appearance; and that all of it is reached and told without a
// mouse and without eyes.
#include <QAccessible>
#include <QColorDialog>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QMenuBar>
#include <QProgressBar>
#include <QScreen>
#include <QSettings>
#include <QSplitter>
#include <QTextBrowser>
#include <QToolButton>
#include <QTreeWidget>

#include "studio/regions/region_edits.hpp"
#include "studio/time/time_strip.hpp"
#include "studio/time/times.hpp"
#include "studio/window/appearance.hpp"
#include "studio_test.hpp"

namespace nutik::studio {
namespace {

class PanelsTest : public StudioTest {
 protected:
  static constexpr int kName = 0, kStill = 2, kClipped = 3, kSolo = 4;

  // A region of 20 × 20 pixels at (10, 10).
  void add_square() {
    open_clip();
    click_button("add_region");
    click_tool("tool_rectangle");
    drag(canvas(), at(10, 10), at(30, 30));
    ASSERT_TRUE(settles());
  }

  [[nodiscard]] QTreeWidget& list() { return child<QTreeWidget>("regions"); }
  // Where a row's box to check is.
  [[nodiscard]] QPoint box_of(QTreeWidgetItem& item, int column) {
    return {list().header()->sectionViewportPosition(column) + 10, list().visualItemRect(&item).center().y()};
  }
  void click_in_list(QPoint at) { QTest::mouseClick(list().viewport(), Qt::LeftButton, {}, at); }
  [[nodiscard]] QString status(const char* label) { return child<QLabel>(label).text(); }
  [[nodiscard]] QImage shown() { return canvas().grab().toImage(); }
};

// ---- regions ----

TEST_F(PanelsTest, ARegionIsRenamedByADoubleClick) {
  ASSERT_NO_FATAL_FAILURE(add_square());
  QTreeWidgetItem& item = *list().currentItem();
  const QPoint name = box_of(item, kName) + QPoint(60, 0);
  click_in_list(name);
  QTest::mouseDClick(list().viewport(), Qt::LeftButton, {}, name);
  auto* editor = list().viewport()->findChild<QLineEdit*>();
  ASSERT_NE(editor, nullptr);
  QTest::keyClicks(editor, "Ball");
  QTest::keyClick(editor, Qt::Key_Return);
  QCoreApplication::processEvents();
  EXPECT_EQ(document().state().looks.at(document().selected_tag()).name, "Ball");
  EXPECT_EQ(document().undo_stack().undoText(), "Rename region");
  QTest::mouseDClick(list().viewport(), Qt::LeftButton, {}, box_of(*list().currentItem(), kStill));
  QCoreApplication::sendPostedEvents(nullptr, QEvent::DeferredDelete);
  EXPECT_EQ(list().viewport()->findChild<QLineEdit*>(), nullptr) << "what is told cannot be edited";
}

TEST_F(PanelsTest, ARegionIsHiddenAndShownAlone) {
  ASSERT_NO_FATAL_FAILURE(add_square());
  const std::uint8_t tag = document().selected_tag();
  click_tool("tool_look");
  QTest::mouseMove(&canvas(), at(80, 40));
  const QPointF edge = canvas().view().to_widget({10, 20});
  const QPoint inside = at(15, 15), outside = at(60, 15);
  const QImage outlined = shown();
  const QColor colour = document().state().looks.at(tag).colour;
  EXPECT_EQ(shown_at(outlined, edge), colour) << "a line in the region's colour";
  const double ratio = outlined.devicePixelRatio();
  int wide = 0;
  for (double x = -4; x <= 4; x += 1 / ratio) wide += shown_at(outlined, edge + QPointF(x, 0)) == colour;
  EXPECT_GE(wide, 2 * ratio - 1) << "as wide on every screen";
  click_in_list(box_of(*list().currentItem(), kName));
  EXPECT_FALSE(document().state().looks.at(tag).is_visible);
  EXPECT_NE(shown_at(shown(), edge), colour);
  click_in_list(box_of(*list().currentItem(), kName));
  EXPECT_EQ(shown(), outlined);

  click_in_list(box_of(*list().currentItem(), kSolo));
  EXPECT_EQ(document().solo(), tag);
  const QImage alone = shown();
  EXPECT_EQ(shown_at(alone, inside), shown_at(outlined, inside));
  EXPECT_LT(shown_at(alone, outside).lightness(), shown_at(outlined, outside).lightness() / 2 + 1)
      << "darkened";
  list().setFocus();
  list().setCurrentItem(list().currentItem(), kSolo);
  QTest::keyClick(&list(), Qt::Key_Space);
  EXPECT_FALSE(document().solo()) << "by keyboard";
  EXPECT_EQ(shown(), outlined);
  click_in_list(box_of(*list().currentItem(), kSolo));
  click_button("remove_region");
  EXPECT_EQ(list().topLevelItemCount(), 1);
  EXPECT_FALSE(document().solo()) << "it goes with the region";
}

TEST_F(PanelsTest, ARegionsColourIsChosen) {
  ASSERT_NO_FATAL_FAILURE(add_square());
  const std::uint8_t tag = document().selected_tag();
  click_tool("tool_look");
  const RegionLook before = document().state().looks.at(tag);
  const QColor chosen("#ff20c0");
  answer_next<QColorDialog>([&](QColorDialog& dialog) {
    EXPECT_TRUE(dialog.windowTitle().contains(before.name)) << dialog.windowTitle().toStdString();
    EXPECT_EQ(dialog.currentColor(), before.colour);
    dialog.setCurrentColor(chosen);
    QTest::keyClick(&dialog, Qt::Key_Return);
  });
  click_button("region_colour");
  EXPECT_TRUE(is_asked_);
  EXPECT_EQ(document().state().looks.at(tag).colour, chosen);
  EXPECT_EQ(shown_at(shown(), canvas().view().to_widget({10, 20})), chosen);
  answer_next<QColorDialog>([](QColorDialog& dialog) { QTest::keyClick(&dialog, Qt::Key_Escape); });
  click_button("region_colour");
  EXPECT_EQ(document().state().looks.at(tag).colour, chosen) << "who escapes changes nothing";
  document().undo_stack().undo();
  EXPECT_EQ(document().state().looks.at(tag), before);
}

TEST_F(PanelsTest, TheWandTakesTheSquareThatIsSeen) {
  open_clip();
  document().set_boxcar({150'000'000, 10'000'000}, "Scrub");  // at rest
  click_button("add_region");
  ASSERT_TRUE(settles());
  const QImage before = canvas().image();
  const int left = test::MovingSquare::left(15), top = test::MovingSquare::kTop;
  click_tool("tool_wand");
  QTest::mouseClick(&canvas(), Qt::LeftButton, {}, at(left + 4.5, top + 4.5));
  EXPECT_EQ(region_of(document(), document().selected_tag()),
            rectangle(96, 48, {1.0 * left, 1.0 * top}, test::MovingSquare::kSide, test::MovingSquare::kSide));
  EXPECT_EQ(document().undo_stack().undoText(), "Magic wand");
  document().set_points(document().selected_tag(), {{0, 0.5}, {100'000'000, 0.0}}, "Shape");
  ASSERT_TRUE(settles());
  EXPECT_NE(difference(canvas().image(), before), "");
  EXPECT_EQ(difference(canvas().image(), fresh_picture()), "");
}

TEST_F(PanelsTest, AllEdgesAreFeatheredAsTyped) {
  ASSERT_NO_FATAL_FAILURE(add_square());
  document().set_points(document().selected_tag(), {{0, 0.25}, {document().duration_ns(), 0.25}}, "Shape");
  document().set_points(kBackground, {{0, 1.0}, {document().duration_ns(), 1.0}}, "Shape");
  ASSERT_TRUE(settles());
  const QImage hard = canvas().image();
  type_into(child<QDoubleSpinBox>("feather"), "2.5");
  EXPECT_EQ(document().state().feather, (Feather{250, {}}));
  ASSERT_TRUE(settles());
  EXPECT_NE(canvas().image().pixel(11, 20), hard.pixel(11, 20));
  EXPECT_EQ(canvas().image().pixel(20, 20), hard.pixel(20, 20));
  EXPECT_EQ(difference(canvas().image(), fresh_picture()), "");
}

TEST_F(PanelsTest, TheWindowsKeysAreItsOwnInFields) {
  open_clip();
  auto& box = child<QDoubleSpinBox>("feather");
  const DocumentState before = document().state();
  type_into(box, "3");
  EXPECT_NE(document().state(), before);
  QTest::keyClick(&box, Qt::Key_Z, Qt::ControlModifier);
  EXPECT_EQ(document().state(), before);
  name_next_export("picture.png");
  QTest::keyClick(&box, Qt::Key_E, Qt::ControlModifier);
  EXPECT_TRUE(is_asked_);
  ASSERT_TRUE(settles());
  EXPECT_TRUE(std::filesystem::exists(scratch_ / "picture.png")) << window_.notice().text().toStdString();
  QTest::keyClicks(&box, "4");
  QTest::keyClick(&box, Qt::Key_Z, Qt::ControlModifier);
  EXPECT_EQ(document().state(), before) << "what is being typed is the field's";
  window_.activateWindow();  // which a desktop does once the dialog is gone
  ASSERT_TRUE(QTest::qWaitForWindowActive(&window_));
  auto& start = child<QLineEdit>("start");
  type_into(start, "10 ms");
  EXPECT_EQ(document().boxcar().start_ns, 10'000'000);
  QTest::keyClick(&start, Qt::Key_Z, Qt::ControlModifier);
  EXPECT_EQ(document().state(), before);
  EXPECT_EQ(start.text(), exact_time_text(before.boxcar.start_ns));
}

TEST_F(PanelsTest, TheWheelChangesNothingThatHasNoFocus) {
  open_clip();
  const DocumentState before = document().state();
  canvas().setFocus();
  for (const char* name : {"mode", "normalization", "brightness"}) {
    auto& field = child<QWidget>(name);
    const QPointF place = field.rect().center();
    QWheelEvent event(place, field.mapToGlobal(place), {}, {0, -120}, Qt::NoButton, {}, Qt::NoScrollPhase, false);
    QApplication::sendEvent(&field, &event);
    EXPECT_EQ(document().state(), before) << name;
  }
}

TEST_F(PanelsTest, AStrokeWithoutARegionMakesOne) {
  open_clip();
  const DocumentState before = document().state();
  for (const char* tool : {"tool_ellipse", "tool_brush"}) {
    click_tool(tool);
    drag(canvas(), at(20, 10), at(40, 30));
    EXPECT_EQ(document().functions().size(), 2u) << tool;
    EXPECT_GT(pixels_of(document().selected_tag()), 100u) << tool;
    EXPECT_NE(document().selected_tag(), kBackground);
    document().undo_stack().undo();
    EXPECT_EQ(document().state(), before) << "in one step";
  }
}

// ---- status ----

TEST_F(PanelsTest, TheStatusTellsThePixelTheArithmeticAndTheTime) {
  open_clip();
  QTest::mouseMove(&canvas(), at(50.5, 20.5));
  const QRgb codes = canvas().image().pixel(50, 20);
  const QString text = status("pixel");
  EXPECT_TRUE(text.startsWith("x 50, y 20")) << text.toStdString();
  EXPECT_TRUE(text.contains(QString("code %1").arg(qRed(codes)))) << text.toStdString();
  const double light = Transfer::srgb().light_of(qRed(codes) / 255.0);
  EXPECT_TRUE(text.contains(QString("light %1").arg(light, 0, 'f', 3))) << text.toStdString();
  QEvent leave(QEvent::Leave);
  QApplication::sendEvent(&canvas(), &leave);
  EXPECT_EQ(status("pixel"), "");
  EXPECT_EQ(status("arithmetic").toStdString(), "exact to 0.01 codes");
  EXPECT_TRUE(child<QLabel>("arithmetic").toolTip().contains("fixed: light within"))
      << child<QLabel>("arithmetic").toolTip().toStdString();
  EXPECT_TRUE(QRegularExpression("^after \\d+ ms$").match(status("milliseconds")).hasMatch())
      << status("milliseconds").toStdString();
  EXPECT_EQ(status("saturated"), "");
  type_into(child<QDoubleSpinBox>("brightness"), "8");
  ASSERT_TRUE(settles());
  EXPECT_EQ(document().state().brightness_ev, 8);
  EXPECT_EQ(difference(canvas().image(), fresh_picture()), "");
  EXPECT_TRUE(status("saturated").startsWith("4608 px clipped")) << status("saturated").toStdString();
}

TEST_F(PanelsTest, EachRegionTellsHowManyOfItsPixelsAreClipped) {
  ASSERT_NO_FATAL_FAILURE(add_square());
  QTreeWidgetItem &square = *list().topLevelItem(0), &background = *list().topLevelItem(1);
  EXPECT_EQ(square.text(kClipped) + background.text(kClipped), "");
  document().set_points(kBackground, {{0, 0.25}, {document().duration_ns(), 0.25}}, "Shape");
  document().set_points(document().selected_tag(), {{0, 1.0}, {document().duration_ns(), 1.0}}, "Shape");
  // Of light 0.045: 1.4, and 0.36 where the gain is a quarter.
  type_into(child<QDoubleSpinBox>("brightness"), "5");
  ASSERT_TRUE(settles());
  EXPECT_EQ(square.text(kClipped), "400") << "all of it";
  EXPECT_EQ(status("saturated"), QString("%1 px clipped").arg(400 + background.text(kClipped).toInt()))
      << "as many as are told of the picture";
  EXPECT_LT(background.text(kClipped).toInt(), 1000);
  QTest::keyClick(&window_, Qt::Key_Z, Qt::ControlModifier);
  ASSERT_TRUE(settles());
  EXPECT_EQ(square.text(kClipped), "");
}

TEST_F(PanelsTest, NumbersHaveAPointAndAreTypedWithACommaToo) {
  QLocale::setDefault(QLocale(QLocale::German, QLocale::Germany));
  {
    MainWindow window;
    window.show();
    open_in(window);
    for (const char* typed : {"2,5", "2.5"}) {
      for (const char* name : {"brush_radius", "brightness", "feather", "radius"}) {
        auto& box = *window.findChild<QDoubleSpinBox*>(name);
        box.setValue(1);
        type_into(box, typed);
        EXPECT_EQ(box.value(), 2.5) << name;
        EXPECT_TRUE(box.text().contains("2.5")) << box.text().toStdString();
      }
      type_into(*window.findChild<QLineEdit*>("width"), QString(typed) + " ms");
      EXPECT_EQ(window.document().boxcar().length_ns, 2'500'000) << typed;
      EXPECT_EQ(read_typed_gain(typed).value, 2.5);
      window.document().set_boxcar({0, 1'000}, "Scrub");
    }
    window.document().undo_stack().setClean();
  }
  QLocale::setDefault(QLocale::c());
}

TEST_F(PanelsTest, StillIsWhatLightThatRestsIsMultipliedBy) {
  open_clip();
  document().set_points(kBackground, {{0, 0}, {document().duration_ns(), 1}}, "Shape");
  const auto still = [&] { return list().topLevelItem(0)->text(kStill); };
  EXPECT_EQ(still(), "0.50×");
  const auto divide = [&](const char* by, double stops) {
    DocumentState state = document().state();
    state.normalization = Normalization::parse(by);
    state.brightness_ev = stops;
    document().apply(state, "Normalize");
  };
  divide("integral", 0);
  EXPECT_EQ(still(), "1.00×") << "the picture keeps its brightness";
  divide("integral", 1);
  EXPECT_EQ(still(), "2.00×");
  document().set_points(kBackground, {{0, -1}, {document().duration_ns(), 1}}, "Shape");
  EXPECT_EQ(still(), "–") << "nothing to divide by";
}

TEST_F(PanelsTest, ProgressIsShownWhileAClipIsOpened) {
  auto& bar = *window_.findChild<QProgressBar*>();
  auto& cancel = child<QToolButton>("cancel");
  EXPECT_FALSE(bar.isVisible());
  bool was_shown = false;
  window_.open(path("frames/%02d.pgm"), "100");
  ASSERT_TRUE(QTest::qWaitFor(
      [&] {
        was_shown = was_shown || (bar.isVisible() && cancel.isVisible() && !bar.accessibleName().isEmpty());
        return window_.is_settled();
      },
      kMaxWaitMs));
  EXPECT_TRUE(was_shown);
  EXPECT_FALSE(bar.isVisible() || cancel.isVisible());
}

TEST_F(PanelsTest, ExposureIsDividedAsChosenByKeyboard) {
  ASSERT_NO_FATAL_FAILURE(add_square());
  document().set_points(kBackground, {{0, 0.5}, {document().duration_ns(), 0.5}}, "Shape");
  ASSERT_TRUE(settles());
  const QImage before = canvas().image();
  auto& box = child<QComboBox>("normalization");
  box.setFocus();
  QTest::keyClick(&box, Qt::Key_Down);
  EXPECT_EQ(document().state().normalization, Normalization::parse("integral"));
  ASSERT_TRUE(settles());
  EXPECT_NE(difference(canvas().image(), before), "");
  EXPECT_EQ(difference(canvas().image(), fresh_picture()), "");
  auto& mode = child<QComboBox>("mode");
  mode.setFocus();
  QTest::keyClick(&mode, Qt::Key_Up);
  EXPECT_EQ(document().mode(), ExposureMode::boxcar);
  DocumentState state = document().state();
  state.normalization = Normalization::parse("seconds:0.01");
  document().apply(std::move(state), "Load");
  EXPECT_EQ(box.currentText() + box.placeholderText(), "seconds:0.01") << "it has no line of its own";
}

// ---- screens ----

// tests/studio/CMakeLists.txt runs this with screens of 1.5 and 2 pixels in each direction, too.
TEST_F(PanelsTest, OnePixelIsOneOfTheScreens) {
  open_clip();
  QTest::keyClick(&window_, Qt::Key_1, Qt::ControlModifier);
  const double ratio = canvas().devicePixelRatioF();
  ASSERT_EQ(ratio, qEnvironmentVariable("QT_SCALE_FACTOR", "1").toDouble());
  EXPECT_DOUBLE_EQ(canvas().view().zoom(), 1 / ratio);
  const QImage screen = shown();
  ASSERT_DOUBLE_EQ(screen.devicePixelRatio(), ratio);
  const QPoint corner = (canvas().view().place().topLeft() * ratio).toPoint();
  const QRect place(corner, canvas().image().size());
  ASSERT_TRUE(screen.rect().contains(place));
  int worst = 0;
  for (int y = 1; y < place.height() - 1; ++y)
    for (int x = 1; x < place.width() - 1; ++x)
      worst = std::max(
          worst, std::abs(qRed(screen.pixel(corner + QPoint(x, y))) - qRed(canvas().image().pixel(x, y))));
  // A corner between two of the screen's pixels leaves none as it is.
  const int allowed = ratio == std::floor(ratio) ? 0 : 255;
  EXPECT_LE(worst, allowed) << "pixel for pixel";
}

TEST_F(PanelsTest, TextsAreReadableDarkAndLight) {
  const QPalette kept = QApplication::palette();
  for (const auto appearance : {Appearance::dark, Appearance::light}) {
    set_appearance(appearance);
    const QPalette palette = QApplication::palette();
    using Pair = std::pair<QPalette::ColorRole, QPalette::ColorRole>;
    for (const auto& [text, ground] :
         {Pair{QPalette::WindowText, QPalette::Window}, Pair{QPalette::Text, QPalette::Base},
          Pair{QPalette::ButtonText, QPalette::Button}}) {
      const auto light = [&](QPalette::ColorRole role) {
        return Transfer::srgb().light_of(palette.color(role).green() / 255.0);
      };
      const double one = light(text) + 0.05, other = light(ground) + 0.05;
      EXPECT_GE(std::max(one / other, other / one), 4.5) << "contrast, as WCAG 2 has it";
    }
  }
  QApplication::setPalette(kept);
}

TEST_F(PanelsTest, TheWindowFitsItsScreenAndIsAsItWasClosed) {
  QSettings().remove("window");
  const QSize screen = window_.screen()->availableSize();
  EXPECT_LE(window_.minimumSizeHint().width(), 1000);
  EXPECT_LE(window_.minimumSizeHint().height(), 600);
  const auto sizes = [](MainWindow& window, const char* splitter) {
    return window.findChild<QSplitter*>(splitter)->sizes();
  };
  QList<int> row, column;
  QSize size;
  {
    MainWindow window;
    EXPECT_LT(window.width(), screen.width());
    EXPECT_LE(window.height(), screen.height() - 40) << "a frame's title";
    window.show();
    // Qt makes a window that is larger than its screen as small as it gets, with the page that it begins with.
    window.resize(QSize(1000, 640).boundedTo(screen - QSize(16, 48)).expandedTo(window.minimumSizeHint()));
    open_in(window);
    window.findChild<QSplitter*>("row")->setSizes({600, 320});
    window.findChild<QSplitter*>("panes")->setSizes({180, 122, 260});
    QTest::keyClick(&window, Qt::Key_B);
    window.findChild<QDoubleSpinBox*>("brush_radius")->setValue(7.5);
    window.findChild<QSpinBox*>("wand_codes")->setValue(9);
    row = sizes(window, "row");
    column = sizes(window, "panes");
    size = window.size();
    ASSERT_TRUE(window.close());
  }
  MainWindow window;
  window.show();
  open_in(window);
  EXPECT_EQ(window.size(), size);
  EXPECT_EQ(sizes(window, "row"), row);
  EXPECT_EQ(sizes(window, "panes"), column);
  EXPECT_TRUE(window.findChild<QAction*>("tool_brush")->isChecked());
  EXPECT_EQ(window.findChild<QDoubleSpinBox*>("brush_radius")->value(), 7.5);
  EXPECT_EQ(window.findChild<QSpinBox*>("wand_codes")->value(), 9);
  EXPECT_EQ(window.canvas().cursor().shape(), Qt::CrossCursor) << "it paints";
  QSettings().remove("window");
}

TEST_F(PanelsTest, WhatIsSaidLiesOverThePictureUntilEscape) {
  open_clip();
  window_.notice().clear();
  QApplication::processEvents();
  const QRect place(canvas().mapTo(&window_, QPoint()), canvas().size());
  window_.notice().say(Notice::Kind::note, "Something to know.");
  QApplication::processEvents();
  EXPECT_EQ(QRect(canvas().mapTo(&window_, QPoint()), canvas().size()), place) << "the picture does not move";
  EXPECT_TRUE(window_.notice().isVisible());
  const QPoint middle = window_.notice().mapTo(&window_, window_.notice().rect().center());
  EXPECT_TRUE(window_.notice().isAncestorOf(window_.childAt(middle))) << "it is in front";
  canvas().setFocus();
  document().set_probe(QPoint(3, 3));
  QTest::keyClick(&canvas(), Qt::Key_Escape);
  EXPECT_TRUE(window_.notice().isVisible()) << "the pixel is given up first";
  QTest::keyClick(&canvas(), Qt::Key_Escape);
  EXPECT_FALSE(window_.notice().isVisible());
}

TEST_F(PanelsTest, NothingOfTheToolBarIsHidden) {
  open_clip();
  window_.resize(window_.minimumSizeHint());
  QApplication::processEvents();
  const auto& bar = child<QToolBar>("tools");
  for (const char* name : {"tool_wand", "play", "fold_side"})
    EXPECT_TRUE(bar.rect().contains(bar.actionGeometry(&child<QAction>(name)))) << name;
  const auto& side = child<QWidget>("side");
  for (const char* name : {"brightness", "mode", "brush_radius", "film_angle", "add_region", "own_feather"}) {
    const auto& widget = child<QWidget>(name);
    EXPECT_TRUE(side.rect().contains(QRect(widget.mapTo(&side, QPoint()), widget.size()))) << name;
  }
  EXPECT_LE(window_.width(), 1000);
  EXPECT_LE(window_.height(), 620);
  auto& start = child<QLineEdit>("start");
  start.selectAll();
  QTest::keyClicks(&start, "early\r");
  EXPECT_TRUE(window_.notice().isVisible());
  auto* heard = QAccessible::queryAccessibleInterface(window_.notice().findChild<QLabel*>());
  EXPECT_TRUE(heard->text(QAccessible::Name).startsWith("Start: 'early' is no time"));
  start.selectAll();
  QTest::keyClicks(&start, "0s\r");
  EXPECT_FALSE(window_.notice().isVisible());
}

// The picture is the largest thing, and panels that are folded stay so.
TEST_F(PanelsTest, ThePictureHasHalfOfTheWindowAndPanelsFold) {
  QSettings().remove("window");
  MainWindow window;
  window.resize(1280, 800);
  window.show();
  open_in(window);
  const auto share = [&] {
    QApplication::processEvents();
    return 1.0 * window.canvas().width() * window.canvas().height() / (window.width() * window.height());
  };
  EXPECT_GE(share(), 0.5);
  EXPECT_GE(window.findChild<QWidget*>("regions")->height(), 120) << "and what is beside it is of use";
  for (const Qt::Key key : {Qt::Key_F7, Qt::Key_F8, Qt::Key_F9}) QTest::keyClick(&window, key);
  EXPECT_GE(share(), 0.85);
  EXPECT_FALSE(window.findChild<QWidget*>("side")->isVisible());
  QTest::keyClick(&window, Qt::Key_F8);
  ASSERT_TRUE(window.close());
  MainWindow next;
  next.show();
  open_in(next);
  EXPECT_FALSE(next.findChild<QWidget*>("side")->isVisible());
  EXPECT_FALSE(next.findChild<QWidget*>("time_strip")->isVisible());
  EXPECT_TRUE(next.findChild<QWidget*>("curves")->isVisible());
  QSettings().remove("window");
}

TEST_F(PanelsTest, ToolsHaveIconsAndTheirNamesOnHover) {
  open_clip();
  std::set<QByteArray> icons;
  for (const char* name : {"look", "brush", "rectangle", "ellipse", "polygon", "wand"}) {
    const auto& action = child<QAction>(("tool_" + std::string(name)).c_str());
    EXPECT_TRUE(action.toolTip().startsWith(action.text())) << action.toolTip().toStdString();
    const QImage icon = action.icon().pixmap(32, 32).toImage();
    icons.insert(QByteArray(reinterpret_cast<const char*>(icon.constBits()), icon.sizeInBytes()));
  }
  EXPECT_EQ(icons.size(), 6u) << "all of them different";
  for (const char* name : {"radius", "feather", "own_feather"})
    EXPECT_FALSE(child<QWidget>(name).toolTip().isEmpty()) << name;
}

TEST_F(PanelsTest, HelpTellsKeysAndRightClicksOfferMenus) {
  shortcut(Qt::Key_F1, {});
  const auto* text = window_.findChild<QTextBrowser*>();
  ASSERT_NE(text, nullptr);
  for (const char* words : {"Ctrl+E", "Export picture", "Strip: I, O", "Brush"})
    EXPECT_TRUE(text->toPlainText().contains(words)) << words;
  text->window()->close();
  QString about;
  answer_next<QMessageBox>([&](QMessageBox& box) {
    about = box.text();
    box.accept();
  });
  click_menu("Help", "About");
  EXPECT_TRUE(about.contains(NUTIK_VERSION)) << about.toStdString();
  for (const auto& [name, words] : {std::pair{"regions", "Remove region"}, {"canvas", "Fit"}}) {
    const QWidget& widget = child<QWidget>(name);
    EXPECT_EQ(widget.contextMenuPolicy(), Qt::ActionsContextMenu) << name;
    EXPECT_TRUE(std::ranges::any_of(widget.actions(), [&](const QAction* action) {
      return action->text().remove('&') == words;
    })) << words;
  }
}

// ---- without a mouse, without eyes ----

TEST_F(PanelsTest, EverythingInFocusHasAName) {
  ASSERT_NO_FATAL_FAILURE(add_square());
  int count = 0;
  for (const QWidget* widget : window_.findChildren<QWidget*>()) {
    if (!widget->isVisible() || widget->focusPolicy() == Qt::NoFocus) continue;
    if (widget->objectName().startsWith("qt_") || widget->parentWidget()->inherits("QAbstractSpinBox"))
      continue;
    QAccessibleInterface* interface = QAccessible::queryAccessibleInterface(const_cast<QWidget*>(widget));
    ASSERT_NE(interface, nullptr);
    EXPECT_FALSE(interface->text(QAccessible::Name).isEmpty())
        << widget->metaObject()->className() << " " << widget->objectName().toStdString();
    ++count;
  }
  EXPECT_GE(count, 25);
  for (const char* name : {"canvas", "time_strip", "curves"})
    EXPECT_FALSE(child<QWidget>(name).accessibleDescription().isEmpty()) << name << " tells what keys do";
}

TEST_F(PanelsTest, TabLeadsThroughTheWindow) {
  ASSERT_NO_FATAL_FAILURE(add_square());
  std::set<QWidget*> reached;
  QWidget* widget = &canvas();
  do {
    widget = widget->nextInFocusChain();
    if (widget->isVisible() && widget->isEnabled() && (widget->focusPolicy() & Qt::TabFocus) != 0)
      reached.insert(widget);
  } while (widget != &canvas());
  for (const char* name : {"canvas", "time_strip", "curves", "regions", "start", "width", "in", "out", "mode",
                           "normalization", "brightness", "feather", "own_feather", "radius", "add_region",
                           "region_colour", "brush_radius", "wand_codes", "film_speed", "film_angle"})
    EXPECT_TRUE(reached.contains(&child<QWidget>(name))) << name;
}

TEST_F(PanelsTest, EveryActionHasAKeyOrALetterOfItsOwn) {
  std::map<QString, QString> shortcuts;
  const std::function<void(const QList<QAction*>&)> look = [&](const QList<QAction*>& actions) {
    std::map<QChar, QString> letters;
    for (QAction* action : actions) {
      if (action->isSeparator()) continue;
      const QString text = action->text();
      const auto at = text.indexOf('&');
      const QChar letter = at < 0 || at + 1 == text.size() ? QChar() : text[at + 1].toLower();
      EXPECT_FALSE(letter.isNull() && action->shortcut().isEmpty()) << text.toStdString();
      EXPECT_TRUE(letter.isNull() || letters.emplace(letter, text).second)
          << text.toStdString() << " and " << letters[letter].toStdString();
      for (const QKeySequence& keys : action->shortcuts())
        EXPECT_TRUE(shortcuts.emplace(keys.toString(), text).second)
            << keys.toString().toStdString() << ": " << text.toStdString();
      if (action->menu() != nullptr && !action->text().contains("recent")) look(action->menu()->actions());
    }
  };
  look(window_.menuBar()->actions());
  look(child<QToolBar>("tools").findChild<QToolButton*>()->parentWidget()->actions().mid(0, 6));
}

}  // namespace
}  // namespace nutik::studio
