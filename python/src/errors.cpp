#include "errors.hpp"

#include <exception>
#include <filesystem>
#include <new>

#include "capture/error.hpp"
#include "capture/memory_needs.hpp"
#include "features/schema/option.hpp"
#include "system/interruption.hpp"

namespace nutik::python {

namespace py = pybind11;

namespace {

// Kept for as long as the interpreter runs: translators have no other place to look.
struct ErrorTypes {
  PyObject *error, *usage, *input, *device, *output, *memory, *imprecise;
};
ErrorTypes& types() {
  static ErrorTypes types{};
  return types;
}

void raise(PyObject* type, const Error& error) {
  const py::str text(message_text(error, Dialect::python));
  py::list settings;
  for (const Setting setting : error.settings()) settings.append(written(setting, Dialect::python));
  const py::object raised = py::reinterpret_borrow<py::object>(type)(text);
  raised.attr("settings") = py::tuple(settings);
  PyErr_SetObject(type, raised.ptr());
}

void translate(std::exception_ptr thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const MemoryTooLittle& error) {
    raise(types().memory, error);
  } catch (const UsageError& error) {
    raise(types().usage, error);
  } catch (const InputError& error) {
    raise(types().input, error);
  } catch (const DeviceError& error) {
    raise(types().device, error);
  } catch (const OutputError& error) {
    raise(types().output, error);
  } catch (const ImpreciseError& error) {
    raise(types().imprecise, error);
  } catch (const Cancelled&) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
  } catch (const Error& error) {
    raise(types().error, error);
  }
}

PyObject* add_type(py::module_& module, const char* name, const py::tuple& bases, const char* doc) {
  const std::string full = std::string("nutik.") + name;
  PyObject* type = PyErr_NewExceptionWithDoc(full.c_str(), doc, bases.ptr(), nullptr);
  if (type == nullptr) throw py::error_already_set();
  module.attr(name) = py::reinterpret_borrow<py::object>(type);
  return type;
}

}  // namespace

void bind_errors(py::module_& module) {
  const auto base = [](PyObject* type) { return py::reinterpret_borrow<py::object>(type); };
  ErrorTypes& made = types();
  made.error = add_type(module, "Error", py::make_tuple(base(PyExc_Exception)),
                        "What nutik raises. settings: the arguments that would help, as a tuple of str.");
  // Of those that Python code raises.
  py::setattr(made.error, "settings", py::tuple());
  const auto error = base(made.error);
  made.usage =
      add_type(module, "UsageError", py::make_tuple(error, base(PyExc_ValueError)),
               "The request itself makes no sense: arguments that contradict each other, an unknown name.");
  made.input = add_type(module, "InputError", py::make_tuple(error, base(PyExc_ValueError)),
                        "Something that was read is wrong: a clip, a capture, pictures, a mask, a function.");
  made.device = add_type(module, "DeviceError", py::make_tuple(error, base(PyExc_RuntimeError)),
                         "The OpenCL device cannot do it: absent, too small, a failed build.");
  made.output = add_type(module, "OutputError", py::make_tuple(error, base(PyExc_OSError)),
                         "A file cannot be written.");
  made.memory = add_type(module, "MemoryTooLittle", py::make_tuple(base(made.usage), base(PyExc_MemoryError)),
                         "Less memory is allowed than the work takes; the message says the least that does.");
  made.imprecise = add_type(module, "ImpreciseError", py::make_tuple(error, base(PyExc_ArithmeticError)),
                            "Light may err by more than half a code, and strict=True allows no more.");
  py::register_exception_translator(translate);
}

}  // namespace nutik::python
