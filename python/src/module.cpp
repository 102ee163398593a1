// nutik._nutik: the engine's session for Python; what its users see is the package around it, python/nutik. Here: what
// the library throws, in the words of arguments; what is stated by name, as the schema's options; and the commands.
#include <sys/prctl.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <exception>
#include <ranges>

#include "app/command_line/command_table.hpp"
#include "app/run.hpp"
#include "capture/error.hpp"
#include "capture/memory_needs.hpp"
#include "features/schema/option.hpp"
#include "parts.hpp"
#include "system/is_absent.hpp"
#include "system/mapped_file.hpp"

namespace nutik::python {

Options stated_options(CommandId command, const Settings& settings) {
  Options options;
  for (const auto& [name, word] : settings) {
    const Option* const option = option_of_argument(command, name);
    if (option == nullptr) throw UsageError("there is no argument " + name + "=");
    option->state(options, name, {word});
  }
  return options;
}

namespace {

struct ErrorType {
  const char* name;
  bool (*is_of)(const Error& error);
  PyObject* builtin;  // the exception of Python's that it is, too
  const char* doc;
  py::handle type = {};
};

template <typename Kind>
bool is(const Error& error) {
  return dynamic_cast<const Kind*>(&error) != nullptr;
}

// From the general to the special, for as long as the interpreter runs: translators have no other place to look.
std::array<ErrorType, 7>& types() {
  static std::array<ErrorType, 7> all{{
      {"Error", [](const Error&) { return true; }, PyExc_Exception,
       "What nutik raises. settings: the arguments that would help, as a tuple of str."},
      {"UsageError", is<UsageError>, PyExc_ValueError,
       "The request itself makes no sense: arguments that contradict each other, an unknown name."},
      {"InputError", is<InputError>, PyExc_ValueError,
       "Something that was read is wrong: a clip, a capture, pictures, a mask, a function."},
      {"DeviceError", is<DeviceError>, PyExc_RuntimeError,
       "The OpenCL device cannot do it: absent, too small, a failed build."},
      {"OutputError", is<OutputError>, PyExc_OSError, "A file cannot be written."},
      {"ImpreciseError", is<ImpreciseError>, PyExc_ArithmeticError,
       "Light may err by more than half a code, or half a float's step, and strict=True allows no more."},
      {"MemoryTooLittle", is<MemoryTooLittle>, PyExc_MemoryError,
       "Less memory is allowed than the work takes; the message says the least that does."},
  }};
  return all;
}

void translate(std::exception_ptr thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Cancelled&) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
  } catch (const Error& error) {
    py::list settings;
    for (const Setting setting : error.settings()) settings.append(written(setting, Dialect::python));
    const auto kinds = types() | std::views::reverse;
    const auto is_of = [&](const ErrorType& kind) { return kind.is_of(error); };
    const auto* const missing = dynamic_cast<const FileMissing*>(&error);
    auto type = py::reinterpret_borrow<py::object>(std::ranges::find_if(kinds, is_of)->type);
    if (missing != nullptr) type = py::module_::import("nutik._words").attr("FileMissing");
    const py::object raised = type(text_of(message_text(error, Dialect::python)));
    raised.attr("settings") = py::tuple(settings);
    if (missing != nullptr) {
      raised.attr("errno") = ENOENT;
      raised.attr("filename") = text_of(missing->file);
    }
    PyErr_SetObject(type.ptr(), raised.ptr());
  }
}

void bind_errors(py::module_& module) {
  for (ErrorType& kind : types()) {
    const py::handle builtin(kind.builtin);
    const char* const base = kind.is_of == is<MemoryTooLittle> ? "UsageError" : "Error";
    const py::tuple bases =
        kind.builtin == PyExc_Exception ? py::make_tuple(builtin) : py::make_tuple(module.attr(base), builtin);
    const std::string name = std::string("nutik.") + kind.name;
    kind.type = PyErr_NewExceptionWithDoc(name.c_str(), kind.doc, bases.ptr(), nullptr);
    if (!kind.type) throw py::error_already_set();
    module.attr(kind.name) = kind.type;
  }
  module.attr("Error").attr("settings") = py::tuple();  // of those that Python code raises
  py::register_exception_translator(translate);
}

const app::Command& command_of(const std::string& name) {
  const app::Command* const found = app::find_command(name);
  if (found == nullptr) throw UsageError("there is no command " + name);
  return *found;
}

std::string argument_of(const Option& option) {
  const std::string written = option.written(Dialect::python);
  return written.substr(0, written.find('='));
}

// What a command is for, its operands, and of each argument: how its value is written, what it says, whether it may be
// given several times, and whether it says what a picture is made of.
py::tuple described(const std::string& command) {
  const app::Command& row = command_of(command);
  py::dict arguments;
  for (const Option* const option : options_of(row.id)) {
    arguments[py::str(argument_of(*option))] =
        py::make_tuple(option->value, option->help, option->take == nullptr, option->makes_picture());
  }
  return py::make_tuple(row.summary, row.operands, arguments);
}

// What an argument is called now; itself where no option is called that.
std::string argument_now(const std::string& name) {
  const Option* const option = option_of_argument(CommandId::encode, name);
  return option == nullptr ? name : argument_of(*option);
}

// The words of a command line that states these, each once or several times.
std::vector<std::string> command_words(const std::string& command,
                                       const std::map<std::string, std::vector<std::vector<std::string>>>& stated) {
  const CommandId id = command_of(command).id;
  Options options;
  std::vector<std::string> line{command};
  for (const auto& [name, values] : stated) {
    const Option* const option = option_of_argument(id, name);
    if (option == nullptr) throw UsageError(command + " has no argument " + name + "=");
    for (const std::vector<std::string>& words : values) {
      if (words.size() != option->word_count()) throw UsageError(name + "= takes " + std::string(option->value));
      option->state(options, name, words);
      line.push_back(option->name());
      line.insert(line.end(), words.begin(), words.end());
    }
  }
  return line;
}

// Runs the command line in this process, which does nothing else; never in one with other work.
int run_program(std::vector<std::string> words) {
  words.insert(words.begin(), "nutik-cl");
  std::vector<const char*> pointers;
  for (const std::string& word : words) pointers.push_back(word.c_str());
  prctl(PR_SET_PDEATHSIG, SIGPIPE);  // it outlives nobody who waits for it
  const py::gil_scoped_release released;
  return app::run_process(pointers);
}

void bind_commands(py::module_& module) {
  module.def("described", &described, "command"_a);
  module.def("argument_now", &argument_now, "name"_a);
  module.def("command_words", &command_words, "command"_a, "stated"_a);
  module.def("run_program", &run_program, "words"_a);
}

}  // namespace
}  // namespace nutik::python

PYBIND11_MODULE(_nutik, module) {
  using namespace nutik::python;
  module.doc() = "The engine. Use the package nutik, which says what its parts take and give.";
  module.attr("__version__") = NUTIK_VERSION;
  // A capture that somebody cuts off must not end the interpreter.
  nutik::watch_mapped_files();
  py::module_::import("atexit").attr("register")(py::cpp_function(&end_work));
  for (const auto bind : {bind_errors, bind_commands, bind_functions, bind_captures, bind_rendering, bind_studies})
    bind(module);
}
