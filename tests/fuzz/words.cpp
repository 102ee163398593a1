// What people write on a command line: times, shutter shapes, rates.
#include "exposure/shutter_shape.hpp"
#include "fuzz/target.hpp"
#include "session/requests/stated_moments.hpp"

namespace nutik::fuzz {
namespace {

void read_time(std::string_view text) {
  const StatedTime time = StatedTime::parse(text, "a time");
  demand(StatedTime::parse(time.text(), "again") == time, "a time is read from its text as it was");
  if (!time.counts_samples()) static_cast<void>(time.nanoseconds());
}

void read_shape(std::string_view text) {
  const ShutterShape shape = ShutterShape::parse(text);
  static_cast<void>(shape.function({0, 1'000'000}, 0.01));
}

void read(Bytes input) {
  const std::string_view text = as_text(input);
  if (text.empty()) return;
  const std::string_view rest = text.substr(1);
  switch (text.front()) {
    case 's': return read_shape(rest);
    case 'r': static_cast<void>(Rational::parse(rest, "a rate")); return;
    default: return read_time(rest);
  }
}

}  // namespace

// A strobe has up to a million flashes, with four corners of 32 bytes each; a vector that grows is there twice.
const Target kTarget{{std::size_t{1} << 29, 0}, read};

}  // namespace nutik::fuzz
