// What the library throws, as Python's exceptions, in the words of its arguments.
#pragma once

#include <pybind11/pybind11.h>

namespace nutik::python {

void bind_errors(pybind11::module_& module);

}  // namespace nutik::python
