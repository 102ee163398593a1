#include "studio/live/live_view.hpp"

#include <utility>

#include "session/below/functions.hpp"
#include "studio/live/changed_pixels.hpp"
#include "studio/live/exposure_of.hpp"
#include "studio/live/picture_image.hpp"

namespace nutik::studio {
namespace {

QString arithmetic_of(const ExposedPicture& exposed) {
  QString text = QString::fromStdString(std::string(to_text(exposed.precision)));
  if (exposed.choice && exposed.choice->bound.precision == exposed.precision)
    text += ": " + QString::fromStdString(error_text(exposed.choice->bound.worst, exposed.output));
  return text;
}

// Of each square the tag in its middle.
Mask reduced_mask(const Mask& mask, const Shape& shape, int divisor) {
  const auto side = static_cast<std::uint32_t>(divisor);
  Mask reduced = Mask::uniform(shape.width, shape.height, 0);
  auto tag = reduced.tags.begin();
  for (std::uint32_t y = 0; y < shape.height; ++y) {
    const std::uint8_t* const row =
        mask.tags.data() + std::size_t{y * side + side / 2} * mask.width + side / 2;
    for (std::uint32_t x = 0; x < shape.width; ++x) *tag++ = row[x * side];
  }
  return reduced;
}

// Of exposures by functions.
std::vector<std::uint8_t> changed_functions(const ExposureRequest& before, const ExposureRequest& now) {
  const FunctionSet &a = *std::get<Shared<FunctionSet>>(before.gains),
                    &b = *std::get<Shared<FunctionSet>>(now.gains);
  std::vector<std::uint8_t> changed;
  const auto add_missing = [&changed](const FunctionSet& of, const FunctionSet& in) {
    for (const auto& [tag, function] : of) {
      const auto found = in.find(tag);
      if (found == in.end() || !(found->second == function)) changed.push_back(tag);
    }
  };
  add_missing(a, b);
  add_missing(b, a);
  return changed;
}

}  // namespace

LiveView::LiveView(Document& document, Jobs& jobs, QObject* parent)
    : QObject(parent), document_(document), jobs_(jobs) {
  connect(&document_, &Document::changed, this, [this] { ask(!document_.is_dragging()); });
  connect(&document_, &Document::released, this, [this] { ask(true); });
}

LiveView::~LiveView() = default;

void LiveView::show(std::shared_ptr<Session> session) {
  pictures_.reset();
  session_ = std::move(session);
  soft_.reset();
  visible_ = {};
  asked_.reset();
  reduced_.reset();
  reduced_from_.reset();
  last_asked_ = last_shown_ = 0;
  full_wanted_ = full_shown_ = false;
  {
    const std::scoped_lock lock(mutex_);
    requests_.clear();
    delivered_.reset();
  }
  if (!session_) return;
  pictures_ = std::make_unique<LivePictures>([this](LiveAnswer answer) { deliver(std::move(answer)); });
  ask(true);
}

void LiveView::set_visible(QRect pixels, double screen_pixels) {
  visible_ = pixels;
  screen_pixels_ = screen_pixels;
}

void LiveView::set_reduced(std::shared_ptr<Session> session, int divisor) {
  reduced_ = std::move(session);
  divisor_ = divisor;
}

// Soft edges are blended from the capture's own pixels.
bool LiveView::shows_reduced(const ExposureRequest& exposure) const {
  return reduced_ && screen_pixels_ * divisor_ <= 1 && !(exposure.mask && (*exposure.mask)->mask.is_soft());
}

LivePart LiveView::reduced_part(ExposureRequest exposure, const QRect& pixels) {
  const Shape& shape = reduced_->format().shape;
  if (exposure.mask) {
    if (!reduced_from_ || &**reduced_from_ != &**exposure.mask) {
      reduced_from_ = exposure.mask;
      reduced_mask_ = Shared(MaskWithRegions(reduced_mask((*exposure.mask)->mask, shape, divisor_)));
    }
    exposure.mask = reduced_mask_;
  }
  const QRect all = rectangle_of(Rectangle::whole(shape));
  const auto reduced = [this](QPoint pixel) { return QPoint(pixel.x() / divisor_, pixel.y() / divisor_); };
  const QRect part = QRect(reduced(pixels.topLeft()), reduced(pixels.bottomRight())) & all;
  return {reduced_.get(), std::move(exposure), screen_format(),
          rectangle_of(part.isEmpty() ? QRect(all.bottomRight(), QSize(1, 1)) : part, shape)};
}

bool LiveView::is_busy() const {
  return pictures_ && (last_shown_ < last_asked_ || (full_wanted_ && !full_shown_));
}

void LiveView::ask(bool with_full) {
  if (!pictures_) return;
  bool is_final = true;
  const ExposureRequest exposure = exposure_of(document_.state(), mask_of(document_.state(), is_final));
  const Shape& shape = session_->format().shape;
  const QRect outdated = outdated_by(exposure);
  const bool is_reduced = shows_reduced(exposure);
  LivePart preview = is_reduced ? reduced_part(exposure, outdated)
                                : LivePart{session_.get(), exposure, screen_format(), rectangle_of(outdated, shape)};
  std::optional<LivePart> full;
  if (with_full && is_final) {
    full = {session_.get(), exposure, screen_format(), Rectangle::whole(shape)};
  }
  full_wanted_ = full.has_value();
  full_shown_ = false;
  const std::scoped_lock lock(mutex_);
  last_asked_ = pictures_->ask({std::move(preview), std::move(full)});
  requests_[last_asked_] = {Clock::now(), is_reduced ? divisor_ : 1};
}

QRect LiveView::outdated_by(const ExposureRequest& exposure) {
  const QRect visible = seen();
  QRect outdated = visible;
  if (asked_ && asked_visible_ == visible_ && asked_reduced_ == shows_reduced(exposure) && !exposure.is_plain() && !asked_->is_plain()) {
    ExposureRequest before = *asked_;
    before.mask = exposure.mask;
    before.gains = exposure.gains;
    if (before == exposure) {
      outdated = changed_pixels(asked_->mask, exposure.mask, visible);
      for (const std::uint8_t tag : changed_functions(*asked_, exposure))
        outdated |= boxes_.of(exposure.mask, tag, visible);
    }
  }
  // Of several requests the last one alone may be answered.
  outdated_ = last_shown_ < last_asked_ ? outdated_ | outdated : outdated;
  asked_ = exposure;
  asked_visible_ = visible_;
  asked_reduced_ = shows_reduced(exposure);
  const QRect changed = outdated_ & visible;
  // An answer is waited for, whatever it shows.
  return changed.isEmpty() ? QRect(visible.topLeft(), QSize(1, 1)) : changed;
}

QRect LiveView::seen() const { return rectangle_of(rectangle_of(visible_, session_->format().shape)); }

std::optional<Shared<MaskWithRegions>> LiveView::mask_of(const DocumentState& state, bool& is_final) {
  const Feather feather = feather_of(state);
  if (!state.mask || state.mode == ExposureMode::boxcar || feather == Feather()) return state.mask;
  const bool is_made = soft_ && soft_->hard == *state.mask && soft_->feather == feather;
  // A stroke that goes on changes the mask again and again: its edges are blended in the end.
  if (!is_made && document_.is_dragging()) {
    is_final = false;
    return state.mask;
  }
  if (!is_made) {
    soft_ = {*state.mask, feather, std::nullopt};
    jobs_.start(tr("Feathering"), [this, wanted = state](const Job&) -> Jobs::Finish {
      return [this, wanted, made = feathered_mask(wanted)] {
        if (!soft_ || !(soft_->hard == *wanted.mask) || soft_->feather != feather_of(wanted)) return;
        soft_->mask = made;
        ask(!document_.is_dragging());
      };
    });
  }
  is_final = soft_->mask.has_value();
  return is_final ? soft_->mask : state.mask;
}

Shared<MaskWithRegions> LiveView::feathered_mask(const DocumentState& state) {
  const Feather feather = feather_of(state);
  if (feather == Feather()) return *state.mask;
  return Shared(MaskWithRegions(feathered((*state.mask)->mask, feather)));
}

// On the engine's thread.
void LiveView::deliver(LiveAnswer answer) {
  Delivered found{answer.request, answer.is_preview, {}, {}};
  if (answer.exposed) {
    const ExposedPicture& exposed = *answer.exposed;
    found.picture.image = image_of(exposed.picture);
    found.picture.is_full = !answer.is_preview;
    found.picture.pixels_below = exposed.saturation.below;
    found.picture.pixels_above = exposed.saturation.above;
    found.picture.arithmetic = arithmetic_of(exposed);
    QStringList warnings;
    for (const std::string& warning : exposed.warnings) warnings += QString::fromStdString(warning);
    found.picture.warnings = warnings.join('\n');
  } else {
    found.error = sentence_of(answer.error);
  }
  found.picture.place = rectangle_of(answer.rectangle);
  const std::scoped_lock lock(mutex_);
  const auto asked = requests_.find(answer.request);
  if (asked != requests_.end()) {
    const auto [at, divisor] = asked->second;
    found.picture.milliseconds = std::chrono::duration<double, std::milli>(Clock::now() - at).count();
    if (answer.is_preview && divisor > 1) {
      const QRect& place = found.picture.place;
      found.picture.place = {place.topLeft() * divisor, place.size() * divisor};
      found.picture.divisor = divisor;
    }
    requests_.erase(requests_.begin(), asked);
  }
  // A full picture is not dropped for its own preview, which comes before it.
  const bool is_waiting = std::exchange(delivered_, std::move(found)).has_value();
  if (!is_waiting)
    QMetaObject::invokeMethod(
        this, [this] { take(); }, Qt::QueuedConnection);
}

void LiveView::take() {
  std::optional<Delivered> found;
  {
    const std::scoped_lock lock(mutex_);
    found = std::exchange(delivered_, std::nullopt);
  }
  if (!found) return;
  last_shown_ = found->request;
  found->picture.is_of_all_seen = !found->is_preview || (found->picture.divisor == 1 && found->picture.place == seen());
  if (found->request == last_asked_ && (!found->is_preview || !found->error.isEmpty())) full_shown_ = true;
  if (found->error.isEmpty()) {
    Q_EMIT pictured(found->picture);
  } else {
    asked_.reset();
    Q_EMIT failed(found->error);
  }
}

}  // namespace nutik::studio
