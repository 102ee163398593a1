#include "session/session.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "imev/each_block.hpp"
#include "imev/expected_values.hpp"
#include "media/events/event_clip.hpp"
#include "render/code_scale.hpp"
#include "render/one_pass.hpp"
#include "render/picture_memory.hpp"
#include "render/plan_cache.hpp"
#include "session/clips/clip_memory.hpp"
#include "session/clips/clip_reading.hpp"
#include "session/clips/clip_source.hpp"
#include "session/uncertainty_map.hpp"

namespace nutik {
namespace {

std::shared_ptr<Devices> needed(std::shared_ptr<Devices> devices) {
  if (!devices) throw UsageError("a session needs devices");
  return devices;
}

// Unpacks a plan's first blocks, or checks those that are not packed, one after another until the device that will read
// them has started. Ends at the first packed block that some function does not read, or with which they would take more
// than `max_bytes`.
void preload_until(const std::future<void>& ready, CaptureSource& source, const RenderPlan& plan,
                   std::uint64_t max_bytes) {
  constexpr std::uint64_t kMaxPreloadedBytes = 256 << 20;  // none of this memory is used twice
  std::uint64_t left = std::min(max_bytes, kMaxPreloadedBytes);
  for (const PlannedBlock& planned : plan.blocks) {
    const std::uint64_t bytes = source.lent_bytes(planned.block);
    const bool is_read_whole = std::ranges::none_of(plan.functions, [&](const PlannedFunction& function) {
      return function.table->span_in(planned.extent).empty();
    });
    if (bytes > left || (bytes > 0 && !is_read_whole)) return;
    source.preload(planned.block);
    left -= bytes;
    if (ready.wait_for(std::chrono::seconds(0)) == std::future_status::ready) return;
  }
}

// Keeps those of a plan's functions with delays that are traced, each where its pixel has it.
void keep_traced(RenderPlan& plan, std::vector<Trace>& traces) {
  if (!plan.map->has_delays()) return;
  std::vector<PlannedFunction> traced;
  for (Trace& trace : traces) {
    PlannedFunction& function = traced.emplace_back(plan.functions[trace.function]);
    function.function = function.table->function();
    trace.function = traced.size() - 1;
  }
  plan.functions = std::move(traced);
}

}  // namespace

SessionIsSpent::SessionIsSpent()
    : UsageError(
          "the session reads its capture forward, for one picture and nothing else; open it to be read "
          "whole") {}

class Session::State {
 public:
  State(const SourceRequest& source, std::shared_ptr<Devices> devices, const Terms& terms)
      : source_(source),
        devices_(needed(std::move(devices))),
        // Events are read whole: only a file lets an exposure skip what does not change.
        reading_(terms.reading == Reading::forward && is_event_recording(source.path) ? Reading::whole : terms.reading),
        besides_(terms.besides),
        is_clip_(terms.open_clip || !is_tik(source.path)),
        plans_(memory().table_bytes()) {
    if (!is_clip_) {
      if (source.describes_clip()) {
        throw UsageError(nutik::format("what is stated describes a clip that is encoded; {} was encoded already",
                                       input_title(source.path.string())));
      }
      reader_ = std::make_unique<tik::Reader>(source.path);
      check_transfer(source.clip.transfer);
    } else if (reading_ == Reading::whole) {
      ScratchCapture scratch = encode_to_scratch(
          source, terms.open_clip, memory(),
          [&](const CaptureFormat& format) {
            MemoryNeeds needs = terms.renders
                                    ? rendering_needs(format, code_type(format), 1, kDefaultBlockSamples)
                                    : MemoryNeeds();
            needs.add(besides_of(format));
            return needs;
          },
          terms.progress, terms.stop);
      reader_ = std::move(scratch.reader);
      facts_ = std::move(scratch.encoded.facts);
      sound_ = scratch.encoded.sound;
      notes_ = std::move(scratch.encoded.notes);
      warnings_ = std::move(scratch.encoded.warnings);
    } else {
      if (terms.open_clip) throw UsageError("a clip that its owner makes is read whole");
      clip_ = open_clip_source(source, memory(), terms.progress, terms.stop);
      announced_ = clip_->timeline(clip_->announced_samples());
      facts_ = clip_->facts(announced_->sample_count());
      sound_ = clip_->sound();
      notes_ = clip_->all_notes(announced_->sample_count());
      if (devices_->has_several()) {
        notes_.emplace_back(
            "a clip that is read for one picture is exposed by the first device alone; all of them expose pictures of "
            "its capture");
      }
    }
    format_ = reader_ ? reader_->format() : held_format(clip_->capture);
    roundings_ = reader_ ? reader_->header().roundings : clip_->clip->info().roundings;
    errors_ = CaptureErrors::of(format_, roundings_);
    std::optional<tik::Alignment> alignment;
    if (reader_) {
      alignment = reader_->header().alignment;
      errors_.made = reader_->header().made;
    } else {
      if (clip_->camera) alignment = kept_alignment(**clip_->camera, clip_->request.align->unseen);
      if (clip_->made) errors_.made = **clip_->made;
    }
    if (alignment) errors_.alignment_pixels = alignment->residual_pixels;
    if (reader_ && !terms.renders) check_reading({});
  }

  ~State() {
    if (reader_) devices_->release(reader_.get());
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

 private:
  friend class Session;

  [[nodiscard]] const Timeline& timeline() const { return reader_ ? reader_->timeline() : *announced_; }
  [[nodiscard]] const MemoryBudget& memory() const { return devices_->request().memory; }
  [[nodiscard]] MemoryNeeds besides_of(const CaptureFormat& format) const {
    return besides_ ? besides_(format) : MemoryNeeds();
  }
  void check_transfer(const std::optional<Transfer>& stated) const {
    if (reader_) check_stated_transfer(reader_->header(), source_.path.string(), stated);
  }

  // What is held while a picture is rendered, beside what rendering itself takes.
  [[nodiscard]] MemoryNeeds held_needs() const {
    MemoryNeeds needs = mask_needs(format_);
    needs.add(besides_of(format_));
    return needs;
  }

  // The same while the capture is read without a picture: with a block of it.
  void check_reading(const MemoryNeeds& more) const {
    MemoryNeeds needs = more;
    needs.add(besides_of(format_));
    needs.add("a block", largest_block(*reader_));
    needs.rest_of(memory().bytes);
  }

  // Calls work(bytes) with what the budget leaves beside held_needs() and `more`. A MemoryTooLittle of its own is
  // thrown again with these added.
  template <typename Work>
  auto within(const MemoryNeeds& more, Work work) const {
    MemoryNeeds held = held_needs();
    held.add(more);
    try {
      return work(std::max(memory().bytes - std::min(memory().bytes, held.bytes()), std::uint64_t{1}));
    } catch (const MemoryTooLittle& error) {
      held.add(error.needs);
      throw MemoryTooLittle(memory().bytes, std::move(held));
    }
  }

  // How many pictures of a type may be in line, the finished ones and those that devices make: four per device, as a
  // fast one need not wait for a slow one, and at most a sixteenth of the memory, so that waiting pictures refuse none
  // that bands could make.
  [[nodiscard]] std::size_t line_length(ValueType type) const {
    const std::uint64_t room = memory().bytes / 16 / (format_.shape.value_count() * value_bytes(type));
    return static_cast<std::size_t>(std::min<std::uint64_t>(4 * devices_->count(), room));
  }

  void spend() {
    if (is_spent_.exchange(reading_ == Reading::forward)) throw SessionIsSpent();
  }

  [[nodiscard]] tik::Reader& capture() {
    if (reading_ == Reading::forward) throw SessionIsSpent();
    return *reader_;
  }

  [[nodiscard]] RenderPlan plan(const ExposureRequest& request) {
    check_transfer(request.plan.transfer);
    return plans_.plan(capture(), functions_of(request, timeline()), mask_of(request, format_.shape),
                       plan_options_of(request, format_.shape));
  }

  // A device that is still starting loads its kernels beside the first blocks.
  void warm_up(CaptureSource& source, const RenderPlan& plan, const OutputFormat& output, const std::stop_token& stop) {
    if (devices_->is_ready()) return;
    measure_tables(plan, stop);  // takes long for many functions, and who chooses an arithmetic needs it
    auto ready = std::async(std::launch::async, [&] { devices_->renderer().prepare(plan, output); });
    preload_until(ready, source, plan, memory().bytes / 4);
    ready.get();
  }

  [[nodiscard]] ExposedPicture expose(CaptureSource& source, const FunctionSet& functions, const Mask& mask,
                                      const PlanOptions& options, const OutputFormat& output,
                                      const RenderControl& control, std::uint64_t stream_bytes = 0) {
    throw_if_cancelled(control);
    check_transfer(options.transfer);
    RenderPlan plan = plans_.plan(source, functions, mask, options);
    const bool adds_up = plan.combine == Combine::integral;  // else a device's light is the reference's to the last bit
    const bool strict = control.strict || devices_->request().strict;
    if (strict && (!adds_up || devices_->request().renderer == RendererKind::reference))
      check_reference_strictly(plan, output);
    if (adds_up && !warmed_up_.test_and_set()) warm_up(source, plan, output, control.stop);
    if (reading_ == Reading::whole) devices_->keep_resident(reader_.get());
    // In the mask and in its map.
    const std::uint64_t mixed_bytes = 2 * mask.mixed.bytes();
    const std::uint64_t pictures = control.by_one_device ? line_length(output.type) : 1;
    const std::uint64_t line_bytes =
        control.by_one_device ? pictures * format_.shape.value_count() * value_bytes(output.type) : 0;
    Rendered rendered = within(
        {{"reading the clip", stream_bytes},
         {"mixed pixels", mixed_bytes},
         {"pictures in line", line_bytes},
         {"the map of bounds", output.maps_bounds ? pictures * UncertaintyMap::bytes(format_.shape) : 0}},
        [&](std::uint64_t left) {
          RenderControl limited = control;
          limited.strict = strict;
          if (limited.memory_bytes == 0 || limited.memory_bytes > left) limited.memory_bytes = left;
          return devices_->renderer().render(plan, source, output, limited);
        });
    rendered.warnings.insert(rendered.warnings.begin(), plan.warnings.begin(), plan.warnings.end());
    if (auto infinite = infinity_warning(rendered.picture)) rendered.warnings.push_back(std::move(*infinite));
    std::vector<PictureLayer> bounds;
    if (output.maps_bounds) {
      const Rectangle part = control.rectangle.value_or(Rectangle::whole(format_.shape));
      const ErrorBound bound = rendered.choice && adds_up ? rendered.choice->bound : reference_bound(plan, output);
      bounds = UncertaintyMap(plan, source.timeline(), bound, *errors_of(plan)).layers(rendered.picture, part, control);
      if (const std::uint64_t count = infinite_values(bounds.front().values); count > 0) {
        rendered.warnings.push_back(
            nutik::format("the map has {} of {} bounds beyond floating point of 32 bits, which ends at 3.4e38: "
                          "infinite",
                          count, bounds.front().values.shape.pixel_count()));
      }
    }
    ExposedPicture exposed = exposed_of(std::move(rendered), std::move(plan), source.timeline(), output);
    if (!bounds.empty() && holds_codes(output.type)) UncertaintyMap::limit(bounds, *exposed.uncertainty.bounds.error);
    exposed.bounds = std::move(bounds);
    return exposed;
  }

  [[nodiscard]] ExposedPicture exposed_of(Rendered rendered, RenderPlan plan, const Timeline& timeline,
                                          const OutputFormat& output) {
    const std::shared_ptr<const CaptureErrors> errors = errors_of(plan);
    const auto block_count = reader_ ? std::optional(reader_->block_count()) : std::nullopt;
    ExposureFigures figures = ExposureFigures::of(std::move(plan), timeline, block_count);
    if (figures.functions.size() == 1) {
      rendered.picture.exposed_ns = figures.functions.front().summary.support_ns;
    }
    ExposedPicture exposed{std::move(rendered), std::move(figures), output};
    exposed.uncertainty = Uncertainty::of(exposed, *errors);
    return exposed;
  }

  [[nodiscard]] std::shared_ptr<const CaptureErrors> errors_of(const RenderPlan& plan) {
    if (plan.combine != Combine::integral)
      return std::make_shared<CaptureErrors>(errors_of(plan.capture)->of_order());
    return errors_of(plan.capture);
  }

  // By the function that the capture has, or that was stated instead.
  [[nodiscard]] std::shared_ptr<const CaptureErrors> errors_of(const CaptureFormat& planned) {
    // Which live as long as the session.
    if (planned.transfer == format_.transfer) return {std::shared_ptr<const CaptureErrors>(), &errors_};
    const std::scoped_lock lock(stated_errors_mutex_);
    if (!stated_errors_ || stated_errors_->first != planned.transfer) {
      auto errors = std::make_shared<CaptureErrors>(CaptureErrors::of(planned, roundings_));
      errors->alignment_pixels = errors_.alignment_pixels;
      errors->made = errors_.made;
      stated_errors_.emplace(planned.transfer, std::move(errors));
    }
    return stated_errors_->second;
  }

  SourceRequest source_;
  std::shared_ptr<Devices> devices_;
  Reading reading_;
  NeedsOfFormat besides_;
  bool is_clip_;
  CaptureFormat format_;
  std::vector<Fact> facts_;
  std::optional<ClipSound> sound_;
  std::vector<Note> notes_;
  std::vector<std::string> warnings_;
  CaptureErrors errors_;
  // Those of the function that was stated last: a series states one for all of its pictures.
  std::optional<std::pair<Transfer, std::shared_ptr<const CaptureErrors>>> stated_errors_;
  std::mutex stated_errors_mutex_;
  CodeRoundings roundings_;

  // A capture, or a clip that has not been read yet and the timeline that its files announce.
  std::unique_ptr<tik::Reader> reader_;
  std::optional<ClipSource> clip_;
  std::optional<Timeline> announced_;

  PlanCache plans_;
  std::atomic_flag warmed_up_;
  std::atomic<bool> is_spent_ = false;
};

Session::Session(const SourceRequest& source, std::shared_ptr<Devices> devices, const Terms& terms)
    : state_(std::make_unique<State>(source, std::move(devices), terms)) {}
Session::Session(const SourceRequest& source, std::shared_ptr<Devices> devices)
    : Session(source, std::move(devices), Terms{}) {}
Session::Session(const SourceRequest& source, const ComputingRequest& computing)
    : Session(source, std::make_shared<Devices>(computing)) {}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

const SourceRequest& Session::source() const { return state_->source_; }
Devices& Session::devices() const { return *state_->devices_; }
bool Session::is_clip() const { return state_->is_clip_; }
const CaptureFormat& Session::format() const { return state_->format_; }
const Timeline& Session::timeline() const { return state_->timeline(); }
const std::vector<Fact>& Session::facts() const { return state_->facts_; }
bool Session::repeats_chroma() const {
  return state_->format_.code_bytes == 1 && std::ranges::count(state_->roundings_.unbounded, kSharedChroma) > 0;
}
const std::optional<ClipSound>& Session::sound() const { return state_->sound_; }
const std::vector<Note>& Session::notes() const { return state_->notes_; }
const std::vector<std::string>& Session::warnings() const { return state_->warnings_; }
tik::Reader& Session::capture() { return state_->capture(); }
std::uint32_t Session::waiting_pictures(ValueType type) const {
  return nutik::waiting_pictures(format().shape.value_count() * value_bytes(type));
}

// Devices make pictures of their own unless blocks are packed: with bands a device unpacks only its own tiles,
// otherwise every device unpacks all.
std::size_t Session::pictures_at_once(ValueType type, std::size_t count) const {
  const std::size_t members = devices().count();
  if (members == 1 || count < members || !state_->reader_ || state_->line_length(type) < members) return 1;
  for (std::uint64_t block = 0; block < state_->reader_->block_count(); ++block) {
    if (state_->reader_->lent_bytes(block) > 0) return 1;
  }
  return state_->line_length(type);
}

ExposedPicture Session::render(const ExposureRequest& request, const OutputFormat& output,
                               const RenderControl& control) {
  state_->spend();
  if (state_->reader_) {
    return state_->expose(*state_->reader_, functions_of(request, timeline()), mask_of(request, format().shape),
                          plan_options_of(request, format().shape), output, control);
  }
  return expose_forward(std::move(*state_->clip_), state_->memory(), request, output.type,
                        state_->besides_of(format()),
                        [&](CaptureSource& stream, const FunctionSet& functions, const Mask& mask,
                            const PlanOptions& options, std::uint64_t stream_bytes) {
                          return state_->expose(stream, functions, mask, options, output, control, stream_bytes);
                        },
                        state_->notes_);
}

ExposedPicture Session::render(const FunctionSet& functions, const Mask& mask, const PlanOptions& options,
                               const OutputFormat& output, const RenderControl& control) {
  return state_->expose(capture(), functions, mask, options, output, control);
}

void Session::render_many(std::span<const ExposureRequest> requests, const OutputFormat& output,
                          const RenderControl& control, const RenderedOne& done) {
  const ComputingRequest& computing = devices().request();
  const auto asked = control.precision ? control.precision : computing.precision;
  const bool in_double = computing.renderer == RendererKind::opencl && !output.maps_bounds &&
                         asked.value_or(Precision::double_) == Precision::double_;
  const Rectangle rectangle = control.rectangle.value_or(Rectangle::whole(format().shape));
  std::vector<RenderPlan> plans;
  std::vector<Rendered> waiting;
  std::size_t next = 0;
  const auto expose_waiting = [&] {
    if (plans.empty()) return;
    std::vector<Picture> light = expose_in_one_pass(plans, *state_->reader_, rectangle, control);
    for (std::size_t i = 0; i < plans.size(); ++i) {
      throw_if_cancelled(control);
      Rendered& rendered = waiting[i];
      rendered.picture = stored(std::move(light[i]), plans[i].capture, output, rendered.saturation);
      state_values(rendered.picture, plans[i].capture, output);
      if (auto infinite = infinity_warning(rendered.picture)) rendered.warnings.push_back(std::move(*infinite));
      done(next++, state_->exposed_of(std::move(rendered), std::move(plans[i]), timeline(), output));
    }
    plans.clear();
    waiting.clear();
  };
  for (const ExposureRequest& request : requests) {
    throw_if_cancelled(control);
    if (in_double && rectangle.lies_in(format().shape)) {
      RenderPlan planned = state_->plan(request);
      Rendered rendered;
      rendered.renderer = "the processor";
      rendered.warnings = planned.warnings;
      if (suits_one_pass(planned)) rendered.choice = {error_bound(planned, Precision::double_, output), {}};
      if (rendered.choice && rendered.choice->is_right_enough()) {
        if (!plans.empty() && plans.front().capture != planned.capture) expose_waiting();
        plans.push_back(std::move(planned));
        waiting.push_back(std::move(rendered));
        if (plans.size() >= pictures_in_one_pass(plans.front(), rectangle, state_->memory().bytes / 16))
          expose_waiting();
        continue;
      }
    }
    expose_waiting();
    done(next++, render(request, output, control));
  }
  expose_waiting();
}

TracedExposure Session::trace(const ExposureRequest& request, const Followed& followed,
                              const ReportedProgress& progress) {
  RenderPlan planned = state_->plan(request);
  state_->check_reading(mask_needs(format()));
  tik::Reader& reader = *state_->reader_;
  const auto* pixel = std::get_if<TracedPixel>(&followed);
  std::vector<Trace> traces =
      pixel ? trace_pixel(planned, reader, pixel->x, pixel->y, progress)
            : std::vector{trace_region(planned, reader, std::get<TracedTag>(followed).tag, progress)};
  if (const auto& made = reader.header().made) {
    const std::vector<bool> marks = made->marks();
    for (Trace& trace : traces) {
      for (TraceStep& step : trace.steps)
        step.is_made = marks[timeline().samples_reaching(step.begin_ns, step.begin_ns + 1).first];
    }
  }
  std::vector<std::string> warnings = std::move(planned.warnings);
  keep_traced(planned, traces);
  return {std::move(traces), ExposureFigures::of(std::move(planned), timeline(), reader.block_count()),
          std::move(warnings)};
}

ValidatedExposure Session::validate(const ExposureRequest& request, const OutputFormat& output,
                                    std::uint32_t runs, const ReportedProgress& progress) {
  if (runs == 0) throw UsageError("a validation runs once at least");
  RenderPlan planned = state_->plan(request);
  devices().keep_resident(state_->reader_.get());
  const auto ignored = [](std::uint64_t, std::uint64_t) {};
  const std::uint64_t light_bytes = format().shape.value_count() * value_bytes(ValueType::light64);
  Validation validation = state_->within({{"the reference's picture", light_bytes}}, [&](std::uint64_t left) {
    // The widest arithmetic's picture, which comes late.
    MemoryNeeds needs = picture_needs(format().shape, ValueType::light64);
    needs.add("a block", largest_block(*state_->reader_));
    needs.rest_of(left);
    const auto device = devices().opencl();
    return nutik::validate(planned, *state_->reader_, output, *device, runs,
                           progress ? progress : ReportedProgress(ignored), left);
  });
  std::vector<std::string> warnings = std::move(planned.warnings);
  return {std::move(validation), ExposureFigures::of(std::move(planned), timeline(), state_->reader_->block_count()),
          std::move(warnings)};
}

SourceCheck Session::compare_with(const SourceRequest& clip, const ReportedProgress& progress) {
  return compare_with_source(capture(), clip, state_->memory(), progress);
}

}  // namespace nutik
