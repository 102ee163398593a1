#include "app/command_line/completion.hpp"

#include "app/commands/commands.hpp"
#include "app/output/console.hpp"
#include "session/error.hpp"

namespace nutik::app {

int run_completion(const Options& options) {
  if (options.operands.empty()) throw UsageError("for which shell? nutik-cl completion bash, zsh or fish");
  const std::string script = completion_script(options.operands.front());
  const std::span<const std::string> words = std::span(options.operands).subspan(1);
  print_text(words.empty() ? script : completions(words));
  return 0;
}

}  // namespace nutik::app
