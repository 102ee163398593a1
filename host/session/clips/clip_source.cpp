#include "session/clips/clip_source.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "capture/format.hpp"
#include "capture/text.hpp"
#include "media/deflicker.hpp"
#include "media/events/event_clip.hpp"
#include "session/clips/evened_times.hpp"
#include "session/clips/measured_noise.hpp"
#include "session/text/number_text.hpp"
#include "system/mapped_file.hpp"
#include "tik/header.hpp"
#include "tik/reader.hpp"

namespace nutik {
namespace {

// Rates from the one to the other are what players show; a clip filmed faster often says one of them.
constexpr double kLowestPlaybackRate = 1.0;
constexpr double kHighestPlaybackRate = 60.0;

bool seeks_path(const SourceRequest& source) { return source.align && !source.align->path; }
bool seeks_motion(const SourceRequest& source) { return source.between && !source.between->made; }

// The progress of what is done twice: both times in one.
std::pair<ReportedProgress, ReportedProgress> halves(const ReportedProgress& progress, bool is_twofold) {
  if (!progress || !is_twofold) return {progress, progress};
  return {[progress](std::uint64_t done, std::uint64_t total) { progress(done, 2 * total); },
          [progress](std::uint64_t done, std::uint64_t total) { progress(total + done, 2 * total); }};
}

// A clip that its owner makes is what it is.
void refuse_what_files_have(const SourceRequest& source) {
  const ClipOptions& clip = source.clip;
  std::vector<std::string_view> stated;
  for (const auto& [is_stated, name] :
       {std::pair(clip.raw.has_value(), "raw"), std::pair(clip.matrix.has_value(), "matrix"),
        std::pair(clip.range.has_value(), "range"), std::pair(clip.chroma_at.has_value(), "chroma_at"),
        std::pair(clip.from.has_value(), "from"), std::pair(clip.to.has_value(), "to"),
        std::pair(clip.crop.has_value(), "crop"), std::pair(clip.scale.has_value(), "scale"),
        std::pair(clip.interlaced != Interlaced::refused, "interlaced"),
        std::pair(clip.ends_at_damage, "ends_at_damage"), std::pair(clip.events != EventOptions(), "events")}) {
    if (is_stated) stated.emplace_back(name);
  }
  if (stated.empty()) return;
  throw UsageError(format("{}: {} can be stated of files alone, and its owner makes this clip",
                          input_title(source.path.string()), joined(stated)));
}

// On the clip itself, which is then opened again. Throws MemoryTooLittle with the least that does for encoding, too.
CameraNoise own_noise(ClipSource& source, const OpenClip& open, const MemoryBudget& memory,
                      const std::stop_token& stop) {
  MemoryNeeds needs{{"pictures within the decoder", source.clip->info().decoder_bytes}};
  const std::uint64_t within_decoder = needs.bytes();
  needs.add(NoiseEstimator::needs(source.capture, kSamplesOfOwnNoise));
  const std::uint64_t watched = StillnessWatch::bytes(source.capture.shape, kSamplesOfOwnNoise);
  needs.add("pixels that are watched for movement", watched);
  if (needs.bytes() > memory.bytes) {
    ClipToRead clip = source.clip_to_read();
    clip.capture.noise.camera.emplace();
    try {
      static_cast<void>(memory_for_encoding(memory, clip));
    } catch (const MemoryTooLittle& error) {
      if (error.min_bytes() > needs.bytes()) throw;
    }
    needs.rest_of(memory.bytes);
  }
  const std::uint32_t threads =
      NoiseEstimator::threads_in(memory.bytes - within_decoder - watched, source.capture, kSamplesOfOwnNoise);
  NoiseEstimator estimator(source.capture, threads);
  StillnessWatch watch(source.capture, kSamplesOfOwnNoise);
  estimator.add_clip(
      source.name(),
      [&](std::span<std::byte> raster) {
        if (stop.stop_requested()) throw Cancelled();
        const bool is_read = source.clip->read(raster);
        if (is_read) watch.add(raster);
        return is_read;
      },
      kSamplesOfOwnNoise);
  source.clip.reset();
  source.clip = open();
  const NoiseEstimate estimate = estimator.estimate();
  if (const std::string reason = reason_for_no_noise(estimate); !reason.empty()) {
    throw InputError(
        format("{}: no noise can be measured on it: {}. {}", source.name(), reason, kNoiseElsewhere));
  }
  if (auto note = check_stillness(watch.judge(estimate.noise), source.request))
    source.notes.push_back(std::move(*note));
  for (const std::string& note : noise_notes(estimate)) source.notes.emplace_back(note);
  return estimate.noise;
}

NoiseModel noise_model(ClipSource& source, const OpenClip& open, const MemoryBudget& memory,
                       const std::stop_token& stop) {
  const SourceRequest& request = source.request;
  if (source.clip->tells_changes() && !std::holds_alternative<NoNoise>(request.noise)) {
    throw UsageError(format("{} holds events: its pixels' noise is not that of pictures, which is measured "
                            "between one and the next; state a tolerance instead",
                            source.name()),
                     {Setting::automatic_noise});
  }
  NoiseModel model{request.tolerance, std::nullopt, request.sigmas};
  if (std::holds_alternative<NoiseOfClip>(request.noise)) {
    model.camera = own_noise(source, open, memory, stop);
  } else if (const auto* stated = std::get_if<StatedNoise>(&request.noise)) {
    model.camera = stated->noise;
    if (auto note = transfer_note(*stated, source.capture.transfer))
      source.notes.emplace_back(std::move(*note));
    if (request.clip.scale || request.align) {
      std::vector settings{Setting::automatic_noise};
      if (request.clip.scale) settings.insert(settings.begin(), Setting::scale);
      source.notes.emplace_back(format("{} is the noise of single pixels, and a mean of several has less: changes "
                                       "below it are taken for noise; measure it on the clip itself",
                                       stated->name),
                                std::move(settings));
    }
  }
  return model;
}

// The picture that others are moved onto.
std::uint64_t reference_of(const AlignRequest& align, const ClipSource& source) {
  if (align.path) return (*align.path)->reference;
  if (!align.reference) return 0;
  const std::uint64_t announced = source.announced_samples();
  if (announced > 0) {
    // Pictures are counted without a rate.
    const Timeline timeline = align.reference->counts_samples()
                                  ? Timeline::constant(Rational{1, 1}, Timeline::kFullShutter, announced)
                                  : source.timeline(announced);
    return sample_at(*align.reference, "the picture to align to", timeline);
  }
  const ClipMoment moment = clip_moment(*align.reference, "the picture to align to");
  if (moment.is_picture && moment.value >= 0) return static_cast<std::uint64_t>(moment.value);
  throw UsageError(
      format("{} does not say how many pictures it has: name the one to align to by its number, 12f",
             source.name()));
}

// From here on the source's clip is one whose camera stands still, however often `open` opens it.
void align(ClipSource& source, OpenClip& open, const MemoryBudget& memory, const ReportedProgress& progress,
           const std::stop_token& stop) {
  AlignRequest& request = *source.request.align;
  const ClipToAlign clip{source.name(),
                         source.capture,
                         source.announced_samples(),
                         source.clip->info().decoder_bytes,
                         open,
                         reference_of(request, source)};
  source.clip.reset();
  if (!request.path) {
    request.path.emplace(find_camera_path(clip, request.motion, memory.bytes, progress, stop));
  }
  source.camera = request.path;
  open = [clip, path = *request.path, unseen = request.unseen] { return open_aligned(clip, path, unseen); };
  source.clip = open();
  source.capture.shape = source.clip->info().format.shape;
  const CameraPath& path = **source.camera;
  source.notes.emplace_back(
      alignment_text(path, shown_area(clip.name, path, request.unseen), request.unseen));
}

// From here on the source's clip has samples between its pictures.
void fill(ClipSource& source, const OpenClip& open, const MemoryBudget& memory, const ReportedProgress& progress,
          const std::stop_token& stop) {
  BetweenRequest& request = *source.request.between;
  if (source.clip->tells_changes()) {
    throw UsageError(
        format("{} holds events, each with its own time: there is nothing to make between them", source.name()),
        {Setting::between});
  }
  CaptureFormat pictures = source.capture;
  pictures.noise = {};
  const ClipToAlign clip{source.name(), pictures, source.announced_samples(), source.clip->info().decoder_bytes, open};
  source.clip.reset();
  if (!request.made) request.made.emplace(plan_between(clip, request, memory.bytes, progress, stop));
  source.clip = open_between(clip, *request.made);
  if ((*request.made)->count() > 0) {
    source.made = request.made;
  } else {
    source.notes.emplace_back(
        "no sample was made between two pictures: nothing that moves could be followed, or all steps are small");
  }
}

}  // namespace

CaptureFormat clip_format(const Clip& clip, const ClipOptions& options) {
  CaptureFormat capture = clip.info().format;
  if (options.transfer) capture.transfer = Transfer::restated(capture.transfer, *options.transfer);
  if (options.white_light && !options.white_code && !clip.info().holds_light) {
    std::string light = format("{:.6g}", *options.white_light);
    if (light.find_first_of(".e") == light.npos) light += ".0";
    throw UsageError(
        format("white '{}' is no code of the clip, a whole number of 1 … 65535; only floating-point pictures "
               "have a light of white",
               light),
        {Setting::white_code});
  }
  if (options.white_code && !clip.makes_codes()) {
    if (capture.code_bytes == 1 && *options.white_code > 255) {
      throw UsageError(
          format("white code {} does not fit the clip's 8-bit codes (255 at most)", *options.white_code));
    }
    capture.white_code = *options.white_code;
  }
  return capture;
}

// It is read once to count and once to decode.
void refuse_streams(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status) || !std::filesystem::is_other(status)) return;
  throw InputError(
      format("{} is no regular file: a clip is read more than once; name standard input as -, or save the stream to a "
             "file first",
             path.string()));
}

void ClipSource::check() const {
  if (!clip) throw UsageError(format("'{}': no clip was opened", name()));
  if (const std::string mistake = mistake_in(clip->info().format); !mistake.empty())
    throw InputError(format("{}: a clip {}", name(), mistake));
}

Timeline ClipSource::filmed(std::uint64_t sample_count) const {
  const std::uint64_t count = made ? (*made)->after.size() : sample_count;
  return request.shutter_angle ? timeline_of(name(), clip->info(), request.clip, *request.shutter_angle, count)
                               : timeline_of(name(), clip->info(), request.clip, count);
}

Timeline ClipSource::timeline(std::uint64_t sample_count) const {
  return made ? (*made)->times(filmed(sample_count)) : filmed(sample_count);
}

std::vector<Fact> ClipSource::facts(std::uint64_t sample_count) const {
  const ClipTiming& timing = clip->info().timing;
  const Timeline timeline = filmed(sample_count);
  const bool is_stated = request.clip.rate.has_value();
  Fact rate{rate_text(timeline), is_stated ? Origin::stated : Origin::file, Setting::frame_rate};
  if (!is_stated && !timing.rate_from.empty()) rate.source = timing.rate_from;
  const bool is_written_down = timing.exposed_ns || !timing.exposures.empty();
  Fact angle{format("shutter {} degrees", timeline.shutter_angle().text()),
             request.shutter_angle ? Origin::stated
             : is_written_down     ? Origin::file
                                   : Origin::assumed,
             Setting::shutter_angle};
  if (!request.shutter_angle && timing.exposed_ns) {
    angle.source = format("{}: {} ns", timing.exposed_from, *timing.exposed_ns);
  } else if (!request.shutter_angle && !timing.exposures.empty()) {
    angle.source = "the mean of the listed exposures";
  }
  std::vector<Fact> facts{std::move(rate), std::move(angle)};
  facts.insert(facts.end(), clip->info().facts.begin(), clip->info().facts.end());
  if (made) facts.push_back({(*made)->text(), Origin::stated, Setting::between});
  return facts;
}

std::optional<ClipSound> ClipSource::sound() const {
  std::optional<ClipSound> sound = clip->info().sound;
  if (!sound || announced_samples() < 2) return {};
  if (!request.clip.rate) sound->uneven_s = 0;
  const Timeline all = timeline(announced_samples());
  sound->filmed_s = static_cast<double>(all.start_ns(all.sample_count() - 1) - all.start_ns(0)) * 1e-9;
  return sound->filmed_s > 0 && sound->last_s > sound->first_s ? sound : std::nullopt;
}

std::vector<Note> ClipSource::all_notes(std::uint64_t sample_count) const {
  std::vector<Note> all = notes;
  const Timeline timeline = filmed(sample_count);
  const ClipTiming& timing = clip->info().timing;
  const bool is_written_down = !timing.exposures.empty() || (timing.exposed_ns && !request.shutter_angle);
  if (!is_written_down && !made) {
    if (auto note = gap_note(timeline)) all.push_back(std::move(*note));
  }
  const double rate = timeline.rate().value();
  const auto is_of_rate = [](const Note& note) {
    return std::ranges::find(note.settings, Setting::frame_rate) != note.settings.end();
  };
  const bool may_be_of_playing = !request.clip.rate && timing.rate_from.empty() &&
                                 std::ranges::none_of(notes, is_of_rate);
  if (may_be_of_playing && rate >= kLowestPlaybackRate && rate <= kHighestPlaybackRate) {
    all.emplace_back(format("the rate of {} a second comes from the file; slow-motion files state their "
                            "playback rate: if it was filmed faster, say so",
                            timeline.rate().text()),
                     std::vector{Setting::frame_rate});
  }
  return all;
}

ClipToRead ClipSource::clip_to_read() const {
  return {capture, clip->info().decoder_bytes, request.block_samples, announced_samples(),
          clip->tells_changes()};
}

ClipSource open_clip_source(const SourceRequest& request, const MemoryBudget& memory, const ReportedProgress& progress,
                            const std::stop_token& stop, OpenClip open) {
  const bool is_made = static_cast<bool>(open);
  if (!is_made) {
    refuse_streams(request.path);
    ClipOptions options = request.clip;
    // Pictures are decoded beside much else; a recording of events is held whole before anything else is allocated.
    options.decoder_bytes = is_event_recording(request.path) ? memory.bytes : memory.bytes / 8;
    open = [path = request.path, options] { return open_clip(path, options); };
  }
  if (request.path.empty()) throw UsageError("no clip is named");
  if (is_made) refuse_what_files_have(request);
  if (!(request.sigmas >= SourceRequest::kMinSigmas && request.sigmas <= SourceRequest::kMaxSigmas)) {
    throw UsageError(format("{} standard deviations of noise are not within {} … {}", request.sigmas,
                            SourceRequest::kMinSigmas, SourceRequest::kMaxSigmas));
  }
  ClipSource source;
  source.request = request;
  source.clip = open();
  source.check();
  if (request.shutter_angle && !request.clip.rate && !source.clip->info().timing.exposures.empty()) {
    throw UsageError(source.name() + " says how long each picture was exposed",
                     Advice{"; leave `shutter-angle` out, or the exposure_ns column empty"});
  }
  source.capture = clip_format(*source.clip, request.clip);
  source.made = source.clip->info().made;
  source.notes = source.clip->info().notes;
  if (request.clip.rate) {
    // What a stated rate was to help with is settled.
    std::erase_if(source.notes,
                  [](const Note& note) { return note.settings == std::vector{Setting::frame_rate}; });
    if (auto note = evened_note(source.clip->info().timing.starts_ns))
      source.notes.push_back(std::move(*note));
  }
  // Each look for something reads the clip.
  const auto [seeking_path, seeking_motion] = halves(progress, seeks_path(request) && seeks_motion(request));
  if (request.align) align(source, open, memory, seeking_path, stop);
  if (request.deflickered) {
    source.clip = deflicker(std::move(source.clip));
    open = [bare = std::move(open)] { return deflicker(bare()); };
  }
  source.capture.noise = noise_model(source, open, memory, stop);
  if (request.between) fill(source, open, memory, seeking_motion, stop);
  return source;
}

TwofoldProgress::TwofoldProgress(const SourceRequest& source, const ReportedProgress& progress) {
  std::tie(finding, reading) = halves(progress, seeks_path(source) || seeks_motion(source));
}

Timeline known_timeline(const SourceRequest& request, const MemoryBudget& memory) {
  if (is_tik(request.path)) return tik::Reader(request.path).timeline();
  SourceRequest timed = request;
  if (!timed.between) timed.align.reset();  // its times are those of the clip
  const ClipSource source = open_clip_source(timed, memory);
  const std::uint64_t count = source.announced_samples();
  if (count == 0) {
    throw InputError(format("{} does not say how many pictures it has; encode it first and name the capture",
                            source.name()));
  }
  return source.timeline(count);
}

}  // namespace nutik
