// The regions beside the picture: which there are, what their still gain is, and what can be done with one.
#pragma once

#include <QTreeWidget>
#include <QWidget>

#include "studio/document/document.hpp"

class QDoubleSpinBox;
class QPushButton;
class QToolButton;

namespace nutik::studio {

class RegionList : public QWidget {
  Q_OBJECT

 public:
  explicit RegionList(Document& document, QWidget* parent = nullptr);

 private:
  enum Column { kName, kTag, kStill, kSolo, kColumns };

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
  bool is_following_ = false;
};

}  // namespace nutik::studio
