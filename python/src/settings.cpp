// What is stated by name, as the schema's options; and the program's commands, which have the same names.
#include "app/command_line/command_table.hpp"
#include "app/run.hpp"
#include "capture/error.hpp"
#include "features/schema/option.hpp"
#include "parts.hpp"

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
  const py::gil_scoped_release released;
  return app::run_process(pointers);
}

}  // namespace

void bind_commands(py::module_& module) {
  module.def("described", &described, "command"_a);
  module.def("argument_now", &argument_now, "name"_a);
  module.def("command_words", &command_words, "command"_a, "stated"_a);
  module.def("run_program", &run_program, "words"_a);
}

}  // namespace nutik::python
