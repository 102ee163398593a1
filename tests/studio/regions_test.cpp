// Regions over each other, and feathers of their own: the model, the picture, the files.
#include <QDoubleSpinBox>
#include <QSignalSpy>
#include <QTreeWidget>

#include "mask/distance.hpp"
#include "studio/regions/region_edits.hpp"
#include "studio/window/project_file.hpp"
#include "studio_test.hpp"
#include "support/program.hpp"
#include "support/random_case.hpp"
#include "support/seeds.hpp"

namespace nutik::studio {
namespace {

using test::Random;

constexpr std::uint32_t kSheetWidth = test::MovingSquare::kWidth, kSheetHeight = test::MovingSquare::kHeight;

// Regions as sheets on a table: each keeps its whole area, whatever lies over it.
struct Sheets {
  struct Sheet {
    std::uint8_t tag;
    Region area;
  };
  std::vector<Sheet> sheets;  // the first lies over the rest

  [[nodiscard]] Sheet& of(std::uint8_t tag) { return *std::ranges::find(sheets, tag, &Sheet::tag); }
  [[nodiscard]] std::uint8_t seen_at(std::size_t pixel) const {
    const auto on_top = [&](const Sheet& sheet) { return sheet.area.inside[pixel] != 0; };
    const auto found = std::ranges::find_if(sheets, on_top);
    return found == sheets.end() ? kBackground : found->tag;
  }
  static void set(Region& area, const Region& pixels, std::uint8_t value) {
    for (std::size_t i = 0; i < area.inside.size(); ++i)
      if (pixels.inside[i] != 0) area.inside[i] = value;
  }
};

class SheetsOnATable : public ::testing::Test {
 protected:
  static constexpr std::uint32_t kColumns = 9, kRows = 7;

  SheetsOnATable() {
    document_.start(
        {"clip.tik", {.shape = {kColumns, kRows, 3}}, Timeline::constant({100, 1}, Timeline::kFullShutter, 100)});
  }

  [[nodiscard]] Region some_pixels(Random& random) {
    return rectangle(kColumns, kRows, {random.real(-2, kColumns), random.real(-2, kRows)}, random.real(1, 7),
                     random.real(1, 7));
  }

  void act(Random& random) {
    const std::int64_t count = static_cast<std::int64_t>(sheets_.sheets.size());
    if (count == 0 || (count < 5 && random.chance(0.15))) {
      add_region(document_);
      sheets_.sheets.insert(sheets_.sheets.begin(),
                            {document_.selected_tag(), Region::none(kColumns, kRows)});
      return;
    }
    const std::uint8_t tag = sheets_.sheets[static_cast<std::size_t>(random.whole(0, count - 1))].tag;
    const Region pixels = some_pixels(random);
    switch (random.whole(0, 9)) {
      case 0: {
        remove_region(document_, tag);
        std::erase_if(sheets_.sheets, [&](const auto& sheet) { return sheet.tag == tag; });
        break;
      }
      case 1: {
        paint_region(document_, pixels, kBackground, "Paint");
        for (auto& sheet : sheets_.sheets) Sheets::set(sheet.area, pixels, 0);
        break;
      }
      case 2:
      case 3: {
        erase_region(document_, pixels, tag, "Erase");
        Sheets::set(sheets_.of(tag).area, pixels, 0);
        break;
      }
      case 4:
      case 5: {
        const bool is_up = random.chance(0.5);
        move_region(document_, tag, is_up ? Move::up : Move::down);
        const auto at = std::ranges::find(sheets_.sheets, tag, &Sheets::Sheet::tag);
        if (is_up && at != sheets_.sheets.begin()) std::iter_swap(at, at - 1);
        if (!is_up && at + 1 != sheets_.sheets.end()) std::iter_swap(at, at + 1);
        break;
      }
      case 6: {
        const double radius = random.real(-2, 2);
        Region& area = sheets_.of(tag).area;
        grow_region(document_, tag, radius);
        area = radius < 0 ? shrunk(area, -radius) : grown(area, radius);
        break;
      }
      default: {
        paint_region(document_, pixels, tag, "Paint");
        Sheets::set(sheets_.of(tag).area, pixels, 1);
      }
    }
  }

  void expect_the_same() {
    const DocumentState& state = document_.state();
    ASSERT_EQ(state.order.size(), sheets_.sheets.size());
    for (std::size_t place = 0; place < state.order.size(); ++place) {
      const auto& [tag, area] = sheets_.sheets[place];
      ASSERT_EQ(state.order[place], tag);
      ASSERT_EQ(region_of(document_, tag), area) << "M" << int{tag};
    }
    for (std::size_t pixel = 0; state.mask && pixel < std::size_t{kColumns} * kRows; ++pixel)
      ASSERT_EQ((*state.mask)->mask.tags[pixel], sheets_.seen_at(pixel)) << "pixel " << pixel;
  }

  Document document_;
  Sheets sheets_;
};

TEST_F(SheetsOnATable, ShowTheFirstAndKeepWhatLiesBeneath) {
  const test::Seeds seeds = test::seeds(1, 12);
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    SCOPED_TRACE(test::rerun(seed));
    Random random(seed);
    while (document_.undo_stack().canUndo()) document_.undo_stack().undo();
    sheets_.sheets.clear();
    const DocumentState before = document_.state();
    for (int step = 0; step < 200; ++step) {
      act(random);
      ASSERT_NO_FATAL_FAILURE(expect_the_same()) << "step " << step;
    }
    const DocumentState after = document_.state();
    while (document_.undo_stack().canUndo()) document_.undo_stack().undo();
    ASSERT_EQ(document_.state(), before);
    while (document_.undo_stack().canRedo()) document_.undo_stack().redo();
    ASSERT_EQ(document_.state(), after);
  }
}

class RegionsTest : public StudioTest {
 protected:
  // Two regions of rectangles that share 10 x 10 pixels, the second before the first; dark and bright.
  void overlap() {
    open_clip();
    for (const double gain : {0.5, 0.25}) {
      click_button("add_region");
      const std::uint8_t tag = document().selected_tag();
      const std::int64_t end_ns = document().duration_ns();
      document().set_points(tag, {{0, gain}, {end_ns, gain}}, "Begin");
      (gain == 0.5 ? behind_ : before_) = tag;
      const int shift = gain == 0.5 ? 0 : 10;
      click_tool("tool_rectangle");
      drag(canvas(), at(20 + shift, 10 + shift), at(40 + shift, 30 + shift));
    }
    // Divided by the same for all, so that gains are brightnesses.
    DocumentState state = document().state();
    state.functions.insert_or_assign(kBackground, GainFunction({{0, 1.0}, {document().duration_ns(), 1.0}}));
    document().apply(state, "Begin");
    ASSERT_TRUE(settles());
    ASSERT_EQ(shared(), 100u);
  }

  // Pixels that both have.
  [[nodiscard]] std::size_t shared() {
    return intersection(region_of(document(), before_), region_of(document(), behind_)).pixel_count();
  }
  [[nodiscard]] std::uint8_t owner(int x, int y) {
    return (*document().state().mask)
        ->mask.tags[static_cast<std::size_t>(y) * kSheetWidth + static_cast<std::size_t>(x)];
  }
  void expect_picture() {
    ASSERT_TRUE(settles());
    EXPECT_EQ(difference(canvas().image(), fresh_picture()), "");
  }

  std::uint8_t before_ = 0, behind_ = 0;
};

TEST_F(RegionsTest, TheFirstCoversTheRest) {
  ASSERT_NO_FATAL_FAILURE(overlap());
  auto& list = child<QTreeWidget>("regions");
  ASSERT_EQ(list.topLevelItemCount(), 3);
  EXPECT_TRUE(list.topLevelItem(0)->toolTip(0).contains(QString("M%1 in").arg(before_)))
      << "a new region lies before the others";
  EXPECT_TRUE(list.topLevelItem(2)->toolTip(0).contains("M0 in")) << "the background behind all";
  EXPECT_EQ(owner(35, 25), before_);
  EXPECT_EQ(pixels_of(behind_), 300u);
  expect_picture();
  const DocumentState first = document().state();
  const QImage unmoved = canvas().image();

  click_button("region_down");
  EXPECT_TRUE(list.topLevelItem(0)->toolTip(0).contains(QString("M%1 in").arg(behind_)));
  EXPECT_EQ(list.currentItem(), list.topLevelItem(1)) << "the moved one stays selected";
  EXPECT_EQ(owner(35, 25), behind_);
  EXPECT_EQ(pixels_of(before_), 300u);
  expect_picture();
  EXPECT_NE(canvas().image().pixel(35, 25), unmoved.pixel(35, 25)) << "the other one's function";
  EXPECT_EQ(canvas().image().pixel(25, 15), unmoved.pixel(25, 15));
  EXPECT_FALSE(child<QPushButton>("region_down").isEnabled()) << "it is the last";
  EXPECT_TRUE(child<QPushButton>("region_up").isEnabled());

  QTest::keyClick(&window_, Qt::Key_PageUp, Qt::ControlModifier);
  EXPECT_EQ(document().state(), first) << "up again, by keyboard";
  QTest::keyClick(&window_, Qt::Key_PageUp, Qt::ControlModifier);
  EXPECT_EQ(document().undo_stack().undoText(), "Move region up") << "the first goes no further";
  EXPECT_FALSE(child<QPushButton>("region_up").isEnabled());
  ASSERT_TRUE(settles());
  EXPECT_EQ(difference(canvas().image(), unmoved), "");
  for (int step = 0; step < 2; ++step) QTest::keyClick(&window_, Qt::Key_Z, Qt::ControlModifier);
  EXPECT_EQ(document().state(), first);
}

TEST_F(RegionsTest, APixelThatARegionLosesShowsTheNext) {
  ASSERT_NO_FATAL_FAILURE(overlap());
  drag(canvas(), at(30, 20), at(40, 30), Qt::AltModifier);
  EXPECT_EQ(owner(35, 25), behind_) << "Alt takes from the selected region alone";
  EXPECT_EQ(pixels_of(behind_), 400u);
  expect_picture();
  QTest::keyClick(&window_, Qt::Key_Z, Qt::ControlModifier);
  EXPECT_EQ(owner(35, 25), before_);
  click_button("remove_region");
  EXPECT_EQ(pixels_of(behind_), 400u) << "what was covered appears";
  expect_picture();
}

TEST_F(RegionsTest, ARegionIsPaintedBeneathThoseBeforeIt) {
  ASSERT_NO_FATAL_FAILURE(overlap());
  const QImage unpainted = canvas().image();
  document().select_tag(behind_);
  click_tool("tool_brush");
  drag(canvas(), at(45, 35), at(46, 35));
  EXPECT_GT(shared(), 100u);
  EXPECT_EQ(owner(45, 35), before_);
  expect_picture();
  EXPECT_EQ(canvas().image().pixel(45, 35), unpainted.pixel(45, 35));
  document().select_tag(kBackground);
  drag(canvas(), at(45, 35), at(46, 35));
  EXPECT_EQ(owner(45, 35), kBackground) << "the background takes from all";
  EXPECT_EQ(region_of(document(), behind_).inside[35 * kSheetWidth + 45], 0);
  expect_picture();
}

TEST_F(RegionsTest, GrowAndShrinkAsTheMasksStepsDo) {
  ASSERT_NO_FATAL_FAILURE(overlap());
  document().select_tag(behind_);
  child<QDoubleSpinBox>("radius").setValue(3);
  const Region area = region_of(document(), behind_);
  click_button("grow");
  EXPECT_EQ(region_of(document(), behind_), grown(area, 3));
  EXPECT_EQ(owner(35, 25), before_) << "beneath the one before it";
  EXPECT_EQ(owner(18, 15), behind_) << "over the background";
  EXPECT_EQ(pixels_of(before_), 400u);
  expect_picture();
  click_button("shrink");
  EXPECT_EQ(region_of(document(), behind_), shrunk(grown(area, 3), 3));
  click_button("smooth");
  EXPECT_EQ(region_of(document(), behind_), smoothed(shrunk(grown(area, 3), 3), 3));
  EXPECT_EQ(document().undo_stack().undoText(), "Smooth region");
  expect_picture();
}

TEST_F(RegionsTest, HaveAFeatherOfTheirOwn) {
  ASSERT_NO_FATAL_FAILURE(overlap());
  const QImage hard = canvas().image();
  auto& own = child<QDoubleSpinBox>("own_feather");
  EXPECT_EQ(own.text(), "as all edges");
  type_into(own, "3");
  EXPECT_EQ(document().state().feather, (Feather{0, {{before_, 300}}}));
  ASSERT_TRUE(settles());
  EXPECT_NE(difference(canvas().image(), hard), "");
  expect_picture();
  EXPECT_EQ(canvas().image().pixel(20, 20), hard.pixel(20, 20)) << "the other region's edges stay hard";
  document().select_tag(behind_);
  EXPECT_EQ(own.text(), "as all edges");
  document().select_tag(before_);
  EXPECT_EQ(own.value(), 3);

  ASSERT_TRUE(window_.save_project(path("feathered.nutik")));
  const QString line = window_.command_for(path("line.png"));
  EXPECT_TRUE(line.contains(QString("--feather M%1=3px").arg(before_))) << line.toStdString();
  run_line(line);
  EXPECT_EQ(difference(canvas().image(), QImage(path("line.png"))), "");

  type_into(own, "0", Qt::Key_Down);
  EXPECT_EQ(own.text(), "as all edges") << "one step below 0";
  EXPECT_EQ(document().state().feather, Feather());
  ASSERT_TRUE(settles());
  EXPECT_EQ(difference(canvas().image(), hard), "");
}

TEST_F(RegionsTest, AreSavedInTheirOrderWithWhatIsCovered) {
  ASSERT_NO_FATAL_FAILURE(overlap());
  click_button("region_down");
  set_feather_of(document(), before_, 150);
  const DocumentState saved = document().state();
  ASSERT_TRUE(settles());
  ASSERT_TRUE(window_.save_project(path("order.nutik")));
  const QImage picture = canvas().image();
  MainWindow other;
  open_in(other, path("order.nutik"));
  EXPECT_EQ(other.document().state(), saved) << other.notice().text().toStdString();
  EXPECT_EQ(difference(other.canvas().image(), picture), "");
  move_region(other.document(), before_, Move::up);
  EXPECT_EQ(other.document().state().covered.at(behind_)->pixel_count(), 100u);
}

TEST_F(RegionsTest, AProjectThatIsDamagedIsRefusedAndAForeignMaskHidesNothing) {
  ASSERT_NO_FATAL_FAILURE(overlap());
  ASSERT_TRUE(window_.save_project(path("order.nutik")));
  const std::string good = test::read_file(scratch_ / "order.nutik");
  const auto refuses = [&](const std::string& text, const char* words) {
    ASSERT_NE(text, good);
    scratch_.write("bad.nutik", text);
    window_.open(path("bad.nutik"));
    EXPECT_TRUE(window_.notice().text().contains(words)) << window_.notice().text().toStdString();
  };
  const std::size_t covered = good.find("\"covered\": \"") + 12;
  refuses(std::string(good).replace(covered, 8, "AAAAAAAA"), "what is covered of a region is damaged");
  refuses(std::string(good).replace(covered + 20, 1, good[covered + 20] == 'x' ? "y" : "x"), "is damaged");
  const std::string tag = "\"tag\": " + std::to_string(behind_);
  refuses(std::string(good).replace(good.find(tag), tag.size(), "\"tag\": " + std::to_string(before_)),
          "two regions with the tag");

  // The mask was replaced by one of another size: what it covered goes with it.
  const Mask small = Mask::uniform(8, 6, before_);
  save_mask(path("order.pgm"), small);
  window_.open(path("order.nutik"));
  EXPECT_TRUE(window_.notice().text().contains("what is covered")) << window_.notice().text().toStdString();
}

}  // namespace
}  // namespace nutik::studio
