// What the window begins: studies, films, exports.
#include <QDoubleSpinBox>
#include <QFileInfo>
#include <algorithm>

#include "features/film/film_making.hpp"
#include "features/schema/requests.hpp"
#include "features/study/study_shot.hpp"
#include "media/formats/file_kinds.hpp"
#include "media/writers/picture_writer.hpp"
#include "session/requests/output_request.hpp"
#include "studio/window/main_window.hpp"
#include "studio/window/options_dialog.hpp"
#include "studio/window/started_work.hpp"

namespace nutik::studio {
namespace {

const StartingPoint& point_of(StudyStyle style) {
  return *std::ranges::find(starting_points(), std::optional(style), &StartingPoint::style);
}

}  // namespace

void MainWindow::choose_file(const StartingPoint* then) {
  ask_for_file(tr("Open"),
               tr("Clips, captures and projects (*.tik *.nutik *.mp4 *.mov *.mkv *.avi *.cine %1);;All files (*)")
                   .arg(QString::fromStdString(clip_patterns())),
               [this, then](const QString& path) { open(path, {}, then); });
}

// ---- starting points ----

void MainWindow::start_from(const StartingPoint& point) {
  if (!session_) {
    choose_file(&point);
  } else if (!point.style) {
    const std::int64_t start_ns = document_.mark_in().value_or(0);
    const std::int64_t end_ns = document_.mark_out().value_or(document_.duration_ns());
    document_.set_boxcar({start_ns, end_ns - start_ns}, tr("Long exposure"));
  } else if (point.style == StudyStyle::clean) {
    jobs_.start(tr("Looking for the empty scene"),
                making_plate(document_, session_,
                             [this](const QImage& plate, const Marks& marks) { show_plate(plate, marks); }));
  } else {
    start_study(usual_study(*point.style));
  }
}

void MainWindow::start_study(const StudyRequest& request) {
  if (!session_) return;
  notice_->clear();
  jobs_.start(tr("Looking for a subject"),
              [this, style = request.style, work = studying(document_, session_, request, told())](const Job& job) {
                try {
                  return work(job);
                } catch (const EverythingMoves&) {
                  const QString why = sentence_of(std::current_exception());
                  return Jobs::Finish([this, style, why] { offer_still_camera(style, why); });
                }
              });
}

void MainWindow::offer_still_camera(StudyStyle style, const QString& why) {
  if (!session_->is_clip() || document_.facts()->stated.contains("align"))
    return notice_->say(Notice::Kind::error, why);
  notice_->say(Notice::Kind::error, why, tr("Hold the camera still"), [this, style] {
    if (!document_.undo_stack().isClean() && !may_leave()) return;  // marks stay
    Stated still = document_.facts()->stated;
    still["align"] = std::string(to_text(kStudyMotion));
    Origin origin;
    origin.marks = document_.marks();
    origin.then = &point_of(style);
    open_capture_file(document_.facts()->path, still, std::move(origin));
  });
}

void MainWindow::choose_study() {
  if (!session_) return;
  StudyRequest request;
  const auto session = session_;
  const auto wanted = ask_options(
      this, {CommandId::study, tr("Motion study"), {"style", "moments", "spacing", "trail", "slit-from"}, {}, {},
             [&](const Wanted&, const Options& options) {
               request = study_request(options);
               if (!options.has("moments")) request.moments = usual_study(request.style).moments;
               request.joins_trail = false;
             }});
  if (!wanted || session != session_) return;
  request.style == StudyStyle::clean ? start_from(point_of(request.style)) : start_study(request);
}

void MainWindow::show_plate(const QImage& plate, const Marks& marks) {
  Glance glance = canvas_->glance();
  glance.instead = plate;
  glance.title = tr("Without what moves. Escape: back to the picture");
  canvas_->look(std::move(glance));
  plate_ = marks;
  const QString note =
      tr("The scene without what moves. It can be saved as a picture of its own; Escape goes back to the exposure.");
  notice_->say(Notice::Kind::note, note, tr("Save…"), [this, marks] { save_plate(marks); });
}

void MainWindow::save_plate(const Marks& marks) {
  ask_for_name(tr("Write the empty scene"), "-empty.png",
               tr("Pictures (%1)").arg(QString::fromStdString(picture_patterns())),
               [this, marks](const QString& path) { write_plate(path, marks); });
}

// ---- films ----

Stated MainWindow::film_options(ExposureMode of) const {
  Stated options{{"speed", QString::number(speed_->value()).toStdString()}};
  if (const auto out = document_.mark_out()) options.emplace("to", StatedTime::of_nanoseconds(*out).text());
  if (of == ExposureMode::functions) return options;  // which are in the capture's time, as long as they say
  options.emplace("out-angle", QString::number(angle_->value()).toStdString());
  if (const auto in = document_.mark_in()) options.emplace("from", StatedTime::of_nanoseconds(*in).text());
  return options;
}

void MainWindow::play_or_stop() {
  if (playing_.isActive()) return stop_playing();
  if (!session_) return;
  try_to([&] {
    DocumentState state = document_.state();
    state.mode = ExposureMode::boxcar;
    const FramesRequest request = film_request(state, options_in(CommandId::video, film_options(state.mode)));
    film_ = frames_of(request, document_.facts()->timeline);
    played_since_.start();
    played_rate_ = request.rate.value();
    playing_.start(std::max(static_cast<int>(1000 / played_rate_), 1));
    play_on();
  });
}

// As many frames as the device exposes in time; the film keeps its speed, and begins again at its end.
void MainWindow::play_on() {
  if (live_.is_busy()) return;
  const auto frame = static_cast<std::uint64_t>(static_cast<double>(played_since_.elapsed()) * played_rate_ / 1000);
  const Exposure exposure = film_->exposure(film_->numbers[frame % film_->numbers.size()]);
  document_.set_played(Boxcar{exposure.start_ns, exposure.end_ns - exposure.start_ns});
}

void MainWindow::stop_playing() {
  playing_.stop();
  document_.set_played({});
}

void MainWindow::choose_film() {
  if (!session_) return;
  const auto session = session_;
  const bool has_regions = document_.mode() == ExposureMode::functions;
  const QString title = has_regions ? tr("Export a film of the regions") : tr("Export a film");
  QString question;
  bool needs_project = false;
  Asked asked{CommandId::video,
              title,
              {"out-fps", "speed", "out-angle", "from", "to", "video-codec", "crf", "quality", "depth", "sound",
               "no-recipe"},
              {suggested("-film.mp4"), film_options(document_.mode())},
              tr("Films and numbered pictures (*.mp4 *.mov *.mkv *.webm *.gif *.webp *-%05d.png)"),
              [&](const Wanted& wanted, const Options& options) {
                needs_project = holds_recipes(wanted.path, wanted.options) && !has_files();
                Stated checked = wanted.options;
                if (needs_project) checked.emplace("no-recipe", "");  // as long as there is no file to name
                static_cast<void>(filming(document_, session_, devices_, files_, wanted.path, checked, {}, {}));
                question = stills_question(document_, *session_, wanted.path, options);
              }};
  if (has_regions) {
    std::erase(asked.options, std::string_view("out-angle"));
    asked.why = tr("The film begins with the picture that is shown, and the functions of its regions move on through "
                   "the capture. For a film with a shutter angle choose One interval for all, at the side.");
  }
  const auto wanted = ask_options(this, asked);
  if (!wanted || session != session_ || (needs_project && !ensure_files())) return;
  if (question.isEmpty() || is_wanted(this, title, question))
    export_film(wanted->path, wanted->options);
}

void MainWindow::export_film(const QString& path, const Stated& options) {
  if (!session_) return;
  try_to([&] {
    if (holds_recipes(path, options) && !names_files()) return;
    write(tr("Filming %1").arg(QFileInfo(path).fileName()),
          filming(document_, session_, devices_, files_, path, options, told_written(path),
                  [this](int signal) { autosave_.end(signal); }));
  });
}

// ---- pictures ----

bool MainWindow::names_files() {
  if (!has_files())
    notice_->say(Notice::Kind::error, tr("Save the project first: recipes name its files"));
  return has_files() && has_capture();
}

void MainWindow::choose_export() {
  if (!canvas_->glance().instead.isNull()) return save_plate(plate_);  // what is shown
  if (!ensure_files()) return;
  const auto session = session_;
  const auto wanted = ask_options(
      this, {CommandId::expose,
             tr("Export the picture"),
             {"depth", "quality", "out-transfer", "negative", "keep-pixels", "no-recipe"},
             {suggested_picture(), written_},
             tr("Pictures (%1)").arg(QString::fromStdString(picture_patterns())),
             [&](const Wanted& asked, const Options& options) {
               static_cast<void>(output_format(options.picture, asked.path.toStdString(), session_->format()));
               static_cast<void>(exporting(document_, session_, files_, asked.path, asked.options, {}));
             }});
  if (wanted && session == session_) export_picture(wanted->path, wanted->options);
}

void MainWindow::export_picture(const QString& path, const Stated& written) {
  if (!session_ || !names_files()) return;
  try_to([&] {
    write(tr("Writing %1").arg(QFileInfo(path).fileName()),
          exporting(document_, session_, files_, path, written, told_written(path)));
    written_ = written;
    exported_ = path;
  });
}

}  // namespace nutik::studio
