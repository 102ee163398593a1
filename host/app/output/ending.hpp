// How commands end, once their output is written.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "app/command_line/options.hpp"
#include "app/output/exposure_tally.hpp"
#include "app/output/json.hpp"
#include "app/output/stopwatch.hpp"
#include "session/session.hpp"

namespace nutik::app {

// Whether -q leaves nothing more to say; prints the output's name where nobody gave it one: with -o or as the second
// operand, unless `was_named` says how.
[[nodiscard]] bool ended_quietly(const Options& options, const std::filesystem::path& output);
[[nodiscard]] bool ended_quietly(const Options& options, const std::filesystem::path& output, bool was_named);

// What comes after the summary of exposures: with -v the renderer's report on the last one, then the notes.
void print_details(const Options& options, const ExposureTally& tally, std::span<const std::string> notes);

// What exposures were made with, for scripts: `precision`, `renderer`, `seconds`.
void add_rendering(Json& json, const Session& session, const ExposureTally& tally,
                   const Stopwatch& stopwatch);

}  // namespace nutik::app
