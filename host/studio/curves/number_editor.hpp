// A point's time and gain as numbers to type, over the curve editor.
//
//   always:  nothing is changed before both numbers are right; what is wrong with one is said below it. Escape leaves
//            everything as it was; text that was not touched keeps its value to the last digit
#pragma once

#include <QFrame>
#include <optional>

#include "capture/timeline.hpp"
#include "exposure/gain_function.hpp"

class QLabel;
class QLineEdit;

namespace nutik::studio {

class NumberEditor : public QFrame {
  Q_OBJECT

 public:
  explicit NumberEditor(QWidget* parent);

  // Shows a point near a place in the parent.
  void open(const ControlPoint& point, const Timeline* timeline, QPointF at);
  // The numbers were right, but could not be used.
  void refuse(const QString& why);
  void close_editor();

 Q_SIGNALS:
  void entered(ControlPoint point);  // whoever can use it calls close_editor()
  void closed();

 protected:
  void keyPressEvent(QKeyEvent* event) override;

 private:
  void enter();

  ControlPoint point_;
  const Timeline* timeline_ = nullptr;
  QLineEdit* time_;
  QLineEdit* gain_;
  QLabel* mistake_;
};

}  // namespace nutik::studio
