#include "settings.hpp"

#include "capture/error.hpp"
#include "features/schema/option.hpp"

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

}  // namespace nutik::python
