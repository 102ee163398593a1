// Takes the pictures of docs/how-to/studio.md: nutik_studio_screenshots CLIP FOLDER. On the screen that QT_QPA_PLATFORM
// names; without one where it names none.
//
//   FOLDER/*.png        the window at 1280 × 800, 2560 × 1600 and 1024 × 640, dark and light
//   FOLDER/drag/NN.png  a control point on its way there and back, with the hand that drags it
#include <QAction>
#include <QApplication>
#include <QDialog>
#include <QDir>
#include <QLineEdit>
#include <QLocale>
#include <QMenu>
#include <QMenuBar>
#include <QPainter>
#include <QTest>
#include <QTimer>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "studio/curves/curve_editor.hpp"
#include "studio/window/appearance.hpp"
#include "studio/window/main_window.hpp"
#include "studio/window/started_work.hpp"

using namespace nutik::studio;

namespace {

constexpr int kMaxWaitMs = 300'000;  // a clip may have to be encoded first

class Photographer {
 public:
  explicit Photographer(const QString& folder) : folder_(folder) {
    window_.resize(1280, 800);
    window_.show();
  }

  // All but failures to write pictures is said in the window, which is on them.
  bool take_all(const QString& clip) {
    Document& document = window_.document();
    if (!take("empty")) return false;
    window_.open(clip);
    if (!take("interval") || document.facts() == nullptr) return false;
    window_.start_study(usual_study(nutik::StudyStyle::trail));
    if (!settles()) return false;
    const QSize picture = window_.canvas().image().size();
    document.set_probe(QPoint(picture.width() / 2, picture.height() / 2));
    document.select_tag(document.functions().rbegin()->first);
    if (!take("studio")) return false;
    window_.resize(1920, 1080);
    if (!take("full-hd")) return false;
    window_.resize(1280, 800);
    return take_looks() && take_dialogs("dark") && take_drag();
  }

 private:
  bool settles() {
    return QTest::qWaitFor([&] { return window_.is_settled(); }, kMaxWaitMs) &&
           (QApplication::processEvents(), true);
  }
  bool save(const QImage& image, const QString& name) { return image.save(folder_.filePath(name + ".png")); }
  bool take(const QString& name) { return settles() && save(window_.grab().toImage(), name); }

  bool take_looks() {
    const QSize size = window_.size();
    set_appearance(Appearance::light);
    bool is_taken = take("light") && take_dialogs("light");
    window_.resize(2560, 1600);
    window_.findChild<QAction*>("tool_brush")->trigger();
    is_taken = is_taken && take("light-large");
    set_appearance(Appearance::dark);
    is_taken = is_taken && take("large");
    window_.resize(1024, 640);
    is_taken = is_taken && take("small");
    window_.findChild<QAction*>("tool_look")->trigger();
    window_.resize(size);
    return is_taken;
  }

  // Menus and dialogs are windows of their own.
  bool take_dialogs(const QString& look) {
    bool is_taken = true;
    for (QAction* action : window_.menuBar()->actions()) {
      const QString name = action->text().remove('&').section(' ', 0, 0).toLower();
      is_taken = is_taken && save(action->menu()->grab().toImage(), QString("menu-%1-%2").arg(name, look));
    }
    // They ask in loops of their own; an interval is exported without a project.
    window_.document().set_mode(ExposureMode::boxcar);
    for (const char* asking : {"&Export picture…", "Export f&ilm…", "Study with &choices…"}) {
      const QString name = QString(asking).remove('&').section(' ', 0, 1).toLower().replace(' ', '-').remove("…");
      for (QAction* action : window_.findChildren<QAction*>()) {
        if (action->text() != MainWindow::tr(asking)) continue;
        QTimer::singleShot(200, &window_, [&] {
          QWidget* asked = QApplication::activeModalWidget();
          is_taken = is_taken && asked != nullptr &&
                     save(asked->grab().toImage(), name + "-" + look);
          if (asked != nullptr) asked->close();
        });
        action->trigger();
      }
    }
    window_.document().set_mode(ExposureMode::functions);
    // By its action and not by keys, which a screen without a window manager gives to no window.
    for (QAction* action : window_.findChildren<QAction*>()) {
      if (action->shortcut() == QKeySequence(Qt::CTRL | Qt::Key_D)) action->trigger();
    }
    auto* dialog = window_.findChild<QDialog*>();
    if (dialog == nullptr) return false;
    QApplication::processEvents();
    // By its name: what has the focus depends on when the screen shows the dialog.
    auto* field = dialog->findChild<QLineEdit*>("difference_from");
    field->selectAll();
    QTest::keyClicks(field, "soon");
    QTest::keyClick(field, Qt::Key_Return);
    QApplication::processEvents();
    is_taken = is_taken && save(dialog->grab().toImage(), "difference-" + look);
    dialog->reject();
    QApplication::processEvents();
    return is_taken;
  }

  // The background's exposure grows from a hundredth of the clip to a third of it, and shrinks again.
  bool take_drag() {
    constexpr int kFrames = 40;
    if (!folder_.mkpath("drag")) return false;
    window_.resize(1000, 720);
    Document& document = window_.document();
    const std::uint8_t tag = document.functions().begin()->first;
    const std::int64_t duration_ns = document.duration_ns(), start_ns = duration_ns / 3,
                       end_ns = start_ns + duration_ns / 100;
    document.select_tag(tag);
    document.set_probe({});
    document.set_points(tag, {{start_ns - 1, 0}, {start_ns, 1}, {end_ns, 1}, {end_ns + 1, 0}}, "Shorten");
    if (!settles()) return false;
    auto& curves = *window_.findChild<CurveEditor*>("curves");
    const PlotFrame frame_of = curves.frame();
    const QPoint from = frame_of.place(document.points(tag)[2]).toPoint();
    const double way = frame_of.x_of(start_ns + duration_ns / 3) - from.x();
    QTest::mousePress(&curves, Qt::LeftButton, {}, from);
    bool is_taken = true;
    for (int frame = 0; frame < kFrames && is_taken; ++frame) {
      const double share = (1 - std::cos(2 * std::numbers::pi * frame / kFrames)) / 2;
      const QPoint hand = from + QPoint(static_cast<int>(std::lround(way * share)), 0);
      QTest::mouseMove(&curves, hand);
      is_taken = settles();
      QImage image = window_.grab().toImage();
      paint_hand(image, curves.mapTo(&window_, hand));
      is_taken = is_taken && save(image, QString("drag/%1").arg(frame, 2, 10, QChar('0')));
    }
    QTest::mouseRelease(&curves, Qt::LeftButton, {}, from);
    return is_taken;
  }

  // Pictures of a window have no pointer.
  static void paint_hand(QImage& image, QPointF at) {
    QPainter painter(&image);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.translate(at);
    painter.setPen(QPen(Qt::black, 1));
    painter.setBrush(Qt::white);
    painter.drawPolygon(
        QPolygonF({{0, 0}, {0, 17}, {4, 13.5}, {6.5, 19.5}, {9, 18.5}, {6.5, 12.5}, {12, 12.5}}));
  }

  QDir folder_;
  MainWindow window_;
};

}  // namespace

int main(int count, char** words) {
  if (!qEnvironmentVariableIsSet("QT_QPA_PLATFORM")) qputenv("QT_QPA_PLATFORM", "offscreen");
  QApplication application(count, words);
  QApplication::setOrganizationName("nutik-tests");
  QApplication::setApplicationName("screenshots");
  const QStringList arguments = QApplication::arguments();
  if (arguments.size() != 3) {
    std::fputs("nutik_studio_screenshots CLIP FOLDER\n", stderr);
    return 2;
  }
  set_appearance(Appearance::dark);
  use_language(QLocale::system().uiLanguages());
  if (Photographer(arguments[2]).take_all(arguments[1])) return 0;
  std::fputs("nutik_studio_screenshots: a picture could not be taken; the last one may say why\n", stderr);
  return 1;
}
