#include <array>

#include "app/output/output_name.hpp"
#include "app/output/report.hpp"
#include "capture/format.hpp"
#include "features/captures/retiming.hpp"
#include "features/schema/options.hpp"
#include "session/text/number_text.hpp"
#include "session/text/shell_text.hpp"

namespace nutik::app {

int run_retime(const Options& options) {
  const auto output = stated_output(options, "retime");
  if (output.has_value() == options.in_place) {
    throw UsageError(
        options.in_place
            ? format("two outputs: {} and the capture itself (--in-place); leave one out", output->string())
            : format("say where to write: nutik-cl retime … {} NEW.tik, or that the capture itself changes: "
                     "--in-place",
                     shell_word(options.operands.front())));
  }
  RetimeRequest request;
  request.capture = options.operands.front();
  request.output = output.value_or(request.capture);
  request.rate = options.source.clip.rate;
  request.shutter_angle = options.source.shutter_angle;
  request.transfer = options.source.clip.transfer;
  request.primaries = options.source.clip.primaries;
  request.pixel_aspect = options.source.clip.pixel_aspect;
  if (output)
    check_output(*output, OutputKind::tik, std::array{request.capture.string()}, replacing(options));

  const auto [capture, timeline, file_bytes, facts, notes] = retime(request);
  Answer answer{{{"capture", request.output.string()}}};
  answer.json.update(shape_json(capture.shape));
  answer.json.update({{"samples", timeline.sample_count()},
                      {"samples_a_second", timeline.rate().text()},
                      {"is_constant_rate", timeline.is_constant()},
                      {"shutter_angle_degrees", timeline.shutter_angle().text()},
                      {"duration_ns", timeline.duration_ns()},
                      {"transfer", capture.transfer.text()},
                      {"primaries", to_text(capture.primaries)},
                      {"pixel_aspect", aspect_text(capture.pixel_aspect)},
                      {"facts", facts_json(facts)},
                      {"file_bytes", file_bytes}});
  answer.line =
      format("{}: {}, {}, {}, shutter {} degrees, transfer {}, primaries {}, pixels {}",
             request.output.string(), shape_text(capture.shape), counted(timeline.sample_count(), "sample"),
             rate_text(timeline), timeline.shutter_angle().text(), capture.transfer.text(),
             to_text(capture.primaries), aspect_text(capture.pixel_aspect));
  answer.tell_source({}, notes);
  return tell(options, request.output, answer, true);
}

}  // namespace nutik::app
