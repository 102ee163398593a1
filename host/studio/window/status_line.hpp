// What stands under the window: the pixel under the pointer, how the picture was computed, what is at work.
#pragma once

#include <QFrame>
#include <QImage>
#include <QPoint>
#include <QStatusBar>
#include <QString>
#include <functional>
#include <optional>
#include <vector>

#include "studio/live/jobs.hpp"
#include "studio/live/live_view.hpp"

class QLabel;
class QProgressBar;
class QToolButton;

namespace nutik::studio {

// A line above the picture that says what went wrong, or what to know, until it is closed. It stops nobody.

class Notice : public QFrame {
  Q_OBJECT

 public:
  enum class Kind { error, note };

  explicit Notice(QWidget* parent = nullptr);
  // In place of what it said. With a button, where there is a way out.
  void say(Kind kind, const QString& text, const QString& label = {}, std::function<void()> way_out = {});
  void clear();
  [[nodiscard]] QString text() const;

 private:
  QLabel* text_;
  QToolButton* way_out_;
  std::function<void()> act_;
};

class StatusLine : public QStatusBar {
  Q_OBJECT

 public:
  StatusLine(const std::vector<Jobs*>& jobs, QWidget* parent = nullptr);

  void tell(const ShownPicture& picture);
  void tell_zoom(double screen_pixels);  // to a side of the capture's; 0: none
  // The codes of a picture on the screen, and the light that they stand for.
  void tell(std::optional<QPoint> pixel, const QImage& image);

 private:
  QLabel *zoom_, *pixel_, *saturated_, *arithmetic_, *milliseconds_, *work_;
  QProgressBar* progress_;
  QToolButton* cancel_;
  Jobs* shown_;  // whose progress is told
};

}  // namespace nutik::studio
