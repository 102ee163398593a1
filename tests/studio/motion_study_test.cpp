// "Specifying functions by graphically selecting and dragging control points, automatically rendering a preview image,
// and scrubbing a boxcar of specified width": the motion study of the paper's Figure 14, by mouse and keyboard alone.
#include <QTreeWidget>
#include <cmath>
#include <fstream>
#include <numbers>

#include "studio/curves/curve_editor.hpp"
#include "studio/regions/region_edits.hpp"
#include "studio/time/time_strip.hpp"
#include "studio_test.hpp"

namespace nutik::studio {
namespace {

constexpr double kSecond = 1e9;

// On the demo's clip, a quarter as wide: a ball that rolls for a second and then rests (tools/scenes/rolling_ball.py).
// It is drawn before there is a window, whose devices start beside it.
class MotionStudyTest : public StudioTest {
 protected:
  static void SetUpTestSuite() {
    const test::Scratch folder;
    drawn_ = test::run_shell("'" NUTIK_TEST_PYTHON "' '" NUTIK_TEST_SCENE "' --size 160x90 .", folder.folder());
    clip_ = test::read_file(folder / "clip.mkv");
  }
  void SetUp() override {
    ASSERT_EQ(drawn_.status, 0) << drawn_.err;
    std::ofstream(scratch_ / "clip.mkv", std::ios::binary) << clip_;
  }

  static constexpr int kWidth = 160, kHeight = 90;
  static constexpr double kRadius = 0.05 * kWidth;

  static QPointF ball(double seconds) {
    constexpr double kSlope = 12 * std::numbers::pi / 180, kWay = 0.775 * kWidth;
    const double along = kWay * seconds * seconds;
    return QPointF(0.105 * kWidth, 0.5 * kHeight - 0.095 * kWidth) +
           along * QPointF(std::cos(kSlope), std::sin(kSlope));
  }

  static inline test::ProgramResult drawn_;
  static inline std::string clip_;

  // In the time strip, from where the interval is to where it begins at a time.
  void scrub_to(double seconds) {
    auto& strip = child<TimeStrip>("time_strip");
    const QRectF held = strip.boxcar_area();
    const auto& [start_ns, length_ns] = document().boxcar();
    const double way =
        (seconds * kSecond - static_cast<double>(start_ns)) * held.width() / static_cast<double>(length_ns);
    drag(strip, held.center().toPoint(), (held.center() + QPointF(way, 0)).toPoint());
  }
  // Drags a point of the selected function.
  void drag_point(std::size_t which, double seconds) {
    auto& curves = child<CurveEditor>("curves");
    const ControlPoint point = document().points(document().selected_tag()).at(which);
    const QPoint from = curves.frame().place(point).toPoint();
    drag(curves, from, {qRound(curves.frame().x_of(std::llround(seconds * kSecond))), from.y()});
  }
};

TEST_F(MotionStudyTest, IsMadeByMouseAlone) {
  name_next_file("clip.mkv");
  click_menu("File", "Open…");
  ASSERT_TRUE(settles());
  ASSERT_NE(document().facts(), nullptr) << window_.notice().text().toStdString();
  type_into(child<QLineEdit>("width"), "10 ms");

  // The ball as it is at four moments, each in a region drawn round it.
  struct Moment {
    QPoint middle;
    QRgb seen;
  };
  std::vector<Moment> moments;
  for (const double seconds : {0.0, 0.4, 0.8, 1.0}) {
    const QImage unscrubbed = canvas().image();
    scrub_to(seconds);
    ASSERT_TRUE(settles());
    EXPECT_NE(difference(canvas().image(), unscrubbed), "") << "the picture follows";
    const double start = static_cast<double>(document().boxcar().start_ns) / kSecond;
    EXPECT_NEAR(start, seconds, 0.002) << "a pixel of the strip, and a sample";
    const QPointF middle = ball(std::min(start + 0.005, 1.0)), reach(kRadius + 1, kRadius + 1);
    moments.push_back({middle.toPoint(), canvas().image().pixel(middle.toPoint())});
    click_button("add_region");
    click_tool("tool_ellipse");
    const QPointF first = middle - reach, last = middle + reach;
    drag(canvas(), at(first.x(), first.y()), at(last.x(), last.y()));
    EXPECT_NEAR(static_cast<double>(pixels_of(document().selected_tag())),
                std::numbers::pi * reach.x() * reach.x(), 20);
  }

  // Around them the background, the last row, exposes all of the way.
  auto& list = child<QTreeWidget>("regions");
  const QTreeWidgetItem* background = list.topLevelItem(list.topLevelItemCount() - 1);
  QTest::mouseClick(list.viewport(), Qt::LeftButton, {}, list.visualItemRect(background).center());
  ASSERT_EQ(document().selected_tag(), kBackground);
  ASSERT_TRUE(settles());
  const QImage undragged = canvas().image();
  drag_point(2, 1.0);
  drag_point(1, 0.0);
  EXPECT_NEAR(static_cast<double>(document().points(kBackground)[2].time_ns) / kSecond, 1, 0.002);
  EXPECT_LT(document().points(kBackground)[1].time_ns, 0.002 * kSecond);
  ASSERT_TRUE(settles());
  EXPECT_NE(difference(canvas().image(), undragged), "") << "the picture follows";
  for (const Moment& moment : moments) {
    const QRgb shown = canvas().image().pixel(moment.middle);
    for (const int shift : {0, 8, 16})
      EXPECT_NEAR(static_cast<int>(shown >> shift & 255U), static_cast<int>(moment.seen >> shift & 255U), 1);
  }

  name_next_file("study.nutik");
  click_menu("File", "Save project");
  ASSERT_TRUE(window_.has_files()) << window_.notice().text().toStdString();
  name_next_export("window.png");
  click_menu("File", "Export picture…");
  ASSERT_TRUE(settles());
  click_menu("File", "Copy as command");
  run_line(QGuiApplication::clipboard()->text());
  const std::string by_window = test::read_file(scratch_ / "window.png");
  ASSERT_FALSE(by_window.empty()) << window_.notice().text().toStdString();
  EXPECT_TRUE(by_window == test::read_file(scratch_ / "study.png")) << "byte for byte";
  EXPECT_EQ(difference(canvas().image(), QImage(path("window.png"))), "");
}

}  // namespace
}  // namespace nutik::studio
