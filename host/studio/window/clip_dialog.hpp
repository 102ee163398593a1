// How a clip is to be read: what a person states beside what its files say.
#pragma once

#include <QString>
#include <optional>

#include "studio/document/document.hpp"

class QWidget;

namespace nutik::studio {

// Asks over `parent`, beginning with what is stated already; `why` stands above the fields. Nothing where it is
// cancelled. The dialog's fields have the names of the options as object names.
[[nodiscard]] std::optional<Stated> ask_how_to_read(QWidget* parent, const QString& why, Stated stated);

}  // namespace nutik::studio
