#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/report.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "features/captures/joining.hpp"
#include "features/schema/options.hpp"
#include "session/text/number_text.hpp"

namespace nutik::app {

int run_join(const Options& options) {
  const std::vector<std::string>& captures = options.operands;
  // No operand is the output: of part-*.tik it would be the last part.
  if (captures.size() < 2 || !options.output || options.output->empty())
    throw UsageError("join takes two captures or more and an output: nutik-cl join a.tik b.tik -o whole.tik");
  const JoinRequest request{{captures.begin(), captures.end()}, *options.output};

  check_output(request.output, OutputKind::tik, captures, replacing(options));
  const Stopwatch stopwatch;
  const Joined joined = join(request, progress_bar("joining", options.quiet, progress_lines(options)));
  const Timeline& timeline = joined.timeline;
  Json parts = Json::array();
  for (const JoinedPart& part : joined.parts)
    parts.push_back(
        {{"capture", part.capture}, {"first_sample", part.first_sample}, {"samples", part.sample_count}});
  Answer answer{{{"capture", request.output.string()}, {"parts", parts}}};
  answer.json.update(shape_json(joined.capture.shape));
  answer.json.update({{"samples", timeline.sample_count()},
                      {"samples_a_second", timeline.rate().text()},
                      {"is_constant_rate", timeline.is_constant()},
                      {"duration_ns", timeline.duration_ns()},
                      {"facts", facts_json(joined.facts)},
                      {"file_bytes", joined.file_bytes},
                      {"seconds", stopwatch.seconds()}});
  answer.line =
      format("{}: {}, {} of {} captures, {}, {}, {:.2f} s", request.output.string(),
             shape_text(joined.capture.shape), counted(timeline.sample_count(), "sample"), captures.size(),
             duration_text(timeline.duration_ns()), bytes_text(joined.file_bytes), stopwatch.seconds());
  answer.tell_source({}, joined.notes);
  return tell(options, request.output, answer);
}

}  // namespace nutik::app
