#include "app/output/skipping.hpp"

#include "app/output/report.hpp"
#include "session/below/error.hpp"
#include "session/below/format.hpp"
#include "session/below/pictures.hpp"
#include "session/output_check.hpp"
#include "session/text/size_text.hpp"

namespace nutik::app {

void require_recipes(const Options& options, const std::filesystem::path& picture) {
  if (options.no_recipe) {
    throw UsageError("--skip-existing knows pictures by their recipes, and --no-recipe makes them without; use one");
  }
  if (names_standard_output(picture) || !is_picture_name(picture) || picture.extension() == ".pfm") {
    throw UsageError(
        format("--skip-existing knows pictures by their recipes, and {} has no place for one; write pictures, for a "
               "video numbered ones: frame-%05d.png, .tif, .exr, …",
               picture.string()));
  }
}

std::optional<std::string> stated_precision(const Options& options) {
  return options.precision ? std::optional(to_text(*options.precision)) : std::nullopt;
}

int tell_all_made(const Options& options, const std::filesystem::path& output, std::size_t count,
                  std::string_view thing) {
  Answer answer{{{"picture", output.string()}, {"skipped", count}}};
  answer.line = format("{}: {}, there already", output.string(), counted(count, std::string(thing)));
  return tell(options, output, answer);
}

}  // namespace nutik::app
