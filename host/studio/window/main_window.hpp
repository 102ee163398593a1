// The window: canvas, regions, time and curves around one document, and the files that it comes from.
//
//   always:  nothing here waits: captures are opened, measured and written by jobs. What fails is said above the
//            picture
#pragma once

#include <QDateTime>
#include <QElapsedTimer>
#include <QEventLoopLocker>
#include <QMainWindow>
#include <QTimer>
#include <map>
#include <memory>

#include "features/film/film_request.hpp"
#include "features/study/study.hpp"
#include "studio/canvas/light_histogram.hpp"
#include "studio/canvas/picture_canvas.hpp"
#include "studio/document/document.hpp"
#include "studio/live/jobs.hpp"
#include "studio/live/live_view.hpp"
#include "studio/live/opening.hpp"
#include "studio/regions/mask_tools.hpp"
#include "studio/time/time_axis.hpp"
#include "studio/window/autosave.hpp"
#include "studio/window/project_file.hpp"
#include "studio/window/status_line.hpp"

class QActionGroup;
class QComboBox;
class QDoubleSpinBox;
class QSpinBox;
class QToolBar;

namespace nutik::studio {

class RegionList;
class StartPage;
struct StartingPoint;

// When the window read or wrote files: later changes are somebody else's.
using FileTimes = std::map<QString, QDateTime>;
[[nodiscard]] FileTimes times_of(const QStringList& files);

// Where a capture that is being opened comes from. It becomes the window's once the capture is open.
struct Origin {
  enum class Kind { capture, project, recovered };
  Kind kind = Kind::capture;
  QString project = {};  // of Kind::project
  CommandFiles files = {};
  FileTimes known = {};
  std::optional<DocumentState> state = {};  // none: the document starts anew
  Marks marks = {};
  std::int64_t duration_ns = 0;                  // of the capture that the state was made of; 0: whatever it is
  std::optional<std::pair<DocumentState, Marks>> left = {};  // what the document was when it was left for this
  std::shared_ptr<const KeptProject> kept = {};  // of Kind::recovered
  bool is_unwritten = false;                     // of Kind::project: its last save was ended in the middle
  bool is_elsewhere = false;                     // the capture, or read otherwise, than the project says
  const StartingPoint* then = nullptr;           // is started once it is open
};

class MainWindow : public QMainWindow {
  Q_OBJECT

 public:
  explicit MainWindow(const ComputingRequest& computing = {});
  ~MainWindow() override;

  // A capture, a clip or a project, in the background; `rate`, pictures a second, is stated of a clip.
  void open(const QString& path, const QString& rate = {}, const StartingPoint* then = nullptr);
  void open_first(const QStringList& paths, const QString& rate = {});  // says which it leaves out
  // False: it failed, and why is said above the picture.
  bool save_project(const QString& path);
  // For an open capture. The reason why a file is refused is said above the picture.
  void use_functions(const QString& path);
  void use_mask(const QString& path);
  // Into files of their own, which the project does not name; why that fails is said above the picture.
  void write_functions(const QString& path);
  void write_mask(const QString& path);
  // Both in the background, of a saved project unless an interval is exposed.
  void export_picture(const QString& path, const Stated& written = {});
  void export_film(const QString& path, const Stated& options);
  void start_study(const StudyRequest& request);
  void start_from(const StartingPoint& point);
  // The interval through the capture, as a film.
  void play_or_stop();
  void use_tool(ToolKind kind);

  // Whether mask and functions lie in files as they are, so that a command can name them.
  [[nodiscard]] bool has_files() const;
  // The line that makes the same picture; of a document that has_files().
  [[nodiscard]] QString command_for(const QString& picture) const;
  // Whether the picture shown is that of the document, and no job runs.
  [[nodiscard]] bool is_settled() const;

  // What was kept of a window that did not end well: from now on this window keeps it.
  void recover(const QString& kept);
  [[nodiscard]] Autosave& autosave() { return autosave_; }

  [[nodiscard]] Document& document() { return document_; }
  [[nodiscard]] Canvas& canvas() { return *canvas_; }
  [[nodiscard]] Notice& notice() { return *notice_; }
  [[nodiscard]] Notice& offer() { return *offer_; }  // of what was kept; stays whatever else is said

 protected:
  bool event(QEvent* event) override;
  bool eventFilter(QObject* field, QEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void keyReleaseEvent(QKeyEvent* event) override;
  void closeEvent(QCloseEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;

 private:
  // main_window.cpp
  void build_window();
  void connect_parts();
  void restore_window();
  void keep_window();
  void open_project(const QString& path, std::shared_ptr<const KeptProject> kept = {},
                    const StartingPoint* then = nullptr, bool asks = false);  // how the clip is read
  void open_capture_file(const QString& path, const Stated& stated, Origin origin);
  void tell_way_out(const QString& path, const Stated& stated, const Origin& origin,
                    const std::exception_ptr& error);
  void take(Opened opened, Origin origin);
  void ask_how_to_read(const QString& path, const Stated& stated, const QString& why, const Origin& origin);
  void stay();
  void look_at_capture();
  void look_along_capture();
  void reduce_capture();
  void add_reduced(std::shared_ptr<Session> from, std::uint32_t by, int divisor);
  void select_motion();
  void choose_difference();
  [[nodiscard]] bool has_region();  // selected, to be painted; else it is said
  void look_at_pixel();
  void follow_title();
  void follow_opening();

  // menus.cpp
  void build_menus();
  void build_tools(QToolBar& bar);
  [[nodiscard]] QWidget* build_exposure();
  QAction* add_action(QMenu& menu, const QString& text, const QKeySequence& keys, std::function<void()> run);
  // An entry that needs a capture.
  void offer(QMenu& menu, const QString& text, const QKeySequence& keys, std::function<void()> run);
  void build_file_menu();
  void build_view_menu();
  void build_start_menu();
  void build_region_menu();
  void build_help_menu();
  void show_keys();
  static void offer_beside(QWidget& widget, const QMenu& menu);
  void follow_exposure();

  // starting.cpp
  void choose_file(const StartingPoint* then = nullptr);
  void choose_export();
  [[nodiscard]] bool names_files();  // has_files(), and the capture; else it is said
  void write(const QString& what, Jobs::Work work);
  void choose_film();
  void choose_study();
  void offer_still_camera(StudyStyle style, const QString& why);
  void show_plate(const QImage& plate, const Marks& marks);
  [[nodiscard]] Stated film_options(ExposureMode of) const;
  void play_on();
  void stop_playing();

  // seeing.cpp
  void measure_light();
  void forget_light();
  void mark_clipped();
  bool keep_snapshot();  // false: a film is shown
  void swap_snapshot();
  bool hold(int key, bool is_held);
  void let_go();

  // files.cpp
  using Use = std::function<void(const QString& path)>;
  void ask_for_file(const QString& title, const QString& filter, const Use& use);
  void ask_for_name(const QString& title, const QString& ending, const QString& filter, const Use& use);
  [[nodiscard]] QString named_file(const QString& title, const QString& ending, const QString& filter);
  bool save(const QString& why = {});  // asks for a name where there is none
  bool save_as(const QString& why = {});
  bool may_leave();  // asks where something is not saved
  bool may_leave_writing();  // asks what becomes of what is being written
  [[nodiscard]] static QStringList written_meanwhile();
  bool ensure_files();
  [[nodiscard]] bool has_capture();  // as it was read; else it is said
  void note_capture();
  void note_written(const QString& path);
  [[nodiscard]] QStringList changed_outside() const;
  void tell_changes();
  void copy_command();
  void write_plate(const QString& path, const Marks& marks);
  void save_plate(const Marks& marks);  // under a name that is asked for
  void save_whole_part(const QString& path, const Origin& origin);
  void fill_recent(QMenu& menu);
  void fill_unsaved(QMenu& menu);
  void remove_unsaved();
  [[nodiscard]] QString suggested(const QString& ending) const;
  [[nodiscard]] QString suggested_picture() const;  // of the kind that was exported last
  bool try_to(const std::function<void()>& what);
  [[nodiscard]] Told told() {
    return [this](const QString& line) { notice_->say(Notice::Kind::note, line); };
  }
  [[nodiscard]] Told told_written(const QString& path);

  Document document_;
  // What a person waits for and may cancel; what is there in no time; pictures on their way to files, which opening
  // another capture does not stop.
  Jobs jobs_, quick_, measuring_, writing_;
  LiveView live_;
  TimeAxis axis_;
  Autosave autosave_;
  std::shared_ptr<Devices> devices_;
  std::shared_ptr<Session> session_;
  QString opening_;  // another file, which was not opened yet; empty: none
  QString project_;
  CommandFiles files_;
  FileTimes known_;  // of the project's files and the capture
  Stated written_;   // how the last picture was exported
  QString exported_;  // which; empty: none yet
  QTimer playing_;
  double played_rate_ = 0;  // frames a second
  QElapsedTimer played_since_;
  std::optional<Frames> film_;
  WritingList being_written_;
  std::unique_ptr<QEventLoopLocker> writes_on_;  // of a closed window
  std::shared_ptr<const MeasuredLight> light_;
  Marks plate_;  // between which the scene without what moves was found, while it is shown
  struct Snapshot {
    DocumentState state;
    QImage image;
  };
  std::optional<Snapshot> snapshot_;  // A: first the picture that the window was opened with
  QString told_changes_;  // what was said of them
  ToolSettings tool_settings_;
  std::unique_ptr<CanvasTool> tool_;
  QDoubleSpinBox *radius_ = nullptr, *speed_ = nullptr, *angle_ = nullptr;
  QSpinBox* codes_ = nullptr;

  Notice *notice_ = nullptr, *offer_ = nullptr;
  Canvas* canvas_ = nullptr;
  QWidget *time_ = nullptr, *curves_ = nullptr, *side_ = nullptr;
  StartPage* start_ = nullptr;
  LightHistogram* histogram_ = nullptr;
  RegionList* regions_ = nullptr;
  StatusLine* status_ = nullptr;
  QActionGroup* tools_ = nullptr;
  QList<QAction*> needs_capture_, folds_;
  QAction* clipping_ = nullptr;
  QComboBox *mode_ = nullptr, *normalization_ = nullptr;
  QDoubleSpinBox* brightness_ = nullptr;
};

}  // namespace nutik::studio
