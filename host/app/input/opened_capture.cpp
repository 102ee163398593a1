#include "app/input/opened_capture.hpp"

#include <utility>

#include "app/output/console.hpp"
#include "app/output/progress.hpp"
#include "app/requests/source_words.hpp"
#include "app/text/timing_text.hpp"
#include "capture/format.hpp"
#include "session/clip_source.hpp"
#include "session/scratch_capture.hpp"

namespace nutik::app {

OpenedCapture::OpenedCapture(const std::string& name, const Options& options) {
  const SourceRequest request = source_request(options, name);
  if (is_tik(name)) {
    reader_ = std::make_unique<tik::Reader>(name);
    return;
  }
  ScratchCapture scratch =
      encode_to_scratch(request, memory_budget(options), progress_bar("reading", options.quiet));
  for (const std::string& warning : scratch.encoded.warnings) print_warning(warning);
  reader_ = std::move(scratch.reader);
  const Timeline& timeline = scratch.encoded.timeline;
  notes_ = note_lines(scratch.encoded.notes, timeline, request);
  notes_.insert(notes_.begin(), format("source: {}", timing_text(timeline, request)));
}

}  // namespace nutik::app
