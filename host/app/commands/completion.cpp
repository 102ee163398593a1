#include "app/command_line/completion.hpp"

#include "app/commands/commands.hpp"
#include "app/output/console.hpp"
#include "session/error.hpp"

namespace nutik::app {

int run_completion(const Options& options) {
  if (options.operands.size() != 1) {
    throw UsageError("for which shell? nutik-cl completion bash, zsh or fish");
  }
  print_text(completion_script(options.operands.front()));
  return 0;
}

}  // namespace nutik::app
