#include <filesystem>

#include "app/commands/commands.hpp"
#include "app/commands/expose_series.hpp"
#include "app/input/exposer.hpp"
#include "app/output/console.hpp"
#include "app/output/ending.hpp"
#include "app/output/exposure_report.hpp"
#include "app/output/output_format.hpp"
#include "app/output/output_name.hpp"
#include "app/output/picture_recipe.hpp"
#include "app/output/stopwatch.hpp"
#include "app/requests/exposure_words.hpp"
#include "app/requests/source_words.hpp"
#include "app/text/timing_text.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/picture_writer.hpp"
#include "media/read_ahead.hpp"
#include "render/render_plan.hpp"
#include "session/clip_source.hpp"
#include "session/size_text.hpp"
#include "tik/reader.hpp"

namespace nutik::app {
namespace {

// An exposure, and the timeline of the capture it was made from.
struct ExposedCapture {
  Exposed exposed;
  Timeline timeline;
};

class Exposing {
 public:
  Exposing(const Options& options, const std::filesystem::path& output)
      : options_(options), output_(output), request_(exposure_request(options)), exposer_(options) {}

  ExposedCapture from_tik(const std::string& input) {
    tik::Reader reader(input);
    block_count_ = reader.block_count();
    return expose(reader, functions_of(request_, reader.timeline()));
  }

  // The timeline is known for sure only when the clip has been read to its end, which an exposure of its
  // beginning never does. So the clip's word is taken, and where decoding proves it wrong, it is read
  // once more with the right number of pictures.
  ExposedCapture from_clip(const std::string& input, const SourceRequest& request,
                           const MemoryBudget& memory) {
    std::optional<std::uint64_t> sample_count;
    for (;;) {
      ClipSource source = open_clip_source(request, memory);
      notes_ = source.notes;
      const Timeline timeline = source.timeline(sample_count.value_or(source.announced_samples()));
      const FunctionSet functions = functions_of(request_, timeline);
      PlanOptions plan_options = plan_options_of(request_);
      plan_options.transfer.reset();  // it went into the capture's format
      const SampleRange needed =
          needed_samples(timeline, functions, mask_of(request_, source.capture.shape), plan_options);
      const std::uint64_t last =
          streamed_samples(source.capture, needed, source.block_samples, timeline.sample_count()).last;
      // At the timeline's end samples that follow are counted: they prove it wrong.
      const bool is_end = last == timeline.sample_count();
      ReadAhead samples(*source.clip, memory.read_ahead_bytes(), is_end ? ReadAhead::kAll : last);
      StreamingCapture stream(source.capture, timeline, needed, source.block_samples, request.tiles,
                              [&](std::uint64_t most) { return samples.next(most); });
      try {
        return expose(stream, functions);
      } catch (const SampleCountMismatch& mismatch) {
        if (sample_count == mismatch.sample_count || mismatch.sample_count == 0) {
          throw InputError(format("{}: only {} pictures can be decoded", input, mismatch.sample_count));
        }
        sample_count = mismatch.sample_count;
      }
    }
  }

  // What makes the picture, for the summary.
  [[nodiscard]] const Exposer& exposer() const { return exposer_; }
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
  // Of a .tik.
  [[nodiscard]] std::optional<std::uint64_t> block_count() const { return block_count_; }
  void set_output(const std::filesystem::path& output) { output_ = output; }

 private:
  ExposedCapture expose(CaptureSource& source, const FunctionSet& functions) {
    return {exposer_.expose(source, functions, mask_of(request_, source.format().shape),
                            plan_options_of(request_), output_format(options_, output_, source.format())),
            source.timeline()};
  }

  const Options& options_;
  std::filesystem::path output_;
  ExposureRequest request_;
  Exposer exposer_;
  std::optional<std::uint64_t> block_count_;
  std::vector<std::string> notes_;  // on the clip
};

}  // namespace

int run_expose(const Options& options) {
  if (options.every) return expose_series(options);
  if (options.count) throw UsageError("--count goes with --every: a series needs both a step and a number");
  const Stopwatch stopwatch;
  const auto stated = stated_output(options.output, options.operands, "expose");
  const std::string& input = options.operands.front();
  std::filesystem::path output = stated.value_or("");
  Exposing exposing(options, output);
  if (!stated) {
    output = picture_name(input, exposure_label(options));
    exposing.set_output(output);
  }
  check_output(output, OutputKind::picture, input_files(options));

  PictureRecipe recipe(options);
  const bool captured = is_tik(input);
  const SourceRequest request = source_request(options, input);
  const auto [exposed, timeline] =
      captured ? exposing.from_tik(input) : exposing.from_clip(input, request, memory_budget(options));
  for (const std::string& warning : exposure_warnings(exposed)) print_warning(warning);
  write_picture(output, exposed.picture, recipe.text(exposing.exposer().precision()));
  if (options.json) {
    Json json{{"picture", output.string()}};
    add_shape(json, exposed.picture.shape);
    json["samples"] = timeline.sample_count();
    json["live_samples"] = exposed.plan.live_sample_count();
    json["functions"] = functions_json(exposed.plan);
    add_saturation(json, exposed.saturation, exposed.picture.type);
    add_rendering(json, exposing.exposer(), stopwatch);
    print_json(json);
    return 0;
  }
  if (ended_quietly(options, output)) return 0;

  const RenderPlan& plan = exposed.plan;
  print_line(format("{}: {}, {} of {} samples{}{}, {:.2f} s on {}", output.string(),
                    shape_text(plan.capture.shape), plan.live_sample_count(), timeline.sample_count(),
                    still_gains_text(plan, !options.functions),
                    saturation_text(exposed.saturation, exposed.picture.type), stopwatch.seconds(),
                    exposing.exposer().renderer_name()));
  if (options.verbose) print_line(plan_text(plan, timeline, exposing.block_count()));
  print_details(options, exposing.exposer(), {});
  if (!captured) {
    print_line(format("source: {}", timing_text(timeline, request)));
    for (const std::string& line : note_lines(exposing.notes(), timeline, request)) print_note(line);
  }
  return 0;
}

}  // namespace nutik::app
