#include "session/requests/source_request.hpp"

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik {

ClipMoment clip_moment(const StatedTime& time, std::string_view what) {
  if (!time.counts_samples()) return {time.nanoseconds(), false};
  if (time.number.denominator != 1) {
    throw UsageError(format("{} {} is not a whole number of pictures", what, time.text()));
  }
  return {time.number.numerator, true};
}

std::int64_t tick_ns(const StatedTime& time, std::string_view what) {
  if (!time.counts_samples() && time.nanoseconds() > 0) return time.nanoseconds();
  throw UsageError(format("{} {} is no length of time of 1 ns or more: 100us, 1ms", what, time.text()));
}

bool SourceRequest::describes_clip() const {
  SourceRequest plain;
  plain.path = path;
  plain.clip.transfer = clip.transfer;  // what codes stand for can be stated of captures, too
  return *this != plain;
}

}  // namespace nutik
