#include "studio/live/live_view.hpp"

#include <cmath>
#include <utility>

#include "exposure/mask.hpp"
#include "exposure/shutter_shape.hpp"
#include "mask/feather.hpp"
#include "render/render_plan.hpp"

namespace nutik::studio {
namespace {

// Takes the tag in the middle of each square.
Mask reduced(const Mask& mask, const Shape& shape, std::uint32_t divisor) {
  Mask tags = Mask::uniform(shape.width, shape.height, 0);
  auto tag = tags.tags.begin();
  for (std::uint32_t y = 0; y < shape.height; ++y) {
    const std::size_t middle = std::size_t{y * divisor + divisor / 2} * mask.width + divisor / 2;
    for (std::uint32_t x = 0; x < shape.width; ++x) *tag++ = mask.tags[middle + x * divisor];
  }
  return tags;
}

void tell_arithmetic(const ExposedPicture& exposed, ShownPicture& picture) {
  picture.arithmetic = QString::fromStdString(std::string(to_text(exposed.precision)));
  if (!exposed.choice || exposed.choice->bound.precision != exposed.precision) return;
  const PictureError& worst = exposed.choice->bound.worst;
  picture.arithmetic += ": " + QString::fromStdString(error_text(worst, exposed.output));
  picture.codes_off = worst.steps;
}

}  // namespace

ReducedCapture::ReducedCapture(std::shared_ptr<Session> session, int divisor)
    : session_(std::move(session)), divisor_(divisor) {}

bool ReducedCapture::can_show(const ExposureRequest& exposure, double screen_pixels) const {
  return screen_pixels * divisor_ < 2 && !(exposure.mask && (*exposure.mask)->mask.is_soft());
}

LivePart ReducedCapture::part(ExposureRequest exposure, const QRect& pixels) {
  const Shape& shape = session_->format().shape;
  if (exposure.mask) {
    if (!whole_ || &**whole_ != &**exposure.mask) {
      whole_ = exposure.mask;
      mask_ = Shared(MaskWithRegions(reduced((*whole_)->mask, shape, static_cast<std::uint32_t>(divisor_))));
    }
    exposure.mask = mask_;
  }
  const QRect all = rectangle_of(Rectangle::whole(shape));
  const auto square = [this](QPoint pixel) { return QPoint(pixel.x() / divisor_, pixel.y() / divisor_); };
  const QRect squares = QRect(square(pixels.topLeft()), square(pixels.bottomRight())) & all;
  return {session_.get(), std::move(exposure), screen_format(),
          rectangle_of(squares.isEmpty() ? QRect(all.bottomRight(), QSize(1, 1)) : squares, shape)};
}

LiveView::LiveView(Document& document, Jobs& jobs, QObject* parent)
    : QObject(parent), document_(document), jobs_(jobs) {
  connect(&document_, &Document::changed, this, [this] { ask(!document_.is_dragging()); });
  connect(&document_, &Document::released, this, [this] {
    least_divisor_ = 1;
    ask(true);
  });
  connect(&document_, &Document::played_changed, this, [this] { ask(!document_.is_dragging()); });
}

LiveView::~LiveView() = default;

void LiveView::show(std::shared_ptr<Session> session) {
  pictures_.reset();
  if (session != session_) reduced_.clear();
  session_ = std::move(session);
  soft_.reset();
  outdated_.forget();
  last_asked_ = last_shown_ = asked_before_drag_ = 0;
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

void LiveView::add_reduced(std::shared_ptr<Session> session, int divisor) {
  reduced_.emplace_back(std::move(session), divisor);
}

ReducedCapture* LiveView::reduced_for(const ExposureRequest& exposure) {
  ReducedCapture* chosen = nullptr;
  for (ReducedCapture& each : reduced_) {
    if (!each.can_show(exposure, least_divisor_ > 1 ? screen_pixels_ / 2 : screen_pixels_)) break;
    chosen = &each;
    if (each.divisor() >= least_divisor_) break;
  }
  return chosen;
}

bool LiveView::is_busy() const {
  return pictures_ && (last_shown_ < last_asked_ || (full_wanted_ && !full_shown_));
}

void LiveView::ask(bool with_full) {
  if (!pictures_) return;
  bool is_final = true;
  DocumentState state = document_.state();
  if (const auto& played = document_.played()) {
    state.mode = ExposureMode::boxcar;
    state.boxcar = *played;
    with_full = false;
  }
  ExposureRequest exposure = exposure_of(state, mask_of(state, is_final));
  // While a drag lasts edges may be hard: fewer pixels suffice then.
  ExposureRequest hard = exposure;
  hard.mask = state.mask;
  if (!with_full && exposure.mask && reduced_for(hard) != nullptr) exposure = std::move(hard);
  const Shape& shape = session_->format().shape;
  ReducedCapture* const reduced = reduced_for(exposure);
  const int divisor = reduced != nullptr ? reduced->divisor() : 1;
  const QRect outdated = outdated_.to_expose(exposure, seen(), divisor, last_shown_ == last_asked_);
  LivePart preview = reduced != nullptr
                         ? reduced->part(exposure, outdated)
                         : LivePart{session_.get(), exposure, screen_format(), rectangle_of(outdated, shape)};
  std::optional<LivePart> full;
  if (with_full && is_final)
    full = {session_.get(), exposure, screen_format(), Rectangle::whole(shape), document_.facts()->precision};
  full_wanted_ = full.has_value();
  full_shown_ = false;
  const std::scoped_lock lock(mutex_);
  last_asked_ = pictures_->ask({std::move(preview), std::move(full)});
  if (!document_.is_dragging()) asked_before_drag_ = last_asked_;
  requests_[last_asked_] = {Clock::now(), divisor};
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
    jobs_.start(
        tr("Feathering"), [state](const Job&) { return feathered_mask(state); },
        [this, wanted = state](const Shared<MaskWithRegions>& made) {
          if (!soft_ || !(soft_->hard == *wanted.mask) || soft_->feather != feather_of(wanted)) return;
          soft_->mask = made;
          ask(!document_.is_dragging());
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
    tell_arithmetic(exposed, found.picture);
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
  const ShownPicture& picture = found->picture;
  found->picture.is_of_all_seen = !found->is_preview || (picture.divisor == 1 && picture.place == seen());
  if (found->is_preview && document_.is_dragging() && found->request > asked_before_drag_ &&
      picture.milliseconds > prompt_ms_)
    least_divisor_ = 2 * picture.divisor;
  if (found->request == last_asked_ && (!found->is_preview || !found->error.isEmpty())) full_shown_ = true;
  if (found->error.isEmpty()) {
    Q_EMIT pictured(found->picture);
  } else {
    outdated_.forget();
    Q_EMIT failed(found->error);
  }
}

ExposureRequest exposure_of(const DocumentState& state, const std::optional<Shared<MaskWithRegions>>& mask) {
  ExposureRequest request;
  request.gain = std::exp2(state.brightness_ev);
  request.normalization = state.normalization;
  if (state.mode == ExposureMode::boxcar) {
    request.start = StatedTime::of_nanoseconds(state.boxcar.start_ns);
    request.gains = PlainInterval{StatedTime::of_nanoseconds(state.boxcar.length_ns), Shutter()};
    return request;
  }
  request.gains = Shared(FunctionSet(state.functions));
  request.mask = mask;
  return request;
}

QImage image_of(const Picture& picture) {
  const auto codes = picture.values<std::uint8_t>();
  const auto width = static_cast<int>(picture.shape.width);
  const auto format = picture.shape.channels == 1 ? QImage::Format_Grayscale8 : QImage::Format_RGB888;
  const QImage borrowed(codes.data(), width, static_cast<int>(picture.shape.height),
                        static_cast<qsizetype>(picture.shape.width) * picture.shape.channels, format);
  return borrowed.convertToFormat(QImage::Format_RGB32);
}

OutputFormat screen_format() {
  OutputFormat format;
  format.transfer = Transfer::srgb();
  return format;
}

QRect rectangle_of(const Rectangle& rectangle) {
  return {static_cast<int>(rectangle.x), static_cast<int>(rectangle.y), static_cast<int>(rectangle.width),
          static_cast<int>(rectangle.height)};
}

Rectangle rectangle_of(const QRect& rectangle, const Shape& shape) {
  const QRect part = rectangle & rectangle_of(Rectangle::whole(shape));
  if (part.isEmpty()) return Rectangle::whole(shape);
  return {static_cast<std::uint32_t>(part.x()), static_cast<std::uint32_t>(part.y()),
          static_cast<std::uint32_t>(part.width()), static_cast<std::uint32_t>(part.height())};
}

}  // namespace nutik::studio
