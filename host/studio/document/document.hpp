// What is edited: gain functions, mask, how regions look, and what is exposed at the moment.
//
//   in:      edits, which name themselves ("Move point") for the undo menu
//   out:     signals; every value can be read at any time
//   always:  each edit is one undo step; all edits between begin_drag() and end_drag() are one step together.
//            A function's times increase strictly, as those of function files do
//   threads: the window's own
//
// What is looked at (selected tag and points, solo, marks, the clicked pixel) is kept here, too, but is no undo step.
#pragma once

#include <QColor>
#include <QImage>
#include <QObject>
#include <QPoint>
#include <QString>
#include <QUndoStack>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "capture/picture.hpp"
#include "capture/timeline.hpp"
#include "exposure/normalization.hpp"
#include "exposure/shutter_shape.hpp"
#include "mask/feather.hpp"
#include "mask/region.hpp"
#include "render/precision.hpp"
#include "render/render_plan.hpp"
#include "session/requests/exposure_request.hpp"
#include "system/shared.hpp"

namespace nutik::studio {

// What the window knows of the capture that is open. Values: read once by the engine's threads, then only looked at.

// What a person stated of a clip, beside what its files say: options of encoding by their names, with their values;
// those of flags are empty.
using Stated = std::map<std::string, std::string>;

// An opened capture's shape, codes and times. timeline.rate() is its sample rate.
struct CaptureFacts {
  QString path;  // as the person gave it: a .tik or a clip
  CaptureFormat format;
  Timeline timeline;
  Stated stated = {};
  // In which pictures are written; none: what suits each. A clip that nutik-cl reads for one picture has other blocks
  // than the capture that the window makes of it, and only whole numbers have the same sum however they are parted.
  std::optional<Precision> precision = {};
};

// What the time strip shows behind the boxcar. Measured after the first picture, so that it does not delay it.
struct CaptureOverview {
  struct Thumbnail {
    std::int64_t time_ns = 0;
    QImage image;
  };
  std::vector<double> changed_share;  // of the pixels, by sample, 0 … 1; empty until it is measured
  std::vector<Thumbnail> thumbnails;  // in time order, evenly spaced
};

// The light of one pixel at each sample, drawn behind the curves.
struct Waveform {
  QPoint pixel;
  std::vector<double> light;  // by sample, mean of the channels, 1 is the capture's white
};

enum class ExposureMode {
  boxcar,    // all pixels are exposed over Boxcar: for scrubbing
  functions  // each pixel is exposed with its region's function
};

// [start_ns, start_ns + length_ns]; within the capture, length_ns >= 1.
struct Boxcar {
  std::int64_t start_ns = 0;
  std::int64_t length_ns = 0;
  friend bool operator==(const Boxcar&, const Boxcar&) = default;
};

// In and out: what work goes on between, from the one on and before the other. None: from the start, to the end.
struct Marks {
  std::optional<std::int64_t> in_ns, out_ns;
  friend bool operator==(const Marks&, const Marks&) = default;
};

inline constexpr double kMostBrightnessEv = 16;

struct RegionLook {
  QString name;
  QColor colour;
  bool is_visible = true;  // its outline, and its curve
  friend bool operator==(const RegionLook&, const RegionLook&) = default;
};

// All that undo brings back. Cheap to copy: copies share mask and regions.
struct DocumentState {
  FunctionSet functions;  // by tag; each with a look
  std::map<std::uint8_t, RegionLook> looks;
  std::optional<Shared<MaskWithRegions>> mask;  // none: tag 0 everywhere
  std::vector<std::uint8_t> order;  // of all tags but 0: the first covers the rest (regions/covering.hpp)
  std::map<std::uint8_t, Shared<Region>> covered;  // pixels of regions that the mask does not show
  ExposureMode mode = ExposureMode::boxcar;
  Boxcar boxcar;
  Normalization normalization;
  Feather feather;           // of the mask's edges
  double brightness_ev = 0;  // in stops, of either sign
  friend bool operator==(const DocumentState&, const DocumentState&) = default;
};

enum class Change {
  mask,  // and what it covers; nothing else
  state
};

class Document : public QObject {
  Q_OBJECT

 public:
  explicit Document(QObject* parent = nullptr);

  // ---- the capture ----

  // None until one is opened.
  [[nodiscard]] const CaptureFacts* facts() const { return facts_ ? &*facts_ : nullptr; }
  [[nodiscard]] std::int64_t duration_ns() const { return facts_ ? facts_->timeline.duration_ns() : 0; }
  // A capture was opened: starts anew with one region, tag 0, exposed over the middle tenth; or with what was loaded.
  void start(CaptureFacts facts, std::optional<DocumentState> state = {}, Marks marks = {});

  [[nodiscard]] const CaptureOverview& overview() const { return overview_; }
  void set_overview(CaptureOverview overview);

  // ---- what is edited ----

  [[nodiscard]] const DocumentState& state() const { return state_; }
  [[nodiscard]] const FunctionSet& functions() const { return state_.functions; }
  [[nodiscard]] std::vector<ControlPoint> points(
      std::uint8_t tag) const;  // empty if there is no such function
  [[nodiscard]] QColor colour(std::uint8_t tag) const;
  [[nodiscard]] const Boxcar& boxcar() const { return state_.boxcar; }
  [[nodiscard]] ExposureMode mode() const { return state_.mode; }

  // Replaces a function's control points: at least one, times strictly increasing, gains finite; whoever drags points
  // keeps them apart. Throws std::logic_error else. Switches to ExposureMode::functions.
  void set_points(std::uint8_t tag, std::vector<ControlPoint> points, const QString& what);
  // Clamped into the capture.
  void set_boxcar(const Boxcar& boxcar, const QString& what, ExposureMode mode = ExposureMode::boxcar);
  void set_mode(ExposureMode mode);
  // Any other edit. The edit is dropped if nothing differs. Several functions get a mask, tag 0 everywhere, where there
  // is none; functions get looks.
  void apply(DocumentState state, const QString& what);

  // While the mouse is down. Drags do not nest.
  void begin_drag();
  void end_drag();
  void give_up_drag(const QString& what);  // ends it with what was there before
  [[nodiscard]] bool is_dragging() const { return is_dragging_; }

  [[nodiscard]] QUndoStack& undo_stack() { return undo_; }
  [[nodiscard]] const QUndoStack& undo_stack() const { return undo_; }
  // Whether all that a project holds is as it was saved or loaded: what undo brings back, and the marks.
  [[nodiscard]] bool is_saved() const { return undo_.isClean() && marks_ == saved_marks_; }
  void set_saved();

  // ---- what is looked at ----

  [[nodiscard]] std::uint8_t selected_tag() const { return selected_tag_; }
  void select_tag(std::uint8_t tag);  // clears the selected points if it is another one
  // Indices into points(selected_tag()).
  [[nodiscard]] const std::set<std::size_t>& selected_points() const { return selected_points_; }
  void select_points(std::set<std::size_t> points);

  [[nodiscard]] std::optional<std::uint8_t> solo() const { return solo_; }
  void set_solo(std::optional<std::uint8_t> tag);

  // In lies before out; a mark that is set beyond the other one takes it away.
  [[nodiscard]] const Marks& marks() const { return marks_; }
  [[nodiscard]] const std::optional<std::int64_t>& mark_in() const { return marks_.in_ns; }
  [[nodiscard]] const std::optional<std::int64_t>& mark_out() const { return marks_.out_ns; }
  void set_mark_in(std::optional<std::int64_t> time_ns);
  void set_mark_out(std::optional<std::int64_t> time_ns);

  // The interval that a film shows at the moment, in place of all that is exposed.
  [[nodiscard]] const std::optional<Boxcar>& played() const { return played_; }
  void set_played(std::optional<Boxcar> boxcar);

  // The pixel that was clicked, and then its light once it has been read.
  [[nodiscard]] const std::optional<QPoint>& probe() const { return probe_; }
  void set_probe(std::optional<QPoint> pixel);
  [[nodiscard]] const std::optional<Waveform>& waveform() const { return waveform_; }
  void set_waveform(Waveform waveform);  // dropped if it is not the probe's

 Q_SIGNALS:
  void capture_changed();     // facts(), and all that is edited; what is looked at is told of by the signals below
  void overview_changed();    // overview()
  void changed(Change what);  // state(); also by undo and redo
  void released();            // a drag ended: the full picture may follow
  void selection_changed();   // selected_tag(), selected_points(), solo()
  void marks_changed();
  void mark_taken_away(bool is_out);  // by the other one, which was set beyond it
  void played_changed();
  void probe_changed();       // probe(), waveform()

 private:
  friend class StateStep;
  void take(const DocumentState& state);
  void set_mark(std::optional<std::int64_t>& mark, std::optional<std::int64_t>& other,
                std::optional<std::int64_t> time_ns);
  void keep_selection_within();
  [[nodiscard]] Boxcar within_capture(const Boxcar& boxcar) const;
  void complete(DocumentState& state) const;

  std::optional<CaptureFacts> facts_;
  CaptureOverview overview_;
  DocumentState state_;
  QUndoStack undo_;
  bool is_dragging_ = false;
  std::uint64_t drag_ = 0;  // counts them: edits of one merge
  DocumentState before_drag_;
  std::uint8_t selected_tag_ = 0;
  std::set<std::size_t> selected_points_;
  std::optional<std::uint8_t> solo_;
  Marks marks_, saved_marks_;
  std::optional<Boxcar> played_;
  std::optional<QPoint> probe_;
  std::optional<Waveform> waveform_;
};

// The feather of regions that the mask has: others have no edges.
[[nodiscard]] Feather feather_of(const DocumentState& state);

// What a region's function comes to as it is exposed: divided and brightened. Throws InputError where the integral that
// it is divided by cancels.
[[nodiscard]] GainSummary exposed_summary(const DocumentState& state, std::uint8_t tag,
                                          std::int64_t duration_ns);

// The colour that the region with a tag begins with: calm ones, told apart on dark and light.
[[nodiscard]] QColor first_colour(std::uint8_t tag);

// Parts of a document as files and command lines have them.

// `2px`, `2px,M128=6px`, `M128=6px`; of none `0px`.
[[nodiscard]] std::string feather_text(const Feather& feather);
// A function file.
[[nodiscard]] std::string functions_text(const FunctionSet& functions);

}  // namespace nutik::studio
