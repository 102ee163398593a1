// What the options make a mask of.
//
//   --tag 128 --moving --largest --grow 4 --tag 255 --ellipse 320,180,40,30
//
// selects what moves, keeps its largest part, grows that by 4 pixels and gives it tag 128; then an ellipse gets
// tag 255, over what it covers.
#pragma once

#include "app/command_line/options.hpp"
#include "session/mask_request.hpp"

namespace nutik::app {

// Pictures have their names and nothing else; there is no base yet. Throws UsageError naming the option whose value
// makes no sense, or which changes a region where none was selected.
[[nodiscard]] MaskRequest mask_request(const Options& options);

// Reads the base and the pictures, once all that was said is known to make sense. Throws InputError where one cannot be
// read.
void read_inputs(MaskRequest& request, const Options& options);

}  // namespace nutik::app
