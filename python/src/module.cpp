// nutik._nutik: the engine's session for Python. What its users see is the package around it, python/nutik.
#include "parts.hpp"
#include "system/mapped_file.hpp"

PYBIND11_MODULE(_nutik, module) {
  module.doc() = "The engine. Use the package nutik, which says what its parts take and give.";
  module.attr("__version__") = NUTIK_VERSION;
  // A capture that somebody cuts off must not end the interpreter.
  nutik::watch_mapped_files();
  const auto at_exit = pybind11::module_::import("atexit").attr("register");
  at_exit(pybind11::cpp_function(&nutik::python::end_work));
  nutik::python::bind_errors(module);
  nutik::python::bind_commands(module);
  nutik::python::bind_functions(module);
  nutik::python::bind_masks(module);
  nutik::python::bind_pictures(module);
  nutik::python::bind_captures(module);
  nutik::python::bind_rendering(module);
  nutik::python::bind_tracing(module);
  nutik::python::bind_studies(module);
}
