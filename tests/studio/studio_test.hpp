// A window on a small clip whose every value is known, and a hand that works it.
#pragma once

#include <gtest/gtest.h>

#include <QAction>
#include <QApplication>
#include <QClipboard>
#include <QFileDialog>
#include <QLineEdit>
#include <QMenu>
#include <QMenuBar>
#include <QMessageBox>
#include <QPushButton>
#include <QStandardPaths>
#include <QTest>
#include <QTimer>
#include <QToolBar>
#include <functional>

#include "hand.hpp"
#include "studio/live/live_view.hpp"
#include "studio/window/main_window.hpp"
#include "support/moving_square.hpp"
#include "support/program.hpp"
#include "support/scratch.hpp"

namespace nutik::studio {

class StudioTest : public ::testing::Test {
 protected:
  static constexpr int kMaxWaitMs = 60'000;  // kernels may have to be built first

  StudioTest() {
    square_.write(scratch_);
    window_.resize(1280, 800);  // whatever the screen, and another test's window
    window_.show();
  }

  [[nodiscard]] QString path(const char* name) const {
    return QString::fromStdString((scratch_ / name).string());
  }

  // Until the picture is that of the document, and nothing is at work.
  [[nodiscard]] bool settles() {
    return QTest::qWaitFor([this] { return window_.is_settled(); }, kMaxWaitMs);
  }
  void open_clip() { open_in(window_); }
  void open_in(MainWindow& window) { open_in(window, path("frames/%02d.pgm"), "100"); }
  void open_in(MainWindow& window, const QString& file, const QString& rate = {}) {
    window.open(file, rate);
    const bool is_settled = QTest::qWaitFor([&] { return window.is_settled(); }, kMaxWaitMs);
    if (!is_settled || window.document().facts() == nullptr)
      throw std::runtime_error("it was not opened: " + window.notice().text().toStdString());
  }

  [[nodiscard]] Document& document() { return window_.document(); }
  [[nodiscard]] Canvas& canvas() { return window_.canvas(); }
  template <typename Widget>
  [[nodiscard]] Widget& child(const char* name) {
    auto* found = window_.findChild<Widget*>(name);
    if (found == nullptr) throw std::logic_error(name);
    return *found;
  }

  // ---- mouse ----

  // Where a pixel's middle lies on the canvas.
  [[nodiscard]] QPoint at(double x, double y) { return canvas().view().to_widget({x, y}).toPoint(); }
  void click_tool(const char* name) {
    auto& bar = child<QToolBar>("tools");
    QTest::mouseClick(bar.widgetForAction(&child<QAction>(name)), Qt::LeftButton);
  }
  void click_button(const char* name) { QTest::mouseClick(&child<QPushButton>(name), Qt::LeftButton); }
  // Both by what their names begin with.
  void click_menu(const char* menu, const char* row) {
    const auto named = [](const QWidget& widget, const char* name) {
      for (QAction* action : widget.actions())
        if (action->text().remove('&').startsWith(name)) return action;
      throw std::logic_error(name);
    };
    QMenuBar& bar = *window_.menuBar();
    QAction* title = named(bar, menu);
    const QPoint place = bar.actionGeometry(title).center();
    // Qt 6.8 closes a menu at a press where the mouse has not moved since it opened, and where it was then is known of
    // what reaches a window: clicks at widgets, as here, do not count.
    QTest::mouseMove(window_.windowHandle(), bar.mapTo(&window_, place));
    QTest::mouseClick(&bar, Qt::LeftButton, {}, place);
    QMenu& rows = *title->menu();
    QTest::mouseClick(&rows, Qt::LeftButton, {}, rows.actionGeometry(named(rows, row)).center());
  }

  // A key in the window, once it is active: a desktop makes it so when a dialog is gone.
  void shortcut(Qt::Key key, Qt::KeyboardModifiers keys = Qt::ControlModifier) {
    window_.activateWindow();
    ASSERT_TRUE(QTest::qWaitForWindowActive(&window_));
    QTest::keyClick(&window_, key, keys);
  }

  // To the dialog that comes next, once it is there.
  template <typename Dialog>
  void answer_next(const std::function<void(Dialog&)>& answer) {
    is_asked_ = false;
    auto* timer = new QTimer(&window_);
    QObject::connect(timer, &QTimer::timeout, timer, [this, timer, answer] {
      auto* dialog = qobject_cast<Dialog*>(QApplication::activeModalWidget());
      if (dialog == nullptr) return;
      is_asked_ = true;
      timer->deleteLater();
      answer(*dialog);
    });
    timer->start(1);
  }
  void answer_next(QMessageBox::StandardButton button) {
    answer_next<QMessageBox>([button](QMessageBox& question) {
      const bool names_files = button == QMessageBox::Yes || button == QMessageBox::No;
      EXPECT_TRUE(!names_files || question.textFormat() == Qt::PlainText);
      QTest::mouseClick(question.button(button), Qt::LeftButton);
    });
  }

  // Pastes a file's path into the dialog that comes next: typed, it would open each folder on its way.
  void name_next_file(const char* name) {
    answer_next<QFileDialog>([this, name](QFileDialog& dialog) {
      auto* field = dialog.findChild<QLineEdit*>("fileNameEdit");
      ASSERT_NE(field, nullptr);
      QGuiApplication::clipboard()->setText(path(name));
      field->selectAll();
      QTest::keyClick(field, Qt::Key_V, Qt::ControlModifier);
      QTest::keyClick(field, Qt::Key_Return);
    });
  }

  // Types a file's path into the export dialog that comes next, which `change` may change further.
  void name_next_export(const char* name, const std::function<void(QDialog&)>& change = {}) {
    answer_next<QDialog>([this, name, change](QDialog& dialog) {
      auto* field = dialog.findChild<QLineEdit*>("path");
      ASSERT_NE(field, nullptr);
      field->setText(path(name));
      if (change) change(dialog);
      QTest::keyClick(field, Qt::Key_Return);
    });
  }

  // Runs a line that was copied, with the program that was built.
  test::ProgramResult run_line(const QString& line, int status = 0) {
    const std::string words = line.toStdString();
    EXPECT_TRUE(words.starts_with("nutik-cl ")) << words;
    test::ProgramResult made = test::run_shell(std::string(NUTIK_TEST_PROGRAM) + words.substr(8), scratch_.folder());
    EXPECT_EQ(made.status, status) << words << made.out << made.err;
    return made;
  }

  [[nodiscard]] std::size_t pixels_of(std::uint8_t tag) {
    const auto& mask = document().state().mask;
    return mask ? static_cast<std::size_t>((*mask)->mask.pixels_per_tag()[tag]) : 0;
  }

  // What a session of its own makes of the document, as a picture that is written.
  [[nodiscard]] QImage fresh_picture() {
    const DocumentState& state = document().state();
    SourceRequest source{.path = document().facts()->path.toStdString()};
    const Stated& stated = document().facts()->stated;
    if (stated.contains("fps")) source.clip.rate = Rational::parse(stated.at("fps"), "rate");
    Session session(source);
    const auto mask = state.mask ? std::optional(LiveView::feathered_mask(state)) : std::nullopt;
    const RenderControl control{.precision = document().facts()->precision};
    return image_of(session.render(exposure_of(state, mask), screen_format(), control).picture);
  }

  // The colour that a widget shows at one of its places, whatever the screen's scale.
  [[nodiscard]] static QColor shown_at(const QImage& grabbed, QPointF place) {
    return grabbed.pixelColor((place * grabbed.devicePixelRatio()).toPoint());
  }

  // The first pixel at which two pictures differ; nothing where they are the same.
  [[nodiscard]] static std::string difference(const QImage& got, const QImage& want) {
    if (got.size() != want.size()) return "another size";
    for (int y = 0; y < got.height(); ++y) {
      for (int x = 0; x < got.width(); ++x) {
        if (got.pixel(x, y) == want.pixel(x, y)) continue;
        return QString("pixel (%1, %2): %3, not %4")
            .arg(x)
            .arg(y)
            .arg(got.pixel(x, y), 0, 16)
            .arg(want.pixel(x, y), 0, 16)
            .toStdString();
      }
    }
    return {};
  }

  test::MovingSquare square_;
  test::Scratch scratch_;
  MainWindow window_;
  bool is_asked_ = false;
};

}  // namespace nutik::studio
