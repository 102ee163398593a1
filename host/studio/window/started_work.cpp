#include "studio/window/started_work.hpp"

#include <QDir>
#include <QFileInfo>
#include <span>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/function_text.hpp"
#include "features/film/film_making.hpp"
#include "features/masks/mask_making.hpp"
#include "features/plate/plate.hpp"
#include "media/stills/still_sequence.hpp"
#include "media/writers/picture_writer.hpp"
#include "media/writers/recipe.hpp"
#include "session/output_check.hpp"
#include "session/requests/output_request.hpp"
#include "session/text/number_text.hpp"
#include "studio/live/live_view.hpp"
#include "studio/live/opening.hpp"
#include "studio/window/options_dialog.hpp"
#include "system/is_absent.hpp"

namespace nutik::studio {
namespace {

QString text_of(std::span<const std::string> lines) {
  QStringList texts;
  for (const std::string& line : lines) texts += QString::fromStdString(line);
  return texts.join('\n');
}

std::vector<std::string> inputs_of(const Document& document, const CommandFiles& files, const QString& picture) {
  std::vector<std::string> inputs = clip_files(document.facts()->path, picture);
  if (document.mode() == ExposureMode::boxcar) return inputs;
  for (const QString& file : {files.functions, document.state().mask ? files.mask : QString()})
    if (!file.isEmpty()) inputs.push_back(file.toStdString());  // of a project that is not saved yet: none
  return inputs;
}

std::optional<Shared<MaskWithRegions>> exposed_mask(const DocumentState& state) {
  if (!state.mask || state.mode == ExposureMode::boxcar) return {};
  return LiveView::feathered_mask(state);
}

// A function of a stretch in the whole capture's time: nothing outside of it.
GainFunction placed(const GainFunction& function, const Stretch& stretch) {
  const std::int64_t duration_ns = stretch.session->timeline().duration_ns();
  std::vector<ControlPoint> points{{0, 0}};
  const auto add = [&points](ControlPoint point) {
    if (point != points.back()) points.push_back(point);
  };
  for (const GainPiece& piece : function.pieces(duration_ns)) {
    add({piece.begin_ns, piece.begin_gain});
    add({piece.end_ns, piece.end_gain});
  }
  add({duration_ns, 0});
  return GainFunction(std::move(points)).shifted(stretch.start_ns);
}

DocumentState state_of(const DocumentState& before, const Study& study, Mask mask, const Stretch& stretch,
                       const Timeline& whole, StudyStyle style) {
  const Timeline& timeline = stretch.session->timeline();
  const bool is_part = timeline.sample_count() < whole.sample_count();
  DocumentState state = before;
  state.looks.clear();
  state.functions.clear();
  Interval live{whole.duration_ns(), 0};  // of them all: what the time strip has for an interval
  for (const auto& [tag, function] : study.functions) {
    const GainFunction exposed = is_part ? placed(function, stretch) : function;
    const Interval its = summarize(exposed, whole.duration_ns()).live;
    if (!its.empty()) live = {std::min(live.begin_ns, its.begin_ns), std::max(live.end_ns, its.end_ns)};
    state.functions.emplace(tag, with_steps(exposed));
  }
  if (!live.empty()) state.boxcar = {live.begin_ns, live.end_ns - live.begin_ns};
  const bool is_slit = style == StudyStyle::slit;
  for (const auto& [tag, function] : state.functions) {
    const std::size_t moment = is_slit ? tag : tag - std::size_t{1};
    if (moment >= study.moments.size()) continue;  // what is left around the subject
    const std::string time = duration_text(stretch.start_ns + timeline.start_ns(study.moments[moment]));
    state.looks[tag] = {Document::tr("At %1").arg(QString::fromStdString(time)), first_colour(tag), true};
  }
  state.mask = Shared(MaskWithRegions(std::move(mask)));
  state.mode = ExposureMode::functions;
  state.normalization = Normalization::parse("integral");
  state.order.clear();
  state.covered.clear();
  state.feather = {is_slit ? 0 : kStudyFeatherCentipixels, {}};
  return state;
}

}  // namespace

std::vector<std::string> clip_files(const QString& clip, const QString& picture) {
  const QFileInfo from(clip), to(picture);
  const bool is_folder = from.isDir();
  const bool is_there = QFileInfo(to.path()) == QFileInfo(is_folder ? clip : from.path());
  if (is_there && (is_folder || (is_pattern(clip) && QDir::match(from.fileName(), to.fileName()))))
    throw UsageError(format("{} would be taken for one of the clip's stills; choose another folder",
                            picture.toStdString()));
  std::vector<std::string> files{clip.toStdString()};
  for (const auto& still : list_stills(files.front()).value_or(std::vector<std::filesystem::path>{}))
    files.push_back(still.string());
  return files;
}

std::span<const StartingPoint> starting_points() {
  static constexpr StartingPoint kAll[] = {
      {StudyStyle::trail, QT_TRANSLATE_NOOP("nutik::studio::Document", "&Motion study"),
       QT_TRANSLATE_NOOP("nutik::studio::Document", "Sharp moments over the trail of the whole way")},
      {StudyStyle::strobe, QT_TRANSLATE_NOOP("nutik::studio::Document", "&Strobe"),
       QT_TRANSLATE_NOOP("nutik::studio::Document", "Sharp moments, and nothing between them")},
      {StudyStyle::rear_curtain, QT_TRANSLATE_NOOP("nutik::studio::Document", "&Rear curtain"),
       QT_TRANSLATE_NOOP("nutik::studio::Document", "The last moment, and a trail that grows towards it")},
      {StudyStyle::frozen, QT_TRANSLATE_NOOP("nutik::studio::Document", "&Frozen subject"),
       QT_TRANSLATE_NOOP("nutik::studio::Document", "One moment in a scene that is exposed for all of the time")},
      {StudyStyle::slit, QT_TRANSLATE_NOOP("nutik::studio::Document", "S&lit-scan"),
       QT_TRANSLATE_NOOP("nutik::studio::Document", "Strips side by side, each at a moment of its own")},
      {StudyStyle::clean, QT_TRANSLATE_NOOP("nutik::studio::Document", "Remove &people"),
       QT_TRANSLATE_NOOP("nutik::studio::Document", "The empty scene, without what moves")},
      {std::nullopt, QT_TRANSLATE_NOOP("nutik::studio::Document", "Lon&g exposure"),
       QT_TRANSLATE_NOOP("nutik::studio::Document", "All of the time in one picture: silky water, trails of light")}};
  return kAll;
}

StudyRequest usual_study(StudyStyle style) {
  StudyRequest request;
  request.style = style;
  if (style != StudyStyle::slit) request.moments = usual_moments(style);  // few strips: each is edited by hand
  return request;
}

Jobs::Work studying(Document& document, std::shared_ptr<Session> session, const StudyRequest& request, Told told) {
  return [&document, session = std::move(session), request, told = std::move(told), marks = document.marks(),
          path = document.facts()->path](const Job& job) -> Jobs::Finish {
    const std::string name = path.toStdString();
    const MemoryBudget& memory = session->devices().request().memory;
    const Stretch stretch = stretch_between(marks, session, job);
    auto study =
        std::make_shared<Study>(plan_study(stretch.session->capture(), name, request, memory, job.progress));
    return [&document, session, stretch, study, style = request.style, told] {
      document.apply(state_of(document.state(), *study, std::move(study->regions.mask), stretch,
                              session->timeline(), style),
                     Document::tr("Starting point"));
      const QString notes = text_of(study->notes);
      told(notes.isEmpty() || stretch.start_ns == 0
               ? notes
               : notes + Document::tr("\nTimes and pictures count from In."));
    };
  };
}

Jobs::Work making_plate(const Document& document, std::shared_ptr<Session> session,
                        std::function<void(QImage, Marks)> show) {
  return [session = std::move(session), show = std::move(show), marks = document.marks(),
          name = document.facts()->path.toStdString()](const Job& job) -> Jobs::Finish {
    const MadePlate plate = make_plate(stretch_between(marks, session, job).session->capture(), name, {},
                                       screen_format(), session->devices().request().memory, job.progress);
    return [show, image = image_of(plate.picture), marks] { show(image, marks); };
  };
}

Jobs::Work writing_plate(const Marks& marks, std::shared_ptr<Session> session, const QString& picture,
                         Told told) {
  const std::filesystem::path path = picture.toStdString();
  const std::string name = session->source().path.string();
  check_output(path, OutputKind::picture, clip_files(QString::fromStdString(name), picture));
  return [session = std::move(session), path, name, told = std::move(told), marks](const Job& job) -> Jobs::Finish {
    const MadePlate plate = make_plate(stretch_between(marks, session, job).session->capture(), name, {},
                                       output_format({}, path, session->format()),
                                       session->devices().request().memory, job.progress);
    write_picture(path, plate.picture);
    const QString line =
        Document::tr("%1: the scene without what moves").arg(QString::fromStdString(path.string()));
    return [told, line] { told(line); };
  };
}

Jobs::Work exporting(const Document& document, std::shared_ptr<Session> session, const CommandFiles& files,
                     const QString& picture, const Stated& written, Told told) {
  const std::filesystem::path path = picture.toStdString();
  const Options options = options_in(CommandId::expose, written);
  check_quality(options.picture, path);
  check_output(path, OutputKind::picture, inputs_of(document, files, picture));
  return [state = document.state(), sources = recipe_sources(document, files, written), options,
          session = std::move(session), path, told = std::move(told),
          precision = document.facts()->precision](const Job& job) -> Jobs::Finish {
    RenderControl control;
    control.stop = job.stop;
    control.precision = precision;
    control.is_chosen = true;
    PictureRecipe recipe(sources);
    const ExposedPicture exposed =
        session->render(exposure_of(state, exposed_mask(state)),
                        output_format(options.picture, path, session->format()), control);
    const std::string text = recipe.text(to_text(exposed.precision), {}, exposed.error_bound());
    const FileWishes wishes = file_wishes(options.picture);
    write_picture(path, exposed.picture, options.no_recipe ? std::string() : text, wishes);
    const Shape shape = written_shape(path, exposed.picture.shape, exposed.picture.pixel_aspect, wishes);
    const bool is_within = exposed.saturation.below + exposed.saturation.above == 0;
    const QString line = Jobs::tr("%1 was written: %2, %3")
                             .arg(QString::fromStdString(path.string()), QString::fromStdString(shape_text(shape)),
                                  is_within ? Jobs::tr("no pixel is clipped")
                                            : QString::fromStdString(saturated_text(exposed.saturation)));
    return [told, line] { told(line); };
  };
}

FramesRequest film_request(const DocumentState& state, const Options& options) {
  FramesRequest request = options.film;
  request.exposure = exposure_of(state, exposed_mask(state));
  return request;
}

QString stills_question(const Document& document, const Session& session, const QString& film,
                        const Options& options) {
  const FramesRequest request = film_request(document.state(), options);
  const VideoOutput output(film.toStdString(), request.rate, options.video_codec, options.picture);
  if (!output.writes_stills()) return {};
  const std::vector<std::uint64_t> numbers = frames_of(request, session.timeline()).numbers;
  const auto there = std::ranges::count_if(numbers, [&](auto number) { return !is_absent(output.still(number)); });
  if (there == 0) return {};
  return Document::tr("%1 of %2 pictures are there. Replace them?").arg(there).arg(numbers.size());
}

bool holds_recipes(const QString& film, const Stated& written) {
  const Options options = options_in(CommandId::video, written);
  const VideoOutput output(film.toStdString(), options.film.rate, options.video_codec, options.picture);
  return output.writes_stills() && !options.no_recipe;
}

Jobs::Work filming(const Document& document, std::shared_ptr<Session> session, std::shared_ptr<Devices> devices,
                   const CommandFiles& files, const QString& film, const Stated& written, Told told,
                   std::function<void(int signal)> end) {
  const Options options = options_in(CommandId::video, written);
  const FramesRequest request = film_request(document.state(), options);
  const VideoOutput output(film.toStdString(), request.rate, options.video_codec, options.picture);
  const Frames frames = frames_of(request, session->timeline());
  output.check(frames.numbers, inputs_of(document, files, output.writes_stills() ? film : QString()), Replacing::all);
  std::optional<RecipeSources> sources;
  if (holds_recipes(film, written))
    sources = recipe_sources(document, files, written, CommandId::video);
  const CaptureFacts& facts = *document.facts();
  const auto between =
      facts.stated.contains("between") ? std::nullopt : joining_samples(request, frames, *session);
  // The live view goes on with its own.
  ComputingRequest computing = devices->request();
  computing.memory.bytes /= 2;
  return [request, output, session = std::move(session), computing, film, between, sources, stated = facts.stated,
          clip = facts.path, told = std::move(told), end = std::move(end), sound = options.sound,
          precision = sources ? facts.precision : std::nullopt](const Job& job) -> Jobs::Finish {
    std::shared_ptr<Session> filmed = session;
    auto of_stills = sources;
    QStringList notes;
    if (between) {
      Stated joined = stated;
      joined["between"] = between->text();
      try {
        filmed = open_capture(clip, joined, std::make_shared<Devices>(computing), job).session;
        if (of_stills) of_stills->made.options.emplace_back("between", between->text());
        notes = {Document::tr("Samples were made between pictures %1 … %2, so that no frame shows what moves two or "
                              "three times.").arg(between->first).arg(between->last)};
      } catch (const Error& error) {
        if (!is_refusal(error)) throw;
        notes = {Document::tr("Its frames show what moves two or three times: %1").arg(sentence(error.what()))};
      }
    }
    const Frames frames = frames_of(request, filmed->timeline());
    PictureRecipe recipe(std::move(of_stills));
    const auto recipe_of = [&](std::uint64_t frame, const Exposure&, const ExposedPicture& exposed) {
      return recipe.text(to_text(exposed.precision), frame_recipe(request, frames, frame, {}), exposed.error_bound());
    };
    const MadeVideo made = make_video(*filmed, request, frames, output, job.progress, recipe_of, sound, precision);
    const QString line = made.interruption
                             ? Document::tr("%1: %2 of %3 frames were written")
                             : Document::tr("%1: %n frame(s)", nullptr, static_cast<int>(made.frames));
    const auto count = [](std::size_t frames) { return QString::number(frames); };
    QStringList lines{made.interruption ? line.arg(film, count(made.frames), count(frames.numbers.size()))
                                        : line.arg(film)};
    lines += notes;
    for (const std::string& note : made.notes) lines += sentence(note);
    return [told, lines, end, interruption = made.interruption] {
      told(lines.join('\n'));
      if (interruption) end(interruption->signal);
    };
  };
}

}  // namespace nutik::studio
