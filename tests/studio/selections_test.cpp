// What is found in the capture for a region, and masks and functions in files of their own.
#include <QCheckBox>
#include <QDialog>
#include <QDialogButtonBox>
#include <QLabel>
#include <QLineEdit>

#include "studio/regions/region_edits.hpp"
#include "studio/window/project_file.hpp"
#include "studio_test.hpp"

namespace nutik::studio {
namespace {

class SelectionsTest : public StudioTest {
 protected:
  // What the command line's mask has in its tag 255.
  [[nodiscard]] Region by_command(const std::string& selection) {
    run_line(QString::fromStdString("nutik-cl mask -f 100 " + selection + " frames/%02d.pgm by-command.pgm"));
    const Shared<MaskWithRegions> loaded = load_mask(path("by-command.pgm"));
    const Mask& mask = loaded->mask;
    Region region = Region::none(mask.width, mask.height);
    for (std::size_t i = 0; i < mask.tags.size(); ++i) region.inside[i] = mask.tags[i] == 255;
    return region;
  }
  void type(const char* field, const QString& text) {
    auto& line = child<QLineEdit>(field);
    line.selectAll();
    QTest::keyClicks(&line, text);
  }
  void press_ok() {
    QTest::mouseClick(child<QDialogButtonBox>("difference_buttons").button(QDialogButtonBox::Ok),
                      Qt::LeftButton);
  }
};

TEST_F(SelectionsTest, SelectWhatDiffersBetweenTwoMoments) {
  open_clip();
  click_button("add_region");
  const std::uint8_t tag = document().selected_tag();
  const DocumentState before = document().state();
  ASSERT_TRUE(settles());
  const QImage unselected = canvas().image();
  QTest::keyClick(&window_, Qt::Key_D, Qt::ControlModifier);
  EXPECT_EQ(child<QLineEdit>("difference_from").text(), "0 s");
  type("difference_from", "0f");
  type("difference_to", "12f");
  press_ok();
  ASSERT_TRUE(settles());
  const Region both = by_command("--difference 0f 12f --smooth 1");
  EXPECT_EQ(region_of(document(), tag).inside, both.inside);
  EXPECT_NEAR(static_cast<double>(pixels_of(tag)), 128, 16) << "where the square was, and where it is";
  EXPECT_TRUE(window_.notice().text().contains("differ between 0 s and 120 ms"))
      << window_.notice().text().toStdString();
  EXPECT_EQ(document().undo_stack().undoText(), "Select what differs");
  shortcut(Qt::Key_Z);
  EXPECT_EQ(document().state(), before);
  ASSERT_TRUE(settles());
  EXPECT_EQ(difference(canvas().image(), unselected), "");
}

TEST_F(SelectionsTest, SayWhatIsWrongAndWhatWasNotFound) {
  open_clip();
  QTest::keyClick(&window_, Qt::Key_D, Qt::ControlModifier);
  EXPECT_TRUE(window_.notice().text().contains("Select a region first"))
      << window_.notice().text().toStdString();
  EXPECT_EQ(window_.findChild<QDialog*>(), nullptr);
  click_button("add_region");
  const DocumentState before = document().state();
  QTest::keyClick(&window_, Qt::Key_D, Qt::ControlModifier);
  auto& mistake = child<QLabel>("difference_mistake");
  type("difference_to", "soon");
  press_ok();
  EXPECT_TRUE(mistake.isVisible()) << "the dialog stays";
  EXPECT_EQ(window_.findChild<QDialog*>()->focusWidget(), &child<QLineEdit>("difference_to"));
  type("difference_to", "1 h");
  press_ok();
  EXPECT_TRUE(mistake.text().contains("pictures from 0 s to 199.999999 ms")) << mistake.text().toStdString();
  type("difference_to", "0f");
  QTest::keyClick(&child<QLineEdit>("difference_to"), Qt::Key_Return);
  ASSERT_TRUE(settles());
  EXPECT_TRUE(window_.notice().text().contains("the region stays as it is"))
      << window_.notice().text().toStdString();
  EXPECT_EQ(document().state(), before);
}

TEST_F(SelectionsTest, TakeTheLargestPartAlone) {
  open_clip();
  click_button("add_region");
  QTest::keyClick(&window_, Qt::Key_D, Qt::ControlModifier);
  type("difference_from", "0f");
  type("difference_to", "2f");  // 4 pixels further: both parts are one
  child<QCheckBox>("difference_largest").setChecked(true);
  press_ok();
  ASSERT_TRUE(settles());
  EXPECT_EQ(region_of(document(), document().selected_tag()).inside,
            by_command("--difference 0f 2f --largest --smooth 1").inside);
}

TEST_F(SelectionsTest, SelectWhatMoves) {
  open_clip();
  QTest::keyClick(&window_, Qt::Key_M, Qt::ControlModifier);
  EXPECT_TRUE(window_.notice().text().contains("Select a region first"));
  click_button("add_region");
  QTest::keyClick(&window_, Qt::Key_M, Qt::ControlModifier);
  ASSERT_TRUE(settles());
  EXPECT_EQ(region_of(document(), document().selected_tag()).inside,
            by_command("--moving --smooth 1").inside);
}

TEST_F(SelectionsTest, AreAloneByAKey) {
  open_clip();
  QTest::keyClick(&window_, Qt::Key_O, Qt::ControlModifier | Qt::ShiftModifier);
  EXPECT_EQ(document().solo(), document().selected_tag());
  QTest::keyClick(&window_, Qt::Key_O, Qt::ControlModifier | Qt::ShiftModifier);
  EXPECT_FALSE(document().solo());
}

TEST_F(SelectionsTest, AreWrittenAsMasksAndFunctionsOfTheirOwn) {
  open_clip();
  window_.write_mask(path("none.pgm"));
  EXPECT_TRUE(window_.notice().text().contains("no mask yet")) << window_.notice().text().toStdString();
  add_region(document());
  paint_region(document(), rectangle(96, 48, {10, 10}, 20, 20), document().selected_tag(), "Rectangle");
  set_feather(document(), 250);
  window_.write_mask(path("alone.png"));
  EXPECT_TRUE(window_.notice().text().contains("their feather, 2.5px, is not in the file"))
      << window_.notice().text().toStdString();
  EXPECT_EQ(load_mask(path("alone.png"))->mask, (*document().state().mask)->mask);
  window_.write_functions(path("alone.fn"));
  EXPECT_EQ(load_functions(path("alone.fn")), document().functions());
  EXPECT_FALSE(window_.has_files()) << "they are no project";

  window_.write_mask(path("alone.jpg"));
  EXPECT_TRUE(window_.notice().text().contains("keep every tag")) << window_.notice().text().toStdString();
  window_.write_functions(path("alone.txt"));
  EXPECT_TRUE(window_.notice().text().contains("written as .fn")) << window_.notice().text().toStdString();
  for (const char* name : {"none.pgm", "alone.jpg", "alone.txt"})
    EXPECT_FALSE(std::filesystem::exists(scratch_ / name)) << name;
}

}  // namespace
}  // namespace nutik::studio
