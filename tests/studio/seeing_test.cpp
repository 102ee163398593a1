// How a picture is looked at, what it begins with, and what becomes of it: light, snapshots, films, exports.
#include <QComboBox>
#include <QDir>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QListWidget>
#include <QPainter>
#include <QSettings>
#include <QToolButton>
#include <QTreeWidget>

#include <set>

#include "capture/format.hpp"
#include "media/event_files.hpp"
#include "studio/canvas/light_histogram.hpp"
#include "studio/regions/region_edits.hpp"
#include "studio/time/time_strip.hpp"
#include "studio/window/start_page.hpp"
#include "studio/window/started_work.hpp"
#include "studio_test.hpp"

namespace nutik::studio {
namespace {

class SeeingTest : public StudioTest {
 protected:
  [[nodiscard]] QImage shown() { return canvas().grab().toImage(); }
  [[nodiscard]] QColor shown_pixel(int x, int y) {
    return shown_at(shown(), canvas().view().to_widget({x + 0.5, y + 0.5}));
  }
  void brighten(double stops) {
    child<QDoubleSpinBox>("brightness").setValue(stops);
    ASSERT_TRUE(settles());
  }
  // In the question that comes next.
  void press_next(const char* button) {
    answer_next<QMessageBox>([button](QMessageBox& question) {
      EXPECT_TRUE(question.text().contains("Filming film.mkv")) << question.text().toStdString();
      for (QAbstractButton* each : question.buttons())
        if (each->text().remove('&').startsWith(button)) return each->click();
    });
  }
  // Compares a frame of the window's film with the command's, byte for byte, with its recipe.
  void expect_same_still(int frame) {
    const auto name = format("{:05}.png", frame);
    const std::string by_window = test::read_file(scratch_ / ("film-" + name));
    ASSERT_FALSE(by_window.empty()) << name;
    EXPECT_TRUE(by_window == test::read_file(scratch_ / ("by-" + name))) << name;
    run_line(QString::fromStdString("nutik-cl reproduce film-" + name));
  }
};

// ---- see ----

TEST_F(SeeingTest, LightIsCountedBeforeCodesEndIt) {
  open_clip();
  Session session({.path = path("frames/%02d.pgm").toStdString(), .clip = {.rate = Rational::parse("100", "rate")}});
  DocumentState state = document().state();
  state.brightness_ev = 2;  // the square, code 200, is then beyond white, and the ground is not
  const Job job{{}, {}};
  const MeasuredLight light = measured_light(session, state, job);
  OutputFormat codes = screen_format();
  const ExposedPicture picture = session.render(exposure_of(state, {}), codes);
  EXPECT_GT(picture.saturation.above, 0u);
  EXPECT_EQ(light.saturated.at(0), picture.saturation) << "as many as the renderer counts";
  ASSERT_EQ(light.channels.size(), 1u);
  std::array<std::uint32_t, 256> counted{};
  for (const std::uint8_t code : picture.picture.values<std::uint8_t>()) ++counted[code];
  for (std::size_t code = 0; code < 255; ++code) EXPECT_EQ(light.channels[0][code], counted[code]) << code;
  std::uint64_t marked = 0;
  for (int y = 0; y < light.marks.height(); ++y)
    for (int x = 0; x < light.marks.width(); ++x) marked += qAlpha(light.marks.pixel(x, y)) != 0;
  EXPECT_EQ(marked, picture.saturation.above);
}

TEST_F(SeeingTest, ClippedLightIsMarkedUntilTheKeyIsPressedAgain) {
  open_clip();
  ASSERT_NO_FATAL_FAILURE(brighten(8));
  EXPECT_EQ(shown_pixel(10, 10), QColor(Qt::white));
  QTest::keyClick(&window_, Qt::Key_C);
  ASSERT_TRUE(settles());
  EXPECT_EQ(shown_pixel(10, 10), QColor(255, 40, 30));
  EXPECT_TRUE(child<QWidget>("histogram").toolTip().contains("Background: 4608 px beyond white"))
      << child<QWidget>("histogram").toolTip().toStdString();
  ASSERT_NO_FATAL_FAILURE(brighten(0));
  EXPECT_NE(shown_pixel(10, 10), QColor(255, 40, 30)) << "nothing is clipped any more";
  ASSERT_NO_FATAL_FAILURE(brighten(8));
  QTest::keyClick(&window_, Qt::Key_C);
  EXPECT_EQ(shown_pixel(10, 10), QColor(Qt::white));
}

TEST_F(SeeingTest, LightOfALoneRegionIsItsOwn) {
  open_clip();
  scratch_.write("lone.fn", "M1 [0:1], [1000000000:1]\n");
  window_.use_functions(path("lone.fn"));
  for (const ExposureMode mode : {ExposureMode::functions, ExposureMode::boxcar}) {
    document().set_mode(mode);
    ASSERT_NO_FATAL_FAILURE(brighten(mode == ExposureMode::functions ? 8 : 7));
    EXPECT_TRUE(child<QWidget>("histogram").toolTip().contains("Region 1: 4608 px beyond white"))
        << child<QWidget>("histogram").toolTip().toStdString();
  }
}

TEST_F(SeeingTest, KeysThatAreHeldHideOutlinesMagnifyAndShowTheSnapshot) {
  open_clip();
  click_button("add_region");
  click_tool("tool_rectangle");
  drag(canvas(), at(10, 10), at(30, 30));
  ASSERT_TRUE(settles());
  canvas().setFocus();
  QTest::keyClick(&window_, Qt::Key_V);
  QTest::mouseMove(&canvas(), at(60.5, 40.5));
  const QImage before = shown();
  for (const Qt::Key key : {Qt::Key_H, Qt::Key_M}) {
    QTest::keyPress(&canvas(), key);
    EXPECT_NE(shown(), before) << key;
    QTest::keyRelease(&canvas(), key);
    EXPECT_EQ(shown(), before) << key;
  }
  const QColor opened = shown_pixel(70, 40);
  ASSERT_NO_FATAL_FAILURE(brighten(3));
  const QColor bright = shown_pixel(70, 40);
  EXPECT_GT(bright.green(), opened.green());
  QTest::keyPress(&canvas(), Qt::Key_A);
  EXPECT_EQ(shown_pixel(70, 40), opened) << "A is first what was opened";
  QEvent leave(QEvent::WindowDeactivate);
  QApplication::sendEvent(&window_, &leave);
  EXPECT_EQ(shown_pixel(70, 40), bright) << "a key let go elsewhere";
  QTest::keyClick(&window_, Qt::Key_K, Qt::ControlModifier);
  const DocumentState kept = document().state();
  ASSERT_NO_FATAL_FAILURE(brighten(-1));
  const DocumentState other = document().state();
  QTest::keyClick(&window_, Qt::Key_K, Qt::ControlModifier | Qt::ShiftModifier);
  EXPECT_EQ(document().state(), kept);
  QTest::keyClick(&window_, Qt::Key_K, Qt::ControlModifier | Qt::ShiftModifier);
  EXPECT_EQ(document().state(), other) << "to and fro";
  ASSERT_TRUE(settles());
}

TEST_F(SeeingTest, ZoomAndStopsAreTold) {
  open_clip();
  QTest::keyClick(&window_, Qt::Key_1, Qt::ControlModifier);
  EXPECT_EQ(child<QLabel>("zoom").text(), "Zoom 100 %");
  const auto& list = child<QTreeWidget>("regions");
  document().set_points(kBackground, {{0, 0.5}, {document().duration_ns(), 0.5}}, "Shape");
  EXPECT_EQ(list.topLevelItem(0)->text(1), "-1.0");
  EXPECT_EQ(list.topLevelItem(0)->text(2), "0.50×");
}

// ---- begin ----

TEST_F(SeeingTest, TheEmptyWindowHasRecentWorkAndCards) {
  EXPECT_TRUE(child<QWidget>("start_page").isVisible());
  EXPECT_FALSE(child<QWidget>("side").isVisible()) << "no fields that do nothing";
  for (const StartingPoint& point : starting_points()) {
    if (point.style != StudyStyle::frozen) continue;
    run_line("nutik-cl encode -f 100 frames/%02d.pgm clip.tik");
    name_next_file("clip.tik");
    window_.start_from(point);
  }
  ASSERT_TRUE(settles());
  EXPECT_TRUE(is_asked_);
  EXPECT_FALSE(child<QWidget>("start_page").isVisible());
  EXPECT_TRUE(child<QWidget>("side").isVisible());
  EXPECT_GT(document().functions().size(), 1u) << "the card was turned";
  MainWindow next;
  next.show();
  auto* recent = next.findChild<QListWidget*>("recent");
  ASSERT_GE(recent->count(), 1);
  EXPECT_EQ(recent->item(0)->text(), "clip.tik");
  ASSERT_EQ(recent_files().front().path, path("clip.tik"));
  EXPECT_FALSE(recent_files().front().picture.isNull()) << "a picture of it is kept";
  ASSERT_TRUE(window_.save_project(path("clip.nutik")));
  ASSERT_EQ(recent_files().front().path, path("clip.nutik"));
  EXPECT_FALSE(recent_files().front().picture.isNull()) << "and of the project from its first save on";
  recent->setCurrentRow(0);
  QTest::keyClick(recent, Qt::Key_Return);
  ASSERT_TRUE(QTest::qWaitFor([&] { return next.is_settled(); }, kMaxWaitMs));
  EXPECT_NE(next.document().facts(), nullptr);
}

TEST_F(SeeingTest, TheEmptySceneIsSeenUntilEscape) {
  open_clip();
  const DocumentState before = document().state();
  const QColor square = shown_pixel(22, 24);
  click_menu("Start", "Remove people");
  ASSERT_TRUE(settles());
  EXPECT_EQ(document().state(), before);
  const int ground = test::MovingSquare::kGround;
  EXPECT_NEAR(shown_pixel(22, 24).green(), ground, test::MovingSquare::kNoise) << "the square is gone";
  EXPECT_TRUE(window_.notice().isVisible()) << "and offers to save it";
  QEvent leave(QEvent::WindowDeactivate);  // for the dialog that saves it, for example
  QApplication::sendEvent(&window_, &leave);
  QTest::keyPress(&canvas(), Qt::Key_A);
  EXPECT_EQ(shown_pixel(22, 24), square) << "A over it";
  QTest::keyRelease(&canvas(), Qt::Key_A);
  EXPECT_NEAR(shown_pixel(22, 24).green(), ground, test::MovingSquare::kNoise) << "it is still seen";
  QTest::keyClick(&canvas(), Qt::Key_Escape);
  EXPECT_EQ(shown_pixel(22, 24), square);
}

TEST_F(SeeingTest, AStudyHasTheChoicesOfTheCommand) {
  open_clip();
  answer_next<QDialog>([](QDialog& dialog) {
    dialog.findChild<QComboBox*>("style")->setCurrentText("strobe");
    auto* moments = dialog.findChild<QLineEdit*>("moments");
    moments->setText("many");
    QTest::keyClick(moments, Qt::Key_Return);
    EXPECT_FALSE(dialog.findChild<QLabel*>("mistake")->text().isEmpty()) << "what is wrong is said there";
    moments->setText("2");
    QTest::keyClick(moments, Qt::Key_Return);
  });
  click_menu("Start", "Study with");
  ASSERT_TRUE(settles());
  EXPECT_TRUE(is_asked_);
  const auto& looks = document().state().looks;
  EXPECT_EQ(std::ranges::count_if(looks, [](const auto& look) { return look.second.name.startsWith("At "); }), 2)
      << window_.notice().text().toStdString();
}

TEST_F(SeeingTest, AStudyOfAHandHeldClipHoldsTheCameraStill) {
  test::Random random(7);
  const auto any = [&](int least, int most) { return static_cast<int>(random.whole(least, most)); };
  QImage ground(260, 200, QImage::Format_Grayscale8);
  ground.fill(90);
  for (int patch = 0; patch < 200; ++patch) {
    const int grey = any(30, 180);
    QPainter(&ground).fillRect(any(0, 250), any(0, 190), any(4, 24), any(4, 24), QColor(grey, grey, grey));
  }
  for (int k = 0; k < 16; ++k) {
    QImage picture = ground.copy(30 + k * 7 % 13, 20 + k * 5 % 11, 200, 150);
    QPainter ball(&picture);
    ball.setBrush(Qt::white);
    ball.drawEllipse(QPoint(20 + 11 * k, 75), 8, 8);
    ball.end();
    ASSERT_TRUE(picture.save(path(format("shaken-{:02}.png", k).c_str())));
  }
  window_.open(path("shaken-%02d.png"), "100");
  ASSERT_TRUE(settles());
  window_.start_study(usual_study(StudyStyle::frozen));
  ASSERT_TRUE(settles());
  auto& way_out = *window_.notice().findChild<QToolButton*>("way_out");
  ASSERT_EQ(way_out.text(), "Hold the camera still") << window_.notice().text().toStdString();
  EXPECT_FALSE(document().facts()->stated.contains("align"));
  document().set_mark_in(20'000'000);
  QTest::mouseClick(&way_out, Qt::LeftButton);
  ASSERT_TRUE(settles());
  EXPECT_EQ(document().mark_in(), 20'000'000);
  document().undo_stack().setClean();
  EXPECT_FALSE(document().is_saved()) << "the mark lies in no project";
  ASSERT_TRUE(document().facts()->stated.contains("align")) << window_.notice().text().toStdString();
  EXPECT_GT(document().functions().size(), 1u)
      << "the study goes on by itself: " << window_.notice().text().toStdString();
}

// ---- films ----

TEST_F(SeeingTest, SpacePlaysTheIntervalAndStopsIt) {
  open_clip();
  document().set_mark_in(40'000'000);
  document().set_mark_out(180'000'000);
  child<QDoubleSpinBox>("film_speed").setValue(0.1);
  child<QDoubleSpinBox>("film_angle").setValue(360);
  ASSERT_TRUE(settles());
  const DocumentState before = document().state();
  const QImage still = canvas().image();
  std::set<std::int64_t> starts;
  bool is_seen = false;
  QObject::connect(&document(), &Document::played_changed, &window_, [&] {
    if (!document().played()) return;
    starts.insert(document().played()->start_ns);
    EXPECT_GE(document().played()->start_ns, 40'000'000);
    EXPECT_LE(document().played()->start_ns + document().played()->length_ns, 180'000'000);
    is_seen = is_seen || difference(canvas().image(), still) != "";
  });
  QTest::keyClick(&canvas(), Qt::Key_Space);
  ASSERT_TRUE(QTest::qWaitFor([&] { return starts.size() >= 8 && is_seen; }, kMaxWaitMs));
  EXPECT_EQ(document().state(), before) << "playing changes nothing";
  for (const std::int64_t start_ns : starts) {
    // 24 frames a second at a tenth of the speed: 4 1/6 ms each.
    const double frame = static_cast<double>(start_ns - 40'000'000) * 24 / 1e8;
    EXPECT_NEAR(frame, std::round(frame), 1e-6);
  }
  QTest::keyClick(&child<TimeStrip>("time_strip"), Qt::Key_Space);
  EXPECT_FALSE(document().played());
  ASSERT_TRUE(settles());
  EXPECT_EQ(difference(canvas().image(), fresh_picture()), "");
  EXPECT_EQ(document().undo_stack().index(), 0);
}

TEST_F(SeeingTest, EscapeStopsTheFilmBesideAPixelAndATool) {
  open_clip();
  document().set_probe(QPoint(20, 20));
  click_tool("tool_brush");
  window_.play_or_stop();
  EXPECT_TRUE(document().played());
  QTest::keyClick(&canvas(), Qt::Key_Escape);
  EXPECT_FALSE(document().played());
}

TEST_F(SeeingTest, AFilmIsExportedAsTheCommandMakesIt) {
  open_clip();
  child<QDoubleSpinBox>("film_speed").setValue(0.5);
  for (const char* name : {"film.mkv", "film-%05d.png"}) {
    name_next_export(name, [](QDialog& dialog) { dialog.findChild<QLineEdit*>("out-fps")->setText("25"); });
    shortcut(Qt::Key_E, Qt::ControlModifier | Qt::ShiftModifier);
    ASSERT_TRUE(settles());
    EXPECT_TRUE(is_asked_);
    EXPECT_TRUE(window_.notice().text().contains("10 frame")) << window_.notice().text().toStdString();
  }
  std::filesystem::remove(scratch_ / "film-00003.png");
  name_next_export("film-%05d.png", [this](QDialog& dialog) {
    dialog.findChild<QLineEdit*>("out-fps")->setText("25");
    answer_next<QMessageBox>([](QMessageBox& question) {
      EXPECT_EQ(question.text(), "9 of 10 pictures are there. Replace them?");
      QTest::mouseClick(question.button(QMessageBox::Yes), Qt::LeftButton);
    });
  });
  shortcut(Qt::Key_E, Qt::ControlModifier | Qt::ShiftModifier);
  ASSERT_TRUE(settles());
  EXPECT_TRUE(is_asked_) << window_.notice().text().toStdString();
  window_.export_film(path("frames/%02d.pgm"), {});
  EXPECT_TRUE(window_.notice().text().contains("clip's stills")) << window_.notice().text().toStdString();
  run_line("nutik-cl video -f 100 --speed 0.5 --out-fps 25 --precision fixed frames/%02d.pgm by-%05d.png");
  for (int frame = 0; frame < 10; ++frame) expect_same_still(frame);
  window_.export_film(path("film-%05d.png"), {{"no-recipe", ""}});
  ASSERT_TRUE(settles());
  run_line("nutik-cl reproduce film-00001.png", 3);
}

TEST_F(SeeingTest, AFilmOfTheRegionsIsExportedAsTheCommandMakesIt) {
  open_clip();
  add_region(document());
  const std::uint8_t tag = document().selected_tag();
  paint_region(document(), ellipse(96, 48, {40, 24}, 20, 12), tag, "Ellipse");
  set_feather(document(), 250);
  document().set_points(0, {{0, 1}, {30'000'000, 0}}, "Points");
  document().set_points(tag, {{0, 0}, {10'000'000, 0}, {10'000'001, 1}, {60'000'000, 1}, {60'000'001, 0}}, "Points");
  window_.export_film(path("film-%05d.png"), {{"out-fps", "25"}});
  EXPECT_TRUE(window_.notice().text().contains("Save the project first")) << window_.notice().text().toStdString();
  name_next_export("film.gif", [](QDialog& dialog) { dialog.findChild<QLineEdit*>("out-fps")->setText("25"); });
  shortcut(Qt::Key_E, Qt::ControlModifier | Qt::ShiftModifier);
  ASSERT_TRUE(settles());
  EXPECT_TRUE(std::filesystem::exists(scratch_ / "film.gif")) << window_.notice().text().toStdString();
  EXPECT_FALSE(window_.has_files()) << "it names no file";
  ASSERT_TRUE(window_.save_project(path("regions.nutik")));
  ASSERT_TRUE(settles());
  const QImage shown = canvas().image();
  document().set_mark_out(180'000'000);
  name_next_export("film-%05d.png", [](QDialog& dialog) {
    EXPECT_EQ(dialog.findChild<QLineEdit*>("out-angle"), nullptr) << "functions say how long a frame is exposed";
    dialog.findChild<QLineEdit*>("out-fps")->setText("25");
  });
  shortcut(Qt::Key_E, Qt::ControlModifier | Qt::ShiftModifier);
  ASSERT_TRUE(settles());
  EXPECT_TRUE(is_asked_);
  EXPECT_TRUE(window_.notice().text().contains("3 frame")) << window_.notice().text().toStdString();
  EXPECT_EQ(difference(QImage(path("film-00000.png")), shown), "") << "it begins with the picture that is shown";
  run_line(
      "nutik-cl video -f 100 -k regions.fn -m regions.pgm --feather 2.5px --out-fps 25 --to 180ms --precision fixed "
      "frames/%02d.pgm by-%05d.png");
  for (int frame = 0; frame < 3; ++frame) expect_same_still(frame);
  document().set_points(0, {{0, 1}, {200'000'001, 0}}, "Points");
  ASSERT_TRUE(window_.save_project(path("regions.nutik")));
  window_.export_film(path("film.mkv"), {{"to", "150ms"}});
  EXPECT_TRUE(window_.notice().text().startsWith("No frame fits")) << window_.notice().text().toStdString();
}

// Where samples each have their own time there is nothing to make.
TEST_F(SeeingTest, AFilmOfEventsIsNotTriedWithSamplesBetweenThem) {
  test::Events events;
  for (unsigned k = 0; k < 40; ++k) events.push_back({10'000ull * k, k % 8, k / 8, k % 2 == 0});
  scratch_.write("events.raw", test::raw_header("EVT2", 8, 8) + test::evt2_words(events));
  window_.open(path("events.raw"));
  ASSERT_TRUE(settles());
  ASSERT_NE(document().facts(), nullptr) << window_.notice().text().toStdString();
  window_.export_film(path("events.mkv"), {{"out-fps", "25"}});
  ASSERT_TRUE(settles());
  EXPECT_TRUE(window_.notice().text().contains("10 frame")) << window_.notice().text().toStdString();
  EXPECT_FALSE(window_.notice().text().contains("two or three times")) << window_.notice().text().toStdString();
}

TEST_F(SeeingTest, AFilmWhoseFramesMixPicturesHasSamplesBetweenThem) {
  open_clip();
  window_.export_film(path("film-%05d.png"), {{"speed", "0.5"}, {"out-fps", "25"}, {"out-angle", "360"}});
  ASSERT_TRUE(settles());
  EXPECT_TRUE(window_.notice().text().contains("Samples were made between")) << window_.notice().text().toStdString();
  const auto made = run_line(
      "nutik-cl video -f 100 --speed 0.5 --out-fps 25 --out-angle 360 --precision fixed frames/%02d.pgm by-%05d.png");
  EXPECT_TRUE(QString::fromStdString(made.err).contains("samples are looked for between")) << made.err;
  for (const int frame : {0, 4}) expect_same_still(frame);
}

TEST_F(SeeingTest, AFilmIsWrittenAlthoughTheWindowIsClosed) {
  open_clip();
  QTimer::singleShot(0, &window_, [this] {
    window_.export_film(path("film.mkv"), {{"speed", "0.02"}});
    press_next("Cancel");
    EXPECT_FALSE(window_.close());
    press_next("Finish");
    EXPECT_TRUE(window_.close());
    EXPECT_TRUE(is_asked_);
  });
  QTimer too_late;
  too_late.callOnTimeout([] { QApplication::exit(1); });
  too_late.start(kMaxWaitMs);
  ASSERT_EQ(QApplication::exec(), 0) << "the program ends after the film";
  EXPECT_TRUE(window_.notice().text().contains("240 frame")) << window_.notice().text().toStdString();
  EXPECT_TRUE(std::filesystem::exists(scratch_ / "film.mkv"));
  EXPECT_TRUE(MainWindow().offer().text().contains("film.mkv: 240 frame")) << "the next window tells";
  EXPECT_FALSE(MainWindow().offer().text().contains("film.mkv")) << "once";
}

TEST_F(SeeingTest, AFilmThatIsStoppedLeavesNoFile) {
  open_clip();
  window_.export_film(path("film.mkv"), {{"speed", "0.001"}});
  press_next("Stop");
  EXPECT_TRUE(window_.close());
  EXPECT_TRUE(is_asked_);
  ASSERT_TRUE(settles());
  EXPECT_EQ(QDir(path("")).entryList({"*film*"}, QDir::AllEntries | QDir::Hidden), QStringList());
  EXPECT_FALSE(MainWindow().offer().text().contains("film.mkv")) << "a person knows";
}

TEST_F(SeeingTest, AFilmThatAProgramLeftIsTold) {
  const auto said = [] { return MainWindow().offer().text(); };
  auto gone = std::make_unique<WritingList>();
  WritingList alive;
  gone->keep({"Filming throw.mp4", "Writing throw.png"});
  gone->keep({"Filming throw.mp4"});
  alive.keep({"Filming dive.mp4"});
  EXPECT_FALSE(said().contains(".mp4")) << "both are at work";
  gone.reset();  // and its lock, as at a process's end
  EXPECT_EQ(said().count("Filming throw.mp4: the program ended before it was done."), 1);
  EXPECT_FALSE(said().contains(".mp4")) << "once";
  alive.keep({});
  EXPECT_TRUE(WritingList::left().isEmpty()) << "it was done";
}

// ---- pictures ----

TEST_F(SeeingTest, OneDialogExportsWithTheOptionsOfTheCommand) {
  open_clip();
  name_next_export("window.jpg", [](QDialog& dialog) {
    dialog.findChild<QComboBox*>("depth")->setCurrentText("16");
    QTest::keyClick(dialog.findChild<QLineEdit*>("path"), Qt::Key_Return);
    EXPECT_TRUE(dialog.findChild<QLabel*>("mistake")->text().contains(".jpg")) << "no such file holds 16 bits";
    dialog.findChild<QComboBox*>("depth")->setCurrentIndex(0);
    dialog.findChild<QLineEdit*>("quality")->setText("40");
    dialog.findChild<QComboBox*>("negative")->setCurrentText("offset");
  });
  shortcut(Qt::Key_E);
  ASSERT_TRUE(settles());
  const std::string by_window = test::read_file(scratch_ / "window.jpg");
  ASSERT_FALSE(by_window.empty()) << window_.notice().text().toStdString();
  run_line(window_.command_for(path("command.jpg")));
  EXPECT_TRUE(by_window == test::read_file(scratch_ / "command.jpg")) << "byte for byte, with its recipe";
}

TEST_F(SeeingTest, AWindowThatIsClosedComesBackWithWhatFailed) {
  open_clip();
  for (const bool is_answered : {false, true}) {
    std::filesystem::create_directory(scratch_ / "gone");
    window_.export_film(path("gone/film.mkv"), {{"speed", "0.02"}});
    std::filesystem::remove_all(scratch_ / "gone");
    if (is_answered) press_next("Finish");
    const bool closes = window_.close();
    EXPECT_TRUE(is_answered || !closes) << "it fails while that is asked";
    ASSERT_TRUE(settles());
    EXPECT_TRUE(window_.isVisible());
    EXPECT_TRUE(window_.notice().text().contains("Filming")) << window_.notice().text().toStdString();
    window_.notice().clear();
  }
}

TEST_F(SeeingTest, TheCommandWritesTheKindThatWasExported) {
  run_line("nutik-cl encode -f 100 frames/%02d.pgm clip.tik");
  window_.open(path("clip.tik"));
  ASSERT_TRUE(settles());
  window_.export_picture(path("window.jpg"), {{"quality", "40"}});
  ASSERT_TRUE(settles());
  click_menu("File", "Copy as command");
  run_line(QGuiApplication::clipboard()->text());
  EXPECT_TRUE(test::read_file(scratch_ / "window.jpg") == test::read_file(scratch_ / "clip.jpg"));
  open_clip();
  EXPECT_FALSE(window_.command_for(path("next.png")).contains("quality")) << "of another clip";
}

}  // namespace
}  // namespace nutik::studio
