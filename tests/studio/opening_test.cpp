// What a window keeps until another file is open, and what it forgets then.
#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QSettings>
#include <QToolButton>
#include <fstream>

#include "capture/error.hpp"
#include "studio/live/opening.hpp"
#include "studio/regions/region_edits.hpp"
#include "studio/window/project_file.hpp"
#include "studio_test.hpp"
#include "support/messages.hpp"

namespace nutik::studio {
namespace {

class OpeningTest : public StudioTest {
 protected:
  OpeningTest() {
    QSettings().remove("recent");
    std::filesystem::create_directory(scratch_ / "damaged");
    scratch_.write("damaged/0.pgm", "P5 16 8 255\n" + std::string(128, 'a'));  // which is shown at first
    scratch_.write("damaged/1.pgm", "P5 16 8 255\n" + std::string(100, 'a'));
    std::filesystem::create_directory(scratch_ / "small");
    scratch_.write("small/0.pgm", "P5 16 8 255\n" + std::string(128, 'a'));
    scratch_.write("small/1.pgm", "P5 16 8 255\n" + std::string(128, 'z'));
  }

  void open_project() {
    open_clip();
    click_button("add_region");
    paint_region(document(), rectangle(96, 48, {4, 2}, 20, 20), document().selected_tag(), "Rectangle");
    ASSERT_TRUE(settles());
    ASSERT_TRUE(window_.save_project(path("mine.nutik")));
  }
  void expect_mine() {
    EXPECT_TRUE(window_.windowTitle().startsWith("mine.nutik")) << window_.windowTitle().toStdString();
    EXPECT_TRUE(window_.has_files());
    EXPECT_TRUE(window_.command_for("picture.png").contains("mine.fn"));
    document().set_boxcar({7, 1'000}, "Scrub");
    QTest::keyClick(&window_, Qt::Key_S, Qt::ControlModifier);
    EXPECT_EQ(load_project(path("mine.nutik")).state.boxcar, (Boxcar{7, 1'000}))
        << "it is saved where it was";
  }
  // Opens a clip, and does something as soon as its first picture is there: whatever else the window is to hear of the
  // clip comes after that.
  void look_first(const char* clip, const std::function<void()>& act) {
    bool has_looked = false;
    QObject once;
    QObject::connect(&canvas(), &Canvas::visible_changed, &once, [&] {
      if (has_looked || !canvas().shows_first_look()) return;
      has_looked = true;
      const auto& progress = *window_.findChild<QProgressBar*>();
      EXPECT_TRUE(progress.isHidden() || progress.value() < progress.maximum())
          << "the rest is still to come";
      act();
    });
    window_.open(path(clip), "100");
    ASSERT_TRUE(QTest::qWaitFor([&] { return has_looked; }, kMaxWaitMs));
  }
  // In the middle of each pixel, where nothing is drawn over it.
  void expect_to_be_painted(const QImage& image) {
    const QImage seen = canvas().grab().toImage();
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x)
        ASSERT_EQ(shown_at(seen, at(x + 0.5, y + 0.5)), image.pixelColor(x, y)) << x << ", " << y;
  }

  // The button beside what is said.
  void take_way_out(const char* label) {
    auto& button = *window_.notice().findChild<QToolButton*>("way_out");
    ASSERT_TRUE(button.isVisible()) << window_.notice().text().toStdString();
    EXPECT_EQ(button.text(), label);
    QTest::mouseClick(&button, Qt::LeftButton);
    ASSERT_TRUE(settles());
  }

  // The menu of recent files, once it was filled.
  [[nodiscard]] QMenu& recent() {
    for (QAction* action : window_.menuBar()->actions().front()->menu()->actions()) {
      if (action->menu() == nullptr) continue;
      Q_EMIT action->menu()->aboutToShow();
      return *action->menu();
    }
    throw std::logic_error("no menu of recent files");
  }
  [[nodiscard]] QStringList recent_files() {
    QStringList files;
    for (const QAction* action : recent().actions()) files += QFileInfo(action->text()).fileName();
    return files;
  }
};

TEST(RoomWatch, SaysThatACaptureWillNotFitBeforeTheDiskIsFull) {
  constexpr std::uint64_t kMB = 1'000'000;
  std::uint64_t left = 1000 * kMB;
  const RoomWatch room("/tmp/some", [&] { return left; });
  room.look(1, 100);
  left = 990 * kMB;
  room.look(1, 1000) /* too little was written to tell */;
  left = 900 * kMB;
  room.look(10, 100) /* 900 MB more, and 900 are left */;
  left = 800 * kMB;
  room.look(17, 100) /* 976 MB more: the rest may pack better */;
  test::expect_error<OutputError>([&] { room.look(10, 100); },
                                  {"10 of 100 samples took 200 MB", "needs some 1.8 GB", "800 MB are left in /tmp/some",
                                   "name another folder in TMPDIR"});
  room.look(100, 100);
  left = 2000 * kMB;
  room.look(10, 100) /* others made room */;
}

TEST_F(OpeningTest, AProjectStaysWhereAnotherFileCannotBeOpened) {
  ASSERT_NO_FATAL_FAILURE(open_project());
  const QImage picture = canvas().image();
  window_.open(path("damaged/%d.pgm"), "100");
  ASSERT_TRUE(settles());
  EXPECT_TRUE(window_.notice().text().contains("1.pgm")) << window_.notice().text().toStdString();
  EXPECT_EQ(document().facts()->path, path("frames/%02d.pgm"));
  EXPECT_EQ(difference(canvas().image(), picture), "");
  expect_mine();
}

TEST_F(OpeningTest, AProjectStaysWhereAnotherProjectsClipCannotBeOpened) {
  ASSERT_NO_FATAL_FAILURE(open_project());
  scratch_.write("other.fn", "M0 [0:1]\n");
  scratch_.write("other.nutik", R"({"nutik-studio": 1, "capture": "gone.tik", "functions": "other.fn",
    "exposes": "interval", "start_ns": "0", "length_ns": "5", "normalize": "support", "feather": "0px"})");
  window_.open(path("other.nutik"));
  ASSERT_TRUE(settles());
  EXPECT_TRUE(window_.notice().text().contains("gone.tik")) << window_.notice().text().toStdString();
  EXPECT_EQ(recent_files(), QStringList({"mine.nutik", "%02d.pgm"})) << "what was not opened is not listed";
  expect_mine();
}

TEST_F(OpeningTest, AProjectStaysWhileAnotherFileIsOpenedAndIfThatIsCancelled) {
  ASSERT_NO_FATAL_FAILURE(open_project());
  window_.open(path("frames/%02d.pgm"), "100");
  EXPECT_TRUE(window_.windowTitle().startsWith("mine.nutik"));
  EXPECT_TRUE(window_.has_files());
  QTest::mouseClick(&child<QToolButton>("cancel"), Qt::LeftButton);
  ASSERT_TRUE(settles());
  expect_mine();
  open_clip();
  EXPECT_TRUE(window_.windowTitle().startsWith("%02d.pgm")) << window_.windowTitle().toStdString();
  document().set_mode(ExposureMode::functions);
  EXPECT_FALSE(window_.has_files()) << "what is open lies in no project";
}

TEST_F(OpeningTest, AsksForWhatWasChangedWhileAnotherFileWasOpened) {
  ASSERT_NO_FATAL_FAILURE(open_project());
  const auto change_while_opening = [&](QMessageBox::StandardButton button, bool is_mark = false) {
    window_.open(path("frames/%02d.pgm"), "100");
    if (is_mark) document().set_mark_in(5'000'000);
    if (!is_mark) add_region(document());
    answer_next(button);
    ASSERT_TRUE(settles());
    EXPECT_TRUE(is_asked_);
  };
  ASSERT_NO_FATAL_FAILURE(change_while_opening(QMessageBox::Cancel, true));
  ASSERT_NO_FATAL_FAILURE(change_while_opening(QMessageBox::Cancel));
  EXPECT_EQ(document().functions().size(), 3u);
  EXPECT_EQ(difference(canvas().image(), fresh_picture()), "");
  ASSERT_NO_FATAL_FAILURE(change_while_opening(QMessageBox::Discard));
  EXPECT_EQ(document().functions().size(), 1u);
  EXPECT_TRUE(window_.windowTitle().startsWith("%02d.pgm")) << window_.windowTitle().toStdString();
}

TEST_F(OpeningTest, TheFirstPictureIsShownWhileTheRestIsDecoded) {
  ASSERT_NO_FATAL_FAILURE(look_first("frames/%02d.pgm", [this] {
    EXPECT_EQ(document().facts(), nullptr);
    const auto codes = square_.pictures.front().begin();
    for (int y = 0; y < canvas().image().height(); ++y) {
      for (int x = 0; x < canvas().image().width(); ++x) {
        const int code = codes[y * test::MovingSquare::kWidth + x];
        ASSERT_EQ(canvas().image().pixel(x, y), qRgb(code, code, code)) << x << ", " << y;
      }
    }
    expect_to_be_painted(canvas().image());
  }));
  ASSERT_TRUE(settles());
  EXPECT_FALSE(canvas().shows_first_look());
  ASSERT_NE(document().facts(), nullptr) << window_.notice().text().toStdString();
  EXPECT_EQ(difference(canvas().image(), fresh_picture()), "");
  expect_to_be_painted(canvas().image());
}

TEST_F(OpeningTest, NoToolWorksOnTheFirstPicture) {
  ASSERT_NO_FATAL_FAILURE(open_project());
  const DocumentState before = document().state();
  const QImage fitting = canvas().image();
  ASSERT_NO_FATAL_FAILURE(look_first("small/%d.pgm", [&] {
    const QRect place = canvas().view().place().toAlignedRect().adjusted(1, 1, -1, -1);
    const QImage seen = canvas().grab(place).toImage();
    QImage plain(seen.size(), seen.format());
    plain.fill(QColor('a', 'a', 'a'));
    EXPECT_EQ(difference(seen, plain), "") << "no outline of what is open still";
    ShownPicture late;  // of what is open still
    late.place = QRect({0, 0}, fitting.size());
    late.image = fitting;
    canvas().show_picture(late);
    EXPECT_EQ(canvas().grab(place).toImage(), seen);
    for (const char* tool : {"tool_brush", "tool_rectangle", "tool_ellipse", "tool_wand", "tool_look"}) {
      click_tool(tool);
      drag(canvas(), at(2, 2), at(12, 6));
      QTest::mouseClick(&canvas(), Qt::LeftButton, {}, at(8, 4));
      for (const Qt::Key key : {Qt::Key_Right, Qt::Key_Space, Qt::Key_Right, Qt::Key_Space})
        QTest::keyClick(&canvas(), key);
      EXPECT_EQ(document().state(), before) << tool;
      EXPECT_EQ(document().probe(), std::nullopt) << tool;
    }
  }));
  ASSERT_TRUE(settles());
  EXPECT_EQ(document().facts()->path, path("small/%d.pgm"));
  EXPECT_EQ(difference(canvas().image(), fresh_picture()), "");
}

TEST_F(OpeningTest, NothingElseIsSaidOfAnotherCaptureBesideTheFirstPicture) {
  const auto seen = [this](const char* name) {
    QWidget& widget = child<QWidget>(name);
    const QImage image = widget.grab().toImage();
    QImage plain(image.size(), image.format());
    plain.fill(window_.palette().color(QPalette::Window));
    return difference(image, plain);
  };
  ASSERT_NO_FATAL_FAILURE(open_project());
  ASSERT_NO_FATAL_FAILURE(look_first("small/%d.pgm", [&] {
    EXPECT_TRUE(window_.windowTitle().startsWith("%d.pgm")) << window_.windowTitle().toStdString();
    for (const char* name : {"time_strip", "curves"}) EXPECT_EQ(seen(name), "") << name;
    for (const char* name : {"start", "regions"}) EXPECT_FALSE(child<QWidget>(name).isEnabled()) << name;
    EXPECT_FALSE(child<QWidget>("said").isVisible());
    QTest::mouseClick(&child<QToolButton>("cancel"), Qt::LeftButton);
  }));
  ASSERT_TRUE(settles());
  for (const char* name : {"time_strip", "curves"}) EXPECT_NE(seen(name), "") << name;
  for (const char* name : {"start", "regions"}) EXPECT_TRUE(child<QWidget>(name).isEnabled()) << name;
  expect_mine();
}

TEST_F(OpeningTest, TheFirstPictureStaysUntilTheDocumentsIsThere) {
  bool is_checked = false;
  QObject once;
  QObject::connect(&document(), &Document::capture_changed, &once, [&] {
    is_checked = true;
    EXPECT_EQ(shown_at(canvas().grab().toImage(), at(8.5, 4.5)), QColor('a', 'a', 'a'));
    click_tool("tool_brush");
    QTest::mouseClick(&canvas(), Qt::LeftButton, {}, at(8, 4));
    EXPECT_EQ(document().undo_stack().count(), 0) << "no tool works on it";
  });
  window_.open(path("small/%d.pgm"), "100");
  ASSERT_TRUE(settles());
  EXPECT_TRUE(is_checked);
  EXPECT_FALSE(canvas().shows_first_look());
  EXPECT_EQ(difference(canvas().image(), fresh_picture()), "");
}

TEST_F(OpeningTest, AStrokeThatIsNotFinishedIsGivenUpForTheFirstPicture) {
  ASSERT_NO_FATAL_FAILURE(open_project());
  const DocumentState before = document().state();
  click_tool("tool_brush");
  const QPoint from = at(60, 20);
  QTest::mousePress(&canvas(), Qt::LeftButton, {}, from);
  ASSERT_NE(document().state(), before);
  ASSERT_NO_FATAL_FAILURE(look_first("small/%d.pgm", [&] {
    QTest::mouseRelease(&canvas(), Qt::LeftButton, {}, from + QPoint(20, 0));
    EXPECT_EQ(document().state(), before);
    EXPECT_FALSE(document().is_dragging());
    QTest::mouseClick(&child<QToolButton>("cancel"), Qt::LeftButton);
  }));
  ASSERT_TRUE(settles());
  EXPECT_EQ(document().state(), before);
}

TEST_F(OpeningTest, CancelledTheFirstPictureGivesWayToWhatWasThere) {
  const auto cancel = [this] { QTest::mouseClick(&child<QToolButton>("cancel"), Qt::LeftButton); };
  ASSERT_NO_FATAL_FAILURE(look_first("small/%d.pgm", cancel));
  ASSERT_TRUE(settles());
  EXPECT_TRUE(canvas().image().isNull());
  EXPECT_EQ(document().facts(), nullptr);
  EXPECT_EQ(window_.notice().text(), "") << "who cancels knows why";
  ASSERT_NO_FATAL_FAILURE(open_project());
  const DocumentState before = document().state();
  const QImage picture = canvas().image();
  ASSERT_NO_FATAL_FAILURE(look_first("small/%d.pgm", cancel));
  ASSERT_TRUE(settles());
  EXPECT_FALSE(canvas().shows_first_look());
  EXPECT_EQ(document().state(), before);
  EXPECT_EQ(difference(canvas().image(), picture), "");
  expect_mine();
}

// A capture that has more pixels than the screen; while a drag lasts all of them are exposed only where no smaller
// capture is there.
TEST_F(OpeningTest, WhatOpeningAnotherFileBrokeOffIsMadeAfterAll) {
  std::filesystem::create_directory(scratch_ / "wide");
  for (const char* name : {"wide/0.pgm", "wide/1.pgm"})
    scratch_.write(name, "P5 4000 8 255\n" + std::string(32'000, name[5] == '0' ? 'a' : 'z'));
  window_.open(path("wide/%d.pgm"), "100");
  ASSERT_TRUE(QTest::qWaitFor([&] { return document().facts() != nullptr; }, kMaxWaitMs));
  window_.open(path("damaged/%d.pgm"), "100");
  ASSERT_TRUE(settles());
  EXPECT_TRUE(window_.notice().text().contains("1.pgm")) << window_.notice().text().toStdString();
  EXPECT_EQ(document().facts()->path, path("wide/%d.pgm"));
  EXPECT_FALSE(document().overview().thumbnails.empty());
  EXPECT_FALSE(document().overview().changed_share.empty());
  const QImage full = canvas().image();
  document().begin_drag();
  document().set_boxcar({15'000'000, 1'000}, "Scrub");
  ASSERT_TRUE(settles());
  EXPECT_EQ(canvas().image(), full) << "the preview is a small one";
  document().end_drag();
  ASSERT_TRUE(settles());
  EXPECT_NE(canvas().image(), full);
}

// As its self-test found, which is kept.
TEST_F(OpeningTest, AClipIsOpenedWhereADeviceComputesWholeNumbersWrongly) {
  const QByteArray kept = qgetenv("XDG_CACHE_HOME");
  qputenv("XDG_CACHE_HOME", path("cache").toUtf8());
  for (const bool is_wrong : {false, true}) {
    MainWindow window;
    open_in(window);
    EXPECT_EQ(window.document().facts()->precision,
              is_wrong ? std::nullopt : std::optional(Precision::fixed));
    EXPECT_EQ(window.command_for("picture.png").contains("--precision fixed"), !is_wrong);
    EXPECT_FALSE(window.canvas().shows_first_look());
    for (const auto& file : std::filesystem::recursive_directory_iterator(scratch_ / "cache")) {
      if (!file.path().filename().string().starts_with("self-test-")) continue;
      std::string text = test::read_file(file.path());
      if (const auto at = text.find("\nfixed right"); at != std::string::npos)
        text.replace(at, 12, "\nfixed wrong");
      std::ofstream(file.path()) << text;
    }
  }
  kept.isNull() ? qunsetenv("XDG_CACHE_HOME") : qputenv("XDG_CACHE_HOME", kept);
}

TEST_F(OpeningTest, OfADamagedClipThePartBeforeTheDamageIsOpened) {
  std::filesystem::create_directory(scratch_ / "torn");
  for (const char* name : {"torn/0.pgm", "torn/1.pgm", "torn/2.pgm"})
    scratch_.write(name, "P5 16 8 255\n" + std::string(name[5] == '2' ? 100 : 128, name[5]));
  window_.open(path("torn/%d.pgm"), "100");
  ASSERT_TRUE(settles());
  EXPECT_TRUE(window_.notice().text().contains("2 pictures before it can be taken"))
      << window_.notice().text().toStdString();
  take_way_out("Open that part");
  ASSERT_NE(document().facts(), nullptr) << window_.notice().text().toStdString();
  EXPECT_EQ(document().facts()->timeline.sample_count(), 2u);
  EXPECT_TRUE(window_.notice().text().contains("taken as far as it goes"))
      << window_.notice().text().toStdString();
  document().set_boxcar({0, 20'000'000}, "Scrub");
  ASSERT_TRUE(window_.save_project(path("torn.nutik")));
  for (const char* again : {"F5", "project"}) {
    again[0] == 'F' ? QTest::keyClick(&window_, Qt::Key_F5) : window_.open(path("torn.nutik"));
    ASSERT_TRUE(settles());
    EXPECT_EQ(document().facts()->timeline.sample_count(), 2u) << again;
    window_.export_picture(path("window.png"));
    ASSERT_TRUE(settles());
    run_line(window_.command_for(path("line.png")));
    EXPECT_EQ(test::read_file(scratch_ / "window.png"), test::read_file(scratch_ / "line.png"));
  }
}

TEST_F(OpeningTest, OfACaptureThatWasCutOffIsSavedAndOpenedWhatIsWhole) {
  run_line("nutik-cl encode -f 100 --block-samples 8 frames/%02d.pgm cut.tik");
  std::filesystem::resize_file(scratch_ / "cut.tik",
                               std::filesystem::file_size(scratch_ / "cut.tik") / 10 * 9);
  window_.open(path("cut.tik"));
  ASSERT_TRUE(settles());
  name_next_file("saved.tik");
  take_way_out("Save what is whole…");
  ASSERT_NE(document().facts(), nullptr) << window_.notice().text().toStdString();
  EXPECT_EQ(document().facts()->path, path("saved.tik"));
  EXPECT_EQ(document().facts()->timeline.sample_count(), 16u);
  EXPECT_TRUE(window_.notice().text().contains("16 samples were saved"))
      << window_.notice().text().toStdString();
}

TEST_F(OpeningTest, AProjectsClipThatWasMovedIsLocated) {
  ASSERT_NO_FATAL_FAILURE(open_project());
  const DocumentState state = document().state();
  const QImage picture = canvas().image();
  run_line("nutik-cl encode -f 100 frames/%02d.pgm clip.tik");
  std::string project = test::read_file(scratch_ / "mine.nutik");
  project.replace(project.find("frames/%02d.pgm"), 15, "gone/clip.tik");
  scratch_.write("mine.nutik",
                 project.erase(project.find("\"fps\""),
                               project.find('\n', project.find("\"fps\"")) - project.find("\"fps\"")));
  window_.open(path("mine.nutik"));
  ASSERT_TRUE(settles());
  std::filesystem::create_directory(scratch_ / "other");
  scratch_.write("other/0.pgm", "P5 16 8 255\n" + std::string(128, 'a'));
  run_line("nutik-cl encode -f 100 other other.tik");
  name_next_file("other.tik");
  take_way_out("Locate…");
  EXPECT_TRUE(window_.notice().text().contains("16 × 8 pixels large")) << window_.notice().text().toStdString();
  EXPECT_EQ(document().state(), state) << "another clip, on which the mask does not lie";
  run_line("nutik-cl encode -f 100 --to 10f frames/%02d.pgm short.tik");
  for (const auto button : {QMessageBox::No, QMessageBox::Yes}) {
    name_next_file("short.tik");
    answer_next<QMessageBox>([&](QMessageBox& question) {
      EXPECT_TRUE(question.text().contains("it lasts 100 ms, and the project's clip 200 ms"))
          << question.text().toStdString();
      QTest::mouseClick(question.button(button), Qt::LeftButton);
    });
    take_way_out("Locate…");
    ASSERT_TRUE(is_asked_) << "another length";
    EXPECT_EQ(document().duration_ns(), button == QMessageBox::No ? 200'000'000 : 100'000'000);
  }
  window_.open(path("mine.nutik"));
  ASSERT_TRUE(settles());
  name_next_file("clip.tik");
  take_way_out("Locate…");
  EXPECT_EQ(document().facts()->path, path("clip.tik")) << window_.notice().text().toStdString();
  EXPECT_EQ(document().state(), state);
  EXPECT_TRUE(window_.windowTitle().startsWith("mine.nutik"));
  EXPECT_TRUE(window_.isWindowModified()) << "the project names the old place";
  shortcut(Qt::Key_S);
  EXPECT_TRUE(load_project(path("mine.nutik")).capture == path("clip.tik"));
}

TEST_F(OpeningTest, RecentFilesAreListedTheLastFirstAndOpened) {
  EXPECT_EQ(recent_files(), QStringList("None yet"));
  ASSERT_NO_FATAL_FAILURE(open_project());
  EXPECT_EQ(recent_files(), QStringList({"mine.nutik", "%02d.pgm"}));
  std::filesystem::copy_file(scratch_ / "mine.nutik", scratch_ / "copy.nutik");
  window_.open(path("copy.nutik"));
  ASSERT_TRUE(settles());
  EXPECT_EQ(recent_files(), QStringList({"copy.nutik", "mine.nutik", "%02d.pgm"}));
  recent().actions()[1]->trigger();
  ASSERT_TRUE(settles());
  EXPECT_TRUE(window_.windowTitle().startsWith("mine.nutik")) << window_.windowTitle().toStdString();
  std::filesystem::remove(scratch_ / "copy.nutik");
  const QList<QAction*> actions = recent().actions();
  EXPECT_EQ(QFileInfo(actions[1]->text()).fileName(), "copy.nutik");
  EXPECT_FALSE(actions[1]->isEnabled()) << "it is gone";
  EXPECT_TRUE(actions[2]->isEnabled()) << "a pattern, whose folder is there";
}

TEST_F(OpeningTest, FilesAreChosenInDialogsByKeyboard) {
  run_line("nutik-cl encode -f 100 frames/%02d.pgm clip.tik");
  const auto choose = [&](Qt::Key key, const char* name) {
    key == Qt::Key_E ? name_next_export(name) : name_next_file(name);
    shortcut(key);
    ASSERT_TRUE(settles());
    EXPECT_TRUE(is_asked_) << name;
  };
  ASSERT_NO_FATAL_FAILURE(choose(Qt::Key_O, "clip.tik"));
  ASSERT_NE(document().facts(), nullptr) << window_.notice().text().toStdString();
  click_button("add_region");
  click_tool("tool_ellipse");
  drag(canvas(), at(10, 10), at(60, 40));
  ASSERT_NO_FATAL_FAILURE(choose(Qt::Key_S, "mine.nutik"));
  ASSERT_TRUE(window_.has_files()) << window_.notice().text().toStdString();
  ASSERT_NO_FATAL_FAILURE(choose(Qt::Key_E, "window"));  // an ending is added
  shortcut(Qt::Key_C, Qt::ControlModifier | Qt::ShiftModifier);
  const QString line = QGuiApplication::clipboard()->text();
  EXPECT_EQ(line, window_.command_for(path("mine.png")));
  run_line(line);
  const std::string by_window = test::read_file(scratch_ / "window.png");
  ASSERT_FALSE(by_window.empty()) << window_.notice().text().toStdString();
  EXPECT_TRUE(by_window == test::read_file(scratch_ / "mine.png")) << "byte for byte";
  std::filesystem::last_write_time(scratch_ / "clip.tik", std::filesystem::file_time_type());
  ASSERT_TRUE(window_.save_project(path("mine.nutik")));
  window_.export_picture(path("changed.png"));
  EXPECT_TRUE(window_.notice().text().contains("clip.tik is not what was read")) << "nor does saving change that";
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "changed.png"));
}

TEST_F(OpeningTest, ReadsAClipAsItIsTold) {
  ASSERT_NO_FATAL_FAILURE(open_project());
  const DocumentState drawn = document().state();
  const auto actions = window_.findChildren<QAction*>();
  const auto action =
      std::ranges::find_if(actions, [](QAction* each) { return each->text().remove('&').contains("How the clip"); });
  ASSERT_NE(action, actions.end());
  const auto answer = [&](int align, bool deflickers, bool makes_between) {
    answer_next<QDialog>([=](QDialog& question) {
      EXPECT_EQ(question.findChild<QLineEdit*>("fps")->text(), "100");
      question.findChild<QComboBox*>("align")->setCurrentIndex(align);
      question.findChild<QCheckBox*>("deflicker")->setChecked(deflickers);
      question.findChild<QComboBox*>("between")->setCurrentText(makes_between ? "auto" : "");
      QTest::keyClick(&question, Qt::Key_Return);
    });
    (*action)->trigger();
    ASSERT_TRUE(settles());
    ASSERT_TRUE(is_asked_);
  };
  ASSERT_NO_FATAL_FAILURE(answer(0, true, true));
  const Stated told = {{"between", "auto"}, {"deflicker", ""}, {"fps", "100"}};
  ASSERT_EQ(document().facts()->stated, told) << window_.notice().text().toStdString();
  EXPECT_GT(document().facts()->timeline.sample_count(), 20U) << "samples were made";
  EXPECT_TRUE(document().state() == drawn && window_.windowTitle().startsWith("mine.nutik"));
  EXPECT_TRUE(window_.isWindowModified()) << "the project says otherwise";
  ASSERT_TRUE(window_.save_project(path("read.nutik")));
  EXPECT_EQ(load_project(path("read.nutik")).stated, told);
  const std::string text = test::read_file(scratch_ / "read.nutik");
  scratch_.write("old.nutik", std::string(text).replace(text.find('{'), 1, "{\"as_far_as_it_goes\": true,"));
  EXPECT_TRUE(load_project(path("old.nutik")).stated.contains("ignore-errors")) << "as earlier versions call it";
  run_line(window_.command_for(path("read.png")));

  ASSERT_NO_FATAL_FAILURE(answer(3, false, false));
  // Cropped to what all see once the square holds still, they do not fit the mask: the clip stays as it was.
  EXPECT_TRUE(window_.notice().text().endsWith("the project's mask 96 × 48"))
      << window_.notice().text().toStdString();
  EXPECT_EQ(document().facts()->stated, told);
}

TEST_F(OpeningTest, AsksHowFastAClipWasFilmedThatDoesNotSay) {
  answer_next<QDialog>([](QDialog& question) {
    const QString why = question.findChild<QLabel*>()->text();
    EXPECT_TRUE(why.contains("How many pictures a second")) << why.toStdString();
    QTest::keyClicks(question.findChild<QLineEdit*>("fps"), "50,5");
    QTest::keyClick(&question, Qt::Key_Return);
  });
  window_.open(path("frames/%02d.pgm"));
  ASSERT_TRUE(settles());
  EXPECT_TRUE(is_asked_);
  ASSERT_NE(document().facts(), nullptr) << window_.notice().text().toStdString();
  EXPECT_EQ(document().duration_ns(), 396'039'604);
  EXPECT_TRUE(window_.command_for("picture.png").contains("--fps 50.5"));
}

}  // namespace
}  // namespace nutik::studio
