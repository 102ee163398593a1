// Keeps what is not saved, so that a crash loses little.
//
//   always:  a change is kept within kDelay, beside nothing of the user's; what was saved or given up is kept no longer
#pragma once

#include <QObject>
#include <QTimer>
#include <chrono>

#include "studio/document/document.hpp"

namespace nutik::studio {

class Autosave : public QObject {
  Q_OBJECT

 public:
  static constexpr std::chrono::seconds kDelay{10};

  explicit Autosave(Document& document, QObject* parent = nullptr);

  // The project that is kept; empty: none.
  [[nodiscard]] static QString found();
  void keep();
  static void forget();

 private:
  Document& document_;
  QTimer timer_;
};

}  // namespace nutik::studio
