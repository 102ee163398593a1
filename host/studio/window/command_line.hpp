// The command line that makes a document's picture, and the recipe that the picture carries.
//
//   always:  both come from one list of options, and nutik-cl writes the same bytes
#pragma once

#include <QString>
#include <string>

#include "session/making/picture_recipe.hpp"
#include "studio/document/document.hpp"

namespace nutik::studio {

// Where a document's mask and functions are; not used of a plain interval.
struct CommandFiles {
  QString mask, functions;
};

// One line for a POSIX shell.
[[nodiscard]] QString command_line(const Document& document, const CommandFiles& files,
                                   const QString& picture);
// Reads both files.
[[nodiscard]] RecipeSources recipe_sources(const Document& document, const CommandFiles& files);

}  // namespace nutik::studio
