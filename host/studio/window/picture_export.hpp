// Writes the picture of a document as nutik-cl does: the same bytes, and with its recipe.
#pragma once

#include <memory>

#include "session/session.hpp"
#include "studio/document/document.hpp"
#include "studio/live/jobs.hpp"
#include "studio/window/project_file.hpp"

namespace nutik::studio {

// A job's work. `files` hold the document's mask and functions. What comes of it is told on the window's thread: a line
// about the picture.
[[nodiscard]] Jobs::Work exporting(const Document& document, std::shared_ptr<Session> session,
                                   const CommandFiles& files, const QString& picture,
                                   std::function<void(const QString&)> told);

}  // namespace nutik::studio
