// A hand that does whatever it likes: nothing breaks, undo brings everything back, and the picture that stands in the
// end is the document's.
#include <QComboBox>
#include <QDoubleSpinBox>

#include "studio/curves/curve_editor.hpp"
#include "studio/time/time_strip.hpp"
#include "studio/window/started_work.hpp"
#include "studio_test.hpp"
#include "support/random_case.hpp"
#include "support/seeds.hpp"

namespace nutik::studio {
namespace {

using test::Random;

class RandomEventsTest : public StudioTest {
 protected:
  [[nodiscard]] QPoint somewhere(const QWidget& widget) {
    return {static_cast<int>(random_.whole(0, widget.width() - 1)),
            static_cast<int>(random_.whole(0, widget.height() - 1))};
  }

  void act() {
    QWidget* const widgets[] = {&canvas(), &child<TimeStrip>("time_strip"), &child<CurveEditor>("curves")};
    QWidget& widget = *widgets[random_.whole(0, 2)];
    const auto modifiers = random_.pick(
        std::vector<Qt::KeyboardModifiers>{{}, Qt::ShiftModifier, Qt::ControlModifier, Qt::AltModifier});
    switch (random_.whole(0, 9)) {
      case 0:
        return click_tool(random_.pick(std::vector<const char*>{
            "tool_look", "tool_brush", "tool_rectangle", "tool_ellipse", "tool_polygon", "tool_wand"}));
      case 1:
        return click_button(
            random_.pick(std::vector<const char*>{"add_region", "remove_region", "region_up", "region_down",
                                                  "grow", "shrink", "smooth", "over_interval"}));
      case 2:
        return QTest::mouseClick(&widget, random_.chance(0.8) ? Qt::LeftButton : Qt::RightButton, modifiers,
                                 somewhere(widget));
      case 3:
        return QTest::keyClick(&widget,
                               random_.pick(std::vector<Qt::Key>{
                                   Qt::Key_Left, Qt::Key_Right, Qt::Key_Up, Qt::Key_Down, Qt::Key_Escape,
                                   Qt::Key_Tab, Qt::Key_Insert, Qt::Key_Delete, Qt::Key_Plus, Qt::Key_Minus,
                                   Qt::Key_Space, Qt::Key_Backspace, Qt::Key_Return}),
                               modifiers);
      case 4:
        return QTest::keyClick(&window_, random_.chance(0.7) ? Qt::Key_Z : Qt::Key_Y, Qt::ControlModifier);
      case 5: return QCoreApplication::processEvents();
      case 6: return choose();
      case 7:  // with Ctrl some of them ask
        return QTest::keyClick(&widget,
                               random_.pick(std::vector<Qt::Key>{Qt::Key_I, Qt::Key_O, Qt::Key_X, Qt::Key_Z,
                                                                 Qt::Key_F, Qt::Key_C}),
                               random_.chance(0.8) ? Qt::NoModifier : Qt::ShiftModifier);
      default: return drag(widget, somewhere(widget), somewhere(widget), modifiers);
    }
  }

  // What is at the side, and what takes its time.
  void choose() {
    switch (random_.whole(0, 3)) {
      case 0: return child<QDoubleSpinBox>("brightness").setValue(static_cast<double>(random_.whole(-4, 8)));
      case 1: return child<QDoubleSpinBox>("feather").setValue(static_cast<double>(random_.whole(0, 3)));
      case 2:
        return QTest::keyClick(&child<QComboBox>(random_.chance(0.5) ? "mode" : "normalization"),
                               random_.chance(0.5) ? Qt::Key_Down : Qt::Key_Up);
      default:
        if (random_.chance(0.3)) window_.start_from(starting_points()[random_.whole(0, 6)]);
        if (random_.chance(0.3)) QTest::keyClick(&window_, Qt::Key_M, Qt::ControlModifier);
    }
  }

  void run() {
    if (const QString clip = qEnvironmentVariable("NUTIK_TEST_CLIP"); clip.isEmpty()) {
      open_clip();
    } else {
      window_.open(clip);
      ASSERT_TRUE(settles() && document().facts() != nullptr) << window_.notice().text().toStdString();
    }
    const DocumentState before = document().state();
    for (int event = 0; event < 400; ++event) act();
    for (int press = 0; press < 2; ++press) QTest::keyClick(&canvas(), Qt::Key_Escape);  // a stroke, a film
    ASSERT_FALSE(document().is_dragging());
    ASSERT_FALSE(document().played());
    ASSERT_TRUE(QTest::qWaitFor([this] { return window_.is_settled(); }, 10 * kMaxWaitMs)) << "studies take long";

    try {
      EXPECT_EQ(difference(canvas().image(), fresh_picture()), "");
    } catch (const InputError& error) {
      EXPECT_EQ(window_.notice().text(), sentence(error.what())) << "what cannot be exposed is said";
    }
    while (document().undo_stack().canUndo()) document().undo_stack().undo();
    EXPECT_TRUE(document().state() == before);
  }

  Random random_{1};
};

TEST_F(RandomEventsTest, LeaveTheDocumentsPicture) {
  const test::Seeds seeds = test::seeds(1, 2);
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    SCOPED_TRACE(test::rerun(seed));
    random_ = Random(seed);
    ASSERT_NO_FATAL_FAILURE(run());
  }
}

}  // namespace
}  // namespace nutik::studio
