// Times and gains as a person types and reads them, exactly; and the times at which a camera's exposures begin and
// end, as places to go to and to snap to.
#pragma once

#include <QString>
#include <cstdint>
#include <optional>

#include "capture/timeline.hpp"

namespace nutik::studio {

template <typename Number>
struct Typed {
  std::optional<Number> value;
  QString mistake;  // what is wrong and what would be right; empty where there is a value
};

// `400.000001 ms`, `1.5 s`: no digit is lost, and read_typed_time() reads it back.
[[nodiscard]] QString exact_time_text(std::int64_t time_ns);
// As times are stated everywhere (session/requests/stated_moments.hpp), blanks between number and unit allowed; `37f`
// is the start of picture 37.
[[nodiscard]] Typed<std::int64_t> read_typed_time(const QString& text, const Timeline& timeline);
// The same of a length, which is at least 1 ns; `3f` are three mean periods.
[[nodiscard]] Typed<std::int64_t> read_typed_length(const QString& text, const Timeline& timeline);

// As many digits as it takes to read the same number back.
[[nodiscard]] QString gain_text(double gain);
[[nodiscard]] Typed<double> read_typed_gain(const QString& text);

// What can be typed where a time is asked for.
[[nodiscard]] QString typed_time_help();

// The begin or end of a sample or of a picture that was filmed that is nearest to a time, or the capture's end.
[[nodiscard]] std::int64_t nearest_sample_edge(std::int64_t time_ns, const Timeline& timeline);
// The picture whose own exposure begins at a time or ends behind it, as `37f` counts, else that of the sample at that
// time; none where that was made.
[[nodiscard]] std::optional<std::uint64_t> picture_at(std::int64_t time_ns, const Timeline& timeline);
// `picture 37`, `made sample at 405 ms`.
[[nodiscard]] QString sample_text(std::int64_t time_ns, const Timeline& timeline);
// `start of picture 37`, of a nearest_sample_edge() before the capture's end.
[[nodiscard]] QString edge_text(std::int64_t edge_ns, const Timeline& timeline);

}  // namespace nutik::studio
