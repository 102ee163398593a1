#include "features/film/film_making.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "capture/format.hpp"
#include "exposure/function_text.hpp"
#include "features/series/picture_queue.hpp"
#include "media/events/event_clip.hpp"
#include "media/formats/numbered_name.hpp"
#include "media/input_checksum.hpp"
#include "media/writers/picture_writer.hpp"
#include "system/input_bytes.hpp"
#include "system/is_absent.hpp"

namespace nutik {

std::optional<BetweenRequest> joining_samples(const FramesRequest& request, const Frames& frames,
                                              const Session& session) {
  const std::string clip = session.source().path.string();
  if (!session.is_clip() || request.exposure.plan.combine != Combine::integral) return {};
  if (is_event_recording(clip)) return {};
  const auto seen = seen_together(frames, session.timeline());
  if (!seen) return {};
  return BetweenRequest{.first = seen->first, .last = seen->last - 1};
}

OwnRecipe frame_recipe(const FramesRequest& request, const Frames& frames, std::uint64_t frame,
                       const std::string& functions_name) {
  OwnRecipe own = own_recipe(frames.exposure(frame), request.exposure.is_plain());
  if (request.keys.empty()) return own;
  const std::int64_t film_ns = frames.film->start_ns(frame);
  if (!request.keys.functions.empty()) {
    std::string text;
    for (const auto& [tag, function] : request.keys.functions_at(film_ns))
      text += function_text(tag, function) + "\n";
    own.functions = Recipe::Text{functions_name, std::move(text)};
  }
  if (request.keys.masks.empty()) return own;
  const auto input = [&](std::size_t key) {
    const MaskKey& mask = request.keys.masks[key];
    return Recipe::Input{input_name(mask.name), mask.checksum};
  };
  const auto [key, way] = request.keys.mask_moment(film_ns);
  own.mask = input(key);
  own.options["mask-blend"] = {};  // says nothing of one mask
  if (way == 0) return own;
  own.mask_to = input(key + 1);
  own.options["mask-share"] = Rational::of(way, kWholeWay).text();
  own.options["mask-blend"] = request.keys.blend == MaskBlend::alpha ? "alpha" : "distance";
  return own;
}

namespace {

std::filesystem::path file_of(const Session& session) {
  const std::filesystem::path& clip = session.source().path;
  return is_standard_input(clip.string()) ? standard_input_file() : clip;
}

// The part of the clip's sound that is heard with these frames; says in `notes` why there is none.
std::optional<FilmSound> film_sound(const Session& session, const FramesRequest& request, const Frames& frames,
                                    const VideoOutput& output, FilmSoundWish wish, std::vector<std::string>& notes) {
  const auto& found = session.sound();
  if (wish == FilmSoundWish::stretched && !found)
    notes.push_back(format("{} has no sound to stretch", input_title(session.source().path.string())));
  if (wish == FilmSoundWish::none || !found) return {};
  const auto left_out = [&](const std::string& why) {
    notes.push_back(format("the clip's sound is left out: {}", why));
    return std::nullopt;
  };
  if (!output.holds_sound()) return left_out(format("{} holds none", output.path().extension().string()));
  if (frames.curve) return left_out("the film's speed changes");
  if (frames.numbers.back() - frames.numbers.front() + 1 != frames.numbers.size())
    return left_out("the film has not all of its frames");
  const double file_s = (found->last_s - found->first_s) / found->filmed_s;  // of the file in a filmed second
  FilmSound sound{file_of(session), 0.0, request.speed.value() * file_s,
                  static_cast<double>(frames.numbers.size()) / request.rate.value()};
  const std::int64_t start_ns = frames.times.start_ns(frames.numbers.front());
  sound.start_s = found->first_s + file_s * static_cast<double>(start_ns) * 1e-9;
  sound.is_cut = start_ns > 0;
  if (found->uneven_s / sound.speed * request.rate.value() > 1.0)
    return left_out("the file's pictures do not lie at even times, as the rate that was stated has them");
  // Where both run as fast but for what half a frame comes to at the film's end, packets stay as they are.
  if (std::abs(sound.speed - 1.0) * sound.seconds * request.rate.value() < 0.5) sound.speed = 1.0;
  sound.is_asked = wish == FilmSoundWish::stretched;
  if (sound.speed != 1.0 && !sound.is_asked)
    return left_out(
        format("the film runs {:.4g} times as fast as the file, and stretching it was not asked for", sound.speed));
  if (sound.speed < 9e-6 || sound.speed > 1100)  // a little more than is told, for the file's own speed is measured
    return left_out("it gets at most 100000 times slower or 1000 times faster");
  if (found->tracks > 1)
    notes.push_back(format("the clip has {} tracks of sound, and the film track {}, which players take, too ({})",
                           found->tracks, found->track, found->codec));
  return sound;
}

// Whether no light becomes more than it was: what the clip says of its brightest then holds for the film. Between keys
// of masks a pixel has a function that one of both gives it, or shares of several.
bool is_nowhere_brighter(FramesRequest request, const Frames& frames, const Timeline& timeline) {
  constexpr double kRounding = 1e-9;
  const auto masks = std::exchange(request.keys.masks, {});
  const auto is_no_brighter = [&](std::uint64_t frame) {
    const ExposureRequest wanted = exposure_of(request, frames, frame);
    const bool is_sum = wanted.plan.combine == Combine::integral && !wanted.delay;
    return std::ranges::all_of(functions_of(wanted, frames.exposure(frame), timeline), [&](const auto& each) {
      const GainFunction& function = each.second;
      return (is_sum ? summarize(function, timeline.duration_ns()).error_scale() : function.largest_gain()) <=
             1 + kRounding;
    });
  };
  if (masks.empty()) return std::ranges::all_of(frames.numbers, is_no_brighter);
  return std::ranges::all_of(masks, [&](const auto& key) {
    request.exposure.mask.emplace(MaskWithRegions(*key.mask));
    return std::ranges::all_of(frames.numbers, is_no_brighter);
  });
}

}  // namespace

MadeVideo make_video(Session& session, const FramesRequest& request, const Frames& frames,
                     const VideoOutput& output, const ReportedProgress& progress,
                     const std::function<std::string(std::uint64_t frame, const Exposure& exposure,
                                                     const ExposedPicture& exposed)>& add,
                     FilmSoundWish wish, std::optional<Precision> precision) {
  CaptureFormat capture = session.format();
  const PlanOptions plan = plan_options_of(request.exposure, capture.shape);
  const bool mask_changes = !request.keys.masks.empty();
  const Mask mask = mask_changes ? Mask() : mask_of(exposure_of(request, frames, 0), capture.shape);
  const OutputFormat frame_format = output.frame_format(capture);
  if (plan.transfer) capture.transfer = Transfer::restated(capture.transfer, *plan.transfer);

  MadeVideo made;
  std::vector<std::string> sound_notes;
  VideoFormat video;
  video.sound = film_sound(session, request, frames, output, wish, sound_notes);
  video.repeats_chroma = session.repeats_chroma();
  const Transfer curve = CodeMaking::of(capture, frame_format).transfer;
  if (session.is_clip() && curve == session.format().transfer &&
      (curve == Transfer::pq() || curve == Transfer::hlg()) && frame_format.negative != NegativeLight::offset &&
      is_nowhere_brighter(request, frames, session.timeline()))
    video.graded = file_of(session);
  const TimeToEnd is_kept;  // the frames so far, whatever a frame takes
  std::unique_ptr<VideoWriter> writer;  // none of stills
  const Shape written = output.shape(capture);
  const auto write = [&](Channel<PictureJob>& jobs) {
    // An encoder takes a while to load.
    if (!output.writes_stills()) writer = output.open(capture, frame_format, video);
    while (const auto job = jobs.pop()) {
      if (!writer) job->write();
      else if (job->picture.shape == written) writer->write(job->picture);
      else writer->write(in_square_pixels(job->picture, written));
    }
  };
  PictureQueue queue(write, session.waiting_pictures(frame_format.type));
  PictureLine<ExposedPicture> line(session.pictures_at_once(frame_format.type, frames.numbers.size()));
  const auto expose = [&](std::uint64_t frame, RenderControl control) {
    control.precision = precision;
    control.is_chosen = precision.has_value();
    const ExposureRequest wanted = exposure_of(request, frames, frame);
    const FunctionSet functions = functions_of(wanted, frames.exposure(frame), session.timeline());
    return session.render(functions, mask_changes ? mask_of(wanted, capture.shape) : mask, plan, frame_format,
                          control);
  };
  try {
    const auto work_of = [&](std::size_t k) {
      return [&expose, frame = frames.numbers[k]](const RenderControl& control) { return expose(frame, control); };
    };
    line.make(frames.numbers.size(), progress, work_of, [&](std::size_t k, ExposedPicture exposed) {
      const std::uint64_t frame = frames.numbers[k];
      std::string text = add ? add(frame, frames.exposure(frame), exposed) : std::string();
      const auto path = output.writes_stills() ? output.still(frame) : output.path();
      if (!queue.push({frame, path, std::move(exposed.picture), std::move(text), output.wishes()})) return false;
      ++made.frames;
      return true;
    });
  } catch (const Interrupted& caught) {
    // A part of a video does not replace a whole one.
    if (made.frames == 0 || (!output.writes_stills() && !is_absent(output.path()))) throw;
    made.interruption = caught;
    clear_interruption();  // what was exposed is still to be written
  }
  queue.finish();
  if (writer) {
    writer->finish();
    made.notes = writer->notes();
    if (writer->has_sound()) made.sound = video.sound;
  }
  // Where the writer left it out, its own note says so.
  if (!video.sound || made.sound) std::ranges::move(sound_notes, std::back_inserter(made.notes));
  return made;
}

VideoOutput::VideoOutput(std::filesystem::path path, Rational rate, const std::optional<std::string>& codec,
                         const OutputRequest& request)
    : path_(std::move(path)), rate_(rate), request_(request) {
  if (names_standard_output(path_)) {
    throw UsageError(
        format("{} is standard output, and a video is written to a file: what makes it goes back in it",
               path_.string()));
  }
  if (request.crf && is_picture_name(path_))
    throw UsageError("that is a film's quality, on its codec's scale; pictures have none", {Setting::crf});
  const auto numbered = NumberedName::parse(path_.filename().string());
  const bool is_numbered = numbered.has_value();
  if (numbered) numbered->expect_one(path_.string());
  if (is_picture_name(path_) && is_numbered) {
    if (codec) {
      throw UsageError(format("a video's codec goes with a video in one file; {} are stills", path_.string()),
                       {Setting::video_codec});
    }
    return;
  }
  if (is_picture_name(path_)) {
    throw UsageError(format("{} is one picture and a video has many; number them: {}-%05d{}", path_.string(),
                            (path_.parent_path() / path_.stem()).string(), path_.extension().string()));
  }
  codec_ = &video_codec_for(path_, codec);
  codec_setting_ =
      codec_setting(*codec_, request.crf,
                    request.quality ? std::optional(static_cast<std::uint32_t>(*request.quality)) : std::nullopt);
  if (const double largest = largest_rate_for(path_); rate.value() > largest) {
    throw UsageError(
        format("{}: a {} file tells at most {:.0f} frames a second apart, and {} are asked for; write {}",
               path_.string(), path_.extension().string(), largest, rate.text(),
               largest < 100'000 ? "a .mp4 or .mov, or numbered stills" : "numbered stills"));
  }
}

OutputFormat VideoOutput::frame_format(const CaptureFormat& capture) const {
  if (codec_ == nullptr) return output_format(request_, path_, capture);
  OutputRequest request = request_;
  request.quality.reset();  // which the codec was told
  OutputFormat output =
      output_format(request, path_, video_value_type(*codec_, request_.depth, code_type(capture)), capture);
  output.white_code = output.type == ValueType::code8 ? 255 : 65'535;  // what players take for white
  return output;
}

void VideoOutput::check(std::span<const std::uint64_t> frames, std::span<const std::string> inputs,
                        Replacing replacing) const {
  if (codec_ != nullptr) {
    check_output(path_, OutputKind::video, inputs, replacing);
    return;
  }
  for (const std::uint64_t frame : frames) {
    // What is not there yet can be no input; the first tells whether they may be there.
    if (frame == frames.front() || !is_absent(still(frame)))
      check_output(still(frame), OutputKind::picture, inputs, replacing);
  }
}

std::filesystem::path VideoOutput::still(std::uint64_t frame) const {
  return path_.parent_path() / NumberedName::parse(path_.filename().string()).value().with(frame);
}

// Encoders of H.264 and H.265 take no more.
static constexpr std::uint32_t kLargestFrameSide = 16'384;

Shape VideoOutput::shape(const CaptureFormat& capture) const {
  const FileWishes wishes = file_wishes(request_);
  if (codec_ == nullptr) return written_shape(path_, capture.shape, capture.pixel_aspect, wishes);
  if (!wishes.square_pixels || codec_->is_lossless) return capture.shape;
  Shape shape = capture.shown_shape();
  const bool pairs = codec_->pairs_pixels;
  if (shape.width != capture.shape.width) shape.width += pairs ? shape.width % 2 : 0;
  if (shape.height != capture.shape.height) shape.height += pairs ? shape.height % 2 : 0;
  return std::max(shape.width, shape.height) <= kLargestFrameSide ? shape : capture.shape;
}

std::unique_ptr<VideoWriter> VideoOutput::open(const CaptureFormat& capture, const OutputFormat& format,
                                               VideoFormat video) const {
  const CodeMaking making = CodeMaking::of(capture, format);
  video.shape = shape(capture);
  video.type = format.type;
  video.white_code = format.white_code;
  video.transfer = making.transfer;
  video.rate = rate_;
  video.primaries = making.primaries;
  if (video.shape == capture.shape) video.pixel_aspect = capture.pixel_aspect;
  video.codec_setting = codec_setting_;
  return open_video_writer(path_, video, *codec_);
}

bool VideoOutput::holds_sound() const {
  return codec_ != nullptr && codec_->name != "gif" && codec_->name != "webp";
}

std::string VideoOutput::kind() const { return writes_stills() ? "stills" : std::string(codec_->name); }

}  // namespace nutik
