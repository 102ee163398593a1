// Makes a series: exposures of one capture, each in a file of its own, which is written while the next is exposed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "session/requests/exposure_request.hpp"
#include "session/requests/output_request.hpp"
#include "session/session.hpp"

namespace nutik {

struct SeriesPicture {
  StatedTime start;
  std::filesystem::path path;
  std::uint64_t number = 0;  // in the series
};

// `exposure` says all but where each begins. `add`, which may be empty, is told each picture as it was exposed, and
// returns the text that goes into its file. Throws what Session::render() does; OutputError at the first picture that
// cannot be written: the next ones are not exposed.
void make_series(Session& session, ExposureRequest exposure, const std::vector<SeriesPicture>& pictures,
                 const OutputFormat& output, const FileWishes& file, const ReportedProgress& progress,
                 const std::function<std::string(std::uint64_t number, ExposedPicture& exposed)>& add);

// Whether `picture` is there with the very recipe, byte for byte, that `recipe_of` makes for its precision: the same
// capture, functions, mask, options and version of the program. `precision`: the only one that counts; none: any, for
// `auto` is settled when a picture is computed. What carries no recipe, or cannot be read, is not made yet, nor without
// `map`, which its recipe must name; empty: with a map or without.
[[nodiscard]] bool is_made(const std::filesystem::path& picture, const std::optional<std::string>& precision,
                           const std::filesystem::path& map,
                           const std::function<std::string(const std::string& precision)>& recipe_of);

}  // namespace nutik
