#include <array>

#include "app/output/output_name.hpp"
#include "app/output/report.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "features/schema/options.hpp"
#include "session/text/number_text.hpp"
#include "session/text/shell_text.hpp"
#include "tik/reader.hpp"

namespace nutik::app {

int run_recover(const Options& options) {
  const auto output = stated_output(options, "recover");
  const std::string& damaged = options.operands.front();
  if (!output)
    throw UsageError(format("the output is missing: nutik-cl recover {} -o whole.tik", shell_word(damaged)));
  check_output(*output, OutputKind::tik, std::array{damaged}, replacing(options));
  const tik::Recovery recovery = tik::recover(damaged, *output);
  Answer answer{{{"capture", output->string()},
                 {"samples", recovery.sample_count},
                 {"blocks", recovery.block_count},
                 {"lost_bytes", recovery.lost_bytes}}};
  answer.line = format("{}: {} in {} were saved, {} behind them left out", output->string(),
                       counted(recovery.sample_count, "sample"), counted(recovery.block_count, "block"),
                       bytes_text(recovery.lost_bytes));
  return tell(options, *output, answer);
}

}  // namespace nutik::app
