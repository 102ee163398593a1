// The canvas: zoom, pan, tools, and the picture that follows them.
#include <QSignalSpy>

#include "studio/regions/region_edits.hpp"
#include "studio_test.hpp"
#include "support/program.hpp"

namespace nutik::studio {
namespace {

using CanvasTest = StudioTest;

TEST(View, KeepsThePointUnderThePointer) {
  View view;
  view.set_sizes({200, 100}, {800, 600});
  EXPECT_DOUBLE_EQ(view.zoom(), 4);
  const QPointF pointer(300, 250), pixel = view.to_picture(pointer);
  view.set_zoom(10, pointer);
  EXPECT_NEAR(view.to_picture(pointer).x(), pixel.x(), 1e-9);
  EXPECT_NEAR(view.to_picture(pointer).y(), pixel.y(), 1e-9);
  view.pan({1e6, 1e6});
  EXPECT_FALSE(view.visible().isEmpty()) << "some of the picture stays in sight";
  view.fit();
  EXPECT_EQ(view.visible(), QRect(0, 0, 200, 100));
}

TEST(Outlines, AreDrawnOnceAndAsLongAsTheyGo) {
  Mask mask = Mask::uniform(6, 4, 0);
  paint(mask, rectangle(6, 4, {1, 1}, 3, 2), 9);
  const Outlines outlines = outlines_of(mask);
  ASSERT_EQ(outlines.size(), 1u);
  const QVector<QLine>& lines = outlines.at(9);
  EXPECT_EQ(lines.size(), 4);
  for (const QLine& line : {QLine(1, 1, 4, 1), QLine(1, 3, 4, 3), QLine(1, 1, 1, 3), QLine(4, 1, 4, 3)})
    EXPECT_TRUE(lines.contains(line));
}

TEST(Wand, TakesWhatHangsTogetherAndLooksAlike) {
  QImage image(5, 1, QImage::Format_RGB32);
  for (int x = 0; x < 5; ++x) image.setPixel(x, 0, x == 3 ? qRgb(200, 0, 0) : qRgb(100 + 5 * x, 0, 0));
  EXPECT_EQ(similar_pixels(image, {0, 0}, 10).inside, (std::vector<std::uint8_t>{1, 1, 1, 0, 0}));
  EXPECT_EQ(similar_pixels(image, {0, 0}, 4).inside, (std::vector<std::uint8_t>{1, 0, 0, 0, 0}));
}

TEST_F(CanvasTest, ShowsThePictureOfTheCommandLine) {
  open_clip();
  run_line(window_.command_for(path("alone.png")));
  EXPECT_EQ(difference(canvas().image(), QImage(path("alone.png"))), "");
}

TEST_F(CanvasTest, ZoomsWithTheWheelAndPansWithTheMouse) {
  open_clip();
  const double before = canvas().view().zoom();
  const QPoint pointer = at(40, 24);
  QWheelEvent wheel(pointer, canvas().mapToGlobal(pointer), {}, {0, 120}, Qt::NoButton, Qt::NoModifier,
                    Qt::NoScrollPhase, false);
  QApplication::sendEvent(&canvas(), &wheel);
  EXPECT_GT(canvas().view().zoom(), before);
  EXPECT_NEAR(canvas().view().to_picture(pointer).x(), 40, 0.5);
  drag(canvas(), pointer, pointer + QPoint(50, 20));
  EXPECT_NEAR(canvas().view().to_picture(pointer + QPoint(50, 20)).x(), 40, 0.5);
  EXPECT_FALSE(document().probe()) << "a drag is no click";
  QTest::keyClick(&window_, Qt::Key_0, Qt::ControlModifier);
  EXPECT_DOUBLE_EQ(canvas().view().zoom(), before);
}

TEST_F(CanvasTest, AClickTakesThePixelAndReadsItsLight) {
  open_clip();
  const int x = test::MovingSquare::left(6) + 4, y = test::MovingSquare::kTop + 4;
  QTest::mouseClick(&canvas(), Qt::LeftButton, {}, at(x + 0.5, y + 0.5));
  ASSERT_TRUE(document().probe());
  EXPECT_EQ(*document().probe(), QPoint(x, y));
  ASSERT_TRUE(settles());
  ASSERT_TRUE(document().waveform());
  const std::vector<double>& light = document().waveform()->light;
  ASSERT_EQ(light.size(), static_cast<std::size_t>(test::MovingSquare::kCount));
  const CaptureFormat& format = document().facts()->format;
  for (std::size_t k = 0; k < light.size(); ++k) {
    const int code = square_.pictures[k][static_cast<std::size_t>(y * test::MovingSquare::kWidth + x)];
    EXPECT_DOUBLE_EQ(light[k], format.transfer.light_of(code / 255.0)) << "sample " << k;
  }
}

TEST_F(CanvasTest, AnotherCaptureHasNoPixelYet) {
  open_clip();
  document().set_probe(QPoint(3, 4));
  ASSERT_TRUE(settles());
  ASSERT_TRUE(document().waveform());
  QSignalSpy changed(&document(), &Document::probe_changed);
  open_clip();
  EXPECT_GT(changed.count(), 0) << "what draws the waveform is told";
  EXPECT_FALSE(document().probe() || document().waveform());
}

TEST_F(CanvasTest, ToolsPaintTheSelectedRegionAndUndoTakesItBack) {
  open_clip();
  click_button("add_region");
  const std::uint8_t tag = document().selected_tag();
  ASSERT_NE(tag, kBackground);
  const QImage before = canvas().image();
  click_tool("tool_rectangle");
  drag(canvas(), at(10, 10), at(30, 20));
  EXPECT_NEAR(static_cast<double>(pixels_of(tag)), 200, 30);
  const std::size_t of_rectangle = pixels_of(tag);
  click_tool("tool_ellipse");
  drag(canvas(), at(50, 10), at(70, 30));
  EXPECT_NEAR(static_cast<double>(pixels_of(tag) - of_rectangle), 314, 45);
  const std::size_t of_both = pixels_of(tag);
  click_tool("tool_brush");
  drag(canvas(), at(20, 40), at(60, 40));
  EXPECT_GT(pixels_of(tag), of_both);
  EXPECT_EQ(document().undo_stack().undoText(), "Brush");
  drag(canvas(), at(10, 40), at(70, 40), Qt::AltModifier);
  EXPECT_LE(pixels_of(tag), of_both) << "Alt erases";
  for (int step = 0; step < 2; ++step) QTest::keyClick(&window_, Qt::Key_Z, Qt::ControlModifier);
  EXPECT_EQ(pixels_of(tag), of_both) << "each stroke is one step";
  click_tool("tool_polygon");
  for (const QPoint corner : {at(80, 5), at(90, 5), at(90, 15)})
    QTest::mouseClick(&canvas(), Qt::LeftButton, {}, corner);
  QTest::keyClick(&canvas(), Qt::Key_Return);
  EXPECT_NEAR(static_cast<double>(pixels_of(tag) - of_both), 50, 16);
  while (document().undo_stack().canUndo()) QTest::keyClick(&window_, Qt::Key_Z, Qt::ControlModifier);
  ASSERT_TRUE(settles());
  EXPECT_EQ(canvas().image(), before);
}

TEST_F(CanvasTest, ToolsPaintByKeyboard) {
  open_clip();
  click_button("add_region");
  const std::uint8_t tag = document().selected_tag();
  document().set_points(tag, {{0, 0.5}, {1'000'000, 0.0}}, "Begin");
  ASSERT_TRUE(settles());
  const QImage before = canvas().image();
  canvas().setFocus();
  const auto key = [&](Qt::Key which, Qt::KeyboardModifiers keys = {}) {
    QTest::keyClick(&canvas(), which, keys);
  };
  key(Qt::Key_R);
  QTest::mouseMove(&canvas(), at(20.5, 20.5));
  key(Qt::Key_Space);
  for (int i = 0; i < 2; ++i) key(Qt::Key_Right, Qt::ShiftModifier);
  for (int i = 0; i < 6; ++i) key(Qt::Key_Down);
  EXPECT_EQ(pixels_of(tag), 0u) << "the stroke goes on";
  key(Qt::Key_Space);
  EXPECT_EQ(pixels_of(tag), 120u) << "20 x 6 pixels";
  EXPECT_EQ(document().undo_stack().undoText(), "Rectangle");
  ASSERT_TRUE(settles());
  EXPECT_NE(difference(canvas().image(), before), "") << "the picture follows";

  key(Qt::Key_Backspace);  // from there on half of it is erased
  key(Qt::Key_Left, Qt::ShiftModifier);
  for (int i = 0; i < 6; ++i) key(Qt::Key_Up);
  key(Qt::Key_Backspace);
  EXPECT_EQ(pixels_of(tag), 60u);

  key(Qt::Key_B);
  key(Qt::Key_Space);
  EXPECT_TRUE(document().is_dragging());
  EXPECT_GT(pixels_of(tag), 60u);
  child<QToolBar>("tools").setFocusPolicy(Qt::StrongFocus);
  child<QToolBar>("tools").setFocus();
  EXPECT_FALSE(document().is_dragging()) << "who leaves the picture ends the stroke";
  canvas().setFocus();
  key(Qt::Key_Space);
  key(Qt::Key_Escape);
  EXPECT_FALSE(document().is_dragging());
  while (document().undo_stack().canUndo()) QTest::keyClick(&window_, Qt::Key_Z, Qt::ControlModifier);
  EXPECT_FALSE(document().state().mask);
}

TEST_F(CanvasTest, APixelIsTakenAndMovedByKeyboard) {
  open_clip();
  QTest::mouseMove(&canvas(), at(30.5, 24.5));
  QTest::keyClick(&canvas(), Qt::Key_Return);
  EXPECT_EQ(document().probe(), QPoint(30, 24));
  QTest::keyClick(&canvas(), Qt::Key_Right, Qt::ShiftModifier);
  QTest::keyClick(&canvas(), Qt::Key_Up);
  EXPECT_EQ(document().probe(), QPoint(40, 23));
  for (int i = 0; i < 20; ++i) QTest::keyClick(&canvas(), Qt::Key_Right, Qt::ShiftModifier);
  EXPECT_EQ(document().probe(), QPoint(95, 23)) << "it stays in the picture";
  ASSERT_TRUE(settles());
  ASSERT_TRUE(document().waveform());
  EXPECT_EQ(document().waveform()->pixel, QPoint(95, 23));
  QTest::keyClick(&canvas(), Qt::Key_Escape);
  EXPECT_FALSE(document().probe());
}

TEST_F(CanvasTest, EscapeTakesBackAStrokeThatIsNotFinished) {
  open_clip();
  click_button("add_region");
  const DocumentState before = document().state();
  click_tool("tool_brush");
  QTest::mousePress(&canvas(), Qt::LeftButton, {}, at(20, 20));
  EXPECT_GT(pixels_of(document().selected_tag()), 0u);
  QTest::keyClick(&canvas(), Qt::Key_Escape);
  QTest::mouseRelease(&canvas(), Qt::LeftButton, {}, at(20, 20));
  EXPECT_EQ(document().state(), before);
  EXPECT_FALSE(document().is_dragging());
}

TEST_F(CanvasTest, ASmallPictureIsShownUntilTheFullOneComes) {
  window_.resize(400, 300);
  open_clip();
  canvas().fit();
  ASSERT_TRUE(settles());
  const QSize size = canvas().image().size();
  const auto grey_at = [this](QPointF pixel) {
    return qGray(shown_at(canvas().grab().toImage(), canvas().view().to_widget(pixel)).rgb());
  };
  ShownPicture small;
  small.divisor = 4;
  small.place = {40, 20, 8, 8};
  small.image = QImage(2, 2, QImage::Format_RGB32);
  small.image.fill(Qt::white);
  const QImage before = canvas().image();
  canvas().show_picture(small);
  EXPECT_EQ(grey_at({44, 24}), 255);
  EXPECT_LT(grey_at({10, 40}), 128) << "what was shown, elsewhere";
  EXPECT_EQ(canvas().image(), before) << "light and wand are those of full pictures";
  ShownPicture full;
  full.image = before;
  full.place = QRect({0, 0}, size);
  canvas().show_picture(full);
  EXPECT_LT(grey_at({44, 24}), 255);
}

}  // namespace
}  // namespace nutik::studio
