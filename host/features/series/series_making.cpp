#include "features/series/series_making.hpp"

#include <atomic>
#include <exception>
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
  std::atomic<bool> has_failed = false;
  std::exception_ptr failure;
  PictureQueue queue([&](std::size_t, const Error&) {
    if (!has_failed) failure = std::current_exception();
    has_failed = true;
  });
  PictureLine<ExposedPicture> line(session.pictures_at_once(output.type, pictures.size()));
  std::size_t asked = 0;
  for (std::uint64_t k = 0; k < pictures.size() && !has_failed; ++k) {
    if (progress) progress(k, pictures.size());
    for (; asked < pictures.size() && !line.is_full(); ++asked) {
      exposure.start = pictures[asked].start;
      line.add([&, exposure](const RenderControl& control) { return session.render(exposure, output, control); });
    }
    ExposedPicture exposed = line.take();
    std::string text = add ? add(k, exposed) : std::string();
    queue.push(k, pictures[k].path, std::move(exposed.picture), std::move(text), file);
  }
  queue.finish();
  if (failure) std::rethrow_exception(failure);
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
    if (!is_as_sealed(picture)) return false;
    recipe.file = Recipe().file;
    recipe.error_bound.clear();  // follows from the rest, as the map does
    recipe.bounds_map.reset();
    return recipe_of(recipe.precision) == recipe.text();
  } catch (const InputError&) {
    return false;  // no picture at all: whether it may be replaced is for check_output() to say
  }
}

}  // namespace nutik
