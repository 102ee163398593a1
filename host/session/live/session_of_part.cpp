#include "session/live/session_of_part.hpp"

#include <optional>
#include <utility>

#include "imev/each_block.hpp"
#include "imev/sample_cursor.hpp"
#include "media/clip.hpp"
#include "media/clip_part.hpp"
#include "tik/reader.hpp"

namespace nutik {
namespace {

// A capture, which outlives it, as a clip again: its samples, one after another, with the times of those that were
// filmed. Where exposures follow each other evenly it tells their rate; how long each lasts is the capture's shutter
// angle, which no clip tells.
class CaptureClip final : public Clip {
 public:
  explicit CaptureClip(tik::Reader& capture) : capture_(capture), blocks_(capture) {
    info_.format = capture.format();
    info_.format.noise = {};
    const Timeline& timeline = capture.timeline().pictures();
    if (timeline.is_constant()) {
      info_.timing.rate = timeline.rate();
    } else {
      const auto exposures = timeline.table();
      info_.timing.exposures.assign(exposures.begin(), exposures.end());
    }
    info_.timing.rate_from = "the capture";
    info_.sample_count = capture.timeline().sample_count();
    if (const auto& made = capture.header().made) info_.made.emplace(*made);
    info_.decoder_bytes = largest_block(capture);
  }

  [[nodiscard]] const ClipInfo& info() const override { return info_; }

  bool read(std::span<std::byte> raster) override {
    if (next_ == end_) {
      if (next_block_ == capture_.block_count()) return false;
      const SampleRange samples = capture_.block_extent(next_block_).range();
      cursor_.reset();
      block_.emplace(blocks_.at(next_block_++));
      cursor_.emplace(capture_.format().shape, *block_);
      first_ = next_ = samples.first;
      end_ = samples.last;
    }
    cursor_->go_to(static_cast<std::uint32_t>(next_++ - first_));
    cursor_->read(raster);
    return true;
  }

 private:
  tik::Reader& capture_;
  ClipInfo info_;
  BlockCursor blocks_;
  std::optional<BlockView> block_;
  std::optional<SampleCursor> cursor_;
  std::uint64_t next_block_ = 0, first_ = 0, next_ = 0, end_ = 0;
};

}  // namespace

std::shared_ptr<Session> session_of_part(Session& whole, const ClipOptions& part,
                                         const ReportedProgress& progress, std::stop_token stop) {
  SourceRequest source;
  source.path = whole.source().path;
  const Timeline& pictures = whole.timeline().pictures();
  if (pictures.is_constant()) source.shutter_angle = pictures.shutter_angle();
  ComputingRequest computing = whole.devices().request();
  computing.memory.bytes /= 4;
  auto devices = std::make_shared<Devices>(computing);
  devices->start();
  const auto open = [&whole, &part] {
    return take_part(std::make_unique<CaptureClip>(whole.capture()), whole.source().path, part);
  };
  return std::make_shared<Session>(
      source, std::move(devices),
      Session::Terms{.progress = progress, .stop = std::move(stop), .open_clip = open});
}

}  // namespace nutik
