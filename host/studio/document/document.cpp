#include "studio/document/document.hpp"

#include "capture/format.hpp"
#include "exposure/function_text.hpp"

#include <QUndoCommand>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace nutik::studio {

// One step of undo: the state before and after it.
class StateStep : public QUndoCommand {
 public:
  // `drag`: steps of the same one merge; 0 merges with none.
  StateStep(Document& document, DocumentState after, const QString& what, std::uint64_t drag)
      : QUndoCommand(what),
        document_(document),
        before_(document.state_),
        after_(std::move(after)),
        drag_(drag),
        selected_(document.selected_tag_) {}

  void undo() override {
    const bool is_back = !document_.functions().contains(selected_);
    const bool is_gone = !before_.functions.contains(document_.selected_tag_);
    document_.take(before_);
    if ((is_back || is_gone) && before_.functions.contains(selected_)) document_.select_tag(selected_);
  }
  void redo() override { document_.take(after_); }
  int id() const override { return 1; }
  bool mergeWith(const QUndoCommand* later) override {
    const auto& step = static_cast<const StateStep&>(*later);
    if (drag_ == 0 || step.drag_ != drag_) return false;
    after_ = step.after_;
    setObsolete(before_ == after_);
    return true;
  }

 private:
  Document& document_;
  DocumentState before_, after_;
  std::uint64_t drag_;
  std::uint8_t selected_;  // before it
};

Document::Document(QObject* parent) : QObject(parent) {}

void Document::start(CaptureFacts facts, std::optional<DocumentState> state, Marks marks) {
  facts_ = std::move(facts);
  overview_ = {};
  undo_.clear();
  is_dragging_ = false;
  const std::int64_t duration_ns = facts_->timeline.duration_ns();
  const std::int64_t length_ns = std::max<std::int64_t>(duration_ns / 10, 1);
  const std::int64_t start_ns = (duration_ns - length_ns) / 2;
  state_ = {};
  state_.boxcar = {start_ns, length_ns};
  state_.functions.emplace(0, with_steps(GainFunction::boxcar(start_ns, start_ns + length_ns)));
  if (state) state_ = std::move(*state);
  state_.boxcar = within_capture(state_.boxcar);
  complete(state_);
  selected_tag_ = state_.functions.begin()->first;
  selected_points_.clear();
  solo_.reset();
  probe_.reset();
  waveform_.reset();
  marks_ = {};
  played_.reset();
  Q_EMIT capture_changed();
  Q_EMIT overview_changed();
  Q_EMIT probe_changed();
  set_mark_in(marks.in_ns);
  set_mark_out(marks.out_ns);
  saved_marks_ = state ? marks_ : Marks();
}

void Document::set_saved() {
  saved_marks_ = marks_;
  undo_.setClean();
}

void Document::set_overview(CaptureOverview overview) {
  overview_ = std::move(overview);
  Q_EMIT overview_changed();
}

std::vector<ControlPoint> Document::points(std::uint8_t tag) const {
  const auto found = state_.functions.find(tag);
  if (found == state_.functions.end()) return {};
  return {found->second.points().begin(), found->second.points().end()};
}

QColor Document::colour(std::uint8_t tag) const {
  const auto found = state_.looks.find(tag);
  return found == state_.looks.end() ? first_colour(tag) : found->second.colour;
}

void Document::set_points(std::uint8_t tag, std::vector<ControlPoint> points, const QString& what) {
  const auto not_after = [](const ControlPoint& a, const ControlPoint& b) { return a.time_ns >= b.time_ns; };
  if (std::ranges::adjacent_find(points, not_after) != points.end())
    throw std::logic_error("times of control points do not increase");
  DocumentState after = state_;
  after.functions.insert_or_assign(tag, GainFunction(std::move(points)));
  after.mode = ExposureMode::functions;
  apply(std::move(after), what);
}

Boxcar Document::within_capture(const Boxcar& boxcar) const {
  const std::int64_t duration_ns = std::max<std::int64_t>(this->duration_ns(), 1);
  const std::int64_t length_ns = std::clamp<std::int64_t>(boxcar.length_ns, 1, duration_ns);
  return {std::clamp<std::int64_t>(boxcar.start_ns, 0, duration_ns - length_ns), length_ns};
}

void Document::set_boxcar(const Boxcar& boxcar, const QString& what, ExposureMode mode) {
  DocumentState after = state_;
  after.boxcar = within_capture(boxcar);
  after.mode = mode;
  apply(std::move(after), what);
}

void Document::set_mode(ExposureMode mode) {
  DocumentState after = state_;
  after.mode = mode;
  apply(std::move(after), mode == ExposureMode::boxcar ? tr("Expose the interval") : tr("Expose regions"));
}

void Document::complete(DocumentState& state) const {
  if (state.functions.size() > 1 && !state.mask && facts_) {
    const Shape& shape = facts_->format.shape;
    state.mask = Shared(MaskWithRegions(Mask::uniform(shape.width, shape.height, 0)));
  }
  const auto is_gone = [&](std::uint8_t tag) { return !state.functions.contains(tag); };
  const auto is_of_none = [&](const auto& entry) { return is_gone(entry.first); };
  std::erase_if(state.looks, is_of_none);
  std::erase_if(state.covered, is_of_none);
  std::erase_if(state.feather.of_tag, is_of_none);
  std::erase_if(state.order, is_gone);
  for (const auto& [tag, function] : state.functions)
    if (tag != 0 && std::ranges::find(state.order, tag) == state.order.end()) state.order.push_back(tag);
  for (const auto& [tag, function] : state.functions)
    state.looks.try_emplace(
        tag, RegionLook{tag == 0 ? tr("Background") : tr("Region %1").arg(tag), first_colour(tag), true});
}

void Document::apply(DocumentState state, const QString& what) {
  complete(state);
  if (state == state_) return;
  undo_.push(new StateStep(*this, std::move(state), what, is_dragging_ ? drag_ : 0));
}

void Document::begin_drag() {
  is_dragging_ = true;
  ++drag_;
  before_drag_ = state_;
}

void Document::end_drag() {
  if (!is_dragging_) return;
  is_dragging_ = false;
  Q_EMIT released();
}

void Document::give_up_drag(const QString& what) {
  if (is_dragging_) apply(before_drag_, what);
  end_drag();
}

void Document::select_tag(std::uint8_t tag) {
  if (tag == selected_tag_) return;
  selected_tag_ = tag;
  selected_points_.clear();
  Q_EMIT selection_changed();
}

void Document::select_points(std::set<std::size_t> points) {
  if (points == selected_points_) return;
  selected_points_ = std::move(points);
  keep_selection_within();
  Q_EMIT selection_changed();
}

void Document::set_solo(std::optional<std::uint8_t> tag) {
  if (tag == solo_) return;
  solo_ = tag;
  Q_EMIT selection_changed();
}

void Document::set_mark_in(std::optional<std::int64_t> time_ns) { set_mark(marks_.in_ns, marks_.out_ns, time_ns); }
void Document::set_mark_out(std::optional<std::int64_t> time_ns) { set_mark(marks_.out_ns, marks_.in_ns, time_ns); }

void Document::set_mark(std::optional<std::int64_t>& mark, std::optional<std::int64_t>& other,
                        std::optional<std::int64_t> time_ns) {
  mark = time_ns;
  if (mark) mark = std::clamp<std::int64_t>(*mark, 0, duration_ns());
  if (marks_.in_ns && marks_.out_ns && *marks_.out_ns <= *marks_.in_ns) {
    other.reset();
    Q_EMIT mark_taken_away(&other == &marks_.out_ns);
  }
  Q_EMIT marks_changed();
}

void Document::set_played(std::optional<Boxcar> boxcar) {
  if (boxcar == played_) return;
  played_ = boxcar;
  Q_EMIT played_changed();
}

void Document::set_probe(std::optional<QPoint> pixel) {
  if (pixel == probe_) return;
  probe_ = pixel;
  waveform_.reset();
  Q_EMIT probe_changed();
}

void Document::set_waveform(Waveform waveform) {
  if (!probe_ || *probe_ != waveform.pixel) return;
  waveform_ = std::move(waveform);
  Q_EMIT probe_changed();
}

void Document::take(const DocumentState& state) {
  DocumentState repainted = state_;
  repainted.mask = state.mask;
  repainted.covered = state.covered;
  const Change what = repainted == state ? Change::mask : Change::state;
  state_ = state;
  keep_selection_within();
  Q_EMIT changed(what);
}

// What undo took away is not selected any more.
void Document::keep_selection_within() {
  if (!state_.functions.contains(selected_tag_))
    selected_tag_ = state_.functions.empty() ? std::uint8_t{0} : state_.functions.begin()->first;
  selected_points_.erase(selected_points_.lower_bound(points(selected_tag_).size()), selected_points_.end());
  if (solo_ && !state_.functions.contains(*solo_)) solo_.reset();
}

Feather feather_of(const DocumentState& state) {
  Feather feather = state.feather;
  std::erase_if(feather.of_tag, [&](const auto& entry) {
    return !state.mask || !(*state.mask)->uses(entry.first) || entry.second == feather.everywhere_centipixels;
  });
  return feather;
}

GainSummary exposed_summary(const DocumentState& state, std::uint8_t tag, std::int64_t duration_ns) {
  return summarize(state.normalization.normalized(state.functions.at(tag), duration_ns,
                                                  std::exp2(state.brightness_ev), format("M{}", tag)),
                   duration_ns);
}

QColor first_colour(std::uint8_t tag) {
  // Steps of the golden angle: neighbours in number are far apart in hue.
  const int hue = static_cast<int>(std::fmod(205.0 + 137.5 * tag, 360.0));
  return QColor(QColor::fromHsl(hue, 150, 150).rgb());  // as files have it
}

std::string feather_text(const Feather& feather) {
  std::string text;
  if (feather.everywhere_centipixels != 0 || feather.of_tag.empty())
    text = format("{}px", feather.everywhere_centipixels / 100.0);
  for (const auto& [tag, reach] : feather.of_tag)
    text += format("{}M{}={}px", text.empty() ? "" : ",", tag, reach / 100.0);
  return text;
}

std::string functions_text(const FunctionSet& functions) {
  std::string text;
  for (const auto& [tag, function] : functions) text += function_text(tag, function) + "\n";
  return text;
}

}  // namespace nutik::studio
