#include <algorithm>
#include <utility>

#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/report.hpp"
#include "app/words/stated_requests.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "features/film/film_making.hpp"
#include "features/schema/option.hpp"
#include "features/series/series_making.hpp"
#include "session/text/number_text.hpp"

namespace nutik::app {

static Json sound_json(const ClipSound& of_clip, const FilmSound& of_film) {
  return {{"codec", of_clip.codec},      {"track", of_clip.track},     {"tracks", of_clip.tracks},
          {"start_s", of_film.start_s}, {"speed", of_film.speed}, {"seconds", of_film.seconds}};
}

// `options` and the session get the samples of joining_samples(), unless they state some; returns what is said of it.
static std::string join_pictures(Options& options, Session& session, const Session::Terms& terms,
                                 const FramesRequest& request, const Frames& frames) {
  const auto between = options.joins_by_itself() ? joining_samples(request, frames, session) : std::nullopt;
  if (!between) return {};
  const auto say = [&](std::string text) {
    if (!options.quiet && !options.json) print_note("note: " + text);
    return text;
  };
  Options joined = options;
  option_of(CommandId::video, "between")->restate(joined, {between->text()});
  static_cast<void>(Session(std::move(session)));  // ended, before another takes its memory
  try {
    session = open_session(joined, terms, "making samples between pictures");
    options = std::move(joined);
    return say(
        format("a quarter of the frames or more would show what moves two or three times: samples are "
               "looked for between pictures {} … {}, which takes most of the time; --between off leaves them out",
               between->first, between->last));
  } catch (const Error& error) {
    // Parts of one film are alike.
    if (!is_refusal(error) || request.numbers || options.skip_existing) throw;
    session = open_session(options, terms);
    return say(format("frames show what moves two or three times: samples cannot be made: {}", error.what()));
  }
}

int run_video(const Options& stated) {
  Options options = stated;
  ExposureTally tally;
  static_cast<void>(stated_output(options, "video"));  // files before what is asked of them
  const FramesRequest request = frames_request(options);
  std::string rate = request.rate.text();
  std::ranges::replace(rate, '/', '_');
  const VideoOutput output(output_name(options, "video", format("-{}fps.mp4", rate)), request.rate,
                           options.video_codec, options.picture);
  const std::vector<std::string> inputs = input_files(options);
  const BoundsMaps maps(options, true, "a video");
  if (maps.are_asked() && output.loses()) {
    throw UsageError(format("--bounds: {} loses more than a map counts; write ffv1 in a .mkv, or numbered stills",
                            output.kind()));
  }
  if (options.skip_existing) require_recipes(options, output.writes_stills() ? output.still(0) : output.path());
  output.check({}, inputs, replacing(options));  // a container's name, before the clip is read

  const Session::Terms terms{.besides = video_needs(output.encoder_frames(), [&](const CaptureFormat& format) {
                               return output.frame_format(format).type;
                             })};
  Session session = open_session(options, terms);
  const Shape shape = output.shape(session.format());
  Frames frames = frames_of(request, session.timeline());
  if (!frames.warning.empty()) print_warning(frames.warning);
  output.check(frames.numbers, inputs, replacing(options));
  const std::string joined = join_pictures(options, session, terms, request, frames);
  PictureRecipe recipe(output.writes_stills() ? recipe_sources(options) : std::nullopt);
  const auto own_recipe_of = [&](std::uint64_t frame) {
    return frame_recipe(request, frames, frame, output.still(frame).stem().string() + ".fn");
  };
  const std::size_t wanted = frames.numbers.size();
  if (options.skip_existing) {
    std::erase_if(frames.numbers, [&](std::uint64_t frame) {
      return is_made(output.still(frame), stated_precision(options), maps.of(frame),
                     [&](const std::string& precision) { return recipe.text(precision, own_recipe_of(frame)); });
    });
    if (frames.numbers.empty()) return tell_all_made(options, output.path(), wanted, "frame");
  }
  for (const std::uint64_t frame : frames.numbers)
    maps.check(frame, inputs, output.writes_stills() ? output.still(frame) : output.path(), replacing(options));
  std::string codes;  // how the frames differ from the capture
  Json told = Json::array();
  const MadeVideo made = [&] {
    WarningsAtEnd warnings;
    return make_video(
        session, request, frames, output, progress_bar("exposing", options.quiet, progress_lines(options)),
        [&](std::uint64_t frame, const Exposure&, const ExposedPicture& exposed) {
          tally.add(exposed);
          told.push_back({{"frame", frame}});
          told.back().update(uncertainty_json(exposed.uncertainty, exposed.output));
          const auto map = maps.write(frame, exposed);
          codes = codes_text(exposed.figures.capture, exposed.output);
          warnings.add(format("frame {}", frame), exposure_warnings(exposed));
          return output.writes_stills() ? recipe.text(tally.precision(), own_recipe_of(frame), tally.error_bound(), map)
                                        : std::string();
        },
        options.sound);
  }();
  const std::string name = output.path().string();
  if (made.interruption) {
    print_note(format("{}: {} of {} frames were written", name, made.frames, frames.numbers.size()));
    throw *made.interruption;
  }

  const auto [start_ns, end_ns] = frames.span();
  Answer answer{{{"video", name}, {"kind", output.kind()}}};
  if (maps.are_asked()) answer.json["bounds_maps"] = *options.picture.bounds;
  tally.wrote(session.format(), shape, {});
  answer.json.update(shape_json(shape));
  answer.json.update({{"frames", frames.numbers.size()},
                      {"skipped", wanted - frames.numbers.size()},
                      {"frames_a_second", request.rate.text()},
                      {"start_ns", start_ns},
                      {"end_ns", end_ns},
                      {"sound", made.sound ? sound_json(*session.sound(), *made.sound) : nullptr}});
  answer.line = format("{}: {}, {} ({}), from {} to {} of the capture, {}", name, shape_text(shape),
                       counted(frames.numbers.size(), "frame"), request.text(), duration_text(start_ns),
                       duration_text(end_ns), output.kind() + codes);
  answer.json["pictures"] = std::move(told);
  if (wanted > frames.numbers.size())
    answer.line += format(", {} there already", counted(wanted - frames.numbers.size(), "frame"));
  tally.end(answer, session, options.verbose);
  answer.tell_source(session, stated);
  if (!joined.empty() && options.json) answer.notes.push_back(joined);  // else it was said in time
  std::ranges::copy(made.notes, std::back_inserter(answer.notes));
  if (output.writes_stills()) note_later(answer.notes, [&](std::uint64_t k) { return output.still(k); }, frames.count);
  return tell(options, output.path(), answer);
}

}  // namespace nutik::app
