#include "app/command_line/man_page.hpp"
#include "app/commands/commands.hpp"
#include "app/output/console.hpp"
#include "session/error.hpp"

namespace nutik::app {

int run_man(const Options& options) {
  if (!options.operands.empty()) throw UsageError("man takes no file: nutik-cl man > nutik-cl.1");
  print_text(man_page());
  return 0;
}

}  // namespace nutik::app
