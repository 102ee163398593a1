// A window on a small clip whose every value is known, and a hand that works it.
#pragma once

#include <gtest/gtest.h>

#include <QAction>
#include <QPushButton>
#include <QStandardPaths>
#include <QTest>
#include <QToolBar>

#include "studio/window/main_window.hpp"
#include "support/moving_square.hpp"
#include "support/scratch.hpp"

namespace nutik::studio {

class StudioTest : public ::testing::Test {
 protected:
  static constexpr int kMaxWaitMs = 60'000;  // kernels may have to be built first

  StudioTest() {
    square_.write(scratch_);
    window_.show();
  }

  [[nodiscard]] QString path(const char* name) const {
    return QString::fromStdString((scratch_ / name).string());
  }

  // Until the picture is that of the document, and nothing is at work.
  [[nodiscard]] bool settles() {
    return QTest::qWaitFor([this] { return window_.is_settled(); }, kMaxWaitMs);
  }
  void open_clip() {
    window_.open(path("frames/%02d.pgm"), "100");
    if (!settles() || document().facts() == nullptr)
      throw std::runtime_error("the clip was not opened: " + window_.notice().text().toStdString());
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
  static void drag(QWidget& widget, QPoint from, QPoint to, Qt::KeyboardModifiers keys = {}) {
    QTest::mousePress(&widget, Qt::LeftButton, keys, from);
    QTest::mouseMove(&widget, (from + to) / 2);
    QTest::mouseMove(&widget, to);
    QTest::mouseRelease(&widget, Qt::LeftButton, keys, to);
  }
  void click_tool(const char* name) {
    auto& bar = child<QToolBar>("tools");
    QTest::mouseClick(bar.widgetForAction(&child<QAction>(name)), Qt::LeftButton);
  }
  void click_button(const char* name) { QTest::mouseClick(&child<QPushButton>(name), Qt::LeftButton); }

  [[nodiscard]] std::size_t pixels_of(std::uint8_t tag) {
    const auto& mask = document().state().mask;
    return mask ? static_cast<std::size_t>((*mask)->mask.pixels_per_tag()[tag]) : 0;
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
};

}  // namespace nutik::studio
