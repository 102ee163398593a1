// Time strip and curve editor within the window: what a hand does there is in the model, and then in the picture.
#include "studio/curves/curve_editor.hpp"
#include "studio/regions/region_edits.hpp"
#include "studio/time/time_strip.hpp"
#include "studio/window/started_work.hpp"
#include "studio_test.hpp"

namespace nutik::studio {
namespace {

constexpr std::int64_t kMsNs = 1'000'000;

// 20 samples of 10 ms; a region of the square's way, exposed from 40 to 80 ms.
class InteractionsTest : public StudioTest {
 protected:
  void SetUp() override {
    open_clip();
    document().set_boxcar({40 * kMsNs, 40 * kMsNs}, "Begin");
    click_button("add_region");
    paint_region(document(), rectangle(96, 48, {4, 18}, 60, 12), document().selected_tag(), "Rectangle");
    DocumentState state = document().state();
    state.normalization = Normalization::parse("integral");  // what is longer looks different
    document().apply(std::move(state), "Begin");
    ASSERT_TRUE(settles());
  }

  // Whatever was done is one step, changes the picture into the document's, and undo brings both back.
  void expect_followed(const std::function<void()>& act, const std::function<void()>& look) {
    const DocumentState before = document().state();
    const QImage unchanged = canvas().image();
    const int steps = document().undo_stack().index();
    act();
    ASSERT_TRUE(settles());
    look();
    EXPECT_NE(document().state(), before);
    EXPECT_EQ(document().undo_stack().index(), steps + 1);
    EXPECT_NE(difference(canvas().image(), unchanged), "") << "the picture follows";
    EXPECT_EQ(difference(canvas().image(), fresh_picture()), "");
    const DocumentState after = document().state();
    QTest::keyClick(&window_, Qt::Key_Z, Qt::ControlModifier);
    EXPECT_EQ(document().state(), before);
    ASSERT_TRUE(settles());
    EXPECT_EQ(difference(canvas().image(), unchanged), "");
    QTest::keyClick(&window_, Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
    EXPECT_EQ(document().state(), after);
    ASSERT_TRUE(settles());
  }

  [[nodiscard]] CurveEditor& curves() { return child<CurveEditor>("curves"); }
  [[nodiscard]] TimeStrip& strip() { return child<TimeStrip>("time_strip"); }
  [[nodiscard]] std::vector<ControlPoint> points() { return document().points(document().selected_tag()); }
  [[nodiscard]] QPoint place(std::int64_t time_ns, double gain) {
    return curves().frame().place({time_ns, gain}).toPoint();
  }
  [[nodiscard]] QPoint place(std::size_t point) {
    return place(points()[point].time_ns, points()[point].gain);
  }
  [[nodiscard]] int in_strip(std::int64_t time_ns) {
    return qRound(strip().boxcar_area().left() + static_cast<double>(time_ns - document().boxcar().start_ns) *
                                                     strip().boxcar_area().width() /
                                                     static_cast<double>(document().boxcar().length_ns));
  }
};

TEST_F(InteractionsTest, ControlPointsAreDraggedAddedAndTakenAway) {
  expect_followed([&] { drag(curves(), place(2), place(120 * kMsNs, 1)); },
                  [&] { EXPECT_EQ(points()[2].time_ns, 120 * kMsNs) << "snapped to a sample"; });
  expect_followed([&] { drag(curves(), place(2), place(2) - QPoint(7, 0), Qt::ControlModifier); },
                  [&] { EXPECT_NE(points()[2].time_ns % (10 * kMsNs), 0) << "with Ctrl it does not snap"; });
  QTest::mouseClick(&curves(), Qt::LeftButton, {}, place(180 * kMsNs, 0.7));  // nothing is selected any more
  expect_followed(
      [&] { drag(curves(), place(1), place(1) + QPoint(40, 0), Qt::ShiftModifier | Qt::ControlModifier); },
      [&] {
        const double ns = 4 * curves().frame().ns_per_pixel();
        EXPECT_NEAR(static_cast<double>(points()[1].time_ns - 40 * kMsNs), ns, 0.6 * ns) << "a tenth";
      });
  // A point on the curve changes nothing that is seen; dragged, it does.
  const QImage unchanged = canvas().image();
  QTest::mouseClick(&curves(), Qt::LeftButton, {}, place(60 * kMsNs, 1));
  ASSERT_EQ(points().size(), 5u);
  EXPECT_EQ(points()[2], (ControlPoint{60 * kMsNs, 1}));
  ASSERT_TRUE(settles());
  EXPECT_EQ(difference(canvas().image(), unchanged), "");
  expect_followed([&] { drag(curves(), place(2), place(60 * kMsNs, 0.5)); },
                  [&] { EXPECT_NEAR(points()[2].gain, 0.5, 0.02); });
  expect_followed([&] { QTest::mouseClick(&curves(), Qt::RightButton, {}, place(2)); },
                  [&] { EXPECT_EQ(points().size(), 4u); });
}

TEST_F(InteractionsTest, TheIntervalIsScrubbedAndTyped) {
  document().set_mode(ExposureMode::boxcar);
  ASSERT_TRUE(settles());
  const auto middle = [&] { return strip().boxcar_area().center().toPoint(); };
  expect_followed(
      [&] {
        drag(strip(), middle(), {in_strip(120 * kMsNs), middle().y()});
      },
      [&] {
        EXPECT_EQ(document().boxcar(), (Boxcar{100 * kMsNs, 40 * kMsNs}));
      });
  expect_followed(
      [&] {
        drag(strip(), {in_strip(100 * kMsNs), middle().y()}, {in_strip(20 * kMsNs), middle().y()});
      },
      [&] {
        EXPECT_EQ(document().boxcar(), (Boxcar{20 * kMsNs, 120 * kMsNs}));
      });
  expect_followed(
      [&] {
        type_into(child<QLineEdit>("width"), "12.5 ms");
        curves().setFocus();
      },
      [&] {
        EXPECT_EQ(document().boxcar(), (Boxcar{20 * kMsNs, 12'500'000}));
      });
}

TEST_F(InteractionsTest, EveryStartingPointIsChosenInTheMenu) {
  QMenu* menu = nullptr;
  for (QAction* action : window_.menuBar()->actions())
    if (action->text().remove('&').startsWith("Start")) menu = action->menu();
  ASSERT_NE(menu, nullptr);
  int count = 0;
  for (QAction* action : menu->actions()) {
    if (action->isSeparator() || action->text().endsWith("…")) continue;  // asks first
    if (action->text().contains("people")) continue;  // a picture beside the document
    ++count;
    const DocumentState before = document().state();
    action->trigger();
    ASSERT_TRUE(settles());
    EXPECT_NE(document().state(), before)
        << action->text().toStdString() << ": " << window_.notice().text().toStdString();
    EXPECT_EQ(difference(canvas().image(), fresh_picture()), "") << action->text().toStdString();
    QTest::keyClick(&window_, Qt::Key_Z, Qt::ControlModifier);
    EXPECT_EQ(document().state(), before) << "one step, " << action->text().toStdString();
    ASSERT_TRUE(settles());
  }
  EXPECT_EQ(count, 6);
}

TEST_F(InteractionsTest, TheEmptySceneIsExportedWhileItIsShown) {
  for (const StartingPoint& point : starting_points())
    if (point.style == StudyStyle::clean) window_.start_from(point);
  ASSERT_TRUE(settles());
  ASSERT_FALSE(canvas().glance().instead.isNull()) << window_.notice().text().toStdString();
  const QImage seen = canvas().glance().instead;
  name_next_file("empty.png");
  shortcut(Qt::Key_E);
  EXPECT_TRUE(is_asked_);
  ASSERT_TRUE(settles());
  EXPECT_EQ(difference(QImage(path("empty.png")).convertToFormat(QImage::Format_RGB32), seen), "");
  EXPECT_NE(window_.notice().text(), "");
  document().set_boxcar({0, kMsNs}, "Scrub");
  EXPECT_TRUE(canvas().glance().instead.isNull());
  EXPECT_EQ(window_.notice().text(), "") << "nothing is to be saved as a picture of its own any more";
}

// The empty street: a picture beside the document, which it leaves as it is.
TEST_F(InteractionsTest, TheEmptySceneIsWrittenAsAPicture) {
  const DocumentState before = document().state();
  const QImage shown = canvas().image();
  const int steps = document().undo_stack().index();
  name_next_file("empty.png");
  click_menu("Start", "Empty scene");
  ASSERT_TRUE(settles());
  EXPECT_TRUE(is_asked_);
  EXPECT_TRUE(window_.notice().text().contains("empty.png: the scene without what moves"))
      << window_.notice().text().toStdString();
  EXPECT_EQ(document().state(), before);
  EXPECT_EQ(document().undo_stack().index(), steps);
  EXPECT_EQ(difference(canvas().image(), shown), "");
  const QImage empty(path("empty.png"));
  ASSERT_EQ(empty.size(), shown.size());
  // A mean of codes of the ground is one of them. Where the square rests at last it is the scene.
  using test::MovingSquare;
  const int rest = MovingSquare::left(MovingSquare::kLastMoving);
  for (int y = 0; y < empty.height(); ++y) {
    for (int x = 0; x < empty.width(); ++x) {
      if (x >= rest && x < rest + MovingSquare::kSide) continue;
      ASSERT_NEAR(qGreen(empty.pixel(x, y)), MovingSquare::kGround, MovingSquare::kNoise) << x << ", " << y;
    }
  }
  run_line("nutik-cl background -f 100 frames/%02d.pgm line.png");
  EXPECT_EQ(difference(empty, QImage(path("line.png"))), "") << "the command's own";
}

}  // namespace
}  // namespace nutik::studio
