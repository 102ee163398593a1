// A trace for people, for spreadsheets and for scripts.
//
// What a step adds, and the sum, are shown to people as shares of the exposure: integrals divided by D, so
// that the last sum is the light of the picture. Tables and JSON have the integrals themselves.
#pragma once

#include <string>

#include "app/output/report.hpp"
#include "session/session.hpp"

namespace nutik::app {

// A row for each step. Unless all are wanted, the middle of a long run between two control points is folded
// into one row.
[[nodiscard]] std::string steps_text(const Trace& trace, const PlannedFunction& function, bool all);

// begin_ns,end_ns,begin_gain,end_gain, then for each channel its begin_light, end_light, integral_ns and sum_ns. Of a
// pixel that functions share each row begins with mask_value,share.
[[nodiscard]] std::string steps_csv(const TracedExposure& exposure);

// Of a pixel that functions share: its light, and under `functions` each of them.
[[nodiscard]] Json trace_json(const TracedExposure& exposure);

// `79.99 %`: what of a pixel's light a trace's function has.
[[nodiscard]] std::string share_text(const Trace& trace);

}  // namespace nutik::app
