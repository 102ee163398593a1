// Pixels that are found in the capture, for the selected region: as jobs, since they read it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "capture/timeline.hpp"
#include "session/session.hpp"
#include "studio/document/document.hpp"
#include "studio/live/jobs.hpp"

class QWidget;

namespace nutik::studio {

// Between the capture's pictures at two times.
struct Difference {
  std::int64_t from_ns = 0, to_ns = 0;
  std::optional<std::uint32_t> by_codes;  // only larger ones count; none: told from the pictures
  bool is_largest_part = false;           // without the others
};

// Each is one step: paints the region that is selected at the start, which is not the background. `told` gets what was
// found, and how many pixels: nothing is painted where there are none.
[[nodiscard]] Jobs::Work selecting_motion(Document& document, std::shared_ptr<Session> session, Told told);
[[nodiscard]] Jobs::Work selecting_difference(Document& document, std::shared_ptr<Session> session,
                                              const Difference& difference, Told told);

// Asks which two moments these are. What cannot be read is explained in the dialog, which stays open.
void ask_difference(QWidget* parent, const Timeline& timeline, const Difference& first,
                    std::function<void(const Difference&)> use);

}  // namespace nutik::studio
