// What is painted anew in part is what painting all of it shows.
#include <QPaintEvent>
#include <QScreen>
#include <algorithm>
#include <utility>

#include "studio_test.hpp"

namespace nutik::studio {
namespace {

class PaintingTest : public StudioTest, public QObject {
 protected:
  PaintingTest() {
    canvas().installEventFilter(this);
    window_.offer().clear();  // of what another test left unsaved, which lies over the picture
  }
  ~PaintingTest() override { canvas().removeEventFilter(this); }

  bool eventFilter(QObject* /*of*/, QEvent* event) override {
    if (event->type() == QEvent::Paint && counts_) painted_ += static_cast<QPaintEvent*>(event)->region();
    return false;
  }

  // Where pixels are mixed Qt does so in steps of 1/256, by one of which what is clipped may be off, either way.
  static constexpr int kMixing = 2;

  [[nodiscard]] static int largest_difference(const QImage& a, const QImage& b) {
    if (a.size() != b.size()) return 256;
    int largest = 0;
    for (int y = 0; y < a.height(); ++y) {
      for (int x = 0; x < a.width(); ++x) {
        const QRgb p = a.pixel(x, y), q = b.pixel(x, y);
        largest = std::max({largest, std::abs(qRed(p) - qRed(q)), std::abs(qGreen(p) - qGreen(q)),
                            std::abs(qBlue(p) - qBlue(q))});
      }
    }
    return largest;
  }

  // What was painted since is some of the canvas, and makes it what it is to be.
  void expect_part_to_be_enough(const std::string& after) {
    counts_ = true;
    QCoreApplication::processEvents();
    counts_ = false;
    const QRegion painted = std::exchange(painted_, {});
    EXPECT_FALSE(painted.isEmpty()) << after;
    EXPECT_FALSE((QRegion(canvas().rect()) - painted).isEmpty()) << after;
    const QImage screen = window_.screen()->grabWindow(window_.winId()).toImage();
    const QRect place(canvas().mapTo(&window_, QPoint(0, 0)), canvas().size());
    EXPECT_LE(largest_difference(screen.copy(place), canvas().grab().toImage()), kMixing) << after;
  }

  bool counts_ = false;
  QRegion painted_;
};

TEST_F(PaintingTest, APartIsPaintedAsWithEverything) {
  open_clip();
  click_button("add_region");
  click_tool("tool_brush");
  for (const double zoom : {0.3, 1.0, 7.0}) {
    const std::string at_zoom = " at " + std::to_string(zoom);
    canvas().zoom_by(zoom / canvas().view().zoom());
    QTest::mouseMove(&canvas(), at(30, 20));
    ASSERT_TRUE(settles());
    QCoreApplication::processEvents();
    QTest::mouseMove(&canvas(), at(34, 22));
    expect_part_to_be_enough("the brush moved" + at_zoom);

    QTest::mousePress(&canvas(), Qt::LeftButton, {}, at(34, 22));
    ASSERT_TRUE(settles());
    QCoreApplication::processEvents();
    move_pressed(canvas(), at(38, 25));
    expect_part_to_be_enough("it was drawn" + at_zoom);
    QTest::mouseRelease(&canvas(), Qt::LeftButton, {}, at(38, 25));
    ASSERT_TRUE(settles());
    QCoreApplication::processEvents();

    ShownPicture part;
    part.place = {41, 13, 12, 8};
    part.image = QImage(12, 8, QImage::Format_RGB32);
    part.image.fill(Qt::white);
    canvas().show_picture(part);
    expect_part_to_be_enough("some pixels came" + at_zoom);

    const QImage full = canvas().image();
    part.divisor = 2;
    part.place = {20, 10, 8, 4};
    part.image = QImage(4, 2, QImage::Format_RGB32);
    part.image.fill(Qt::red);
    canvas().show_picture(part);  // and all of it is painted: what is shown has fewer pixels from here on
    QCoreApplication::processEvents();
    part.place = {30, 12, 8, 4};
    part.image.fill(Qt::green);
    canvas().show_picture(part);
    expect_part_to_be_enough("some of fewer pixels came" + at_zoom);
    ShownPicture whole;
    whole.place = {{0, 0}, full.size()};
    whole.image = full;
    canvas().show_picture(whole);
  }
}

}  // namespace
}  // namespace nutik::studio
