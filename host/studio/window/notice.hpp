// A line above the picture that says what went wrong, or what to know, until it is closed. It stops nobody.
#pragma once

#include <QFrame>
#include <QString>

class QLabel;

namespace nutik::studio {

class Notice : public QFrame {
  Q_OBJECT

 public:
  enum class Kind { error, note };

  explicit Notice(QWidget* parent = nullptr);
  void say(Kind kind, const QString& text);  // in place of what it said
  void clear();
  [[nodiscard]] QString text() const;

 private:
  QLabel* text_;
};

}  // namespace nutik::studio
