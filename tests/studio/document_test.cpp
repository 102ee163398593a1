// The document: edits, drags and undo.
#include <gtest/gtest.h>

#include <QSignalSpy>

#include "studio/document/document.hpp"
#include "studio/time/time_axis.hpp"

namespace nutik::studio {
namespace {

CaptureFacts facts_of_one_second() {
  return {"clip.tik", {.shape = {8, 6, 3}}, Timeline::constant({100, 1}, Timeline::kFullShutter, 100)};
}

TEST(Document, MakesOneStepOfADrag) {
  Document document;
  document.start(facts_of_one_second());
  const DocumentState before = document.state();
  QSignalSpy released(&document, &Document::released);
  document.begin_drag();
  for (int gain = 1; gain <= 5; ++gain) document.set_points(0, {{0, 0.0}, {1'000, 0.5 * gain}}, "Move point");
  document.end_drag();
  EXPECT_EQ(released.count(), 1);
  ASSERT_EQ(document.undo_stack().count(), 1);
  EXPECT_EQ(document.points(0)[1].gain, 2.5);
  EXPECT_EQ(document.mode(), ExposureMode::functions);
  document.undo_stack().undo();
  EXPECT_EQ(document.state(), before);
  document.undo_stack().redo();
  EXPECT_EQ(document.points(0)[1].gain, 2.5);

  document.set_points(0, {{0, 1.0}}, "Remove point");
  document.set_points(0, {{0, 2.0}}, "Set gain");
  EXPECT_EQ(document.undo_stack().count(), 3) << "edits outside a drag stand for themselves";
}

TEST(Document, TakesNoTimesThatDoNotIncrease) {
  Document document;
  document.start(facts_of_one_second());
  EXPECT_THROW(document.set_points(0, {{5, 0.0}, {5, 1.0}}, ""), std::logic_error);
  EXPECT_THROW(document.set_points(0, {}, ""), std::logic_error);
  EXPECT_EQ(document.undo_stack().count(), 0);
}

TEST(Document, KeepsTheBoxcarWithinTheCapture) {
  Document document;
  document.start(facts_of_one_second());
  document.set_boxcar({-5, 2'000'000'000}, "Scrub");
  EXPECT_EQ(document.boxcar(), (Boxcar{0, 1'000'000'000}));
  document.set_boxcar({990'000'000, 100'000'000}, "Scrub");
  EXPECT_EQ(document.boxcar(), (Boxcar{900'000'000, 100'000'000}));
}

TEST(Document, ForgetsASelectionThatUndoTookAway) {
  Document document;
  document.start(facts_of_one_second());
  document.set_points(7, {{0, 0.0}, {1, 1.0}, {2, 2.0}}, "Add region");
  document.select_tag(7);
  document.select_points({1, 2});
  document.set_points(7, {{0, 0.0}, {1, 1.0}}, "Remove point");
  EXPECT_EQ(document.selected_points(), (std::set<std::size_t>{1}));
  document.undo_stack().undo();
  document.undo_stack().undo();
  EXPECT_EQ(document.selected_tag(), 0);
  EXPECT_TRUE(document.selected_points().size() <= document.points(0).size());
}

TEST(Document, SelectsTheRegionThatUndoBringsBack) {
  Document document;
  document.start(facts_of_one_second());
  document.set_points(7, {{0, 0.0}, {1, 1.0}}, "Add region");
  document.select_tag(7);
  DocumentState without = document.state();
  without.functions.erase(7);
  QSignalSpy selected(&document, &Document::selection_changed);
  document.apply(without, "Remove region");
  EXPECT_EQ(document.selected_tag(), 0);
  document.undo_stack().undo();
  EXPECT_EQ(document.selected_tag(), 7);
  EXPECT_EQ(selected.count(), 1);
}

TEST(TimeAxis, ZoomsToThePointerAndStaysAtTheCapture) {
  TimeAxis axis;
  axis.set_duration(1'000'000'000);
  constexpr int kWidth = 800;
  const std::int64_t time_ns = axis.to_time(300, kWidth);
  axis.zoom(0.1, 300, kWidth);
  EXPECT_NEAR(axis.to_pixel(static_cast<double>(time_ns), kWidth), 300, 1e-3);
  axis.pan(1e9, kWidth);
  EXPECT_LE(axis.end_ns(), 1.03e9);
  axis.zoom(1e9, 300, kWidth);
  EXPECT_LT(axis.begin_ns(), 0);
  EXPECT_GT(axis.end_ns(), 1e9);
  axis.zoom(1e-30, 300, kWidth);
  EXPECT_GT(axis.end_ns(), axis.begin_ns());
  for (std::int64_t pictures = 1; pictures < 100; ++pictures) {
    axis.set_duration(pictures * 33'333'333);
    axis.zoom(1e9, 300, kWidth);
    EXPECT_NEAR(axis.begin_ns(), -0.02 * static_cast<double>(axis.duration_ns()), 1e-3);
  }
}

}  // namespace
}  // namespace nutik::studio
