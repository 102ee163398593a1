#include "session/making/study_slit.hpp"

#include <algorithm>
#include <string>

#include "capture/format.hpp"
#include "session/making/gain_pieces.hpp"

namespace nutik {

Study slit_study(CaptureSource& capture, const std::string& name, std::uint32_t wanted, SlitFrom from) {
  const std::uint64_t samples = capture.timeline().sample_count();
  const Shape& shape = capture.format().shape;
  const bool are_columns = from == SlitFrom::left || from == SlitFrom::right;
  const bool are_reversed = from == SlitFrom::right || from == SlitFrom::bottom;
  const auto strips = static_cast<std::uint32_t>(
      std::min<std::uint64_t>({wanted, samples, are_columns ? shape.width : shape.height}));
  const char* const strip = are_columns ? "column" : "row";
  if (strips < 2) throw InputError(format("{}: a single {} shows nothing of the time", name, strip));
  Study study;
  for (std::uint32_t i = 0; i < strips; ++i) {
    const std::uint64_t moment = are_reversed ? strips - 1 - i : i;
    const std::uint64_t sample = moment * (samples - 1) / (strips - 1);
    GainPieces pieces;
    pieces.add({capture.timeline().start_ns(sample), capture.timeline().end_ns(sample)}, 1, 1);
    study.moments.push_back(sample);
    study.functions.emplace(static_cast<std::uint8_t>(i), pieces.function());
  }
  const select::Grid grid{are_columns ? strips : 1, are_columns ? 1 : strips};
  study.mask.steps.push_back({{"slits"}, 0, grid, std::nullopt, {}});
  if (strips < wanted) {
    study.notes.push_back(format("{} {}s, not {}: there are no more {}", strips, strip, wanted,
                                 strips == samples ? "pictures"
                                 : are_columns     ? "pixels in a row"
                                                   : "pixels in a column"));
  }
  return study;
}

}  // namespace nutik
