// What stands under the window: the pixel under the pointer, how the picture was computed, what is at work.
#pragma once

#include <QImage>
#include <QPoint>
#include <QStatusBar>
#include <optional>

#include "studio/live/jobs.hpp"
#include "studio/live/live_view.hpp"

class QLabel;
class QProgressBar;
class QToolButton;

namespace nutik::studio {

class StatusLine : public QStatusBar {
  Q_OBJECT

 public:
  StatusLine(Jobs& jobs, QWidget* parent = nullptr);

  void tell(const ShownPicture& picture);
  // The codes of a picture on the screen, and the light that they stand for.
  void tell(std::optional<QPoint> pixel, const QImage& image);

 private:
  QLabel *pixel_, *saturated_, *arithmetic_, *milliseconds_, *work_;
  QProgressBar* progress_;
  QToolButton* cancel_;
};

}  // namespace nutik::studio
