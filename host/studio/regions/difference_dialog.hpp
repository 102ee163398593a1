// Asks which two moments a region is to be told from.
//
//   in:      a capture's timeline, and times to begin with
//   out:     accepted(), and then what was chosen
//   always:  what cannot be read is explained in the dialog, which stays open
#pragma once

#include <QDialog>
#include <QString>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "capture/timeline.hpp"
#include "session/session.hpp"
#include "studio/document/document.hpp"
#include "studio/live/jobs.hpp"

class QCheckBox;
class QLabel;
class QLineEdit;
class QSpinBox;

namespace nutik::studio {

// Pixels that are found in the capture, for the selected region: as jobs, since they read it.

// Between the capture's pictures at two times.
struct Difference {
  std::int64_t from_ns = 0, to_ns = 0;
  std::optional<std::uint32_t> by_codes;  // only larger ones count; none: told from the pictures
  bool is_largest_part = false;           // without the others
};

// Each is one step: paints the region that is selected at the start, which is not the background. `told` gets what was
// found, and how many pixels: nothing is painted where there are none.
[[nodiscard]] Jobs::Work selecting_motion(Document& document, std::shared_ptr<Session> session, Told told);
[[nodiscard]] Jobs::Work selecting_difference(Document& document, std::shared_ptr<Session> session,
                                              const Difference& difference, Told told);

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
