#include <algorithm>

#include "app/command_line/words.hpp"
#include "app/output/console.hpp"
#include "app/words/stated_requests.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/function_text.hpp"
#include "exposure/shutter_shape.hpp"
#include "features/schema/option.hpp"
#include "features/schema/options.hpp"
#include "session/clips/clip_source.hpp"
#include "session/requests/stated_moments.hpp"

namespace nutik::app {
namespace {

constexpr double kLongestSeconds = 3e9;  // a timeline that pictures can be counted on; almost a century

// Pictures can be counted on a capture's own times, or where its rate is stated.
Timeline timeline_for(const Options& options, const StatedTime& start, const StatedTime& length) {
  if (options.operands.size() == 2) {
    return known_timeline(source_request(options, options.operands[1]), memory_budget(options));
  }
  if (options.source.clip.raw) throw UsageError("--raw says what the bytes of a clip are; name the clip");
  const Rational angle = options.source.shutter_angle.value_or(Timeline::kFullShutter);
  if (options.source.clip.rate) {
    const Rational rate = *options.source.clip.rate;
    return Timeline::constant(rate, angle,
                              static_cast<std::uint64_t>(std::max(1.0, rate.value() * kLongestSeconds)));
  }
  if (start.counts_samples() || length.counts_samples()) {
    throw UsageError(
        "to count in pictures of a clip its times must be known: name the capture behind the shape, "
        "add --fps where its rate is constant, or write times in seconds");
  }
  return Timeline::constant({1, 1}, angle, 1);
}

// In whole numbers, of nanoseconds at the least.
std::string whole_text(const StatedTime& time) {
  if (time.counts_samples()) return time.text();
  const StatedTime rounded = StatedTime::of_nanoseconds(time.nanoseconds());
  if (rounded == time) return rounded.text();
  return StatedTime{{time.number.numerator * time.unit_ns, time.number.denominator}, 1}.text();
}

}  // namespace

int run_shutter(const Options& options) {
  if (options.operands.empty() || options.operands.size() > 2) {
    throw UsageError(
        "shutter takes one shape, and a capture whose pictures are counted: "
        "nutik-cl shutter hann --start 32f --exposure 3f clip.tik");
  }
  check_choice("shutter", options.operands.front(), *find_option("shutter"));
  if (!options.exposure) throw UsageError("how long is the exposure? Add --exposure 10ms");
  const Shutter shutter{ShutterShape::parse(options.operands.front()),
                        options.shutter_error.value_or(ShutterShape::kDefaultError)};
  const StatedTime start = options.start.value_or(StatedTime());
  const StatedTime& length = *options.exposure;
  const auto tag = options.tag.value_or(0);
  const Exposure interval = plain_interval(start, length, timeline_for(options, start, length));
  const double gain = brightening(options);
  const GainFunction function = shutter.function({interval.start_ns, interval.end_ns});
  // Whole before any of it is printed: it may be refused.
  const std::string text = function_text(tag, gain == 1.0 ? function : function.scaled(gain));
  print_line(format("# {} from {} for {}", options.operands.front(), whole_text(start), whole_text(length)));
  print_line(text);
  return 0;
}

}  // namespace nutik::app
