// A camera's noise, from a file or from footage of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "capture/noise_file.hpp"
#include "media/clip.hpp"
#include "noise/noise_estimator.hpp"
#include "noise/stillness.hpp"
#include "session/memory_budget.hpp"
#include "session/requests/source_request.hpp"

namespace nutik {

// Samples that a clip's own noise is measured on, from its start: enough for any camera, and soon decoded.
inline constexpr std::uint64_t kSamplesOfOwnNoise = 256;

// The way out where a clip does not tell its own noise.
inline constexpr std::string_view kNoiseElsewhere =
    "Take the noise of a still scene, filmed with the same settings and not compressed, or a tolerance";

// Throws InputError naming file, line and column of what is wrong with a noise file.
[[nodiscard]] CameraNoise read_noise_file(const std::filesystem::path& path);

// What a person should know where codes stand for light by another transfer function in the noise than in the
// clip, and the noise depends on it; none where all is well.
[[nodiscard]] std::optional<std::string> transfer_note(const StatedNoise& stated, const Transfer& of_clip);

struct ClipTold {
  std::vector<Fact> facts;
  std::vector<Note> notes;
};

// Measures noise on clips of one format: several exposures of a still scene. Throws InputError where a clip
// is of another format than the first, naming both; MemoryTooLittle, before any is read, with the least that does.
// `told` gets what the first clip is taken for, and the notes on all.
[[nodiscard]] NoiseEstimate measure_noise(std::span<const std::string> clips, const ClipOptions& options,
                                          std::uint64_t max_samples, const MemoryBudget& memory,
                                          ClipTold& told);

// Throws InputError where light strays by more than its noise explains: the clip moves, or its brightness drifts, and a
// capture with that noise would hold light that was not there. Returns a note where only some regions stray.
[[nodiscard]] std::optional<Note> check_stillness(const Stillness& stillness, const SourceRequest& request);

// Why this is no sensor's noise; empty where it may be. Pixels that lie apart stray alike, or at many codes some stray
// more than others: something moves, or a codec removed the noise. Codes held within it would leave rings round what
// moves.
[[nodiscard]] std::string reason_for_no_noise(const NoiseEstimate& estimate);

// What a person should know of an estimate: that little was still, or that no sensor's curve fits; empty where
// it is as it should be.
[[nodiscard]] std::vector<std::string> noise_notes(const NoiseEstimate& estimate);

}  // namespace nutik
