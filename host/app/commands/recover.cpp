#include <array>

#include "app/commands/commands.hpp"
#include "app/output/console.hpp"
#include "app/output/output_name.hpp"
#include "app/text/size_text.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "tik/reader.hpp"

namespace nutik::app {

int run_recover(const Options& options) {
  const auto output = stated_output(options.output, options.operands, "recover");
  const std::string& damaged = options.operands.front();
  if (!output) throw UsageError(format("the output is missing: nutik-cl recover {} -o whole.tik", damaged));
  check_output(*output, OutputKind::tik, std::array{damaged});
  const tik::Recovery recovery = tik::recover(damaged, *output);
  if (!options.quiet) {
    print_line(format("{}: {} samples in {} blocks were saved, {} behind them left out", output->string(),
                      recovery.sample_count, recovery.block_count, bytes_text(recovery.lost_bytes)));
  }
  return 0;
}

}  // namespace nutik::app
