// What the library throws, as Python's exceptions, and what its messages call a setting: an argument.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "session/below/error.hpp"

namespace nutik::python {

// `rate=`
[[nodiscard]] std::string_view argument_of(Setting setting);
// ` (rate=, transfer=)`, or nothing.
[[nodiscard]] std::string arguments_text(const std::vector<Setting>& settings);
[[nodiscard]] std::vector<std::string> note_texts(const std::vector<Note>& notes);

void bind_errors(pybind11::module_& module);

}  // namespace nutik::python
