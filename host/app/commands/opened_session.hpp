// What a command works on.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "features/schema/options.hpp"
#include "session/session.hpp"

namespace nutik::app {

// On the first operand; its devices start beside it. A clip that is read whole is read with a progress bar, which says
// `what` is done. Prints what is doubtful about what came of it. Throws UsageError where options describe a clip and
// this is a .tik, and what Session throws.
[[nodiscard]] Session open_session(const Options& options, Session::Terms terms = {}, const char* what = "reading");
// On another capture, with devices that start when the first picture is asked for.
[[nodiscard]] Session open_session(const std::string& name, const Options& options,
                                   std::shared_ptr<Devices> devices, Session::Terms terms = {},
                                   const char* what = "reading");

// That the camera of a capture moved and nobody aligned it, as a note.
[[nodiscard]] std::vector<std::string> camera_notes(const std::optional<MovedCamera>& moved);

}  // namespace nutik::app
