// Pixels that are found in the capture, for the selected region: as jobs, since they read it.
#pragma once

#include <QString>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "session/session.hpp"
#include "studio/document/document.hpp"
#include "studio/live/jobs.hpp"

namespace nutik::studio {

// Between the capture's pictures at two times.
struct Difference {
  std::int64_t from_ns = 0, to_ns = 0;
  std::optional<std::uint32_t> by_codes;  // only larger ones count; none: told from the pictures
  bool is_largest_part = false;           // without the others
};

// What was found, and how many pixels: nothing is painted where there are none.
using ToldSelection = std::function<void(const QString&)>;

// Each is one step: paints the region that is selected at the start, which is not the background.
[[nodiscard]] Jobs::Work selecting_motion(Document& document, std::shared_ptr<Session> session,
                                          ToldSelection told);
[[nodiscard]] Jobs::Work selecting_difference(Document& document, std::shared_ptr<Session> session,
                                              const Difference& difference, ToldSelection told);

}  // namespace nutik::studio
