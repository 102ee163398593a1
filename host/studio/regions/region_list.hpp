// The regions beside the picture: which there are, what their still gain is, and what can be done with one.
#pragma once

#include <QDoubleSpinBox>
#include <QTreeWidget>
#include <QWidget>
#include <array>
#include <cstdint>

#include "studio/canvas/light_histogram.hpp"
#include "studio/document/document.hpp"

class QPushButton;
class QToolButton;

namespace nutik::studio {

// A number with a decimal point, as fields, files and commands have it, whatever the locale; a comma is taken for one.
class NumberBox : public QDoubleSpinBox {
 public:
  explicit NumberBox(QWidget* parent = nullptr) : QDoubleSpinBox(parent) { setLocale(QLocale::c()); }
  QValidator::State validate(QString& text, int& cursor) const override {
    return QDoubleSpinBox::validate(text.replace(',', '.'), cursor);
  }
};

// For tests, for screen readers, and for whoever points at it; the name is the tip where there is no other.
void describe(QWidget& widget, const char* object, const QString& name, const QString& tip = {});

class RegionList : public QWidget {
  Q_OBJECT

 public:
  explicit RegionList(Document& document, QWidget* parent = nullptr);

  // Told beside each region.
  void count_clipped(const MeasuredLight& light);

 private:
  enum Column { kName, kEv, kStill, kClipped, kSolo, kColumns };

  void build_buttons();
  void follow();            // the document's state
  void follow_selection();  // and what is looked at
  void fill(QTreeWidgetItem& item, std::uint8_t tag) const;
  void edited(QTreeWidgetItem* item, int column);
  void choose_colour();

  Document& document_;
  QTreeWidget* list_;
  QPushButton *add_, *remove_, *colour_, *up_, *down_, *over_interval_;
  QDoubleSpinBox *radius_, *feather_, *own_feather_;
  QPushButton *grow_, *shrink_, *smooth_;
  DocumentState listed_;
  std::array<std::uint64_t, kMaskValues> clipped_{};  // pixels by tag
  bool is_following_ = false;
};

}  // namespace nutik::studio
