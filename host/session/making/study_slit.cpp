#include "session/making/study_slit.hpp"

#include <algorithm>
#include <string>

#include "capture/format.hpp"
#include "session/making/gain_pieces.hpp"

namespace nutik {

Study slit_study(CaptureSource& capture, const std::string& name, std::uint32_t wanted) {
  const std::uint64_t samples = capture.timeline().sample_count();
  const auto columns =
      static_cast<std::uint32_t>(std::min<std::uint64_t>({wanted, samples, capture.format().shape.width}));
  if (columns < 2) throw InputError(format("{}: a single column shows nothing of the time", name));
  Study study;
  for (std::uint32_t i = 0; i < columns; ++i) {
    const std::uint64_t sample = std::uint64_t{i} * (samples - 1) / (columns - 1);
    GainPieces moment;
    moment.add({capture.timeline().start_ns(sample), capture.timeline().end_ns(sample)}, 1, 1);
    study.moments.push_back(sample);
    study.functions.emplace(static_cast<std::uint8_t>(i), moment.function());
  }
  study.mask.steps.push_back({{"slits"}, 0, select::Grid{columns, 1}, std::nullopt, {}});
  if (columns < wanted) {
    study.notes.push_back(format("{} columns, not {}: there are no more {}", columns, wanted,
                                 columns == samples ? "pictures" : "pixels in a row"));
  }
  return study;
}

}  // namespace nutik
