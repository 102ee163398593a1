#include "session/live/live_pictures.hpp"

#include <algorithm>
#include <utility>

#include "capture/error.hpp"
#include "imev/tile.hpp"

namespace nutik {
namespace {

// In single the caller looks whether the device computes it rightly.
ExposedPicture expose(const LivePart& part, const Rectangle& rectangle, bool in_single, const std::stop_token& stop) {
  RenderControl control;
  control.stop = stop;
  control.rectangle = rectangle;
  control.precision = in_single ? Precision::single_ : part.precision;
  control.takes_wrong = control.is_chosen = in_single;
  return part.session->render(part.exposure, part.output, control);
}

// Adds the rows below; what is said of infinite values is said of all of them once they are there.
void append(ExposedPicture& exposed, const ExposedPicture& below) {
  exposed.picture.shape.height += below.picture.shape.height;
  exposed.picture.bytes.insert(exposed.picture.bytes.end(), below.picture.bytes.begin(),
                               below.picture.bytes.end());
  add_part(exposed, below, false);
}

// Rows of a full picture that take about as long as a preview of so many pixels; a small one's would be lost in what
// each strip takes by itself. All rows where bounds are mapped, which depend on the rows beside a pixel's.
std::uint32_t strip_rows(const Rectangle& preview, const LivePart& part) {
  const Rectangle& full = part.rectangle;
  if (part.output.maps_bounds) return std::max(full.height, 1u);
  constexpr std::uint64_t kMinPixels = 1 << 17;
  const std::uint64_t pixels = std::max(std::uint64_t{preview.width} * preview.height, kMinPixels);
  const std::uint64_t rows = pixels / std::max(full.width, 1u);
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(
      rows / kTileSide * kTileSide, kTileSide, std::max<std::uint64_t>(full.height, kTileSide)));
}

}  // namespace

LivePictures::LivePictures(Deliver deliver)
    : deliver_(std::move(deliver)), worker_([this](const std::stop_token& stop) { work(stop); }) {}

LivePictures::~LivePictures() = default;

std::uint64_t LivePictures::ask(LiveRequest request) {
  const std::scoped_lock lock(mutex_);
  waiting_ = Asked{++last_number_, std::move(request)};
  changed_.notify_all();
  return last_number_;
}

void LivePictures::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return !waiting_ && !is_busy_; });
}

void LivePictures::work(const std::stop_token& stop) {
  for (;;) {
    std::optional<Asked> asked;
    {
      std::unique_lock lock(mutex_);
      is_busy_ = strips_.has_value();
      if (!is_busy_) changed_.notify_all();
      const bool has_work = changed_.wait(lock, stop, [&] { return waiting_ || strips_; });
      if (!has_work || stop.stop_requested()) return;
      is_busy_ = true;
      asked = std::exchange(waiting_, std::nullopt);
    }
    if (asked) {
      preview(std::move(*asked), stop);
    } else {
      expose_strip(stop);
    }
    if (stop.stop_requested()) return;
  }
}

void LivePictures::preview(Asked asked, const std::stop_token& stop) {
  strips_.reset();
  const LivePart& part = asked.request.preview;
  LiveAnswer found{asked.number, true, part.rectangle, {}, {}};
  try {
    found.exposed = expose(part, part.rectangle, previews_in_single_, stop);
    if (previews_in_single_ && !found.exposed->passed_self_test) {
      previews_in_single_ = false;
      found.exposed = expose(part, part.rectangle, false, stop);
    }
    if (asked.request.full) {
      const std::uint32_t rows = strip_rows(part.rectangle, *asked.request.full);
      strips_ = Strips{asked.number, std::move(*asked.request.full), rows};
    }
  } catch (...) {
    found.exposed.reset();
    found.error = std::current_exception();
  }
  if (!stop.stop_requested()) answer(std::move(found));
}

void LivePictures::expose_strip(const std::stop_token& stop) {
  Strips& strips = *strips_;
  const Rectangle& whole = strips.part.rectangle;
  LiveAnswer found{strips.number, false, whole, {}, {}};
  try {
    Rectangle strip = whole;
    strip.y += strips.next_row;
    strip.height = std::min(strips.rows_at_once, whole.height - strips.next_row);
    ExposedPicture exposed = expose(strips.part, strip, false, stop);
    const bool is_whole = strip.height == whole.height;
    if (const auto infinite = infinity_warning(exposed.picture); infinite && !is_whole)
      std::erase(exposed.warnings, *infinite);
    if (strips.exposed) {
      append(*strips.exposed, exposed);
    } else {
      strips.exposed = std::move(exposed);
    }
    strips.next_row += strip.height;
    if (strips.next_row < whole.height) return;
    if (auto infinite = infinity_warning(strips.exposed->picture); infinite && !is_whole)
      strips.exposed->warnings.push_back(std::move(*infinite));
    found.exposed = std::move(strips.exposed);
  } catch (...) {
    found.error = std::current_exception();
  }
  strips_.reset();
  if (!stop.stop_requested()) answer(std::move(found));
}

void LivePictures::answer(LiveAnswer found) {
  {
    // A full picture gives way to what was asked while its last strip was exposed.
    const std::scoped_lock lock(mutex_);
    if (!found.is_preview && waiting_) return;
  }
  deliver_(std::move(found));
}

}  // namespace nutik
