// The curve editor, driven by mouse and keyboard: what comes of it in the document, and on the screen.
#include <gtest/gtest.h>

#include <QFrame>
#include <QLabel>
#include <QLineEdit>
#include <QSignalSpy>
#include <QTest>
#include <QWheelEvent>

#include "hand.hpp"
#include "studio/curves/curve_editor.hpp"

namespace nutik::studio {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::uint8_t kTag = 3;

// 100 samples of 10 ms; M3 is a boxcar from 300 to 500 ms, M0 a ramp.
class CurveEditorTest : public testing::Test {
 protected:
  CurveEditorTest() : editor_(document_, axis_) {
    document_.start({"clip.tik", {.shape = {8, 6, 3}}, Timeline::constant({100, 1}, Timeline::kFullShutter, 100)});
    axis_.set_duration(document_.duration_ns());
    document_.set_points(0, {{0, 0.0}, {650 * kMs, 0.5}, {650 * kMs + 1, 0.0}}, "Ramp");
    document_.set_points(kTag, boxcar_, "Boxcar");
    document_.select_tag(kTag);
    document_.undo_stack().clear();
    editor_.resize(1000, 300);
    editor_.show();
    editor_.setFocus();
  }

  [[nodiscard]] QPoint at(std::int64_t time_ns, double gain) const {
    return editor_.frame().place({time_ns, gain}).toPoint();
  }
  [[nodiscard]] QPoint at_point(std::size_t index) const {
    return editor_.frame().place(points()[index]).toPoint();
  }
  [[nodiscard]] Points points() const { return document_.points(kTag); }

  void press(QPoint at, Qt::KeyboardModifiers keys = {}) {
    QTest::mousePress(&editor_, Qt::LeftButton, keys, at);
  }
  void release(QPoint at, Qt::KeyboardModifiers keys = {}) {
    QTest::mouseRelease(&editor_, Qt::LeftButton, keys, at);
  }
  void move(QPoint to, Qt::KeyboardModifiers keys = {}) { move_pressed(editor_, to, keys); }
  void drag(QPoint from, QPoint to, Qt::KeyboardModifiers keys = {}) {
    studio::drag(editor_, from, to, keys, 10);
  }
  void key(Qt::Key key, Qt::KeyboardModifiers keys = {}) { QTest::keyClick(&editor_, key, keys); }

  const Points boxcar_{{300 * kMs - 1, 0.0}, {300 * kMs, 1.0}, {500 * kMs, 1.0}, {500 * kMs + 1, 0.0}};
  Document document_;
  TimeAxis axis_;
  CurveEditor editor_;
};

TEST_F(CurveEditorTest, DragsAPointWithItsStepInOneStepOfUndo) {
  drag(at_point(2), at(600 * kMs, 1.0));
  EXPECT_EQ(points()[2], (ControlPoint{600 * kMs, 1.0}));
  EXPECT_EQ(points()[3], (ControlPoint{600 * kMs + 1, 0.0})) << "a step stays one";
  EXPECT_EQ(document_.mode(), ExposureMode::functions);
  ASSERT_EQ(document_.undo_stack().count(), 1);
  EXPECT_EQ(document_.undo_stack().undoText(), "Move point");
  document_.undo_stack().undo();
  EXPECT_EQ(points(), boxcar_);
}

TEST_F(CurveEditorTest, DoesNotLetAPointJumpWhenItIsPressedBesideItsMiddle) {
  const QPoint beside = at_point(1) + QPoint(4, 3);
  press(beside);
  EXPECT_EQ(points(), boxcar_);
  move(beside + QPoint(1, 0));
  EXPECT_EQ(points(), boxcar_);
  move(beside + QPoint(2, 1), Qt::ControlModifier);
  const QPoint now = at_point(1);
  EXPECT_NEAR(now.x() + 4, beside.x() + 2, 1.5);
  EXPECT_NEAR(now.y() + 3, beside.y() + 1, 1.5);
  release(beside);
}

TEST_F(CurveEditorTest, SnapsToSamplesToOtherFunctionsAndToGainOne) {
  // 3 pixels beside sample 60 of 10 ms, and beside gain 1.
  drag(at_point(2), at(600 * kMs, 1.0) + QPoint(3, 3));
  EXPECT_EQ(points()[2], (ControlPoint{600 * kMs, 1.0}));
  drag(at_point(2), at(650 * kMs, 0.5) + QPoint(2, -3));
  EXPECT_EQ(points()[2].gain, 0.5) << "M0's";
  EXPECT_NEAR(static_cast<double>(points()[2].time_ns), 650e6, 1) << "either point of its step";
  const std::int64_t before = points()[2].time_ns;
  drag(at_point(2), at_point(2) + QPoint(-13, 0), Qt::ControlModifier);
  EXPECT_NE(points()[2].time_ns % (10 * kMs), 0) << "with Ctrl nothing snaps";
  EXPECT_NEAR(static_cast<double>(before - points()[2].time_ns), 13 * editor_.frame().ns_per_pixel(),
              1.5 * editor_.frame().ns_per_pixel());
}

TEST_F(CurveEditorTest, MovesATenthAsFastWithShift) {
  axis_.show(290e6, 310e6);  // 50 pixels are 1 ms
  const QPoint from = at_point(1);
  press(from);
  move(from + QPoint(100, 0), Qt::ShiftModifier);
  release(from + QPoint(100, 0), Qt::ShiftModifier);
  const double moved_ns = static_cast<double>(points()[1].time_ns - 300 * kMs);
  EXPECT_NEAR(moved_ns, 10 * editor_.frame().ns_per_pixel(), editor_.frame().ns_per_pixel());
}

TEST_F(CurveEditorTest, MovesAPointOfAStepAloneWithControl) {
  const QPoint foot = at_point(3);
  press(foot);
  release(foot);
  drag(at_point(3), foot + QPoint(60, 0), Qt::ControlModifier);
  EXPECT_EQ(points()[2], boxcar_[2]);
  EXPECT_GT(points()[3].time_ns, 500 * kMs + 10 * kMs);
}

TEST_F(CurveEditorTest, AddsAPointOnTheCurveByAClickAndTakesItAwayByARightClick) {
  document_.set_points(kTag, {{0, 0.0}, {800 * kMs, 1.0}}, "Ramp");
  document_.undo_stack().clear();
  const QPoint on_curve = at(403 * kMs, 403.0 / 800);
  press(on_curve);
  release(on_curve);
  ASSERT_EQ(points().size(), 3U);
  EXPECT_EQ(points()[1], (ControlPoint{400 * kMs, 0.5})) << "on the curve, at a sample";
  EXPECT_EQ(document_.undo_stack().count(), 1);
  EXPECT_EQ(document_.selected_points(), std::set<std::size_t>{1});
  QTest::mouseClick(&editor_, Qt::RightButton, {}, at_point(1));
  EXPECT_EQ(points().size(), 2U);
  QTest::mouseClick(&editor_, Qt::RightButton, {}, at_point(0));
  QTest::mouseClick(&editor_, Qt::RightButton, {}, at_point(0));
  EXPECT_EQ(points().size(), 1U) << "a function keeps one";
}

TEST_F(CurveEditorTest, SelectsByARubberBandAndMovesAllOfThem) {
  drag(at(450 * kMs, 1.1), at(550 * kMs, -0.1));
  EXPECT_EQ(document_.selected_points(), (std::set<std::size_t>{2, 3}));
  drag(at(250 * kMs, 1.1), at(350 * kMs, 0.5), Qt::ShiftModifier);
  EXPECT_EQ(document_.selected_points(), (std::set<std::size_t>{1, 2, 3})) << "Shift adds";
  key(Qt::Key_A, Qt::ControlModifier);
  ASSERT_EQ(document_.selected_points().size(), 4U);
  drag(at_point(1), at(500 * kMs, 1.0));
  EXPECT_EQ(points(),
            (Points{{500 * kMs - 1, 0.0}, {500 * kMs, 1.0}, {700 * kMs, 1.0}, {700 * kMs + 1, 0.0}}));
  EXPECT_EQ(document_.undo_stack().count(), 1);
  const QPoint empty = at(900 * kMs, 0.7);
  press(empty);
  release(empty);
  EXPECT_TRUE(document_.selected_points().empty());
}

TEST_F(CurveEditorTest, StretchesAndMultipliesByTheBoxRoundSelectedPoints) {
  key(Qt::Key_A, Qt::ControlModifier);
  const auto handle = [&](BoxPart part) {
    const auto box = TransformBox::round(editor_.frame(), points(), {0, 1, 2, 3});
    for (const auto& each : box->handles())
      if (each.first == part) return each.second.center().toPoint();
    ADD_FAILURE() << "no such handle";
    return QPoint();
  };
  const QPoint right = handle(BoxPart::right);
  const int to_700 = at(700 * kMs, 0).x() - at(500 * kMs, 0).x();
  drag(right, right + QPoint(to_700, 0));
  EXPECT_EQ(points(),
            (Points{{300 * kMs - 1, 0.0}, {300 * kMs, 1.0}, {700 * kMs, 1.0}, {700 * kMs + 1, 0.0}}));
  const QPoint top = handle(BoxPart::top);
  const int to_half = at(0, 0.5).y() - at(0, 1.0).y();
  drag(top, top + QPoint(0, to_half));
  EXPECT_EQ(points()[1].gain, 0.5);
  EXPECT_EQ(points()[2].gain, 0.5);
  EXPECT_EQ(points()[0].gain, 0.0);
  const QPoint inside = at(450 * kMs, 0.2);
  drag(inside, inside + QPoint(-to_700 / 2, 0));
  EXPECT_EQ(points()[1].time_ns, 200 * kMs);
  EXPECT_EQ(points()[2].time_ns, 600 * kMs);
  EXPECT_EQ(document_.undo_stack().count(), 3);
}

TEST_F(CurveEditorTest, StretchesTimeAndGainTogetherByACornerOfTheBox) {
  key(Qt::Key_A, Qt::ControlModifier);
  const auto box = TransformBox::round(editor_.frame(), points(), {0, 1, 2, 3});
  const auto handles = box->handles();
  const auto corner = std::find_if(handles.begin(), handles.end(),
                                   [](const auto& each) { return each.first == BoxPart::top_right; });
  ASSERT_NE(corner, handles.end());
  const QPoint from = corner->second.center().toPoint(), by = at(700 * kMs, 0.5) - at(500 * kMs, 1.0);
  drag(from, from + by);
  EXPECT_EQ(points(),
            (Points{{300 * kMs - 1, 0.0}, {300 * kMs, 0.5}, {700 * kMs, 0.5}, {700 * kMs + 1, 0.0}}));
  EXPECT_EQ(document_.undo_stack().count(), 1);
}

TEST_F(CurveEditorTest, MovesABoxcarItsEndsAndItsGain) {
  const auto handles = [&] {
    return BoxcarHandles::of(editor_.frame(), boxcars_of(points()).front(), editor_.lane_top());
  };
  const int hundred = at(400 * kMs, 0).x() - at(300 * kMs, 0).x();
  QPoint from = handles().bar.center().toPoint();
  drag(from, from + QPoint(hundred, 0));
  EXPECT_EQ(points(),
            (Points{{400 * kMs - 1, 0.0}, {400 * kMs, 1.0}, {600 * kMs, 1.0}, {600 * kMs + 1, 0.0}}));
  from = handles().begin.center().toPoint();
  drag(from, from - QPoint(2 * hundred, 0));
  EXPECT_EQ(points()[1].time_ns, 200 * kMs);
  EXPECT_EQ(points()[2].time_ns, 600 * kMs);
  from = handles().end.center().toPoint();
  drag(from, from + QPoint(hundred, 0));
  EXPECT_EQ(points()[2].time_ns, 700 * kMs);
  from = handles().level.center().toPoint();
  drag(from, {from.x(), at(0, 0.5).y()});
  EXPECT_EQ(points()[1].gain, 0.5);
  EXPECT_EQ(points()[2].gain, 0.5);
  EXPECT_EQ(document_.undo_stack().count(), 4);
}

TEST_F(CurveEditorTest, TakesADragBackByEscape) {
  const DocumentState before = document_.state();
  press(at_point(2));
  move(at(700 * kMs, 0.3));
  EXPECT_NE(document_.state(), before);
  key(Qt::Key_Escape);
  EXPECT_EQ(document_.state(), before);
  EXPECT_FALSE(document_.is_dragging());
  EXPECT_EQ(document_.undo_stack().count(), 0);
  release(at(700 * kMs, 0.3));
  EXPECT_EQ(document_.state(), before);
}

TEST_F(CurveEditorTest, DropsADragWhoseFunctionWentAway) {
  const auto ramp = document_.points(0);
  document_.set_points(9, boxcar_, "Add region");
  document_.select_tag(9);
  const QPoint from = editor_.frame().place(boxcar_[2]).toPoint();
  press(from);
  move(from + QPoint(40, 0));
  document_.undo_stack().undo();
  document_.undo_stack().undo();
  ASSERT_FALSE(document_.functions().contains(9));
  EXPECT_FALSE(document_.is_dragging());
  move(from + QPoint(80, 0));
  release(from);
  EXPECT_EQ(document_.points(0), ramp) << "the drag goes on with no other function";
  EXPECT_EQ(points(), boxcar_);
}

TEST_F(CurveEditorTest, DoesEverythingByKeyboard) {
  key(Qt::Key_Tab);
  key(Qt::Key_Home);
  EXPECT_EQ(document_.selected_points(), std::set<std::size_t>{0});
  key(Qt::Key_Tab);
  EXPECT_EQ(document_.selected_points(), std::set<std::size_t>{1});
  key(Qt::Key_Right);
  EXPECT_EQ(points()[1].time_ns, 310 * kMs);
  EXPECT_EQ(points()[0].time_ns, 310 * kMs - 1);
  key(Qt::Key_Left, Qt::ShiftModifier);
  EXPECT_EQ(points()[1].time_ns, 210 * kMs);
  key(Qt::Key_Right, Qt::ControlModifier);
  EXPECT_EQ(points()[1].time_ns, 210 * kMs + 1);
  key(Qt::Key_Up);
  EXPECT_EQ(points()[1].gain, 1.1);
  key(Qt::Key_Down, Qt::ShiftModifier);
  EXPECT_EQ(points()[1].gain, 0.1);
  key(Qt::Key_Insert);
  ASSERT_EQ(points().size(), 5U);
  EXPECT_EQ(document_.selected_points(), std::set<std::size_t>{2});
  key(Qt::Key_Delete);
  EXPECT_EQ(points().size(), 4U);
  key(Qt::Key_End);
  EXPECT_EQ(document_.selected_points(), std::set<std::size_t>{3});
  key(Qt::Key_Backtab);
  EXPECT_EQ(document_.selected_points(), std::set<std::size_t>{2});
  EXPECT_TRUE(editor_.accessibleDescription().contains("point 3"))
      << editor_.accessibleDescription().toStdString();
  EXPECT_EQ(document_.undo_stack().count(), 7);
}

TEST_F(CurveEditorTest, TakesTypedNumbersExactlyAndSaysWhatIsWrongWithOthers) {
  key(Qt::Key_Home);
  key(Qt::Key_Tab);
  key(Qt::Key_Tab);
  key(Qt::Key_Return);
  auto* numbers = editor_.findChild<QFrame*>();
  const auto lines = editor_.findChildren<QLineEdit*>();
  ASSERT_TRUE(numbers != nullptr && numbers->isVisible());
  ASSERT_EQ(lines.size(), 2);
  EXPECT_EQ(lines[0]->text(), "500 ms");
  EXPECT_EQ(lines[1]->text(), "1");
  type_into(*lines[0], "half a second");
  EXPECT_TRUE(numbers->isVisible());
  EXPECT_TRUE(numbers->findChild<QLabel*>() != nullptr);
  EXPECT_EQ(points(), boxcar_) << "what is wrong changes nothing";
  type_into(*lines[0], "100 ms");
  EXPECT_TRUE(numbers->isVisible()) << "before the point in front of it";
  EXPECT_EQ(points(), boxcar_);
  type_into(*lines[0], "499.999999 ms");
  EXPECT_FALSE(numbers->isVisible());
  EXPECT_EQ(points()[2].time_ns, 500 * kMs - 1);
  key(Qt::Key_Return);
  type_into(*lines[1], "-0.125");
  EXPECT_EQ(points()[2], (ControlPoint{500 * kMs - 1, -0.125}));
  key(Qt::Key_Return);
  QTest::keyClicks(lines[1], "77");
  QTest::keyClick(lines[1], Qt::Key_Escape);
  EXPECT_FALSE(numbers->isVisible());
  EXPECT_EQ(points()[2].gain, -0.125) << "Escape leaves everything";
  EXPECT_EQ(editor_.focusWidget(), &editor_);
}

TEST_F(CurveEditorTest, TintsWhatTakesLightAway) {
  document_.set_points(kTag, {{0, -1.0}, {500 * kMs, -1.0}, {500 * kMs + 1, 1.0}, {900 * kMs, 1.0}},
                       "Negative");
  const QImage image = editor_.grab().toImage();
  const auto warmth = [&](std::int64_t time_ns, double gain) {  // red against blue, round a place
    int sum = 0;
    for (int x = -6; x <= 6; ++x)
      for (int y = -6; y <= 6; ++y) {
        const QColor colour = image.pixelColor(at(time_ns, gain) + QPoint(x, y));
        sum += colour.red() - colour.blue();
      }
    return sum / 169;
  };
  EXPECT_GT(warmth(253 * kMs, -0.5), warmth(253 * kMs, 0.5) + 25) << "orange below 0";
  EXPECT_LT(warmth(753 * kMs, 0.5), warmth(253 * kMs, -0.5) - 25) << "not above";
}

TEST_F(CurveEditorTest, SaysWhatCheckFinds) {
  EXPECT_TRUE(editor_.findings().empty());
  key(Qt::Key_End);
  key(Qt::Key_Up);
  ASSERT_EQ(editor_.findings().size(), 1U);
  EXPECT_EQ(editor_.findings()[0].kind, FunctionFinding::Kind::held_gain);
  EXPECT_TRUE(editor_.text_at(at_point(3)).contains("holds to the end of the capture"));
  EXPECT_TRUE(editor_.accessibleDescription().contains("holds to the end"));
}

TEST_F(CurveEditorTest, SaysItOfWhatIsExposed) {
  const auto says = [&](const char* words) { return editor_.accessibleDescription().contains(words); };
  document_.set_points(document_.selected_tag(),
                       {{0, 0}, {100'000'000, 4}, {900'000'000, 4}, {1'000'000'000, 0}}, "Shape");
  EXPECT_TRUE(says("still gain is 3.6")) << editor_.accessibleDescription().toStdString();
  DocumentState state = document_.state();
  state.normalization = Normalization::parse("integral");
  document_.apply(state, "Normalize");
  EXPECT_FALSE(says("still gain")) << "the picture keeps its brightness";
  document_.set_points(document_.selected_tag(), {{0, -1}, {1'000'000'000, 1}}, "Shape");
  EXPECT_TRUE(says("integral")) << "there is nothing to divide by: "
                                << editor_.accessibleDescription().toStdString();
}

TEST_F(CurveEditorTest, ZoomsTimeAndGainToThePointerAndKeepsTheGainAxisWhileDragging) {
  const auto wheel = [&](QPointF where, int delta, Qt::KeyboardModifiers keys) {
    QWheelEvent event(where, editor_.mapToGlobal(where), {}, {0, delta}, Qt::NoButton, keys,
                      Qt::NoScrollPhase, false);
    QCoreApplication::sendEvent(&editor_, &event);
  };
  const QPointF where(500, 120);
  const std::int64_t time_ns = editor_.frame().time_at(where.x());
  wheel(where, 480, {});
  EXPECT_NEAR(static_cast<double>(editor_.frame().time_at(where.x()) - time_ns), 0, 10);
  EXPECT_LT(axis_.end_ns() - axis_.begin_ns(), 5e8);
  wheel(where, 120, Qt::ShiftModifier);
  EXPECT_LT(editor_.frame().time_at(where.x()), time_ns);
  const double gain = editor_.frame().gain_at(where.y());
  wheel(where, 240, Qt::ControlModifier);
  EXPECT_NEAR(editor_.frame().gain_at(where.y()), gain, 1e-9);
  key(Qt::Key_F);

  const GainRange before = editor_.frame().gains();
  press(at_point(1));
  move({at_point(1).x(), -200});
  EXPECT_EQ(editor_.frame().gains(), before);
  EXPECT_GT(points()[1].gain, before.high);
  release({at_point(1).x(), -200});
  EXPECT_GT(editor_.frame().gains().high, points()[1].gain);
}

TEST_F(CurveEditorTest, ShowsCoordinatesAndWhatItSnappedToWhileDragging) {
  press(at_point(2));
  move(at(600 * kMs, 1.0));
  const QImage dragging = editor_.grab().toImage();
  release(at(600 * kMs, 1.0));
  EXPECT_NE(dragging, editor_.grab().toImage());
  EXPECT_TRUE(editor_.text_at(at_point(2)).contains("600 ms, gain 1"))
      << editor_.text_at(at_point(2)).toStdString();
}

TEST_F(CurveEditorTest, DrawsTheWaveformOfTheClickedPixelBehindTheCurve) {
  const QImage without = editor_.grab().toImage();
  document_.set_probe(QPoint(2, 3));
  std::vector<double> light(100, 0.25);
  std::fill(light.begin() + 70, light.end(), 0.9);
  document_.set_waveform({{2, 3}, light});
  EXPECT_NE(editor_.grab().toImage(), without);
}

}  // namespace
}  // namespace nutik::studio
