// The time strip and its fields, driven by mouse and keyboard.
#include <gtest/gtest.h>

#include <QLabel>
#include <QLineEdit>
#include <QSignalSpy>
#include <QTest>
#include <QWheelEvent>

#include "capture/made_samples.hpp"
#include "hand.hpp"
#include "studio/curves/drags.hpp"
#include "studio/time/time_fields.hpp"
#include "studio/time/time_strip.hpp"

namespace nutik::studio {
namespace {

constexpr std::int64_t kStripMs = 1'000'000;

// 100 samples of 10 ms; 100 ms from 450 ms on are exposed.
class TimeStripTest : public testing::Test {
 protected:
  TimeStripTest() : strip_(document_, axis_), fields_(document_) {
    document_.start({"clip.tik", {.shape = {8, 6, 3}}, Timeline::constant({100, 1}, Timeline::kFullShutter, 100)});
    axis_.set_duration(document_.duration_ns());
    document_.set_points(0, {{0, 1.0}}, "Function");
    document_.undo_stack().clear();
    strip_.resize(1000, 112);
    fields_.resize(1000, 32);
    strip_.show();
    fields_.show();
    strip_.setFocus();
  }

  [[nodiscard]] QPoint at(std::int64_t time_ns) const {
    return {static_cast<int>(std::lround(axis_.to_pixel(static_cast<double>(time_ns), strip_.width()))), 70};
  }
  void press(QPoint at, Qt::KeyboardModifiers keys = {}) {
    QTest::mousePress(&strip_, Qt::LeftButton, keys, at);
  }
  void release(QPoint at) { QTest::mouseRelease(&strip_, Qt::LeftButton, {}, at); }
  void move(QPoint to, Qt::KeyboardModifiers keys = {}) { move_pressed(strip_, to, keys); }
  void drag(QPoint from, QPoint to, Qt::KeyboardModifiers keys = {}) { studio::drag(strip_, from, to, keys, 10); }
  void key(Qt::Key key, Qt::KeyboardModifiers keys = {}) { QTest::keyClick(&strip_, key, keys); }
  void type(const char* name, const QString& text) {
    auto* field = fields_.findChild<QLineEdit*>(name);
    ASSERT_TRUE(field != nullptr) << name;
    type_into(*field, text);
  }
  [[nodiscard]] QString shown(const char* name) const { return fields_.findChild<QLineEdit*>(name)->text(); }

  Document document_;
  TimeAxis axis_;
  TimeStrip strip_;
  TimeFields fields_;
};

TEST_F(TimeStripTest, ScrubsTheBoxcarFromWhereItWasPressedInOneStepOfUndo) {
  QSignalSpy changed(&document_, &Document::changed), released(&document_, &Document::released);
  ASSERT_EQ(document_.mode(), ExposureMode::functions);
  drag(at(480 * kStripMs), at(680 * kStripMs));
  EXPECT_EQ(document_.boxcar(), (Boxcar{650 * kStripMs, 100 * kStripMs}));
  EXPECT_EQ(document_.mode(), ExposureMode::boxcar);
  EXPECT_GT(changed.count(), 5) << "live";
  EXPECT_EQ(released.count(), 1);
  EXPECT_EQ(document_.undo_stack().count(), 1);
  document_.undo_stack().undo();
  EXPECT_EQ(document_.boxcar(), (Boxcar{450 * kStripMs, 100 * kStripMs}));
}

TEST_F(TimeStripTest, LeavesRegionsForADragAndNotForAClick) {
  for (const std::int64_t ms : {500, 200}) {
    const QPoint there = at(ms * kStripMs);
    drag(there, there + QPoint(1, 0));
    EXPECT_EQ(document_.boxcar(), (Boxcar{(ms - 50) * kStripMs, 100 * kStripMs}));
    EXPECT_EQ(document_.mode(), ExposureMode::functions) << ms;
  }
  drag(at(200 * kStripMs), at(300 * kStripMs));
  EXPECT_EQ(document_.boxcar(), (Boxcar{250 * kStripMs, 100 * kStripMs}));
  EXPECT_EQ(document_.mode(), ExposureMode::boxcar);
}

TEST_F(TimeStripTest, BringsTheBoxcarToAPressElsewhere) {
  const QPoint there = at(200 * kStripMs);
  press(there);
  EXPECT_EQ(document_.boxcar(), (Boxcar{150 * kStripMs, 100 * kStripMs}));
  move(there + QPoint(0, 5));
  EXPECT_EQ(document_.boxcar(), (Boxcar{150 * kStripMs, 100 * kStripMs}));
  release(there);
  drag(at(200 * kStripMs), at(5'000 * kStripMs));
  EXPECT_EQ(document_.boxcar(), (Boxcar{900 * kStripMs, 100 * kStripMs})) << "it stays in the capture";
}

TEST_F(TimeStripTest, MakesTheBoxcarLongerAndShorterAtItsEnds) {
  drag(at(550 * kStripMs), at(700 * kStripMs));
  EXPECT_EQ(document_.boxcar(), (Boxcar{450 * kStripMs, 250 * kStripMs}));
  drag(at(450 * kStripMs), at(300 * kStripMs));
  EXPECT_EQ(document_.boxcar(), (Boxcar{300 * kStripMs, 400 * kStripMs}));
  drag(at(300 * kStripMs), at(950 * kStripMs));
  EXPECT_EQ(document_.boxcar().length_ns, 1) << "it does not turn over";
}

TEST_F(TimeStripTest, MovesATenthAsFastWithShiftAndFreelyWithControl) {
  const QPoint from = at(500 * kStripMs);
  press(from);
  move(from + QPoint(7, 0), Qt::ControlModifier);
  const double free_ns = static_cast<double>(document_.boxcar().start_ns - 450 * kStripMs);
  EXPECT_NEAR(free_ns, 7 * axis_.ns_per_pixel(strip_.width()), 2);
  release(from);
  document_.set_boxcar({450 * kStripMs, 100 * kStripMs}, "Back");
  press(from);
  move(from + QPoint(100, 0), Qt::ShiftModifier | Qt::ControlModifier);
  EXPECT_NEAR(static_cast<double>(document_.boxcar().start_ns - 450 * kStripMs),
              10 * axis_.ns_per_pixel(strip_.width()), 2);
  release(from);
}

TEST_F(TimeStripTest, StepsBySamples) {
  key(Qt::Key_Right);
  EXPECT_EQ(document_.boxcar(), (Boxcar{460 * kStripMs, 100 * kStripMs}));
  key(Qt::Key_Left, Qt::ShiftModifier);
  EXPECT_EQ(document_.boxcar(), (Boxcar{360 * kStripMs, 100 * kStripMs}));
  key(Qt::Key_Right, Qt::ControlModifier);
  EXPECT_EQ(document_.boxcar().start_ns, 360 * kStripMs + 1);
  key(Qt::Key_Left, Qt::ControlModifier);
  key(Qt::Key_Up);
  EXPECT_EQ(document_.boxcar(), (Boxcar{360 * kStripMs, 110 * kStripMs}));
  key(Qt::Key_Down, Qt::ShiftModifier);
  EXPECT_EQ(document_.boxcar(), (Boxcar{360 * kStripMs, 10 * kStripMs}));
  key(Qt::Key_Down);
  EXPECT_EQ(document_.boxcar(), (Boxcar{360 * kStripMs, 10 * kStripMs})) << "nothing would be left";
  key(Qt::Key_Home);
  EXPECT_EQ(document_.boxcar().start_ns, 0);
  key(Qt::Key_Left, Qt::ShiftModifier);
  EXPECT_EQ(document_.boxcar().start_ns, 0) << "no further than the capture";
  key(Qt::Key_End);
  EXPECT_EQ(document_.boxcar().start_ns, 990 * kStripMs);
  EXPECT_EQ(document_.mode(), ExposureMode::boxcar);
}

TEST_F(TimeStripTest, SetsMovesAndTakesAwayMarks) {
  key(Qt::Key_I);
  key(Qt::Key_O);
  EXPECT_EQ(document_.mark_in(), 450 * kStripMs);
  EXPECT_EQ(document_.mark_out(), 550 * kStripMs);
  const QPoint mark = strip_.mark_place(550 * kStripMs).toPoint();
  drag(mark, {at(800 * kStripMs).x(), mark.y()});
  EXPECT_EQ(document_.mark_out(), 800 * kStripMs);
  EXPECT_EQ(document_.undo_stack().count(), 0) << "marks are no edits";
  key(Qt::Key_X);
  EXPECT_EQ(document_.boxcar(), (Boxcar{450 * kStripMs, 350 * kStripMs}));
  key(Qt::Key_Z);
  EXPECT_GT(axis_.begin_ns(), 400e6);
  EXPECT_LT(axis_.end_ns(), 850e6);
  key(Qt::Key_F);
  EXPECT_LT(axis_.begin_ns(), 0);
  QTest::mouseClick(&strip_, Qt::RightButton, {}, strip_.mark_place(800 * kStripMs).toPoint());
  EXPECT_FALSE(document_.mark_out());
  key(Qt::Key_I, Qt::ShiftModifier);
  EXPECT_FALSE(document_.mark_in());
}

TEST_F(TimeStripTest, TakesADragBackByEscape) {
  const DocumentState before = document_.state();
  press(at(500 * kStripMs));
  move(at(800 * kStripMs));
  EXPECT_NE(document_.boxcar(), before.boxcar);
  key(Qt::Key_Escape);
  EXPECT_EQ(document_.state(), before);
  EXPECT_FALSE(document_.is_dragging());
  EXPECT_EQ(document_.undo_stack().count(), 0);
}

TEST_F(TimeStripTest, TakesTypedTimesExactly) {
  EXPECT_EQ(shown("width"), "100 ms");
  EXPECT_EQ(shown("start"), "450 ms");
  type("width", "12.345678 ms");
  EXPECT_EQ(document_.boxcar(), (Boxcar{450 * kStripMs, 12'345'678}));
  type("width", "1/100s");
  EXPECT_EQ(document_.boxcar().length_ns, 10 * kStripMs);
  EXPECT_EQ(shown("width"), "10 ms");
  type("start", "37f");
  EXPECT_EQ(document_.boxcar().start_ns, 370 * kStripMs);
  type("in", "0.2s");
  type("out", "800 ms");
  EXPECT_EQ(document_.mark_in(), 200 * kStripMs);
  EXPECT_EQ(document_.mark_out(), 800 * kStripMs);
  type("in", "");
  EXPECT_FALSE(document_.mark_in());
}

// Three samples were made between pictures 1 and 2, which begin at 10 and 20 ms as before.
TEST_F(TimeStripTest, CountsThePicturesThatWereFilmedAsTypedTimesDo) {
  const Timeline filmed = Timeline::constant({100, 1}, Timeline::kFullShutter, 4);
  const Timeline timeline = MadeSamples{.after = {0, 3, 0, 0}}.times(filmed);
  document_.start({"clip.tik", {.shape = {8, 6, 3}}, timeline});
  axis_.set_duration(document_.duration_ns());
  type("width", "1f");
  type("start", "2f");
  EXPECT_EQ(document_.boxcar(), (Boxcar{20 * kStripMs, 10 * kStripMs}));
  EXPECT_EQ(fields_.findChild<QLabel*>("said")->text(), "picture 2");
  type("start", "4f");
  EXPECT_TRUE(fields_.findChild<QLabel*>("said")->toolTip().contains("has 4 pictures"));
  EXPECT_EQ(interval_text({0, 40 * kStripMs}, timeline), "0 s to 40 ms, pictures 0 to 3");
  EXPECT_EQ(interval_text({10 * kStripMs, 8 * kStripMs}, timeline),
            "10 ms to 18 ms, picture 1 to made sample at 16.25 ms");
  EXPECT_EQ(interval_text({17 * kStripMs, 1}, timeline), "17 ms to 17.000001 ms, made sample at 16.25 ms");
  document_.set_boxcar({0, kStripMs}, "Away");
  EXPECT_TRUE(strip_.text_at(at(17 * kStripMs)).startsWith("Made sample, from 16.25 ms"));
  EXPECT_TRUE(strip_.text_at(at(26 * kStripMs)).startsWith("Picture 2, from 20 ms"));
  const Snapper snapper(&timeline, {}, 0);
  for (const auto& [time_ns, what] :
       {std::pair(10'000'000, "start of picture 1"), std::pair(16'250'000, "start of made sample at 16.25 ms"),
        std::pair(20'000'000, "start of picture 2"), std::pair(23'750'000, "end of made sample at 21.25 ms"),
        std::pair(30'000'000, "start of picture 3")})
    EXPECT_EQ(snapper.time(time_ns + 1, 2)->what, what);
}

TEST_F(TimeStripTest, SaysWhatIsWrongWithATypedTimeAndKeepsIt) {
  const DocumentState before = document_.state();
  for (const auto& [text, said] :
       {std::pair("ten", "write a number and a unit"), std::pair("0 ms", "not longer"),
        std::pair("1 h", "The capture lasts 1 s")}) {
    type("width", text);
    EXPECT_EQ(document_.state(), before) << text;
    EXPECT_EQ(shown("width"), text);
    const auto labels = fields_.findChildren<QLabel*>();
    const auto tells = [&](const QLabel* label) { return label->toolTip().contains(said); };
    EXPECT_TRUE(std::ranges::any_of(labels, tells)) << text;
  }
  type("width", "10 ms");
  EXPECT_EQ(document_.boxcar().length_ns, 10 * kStripMs);
  type("width", "0 ms");
  document_.start(*document_.facts());
  EXPECT_EQ(shown("width"), "100 ms") << "of another capture";
}

TEST_F(TimeStripTest, ShowsActivityAndThumbnailsWhereTheyAre) {
  const QImage empty = strip_.grab().toImage();
  CaptureOverview overview;
  overview.changed_share.assign(100, 0.0);
  for (std::size_t i = 80; i < 90; ++i) overview.changed_share[i] = 0.5;
  document_.set_overview(overview);
  const QImage active = strip_.grab().toImage();
  EXPECT_NE(active.pixel(at(850 * kStripMs)), empty.pixel(at(850 * kStripMs)));
  EXPECT_EQ(active.pixel(at(200 * kStripMs)), empty.pixel(at(200 * kStripMs)));
  EXPECT_TRUE(strip_.text_at(at(850 * kStripMs)).contains("50 % of the pixels change"));
  for (int i = 0; i < 10; ++i) {
    QImage image(32, 24, QImage::Format_RGB32);
    image.fill(i < 5 ? Qt::red : Qt::green);
    overview.thumbnails.push_back({i * 111 * kStripMs, image});
  }
  document_.set_overview(overview);
  const QImage pictured = strip_.grab().toImage();
  EXPECT_EQ(pictured.pixelColor(at(103 * kStripMs).x(), 40), QColor(Qt::red));
  EXPECT_EQ(pictured.pixelColor(at(903 * kStripMs).x(), 40), QColor(Qt::green));
}

TEST_F(TimeStripTest, ZoomsToThePointer) {
  const QPointF where(700, 60);
  const std::int64_t time_ns = axis_.to_time(where.x(), strip_.width());
  QWheelEvent event(where, strip_.mapToGlobal(where), {}, {0, 480}, Qt::NoButton, {}, Qt::NoScrollPhase,
                    false);
  QCoreApplication::sendEvent(&strip_, &event);
  EXPECT_NEAR(static_cast<double>(axis_.to_time(where.x(), strip_.width()) - time_ns), 0, 10);
  EXPECT_LT(axis_.end_ns() - axis_.begin_ns(), 5e8);
}

TEST_F(TimeStripTest, ThumbnailsReachFromTheCapturesStartToItsEnd) {
  CaptureOverview overview;
  QImage image(160, 90, QImage::Format_RGB32);
  image.fill(QColor(10, 200, 30));
  for (const std::int64_t ms : {100, 500, 900}) overview.thumbnails.push_back({ms * kStripMs, image});
  document_.set_overview(overview);
  for (const int width : {600, 640, 680, 720, 760}) {
    strip_.resize(width, strip_.height());
    const QImage seen = strip_.grab().toImage();
    for (const std::int64_t ms : {5, 250, 500, 750, 995}) {
      const QPointF at(axis_.to_pixel(static_cast<double>(ms * kStripMs), width), strip_.track().top() + 10);
      bool is_shown = false;  // pictures have a pixel between them
      for (const int x : {-1, 0, 1}) {
        const QColor colour = seen.pixelColor(((at + QPointF(x, 0)) * seen.devicePixelRatio()).toPoint());
        is_shown = is_shown || colour.green() - colour.red() > 80;
      }
      EXPECT_TRUE(is_shown) << ms << " ms of a strip of " << width;
    }
  }
}

}  // namespace
}  // namespace nutik::studio
