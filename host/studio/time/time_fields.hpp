// The exposed interval and the marks as numbers to type.
//
//   always:  a field shows what is so, to the last digit, unless somebody is typing in it; what cannot be read changes
//            nothing, stays as it was typed, and is explained beside the fields
#pragma once

#include <QWidget>
#include <functional>

#include "studio/document/document.hpp"

class QLabel;
class QLineEdit;

namespace nutik::studio {

class TimeFields : public QWidget {
  Q_OBJECT

 public:
  explicit TimeFields(Document& document, QWidget* parent = nullptr);

 Q_SIGNALS:
  // What is wrong and has no room beside the fields; empty once it is mended.
  void refused(const QString& mistake);

 protected:
  void changeEvent(QEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  // `take` uses what was typed; returns what is wrong with it, empty where nothing is.
  using Take = std::function<QString(const QString& text)>;
  QLineEdit* add_field(const char* object, const QString& name, const QString& help, Take take);
  void show_values();
  QString take_start(const QString& text);
  QString take_length(const QString& text);
  QString take_mark(const QString& text, void (Document::*set)(std::optional<std::int64_t>));
  void refuse(QLineEdit& field, const QString& mistake);
  void accept(QLineEdit& field);

  Document& document_;
  QLineEdit *start_, *length_, *in_, *out_;
  QLabel* said_;
};

}  // namespace nutik::studio
