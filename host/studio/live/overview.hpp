// What is shown of a whole capture beside its picture: when it changes, small pictures of it, the light of one pixel.
// Parts of jobs.
#pragma once

#include "session/session.hpp"
#include "studio/document/document.hpp"
#include "studio/live/jobs.hpp"

namespace nutik::studio {

// Small pictures at evenly spaced times.
[[nodiscard]] CaptureOverview thumbnails_of(Session& session, const Job& job);
// By sample.
[[nodiscard]] std::vector<double> changed_shares_of(Session& session, const Job& job);
[[nodiscard]] Waveform waveform_of(Session& session, QPoint pixel);

}  // namespace nutik::studio
