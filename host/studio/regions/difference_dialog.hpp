// Asks which two moments a region is to be told from.
//
//   in:      a capture's timeline, and times to begin with
//   out:     accepted(), and then what was chosen
//   always:  what cannot be read is explained in the dialog, which stays open
#pragma once

#include <QDialog>

#include "session/below/capture.hpp"
#include "studio/regions/selections.hpp"

class QCheckBox;
class QLabel;
class QLineEdit;
class QSpinBox;

namespace nutik::studio {

class DifferenceDialog : public QDialog {
  Q_OBJECT

 public:
  DifferenceDialog(const Timeline& timeline, std::int64_t from_ns, std::int64_t to_ns, QWidget* parent);

  [[nodiscard]] const Difference& chosen() const { return chosen_; }

 public Q_SLOTS:
  void accept() override;

 private:
  [[nodiscard]] std::optional<std::int64_t> read(QLineEdit& field, const QString& what);

  Timeline timeline_;
  Difference chosen_;
  QLineEdit *from_, *to_;
  QSpinBox* codes_;
  QCheckBox* largest_;
  QLabel* mistake_;
};

}  // namespace nutik::studio
