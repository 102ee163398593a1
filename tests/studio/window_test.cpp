// The window: opening, saving, exporting.
#include <QDir>
#include <QFile>
#include <QMimeData>
#include <QToolButton>
#include <QTreeWidget>
#include <csignal>

#include "studio/regions/region_edits.hpp"
#include "studio/time/times.hpp"
#include "studio/window/project_file.hpp"
#include "studio/window/started_work.hpp"
#include "studio_test.hpp"

namespace nutik::studio {
namespace {

class WindowTest : public StudioTest {
 protected:
  static QDir kept_folder() { return {QStandardPaths::writableLocation(QStandardPaths::AppDataLocation)}; }
  static void remove_all_kept() {
    for (const Autosave::Found& each : Autosave::found()) KeptProject(each.path).remove();
  }
  // As a crash leaves it: the window goes, and nothing is asked.
  DocumentState leave_unsaved(int width) {
    MainWindow window;
    open_in(window);
    add_region(window.document());
    paint_region(window.document(), rectangle(96, 48, {10, 10}, width, 20), window.document().selected_tag(),
                 "Rectangle");
    window.autosave().keep();
    return window.document().state();
  }
  // Gives up the window's changes.
  void open_again_without_asking(MainWindow& window) {
    window.document().undo_stack().setClean();
    open_in(window);
  }
  static QMenu& unsaved_menu(MainWindow& window) {
    for (QAction* action : window.menuBar()->actions().front()->menu()->actions()) {
      if (!action->text().contains("unsaved")) continue;
      Q_EMIT action->menu()->aboutToShow();
      return *action->menu();
    }
    throw std::logic_error("no menu of unsaved work");
  }

  // The exported picture, and that of the line, are the same file.
  void expect_same_picture_by_command() {
    window_.export_picture(path("window.png"));
    ASSERT_TRUE(settles());
    run_line(window_.command_for(path("line.png")));
    const std::string by_window = test::read_file(scratch_ / "window.png");
    ASSERT_FALSE(by_window.empty()) << window_.notice().text().toStdString();
    EXPECT_TRUE(by_window == test::read_file(scratch_ / "line.png"));
    EXPECT_EQ(difference(canvas().image(), QImage(path("line.png"))), "");
  }
};

TEST_F(WindowTest, CopiesTheLineOfWhateverIsExposed) {
  open_clip();
  expect_same_picture_by_command();  // an interval needs no files
  QTest::keyClick(&window_, Qt::Key_C, Qt::ControlModifier | Qt::ShiftModifier);
  EXPECT_TRUE(QGuiApplication::clipboard()->text().endsWith(path("frames.png"))) << "beside the folder of its stills";
  add_region(document());
  paint_region(document(), ellipse(96, 48, {40, 24}, 20, 12), document().selected_tag(), "Ellipse");
  set_feather(document(), 250);
  DocumentState state = document().state();
  state.normalization = Normalization::parse("integral");
  state.brightness_ev = -0.75;
  document().apply(state, "Normalize");
  EXPECT_FALSE(window_.has_files()) << "what is not saved cannot be named";
  ASSERT_TRUE(window_.save_project(path("with 'quotes' and spaces.nutik")));
  ASSERT_TRUE(window_.has_files());
  ASSERT_TRUE(settles());
  expect_same_picture_by_command();
}

// The window exposes a clip's capture, whose blocks begin where its changes say; the line reads the clip, in blocks of
// one length. The mean of two codes in turns is a tie.
TEST_F(WindowTest, WritesTheSamePictureHoweverSamplesArePartedIntoBlocks) {
  constexpr int kSide = 32, kCount = 40;
  std::filesystem::create_directory(scratch_ / "ties");
  for (int k = 0; k < kCount; ++k) {
    std::string file = "P5 32 32 255\n";
    for (int pixel = 0; pixel < kSide * kSide; ++pixel)
      file += static_cast<char>(pixel % 10 + (k + pixel / kSide) % 2);
    scratch_.write("ties/" + std::to_string(k) + ".pgm", file);
  }
  open_in(window_, path("ties/%d.pgm"), "160");
  for (const int samples : {22, 34}) {
    document().set_boxcar({18'750'000, samples * 6'250'000}, "Scrub");
    ASSERT_TRUE(settles());
    expect_same_picture_by_command();
    for (const char* blocks : {" --block-samples 7", " --block-samples 11"}) {
      run_line(window_.command_for(path("line.png")) + " --overwrite" + blocks);
      EXPECT_EQ(difference(QImage(path("line.png")), canvas().image()), "") << samples << blocks;
    }
  }
}

TEST_F(WindowTest, OpensAProjectAsItWasSaved) {
  open_clip();
  add_region(document());
  const std::uint8_t tag = document().selected_tag();
  paint_region(document(), rectangle(96, 48, {10, 10}, 20, 20), tag, "Rectangle");
  set_feather(document(), 125);
  set_look(document(), tag, {"Ball", QColor("#c08040"), false}, "Rename region");
  document().set_boxcar({12'345'678, 9'876'543}, "Scrub");
  ASSERT_TRUE(settles());
  const QImage picture = canvas().image();
  const DocumentState saved = document().state();
  ASSERT_TRUE(window_.save_project(path("saved.nutik")));
  EXPECT_FALSE(window_.isWindowModified());

  MainWindow other;
  open_in(other, QDir::current().relativeFilePath(path("saved.nutik")));
  const DocumentState& loaded = other.document().state();
  EXPECT_EQ(loaded.functions, saved.functions);
  EXPECT_EQ(loaded.looks, saved.looks);
  EXPECT_TRUE(loaded == saved);
  EXPECT_EQ(difference(other.canvas().image(), picture), "");
  EXPECT_FALSE(other.isWindowModified());
  answer_next<QDialog>([this](QDialog& dialog) {
    EXPECT_EQ(dialog.findChild<QLineEdit*>("path")->text(), path("saved.png"));
    dialog.reject();
  });
  for (QAction* action : other.findChildren<QAction*>())
    if (action->text().remove('&') == "Export picture…") action->trigger();
  EXPECT_TRUE(is_asked_);
}

TEST_F(WindowTest, KeepsWhatIsNotSaved) {
  remove_all_kept();
  {
    MainWindow unchanged;
    open_in(unchanged);
    unchanged.autosave().keep();
  }
  EXPECT_TRUE(Autosave::found().empty()) << "nothing was changed";
  const DocumentState changed = leave_unsaved(10);
  ASSERT_EQ(Autosave::found().size(), 1u);
  EXPECT_EQ(Autosave::found().front().capture, "%02d.pgm");
  const QString kept = Autosave::found().front().path;
  EXPECT_EQ(kept_folder().entryList({"unsaved*"}).size(), 2) << "one file, and its lock";
  {
    MainWindow next;
    next.recover(kept);
    ASSERT_TRUE(QTest::qWaitFor([&] { return next.is_settled(); }, kMaxWaitMs));
    EXPECT_TRUE(next.document().state() == changed) << next.notice().text().toStdString();
    EXPECT_TRUE(next.isWindowModified()) << "it is to be saved where a person says";
    EXPECT_TRUE(Autosave::found().empty()) << "it has it";
    window_.recover(kept);
    EXPECT_TRUE(window_.notice().text().contains("nother window")) << window_.notice().text().toStdString();
    EXPECT_EQ(document().facts(), nullptr);
  }
  ASSERT_EQ(Autosave::found().size(), 1u) << "that one did not end well either";
  window_.recover(kept);
  ASSERT_TRUE(settles());
  EXPECT_TRUE(document().state() == changed);
  ASSERT_TRUE(window_.save_project(path("saved.nutik")));
  EXPECT_TRUE(Autosave::found().empty());
  EXPECT_FALSE(QFile::exists(kept));
}

// Whatever is done, short of taking it over or removing it.
TEST_F(WindowTest, OffersWhatIsNotSavedAtEveryStartUntilAPersonDecides) {
  remove_all_kept();
  EXPECT_FALSE(MainWindow().offer().text().contains("unsaved work"));
  leave_unsaved(10);
  leave_unsaved(20);
  const auto still_there = [] { return Autosave::found().size() == 2; };
  ASSERT_TRUE(still_there()) << "one for each window";
  open_clip();
  add_region(document());
  window_.autosave().keep();  // beside theirs
  ASSERT_TRUE(window_.save_project(path("saved.nutik")));
  EXPECT_TRUE(still_there()) << "another window's saving";
  for (const QMessageBox::StandardButton button : {QMessageBox::Discard, QMessageBox::Cancel}) {
    MainWindow next;
    EXPECT_TRUE(next.offer().text().contains("unsaved work"));
    open_in(next);
    EXPECT_TRUE(next.offer().text().contains("unsaved work")) << "opening a clip does not hide it";
    add_region(next.document());
    next.autosave().keep();
    answer_next(button);
    EXPECT_EQ(next.close(), button == QMessageBox::Discard);
    EXPECT_TRUE(is_asked_);
    EXPECT_TRUE(still_there()) << "another window's closing";
    open_again_without_asking(next);
    EXPECT_TRUE(still_there()) << "another clip";
  }
  MainWindow next;
  answer_next(QMessageBox::No);
  unsaved_menu(next).actions().back()->trigger();
  EXPECT_TRUE(still_there());
  EXPECT_EQ(unsaved_menu(next).actions().size(), 4) << "two, a line, and their removal";
  answer_next(QMessageBox::Yes);
  unsaved_menu(next).actions().back()->trigger();
  EXPECT_TRUE(Autosave::found().empty());
  EXPECT_TRUE(kept_folder().entryList({"unsaved*"}).isEmpty());
}

TEST_F(WindowTest, KeepsWhatIsNotSavedWhereItIsAskedToEnd) {
  remove_all_kept();
  DocumentState changed;
  {
    MainWindow ended;
    open_in(ended);
    add_region(ended.document());
    changed = ended.document().state();
    ended.autosave().keep_at_signals();
    raise(SIGTERM);
    EXPECT_EQ(QApplication::exec(), 128 + SIGTERM);
  }
  ASSERT_EQ(Autosave::found().size(), 1u);
  window_.recover(Autosave::found().front().path);
  ASSERT_TRUE(settles());
  EXPECT_TRUE(document().state() == changed);
}

TEST_F(WindowTest, SaysWhyAFileIsRefused) {
  window_.open(path("absent.mp4"));
  ASSERT_TRUE(settles());
  EXPECT_TRUE(window_.notice().text().contains("absent.mp4")) << window_.notice().text().toStdString();
  EXPECT_EQ(document().facts(), nullptr);

  const auto refuses = [&](const char* name, const char* text, const char* words) {
    scratch_.write(name, text);
    window_.open(path(name));
    EXPECT_TRUE(window_.notice().text().contains(words)) << window_.notice().text().toStdString();
  };
  refuses("broken.nutik", "{", "it is no project");
  refuses("list.nutik", "[]", "it is no project: it holds no JSON object");
  refuses("none.nutik", "{}", "it is no project: it has no 'nutik-studio'");
  refuses("text.nutik", R"({"nutik-studio": "1"})", "'nutik-studio' is no number");
  refuses("newer.nutik", R"({"nutik-studio": 2})", "this program reads 1");
  refuses("empty.nutik", R"({"nutik-studio": 1})", "'capture' names no file");
  scratch_.write("bad.fn", "M0 [5:1], [3:1]\n");
  refuses("bad.nutik", R"({"nutik-studio": 1, "capture": "clip.tik", "functions": "bad.fn"})", "bad.fn:1:");
}

TEST(StatusLine, CancelsNothingButTheJobThatItShows) {
  Jobs jobs;
  const StatusLine line({&jobs});
  jobs.start("First", [](const Job& job) -> Jobs::Finish {
    for (;; std::this_thread::sleep_for(std::chrono::milliseconds(1))) job.progress(0, 2);
  });
  bool is_done = false;
  jobs.start("Second", [&](const Job&) { return [&] { is_done = true; }; });
  auto& cancel = *line.findChild<QToolButton*>("cancel");
  ASSERT_TRUE(QTest::qWaitFor([&] { return !cancel.isHidden(); }));
  cancel.click();
  EXPECT_TRUE(QTest::qWaitFor([&] { return is_done; }));
}

TEST_F(WindowTest, MayGoAtAnyTime) {
  {
    MainWindow other;
    other.open(path("frames/%02d.pgm"), "100");
  }
  open_clip();  // what follows it, thumbnails and activity, is still to come in the next one
  MainWindow other;
  other.show();
  other.open(path("frames/%02d.pgm"), "100");
  ASSERT_TRUE(QTest::qWaitFor([&] { return other.document().facts() != nullptr; }, kMaxWaitMs));
}

TEST_F(WindowTest, WritesAPictureAlthoughAnotherCaptureIsOpened) {
  open_clip();
  window_.export_picture(path("picture.png"));
  open_clip();
  EXPECT_TRUE(std::filesystem::exists(scratch_ / "picture.png"));
  EXPECT_TRUE(window_.notice().text().endsWith("no pixel is clipped")) << window_.notice().text().toStdString();
}

TEST_F(WindowTest, SavesBeforeItExportsWhatLiesInNoFile) {
  open_clip();
  add_region(document());
  paint_region(document(), rectangle(96, 48, {10, 10}, 20, 20), document().selected_tag(), "Rectangle");
  window_.export_picture(path("unsaved.png"));
  ASSERT_TRUE(settles());
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "unsaved.png"));
  EXPECT_TRUE(window_.notice().text().contains("Save the project first"));
}

TEST_F(WindowTest, LoadsFunctionsAndMasksOfTheCommandLine) {
  open_clip();
  Mask mask = Mask::uniform(test::MovingSquare::kWidth, test::MovingSquare::kHeight, 0);
  paint(mask, rectangle(mask.width, mask.height, {10, 10}, 20, 20), 200);
  save_mask(path("regions.pgm"), mask);
  window_.use_mask(path("regions.pgm"));
  EXPECT_EQ(pixels_of(200), 400u);
  EXPECT_TRUE(document().functions().contains(200)) << "exposed over the interval";
  scratch_.write("regions.fn", "M200 [0:0], [50000000:1], [100000000:-0.5]\n");
  const std::vector<ControlPoint> background = document().points(0);
  window_.use_functions(path("regions.fn"));
  EXPECT_EQ(document().points(200),
            (std::vector<ControlPoint>{{0, 0}, {50'000'000, 1}, {100'000'000, -0.5}}));
  EXPECT_EQ(document().points(0), background) << "what the file leaves out stays";
  ASSERT_TRUE(window_.save_project(path("regions.nutik")));
  ASSERT_TRUE(settles());
  expect_same_picture_by_command();

  const DocumentState before = document().state();
  scratch_.write("small.pgm", "P5 2 2 255\n    ");
  window_.use_mask(path("small.pgm"));
  EXPECT_TRUE(window_.notice().text().contains("2 x 2 pixels large, the capture 96 x 48"));
  EXPECT_TRUE(document().state() == before);
}

TEST_F(WindowTest, AsksBeforeUnsavedChangesAreLost) {
  open_clip();
  EXPECT_TRUE(window_.close()) << "nothing was changed, nothing is asked";
  window_.show();
  add_region(document());
  EXPECT_TRUE(window_.isWindowModified());
  answer_next(QMessageBox::Cancel);
  EXPECT_FALSE(window_.close());
  ASSERT_TRUE(window_.save_project(path("saved.nutik")));
  document().set_boxcar({0, 1'000}, "Scrub");
  answer_next(QMessageBox::Save);
  EXPECT_TRUE(window_.close());
  EXPECT_EQ(load_project(path("saved.nutik")).state.boxcar, (Boxcar{0, 1'000}));
  window_.show();
  remove_all_kept();
  document().set_mark_in(5'000'000);
  EXPECT_TRUE(window_.isWindowModified());
  window_.autosave().keep();
  EXPECT_EQ(kept_folder().entryList({"unsaved*"}).size(), 2);
  document().set_mark_in({});
  EXPECT_FALSE(window_.isWindowModified()) << "it is as it was saved";
  document().set_mark_in(5'000'000);
  answer_next(QMessageBox::Save);
  EXPECT_TRUE(window_.close());
  EXPECT_EQ(load_project(path("saved.nutik")).marks.in_ns, 5'000'000);
}

TEST_F(WindowTest, AsksBeforeItReplacesWhatChangedOutside) {
  open_clip();
  ASSERT_TRUE(window_.save_project(path("saved.nutik")));
  std::filesystem::remove(scratch_ / "saved.fn");
  scratch_.write("saved.fn", "M0 [0:1]\n");
  std::filesystem::last_write_time(scratch_ / "saved.fn",
                                   std::filesystem::file_time_type::clock::now() + std::chrono::hours(1));
  answer_next(QMessageBox::No);
  QTest::keyClick(&window_, Qt::Key_S, Qt::ControlModifier);
  EXPECT_TRUE(is_asked_);
  EXPECT_EQ(test::read_file(scratch_ / "saved.fn"), "M0 [0:1]\n");
  answer_next(QMessageBox::Yes);
  shortcut(Qt::Key_S);
  EXPECT_TRUE(is_asked_);
  EXPECT_NE(test::read_file(scratch_ / "saved.fn"), "M0 [0:1]\n") << window_.notice().text().toStdString();
}

TEST_F(WindowTest, AsksBeforeItReplacesWhatAProjectMerelyNames) {
  open_clip();
  add_region(document());
  paint_region(document(), rectangle(96, 48, {10, 10}, 20, 20), document().selected_tag(), "Rectangle");
  save_mask(path("theirs.pgm"), (*document().state().mask)->mask);
  save_functions(path("theirs.fn"), document().functions());
  const std::string mask = test::read_file(scratch_ / "theirs.pgm");
  const std::string functions = test::read_file(scratch_ / "theirs.fn");
  ASSERT_TRUE(window_.save_project(path("mine.nutik")));
  std::string project = test::read_file(scratch_ / "mine.nutik");
  for (const char* name : {"mine.fn", "mine.pgm"}) project.replace(project.find(name), 4, "theirs");
  scratch_.write("mine.nutik", project);
  window_.open(path("mine.nutik"));
  ASSERT_TRUE(settles());
  document().set_points(0, {{0, 0.25}}, "Move point");
  const auto save_answering = [&](QMessageBox::StandardButton button) {
    QString said;
    answer_next<QMessageBox>([&](QMessageBox& question) {
      said = question.text();
      QTest::mouseClick(question.button(button), Qt::LeftButton);
    });
    shortcut(Qt::Key_S);
    ASSERT_TRUE(is_asked_);
    EXPECT_TRUE(said.contains("theirs.pgm was not written for this project")) << said.toStdString();
    EXPECT_TRUE(said.contains("theirs.fn was not written for this project")) << said.toStdString();
  };
  ASSERT_NO_FATAL_FAILURE(save_answering(QMessageBox::No));
  EXPECT_EQ(test::read_file(scratch_ / "theirs.pgm"), mask);
  EXPECT_EQ(test::read_file(scratch_ / "theirs.fn"), functions);
  EXPECT_TRUE(window_.isWindowModified());
  ASSERT_NO_FATAL_FAILURE(save_answering(QMessageBox::Yes));
  EXPECT_NE(test::read_file(scratch_ / "theirs.fn"), functions);
  document().set_points(0, {{0, 0.75}}, "Move point");
  shortcut(Qt::Key_S);
  EXPECT_FALSE(window_.isWindowModified()) << "nothing is asked: they are its own now";
  EXPECT_EQ(load_functions(path("theirs.fn")), document().functions());
}

TEST_F(WindowTest, ShowsAProjectWhoseSaveWasEndedAsItWasToBe) {
  open_clip();
  add_region(document());
  ASSERT_TRUE(window_.save_project(path("saved.nutik")));
  document().set_points(0, {{0, 0.25}}, "Move point");
  const std::string functions = test::read_file(scratch_ / "saved.fn");
  // As long as the functions cannot be written.
  std::filesystem::rename(scratch_ / "saved.fn", scratch_ / "away");
  std::filesystem::create_directory(scratch_ / "saved.fn");
  EXPECT_FALSE(window_.save_project(path("saved.nutik")));
  EXPECT_TRUE(window_.notice().text().contains("saved.fn")) << window_.notice().text().toStdString();
  EXPECT_TRUE(window_.isWindowModified());
  std::filesystem::remove(scratch_ / "saved.fn");
  std::filesystem::rename(scratch_ / "away", scratch_ / "saved.fn");

  MainWindow other;
  other.show();
  open_in(other, path("saved.nutik"));
  EXPECT_TRUE(other.document().state() == document().state());
  EXPECT_TRUE(other.notice().text().contains("did not come to its end"))
      << other.notice().text().toStdString();
  EXPECT_FALSE(other.has_files());
  EXPECT_EQ(test::read_file(scratch_ / "saved.fn"), functions) << "opening writes nothing";
  other.activateWindow();
  ASSERT_TRUE(QTest::qWaitForWindowActive(&other));
  QTest::keyClick(&other, Qt::Key_S, Qt::ControlModifier);
  EXPECT_TRUE(other.has_files()) << other.notice().text().toStdString();
  EXPECT_EQ(load_functions(path("saved.fn")), document().functions());
}

TEST_F(WindowTest, SaysOnceWhatHappenedToItsFilesOutside) {
  open_clip();
  add_region(document());
  document().set_mode(ExposureMode::functions);
  ASSERT_TRUE(window_.save_project(path("saved.nutik")));
  const auto come_back = [&] {
    window_.notice().clear();
    QEvent back(QEvent::WindowActivate);
    QApplication::sendEvent(&window_, &back);
    return window_.notice().text();
  };
  EXPECT_EQ(come_back(), "") << "nothing happened";
  std::filesystem::remove(scratch_ / "saved.pgm");
  scratch_.write("saved.fn", "M0 [0:0.5]\n");
  std::filesystem::last_write_time(scratch_ / "saved.fn",
                                   std::filesystem::file_time_type::clock::now() + std::chrono::hours(1));
  const QString said = come_back();
  EXPECT_TRUE(said.contains("saved.pgm is gone")) << said.toStdString();
  EXPECT_TRUE(said.contains("saved.fn was changed by another program")) << said.toStdString();
  EXPECT_EQ(come_back(), "") << "once";
  EXPECT_FALSE(window_.has_files()) << "a recipe would name what is not shown";
  save_mask(path("saved.pgm"), (*document().state().mask)->mask);
  QTest::keyClick(&window_, Qt::Key_F5);
  ASSERT_TRUE(settles());
  EXPECT_EQ(document().points(0), (std::vector<ControlPoint>{{0, 0.5}})) << "F5 takes the change";
}

TEST_F(WindowTest, WritesNothingOverOrAmongTheStillsOfItsClip) {
  open_clip();
  add_region(document());
  window_.write_mask(path("frames/03.pgm"));
  EXPECT_TRUE(window_.notice().text().contains("is also an input")) << window_.notice().text().toStdString();
  SourceRequest source;
  source.path = document().facts()->path.toStdString();
  source.clip.rate = Rational{100, 1};
  EXPECT_THROW(writing_plate({}, std::make_shared<Session>(source), path("frames/03.pgm"), {}), UsageError);
  window_.document().undo_stack().setClean();

  window_.open(path("frames/"), "100");
  ASSERT_TRUE(settles());
  window_.activateWindow();
  ASSERT_TRUE(QTest::qWaitForWindowActive(&window_));
  QTest::keyClick(&window_, Qt::Key_C, Qt::ControlModifier | Qt::ShiftModifier);
  EXPECT_TRUE(QGuiApplication::clipboard()->text().endsWith(path("frames ") + path("frames.png")))
      << QGuiApplication::clipboard()->text().toStdString();
  window_.export_picture(path("frames/out.tif"));
  EXPECT_TRUE(window_.notice().text().contains("taken for one of the clip's stills"));
  add_region(document());
  EXPECT_FALSE(window_.save_project(path("frames/saved.nutik"))) << "its mask is a picture, too";
  ASSERT_TRUE(settles());
  window_.write_functions(path("frames/written.fn"));
  window_.export_picture(path("picture.png"));
  ASSERT_TRUE(settles());
  EXPECT_TRUE(window_.notice().text().contains("no pixel")) << window_.notice().text().toStdString();
}

TEST_F(WindowTest, ChoosesToolsByKeyboard) {
  open_clip();
  const std::pair<Qt::Key, const char*> keys[] = {{Qt::Key_B, "tool_brush"},   {Qt::Key_R, "tool_rectangle"},
                                                  {Qt::Key_E, "tool_ellipse"}, {Qt::Key_P, "tool_polygon"},
                                                  {Qt::Key_W, "tool_wand"},    {Qt::Key_V, "tool_look"}};
  for (const auto& [key, tool] : keys) {
    QTest::keyClick(&window_, key);
    EXPECT_TRUE(child<QAction>(tool).isChecked()) << tool;
  }
}

TEST_F(WindowTest, OpensWhatIsDropped) {
  run_line("nutik-cl encode -f 100 frames/%02d.pgm clip.tik");
  QMimeData files;
  files.setUrls({QUrl::fromLocalFile(path("clip.tik")), QUrl::fromLocalFile(path("other.tik"))});
  QDragEnterEvent enter({10, 10}, Qt::CopyAction, &files, Qt::LeftButton, {});
  QApplication::sendEvent(&window_, &enter);
  EXPECT_TRUE(enter.isAccepted());
  QDropEvent drop({10, 10}, Qt::CopyAction, &files, Qt::LeftButton, {});
  QApplication::sendEvent(&window_, &drop);
  ASSERT_TRUE(settles());
  ASSERT_NE(document().facts(), nullptr) << window_.notice().text().toStdString();
  EXPECT_EQ(document().facts()->path, path("clip.tik"));
  EXPECT_TRUE(window_.notice().text().endsWith("clip.tik is opened, not " + path("other.tik") + "."));
  EXPECT_EQ(document().overview().changed_share.size(), static_cast<std::size_t>(test::MovingSquare::kCount));
  EXPECT_FALSE(document().overview().thumbnails.empty());
}

TEST_F(WindowTest, StudiesAreStartingPoints) {
  open_clip();
  const DocumentState before = document().state();
  window_.start_study(usual_study(StudyStyle::frozen));
  ASSERT_TRUE(settles());
  ASSERT_NE(document().state(), before) << window_.notice().text().toStdString();
  EXPECT_GT(document().functions().size(), 1u);
  ASSERT_TRUE(window_.save_project(path("frozen.nutik")));
  expect_same_picture_by_command();
  document().undo_stack().undo();
  EXPECT_EQ(document().state(), before) << "one step";
}

// The square moves by 2 pixels every 10 ms, and rests from 120 ms on.
TEST_F(WindowTest, WorkGoesOnBetweenTheMarks) {
  open_clip();
  constexpr std::int64_t kIn = 15'000'000, kOut = 115'000'000;
  document().set_mark_out(kIn);
  document().set_mark_in(kIn + 1);
  EXPECT_EQ(window_.notice().text().toStdString(), "Out lay before In and was taken away.");
  document().set_mark_out(kOut);
  document().set_mark_out(kIn);
  EXPECT_EQ(window_.notice().text().toStdString(), "In lay behind Out and was taken away.");
  document().set_mark_in(kIn);
  document().set_mark_out(kOut);
  for (const StudyStyle style : {StudyStyle::trail, StudyStyle::frozen, StudyStyle::slit}) {
    window_.start_study(usual_study(style));
    ASSERT_TRUE(settles());
    ASSERT_GT(document().functions().size(), 1u) << window_.notice().text().toStdString();
    EXPECT_EQ(document().boxcar(), (Boxcar{20'000'000, 100'000'000})) << "Start and Width show what is exposed";
    for (const auto& [tag, function] : document().functions()) {
      const Interval live = summarize(function, document().duration_ns()).live;
      EXPECT_GE(live.begin_ns, 20'000'000 - 1) << "the first picture from the mark on";
      EXPECT_LE(live.end_ns, 120'000'000 + 1);
      const QString& name = document().state().looks.at(tag).name;
      if (!name.startsWith("At ")) continue;
      const auto at = read_typed_time(name.mid(3), document().facts()->timeline);
      ASSERT_TRUE(at.value) << name.toStdString();
      EXPECT_TRUE(*at.value >= kIn && *at.value < kOut) << name.toStdString();
      if (style != StudyStyle::slit) {
        EXPECT_LE(live.begin_ns, *at.value);
        EXPECT_GE(live.end_ns, *at.value + 10'000'000);
      }
    }
  }
  add_region(document());
  QTest::keyClick(&window_, Qt::Key_M, Qt::ControlModifier);
  ASSERT_TRUE(settles());
  EXPECT_TRUE(window_.notice().text().contains("between the marks")) << window_.notice().text().toStdString();
  const auto& region = document().selected_tag();
  const auto& tags = (*document().state().mask)->mask.tags;
  EXPECT_EQ(tags[24 * 96 + 20], region);
  EXPECT_NE(tags[24 * 96 + 4], region) << "where the square is before";

  ASSERT_TRUE(window_.save_project(path("marked.nutik")));
  document().set_mark_in({});
  document().set_mark_out({});
  window_.open(path("marked.nutik"));
  ASSERT_TRUE(settles());
  EXPECT_EQ(document().mark_in(), kIn);
  EXPECT_EQ(document().mark_out(), kOut);
  open_clip();
  EXPECT_EQ(document().marks(), Marks());
}

TEST_F(WindowTest, ShowsNamesAsTheyAre) {
  open_clip();
  click_button("add_region");
  auto& item = *child<QTreeWidget>("regions").currentItem();
  const std::uint8_t tag = document().selected_tag();
  item.setText(0, "<b>50%2");
  EXPECT_EQ(document().state().looks.at(tag).name, "<b>50%2");
  EXPECT_TRUE(item.toolTip(0).startsWith(QString("<qt>&lt;b&gt;50%2, M%1 in").arg(tag)));
  EXPECT_TRUE(child<QWidget>("curves").accessibleDescription().startsWith(QString("<b>50%2 (M%1), ").arg(tag)));
}

}  // namespace
}  // namespace nutik::studio
