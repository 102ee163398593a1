// Where a camera's noise comes from: a file, or footage of it.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "app/input/capture_input.hpp"
#include "noise/noise_estimator.hpp"

namespace nutik::app {

// Samples that --noise auto looks at, from the clip's start: enough for any camera, and soon decoded.
inline constexpr std::uint64_t kAutomaticNoiseSamples = 256;

// Reads a noise file. Throws InputError naming file, line and column of what is wrong with it.
[[nodiscard]] CameraNoise read_noise_file(const std::filesystem::path& path);

// What a person should know where codes stand for light by another transfer function in the noise than in the
// clip, and the noise depends on it; empty where all is well. `name` is the noise file's.
[[nodiscard]] std::optional<std::string> transfer_note(const std::string& name, const CameraNoise& noise,
                                                       const Transfer& of_clip);

// Measures noise on clips of one format: several exposures of a still scene. Throws InputError where a clip
// is of another format than the first, naming both. What the clips say of themselves is added to `clip_notes`.
[[nodiscard]] NoiseEstimate measure_noise(std::span<const std::string> clips, const SourceOptions& options,
                                          std::uint64_t most_samples, std::vector<std::string>& clip_notes);

// What a person should know of an estimate: that little was still, or that no sensor's curve fits; empty where
// it is as it should be.
[[nodiscard]] std::vector<std::string> noise_notes(const NoiseEstimate& estimate);

}  // namespace nutik::app
