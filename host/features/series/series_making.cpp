#include "features/series/series_making.hpp"

#include <utility>

#include "capture/error.hpp"
#include "features/series/picture_queue.hpp"
#include "media/stills/picture_text.hpp"
#include "media/writers/recipe.hpp"
#include "session/output_check.hpp"

namespace nutik {

void make_series(Session& session, ExposureRequest exposure, const std::vector<SeriesPicture>& pictures,
                 const OutputFormat& output, const FileWishes& file, const ReportedProgress& progress,
                 const std::function<std::string(std::uint64_t number, ExposedPicture& exposed)>& add) {
  PictureQueue queue([](Channel<PictureJob>& jobs) {
    while (const auto job = jobs.pop()) job->write();
  });
  PictureLine<ExposedPicture> line(session.pictures_at_once(output.type, pictures.size()));
  const auto work_of = [&](std::size_t k) {
    exposure.start = pictures[k].start;
    return [&, exposure](const RenderControl& control) { return session.render(exposure, output, control); };
  };
  line.make(pictures.size(), progress, work_of, [&](std::size_t k, ExposedPicture exposed) {
    std::string text = add ? add(k, exposed) : std::string();
    return queue.push({k, pictures[k].path, std::move(exposed.picture), std::move(text), file});
  });
  queue.finish();
}

bool is_made(const std::filesystem::path& picture, const std::optional<std::string>& precision,
             const std::filesystem::path& map,
             const std::function<std::string(const std::string& precision)>& recipe_of) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(picture, error)) return false;
  try {
    const auto text = read_picture_text(picture);
    if (!text) return false;
    Recipe recipe = Recipe::parse(*text, picture.string());
    if (precision && recipe.precision != *precision) return false;
    if (recipe.text() != *text) return false;
    const bool has_map = recipe.bounds_map && recipe.bounds_map->name == map.filename() &&
                         std::filesystem::is_regular_file(map, error) &&
                         led_to(map) == led_to(picture.parent_path() / map.filename());
    if (!map.empty() && !has_map) return false;
    if (!recipe.file.empty() && !is_as_sealed(picture)) return false;  // an earlier version's does not tell
    recipe.file = Recipe().file;
    recipe.error_bound.clear();  // follows from the rest, as the map does
    recipe.bounds_map.reset();
    return recipe_of(recipe.precision) == recipe.text();
  } catch (const InputError&) {
    return false;  // no picture at all: whether it may be replaced is for check_output() to say
  }
}

}  // namespace nutik
