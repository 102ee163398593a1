#include "studio/window/picture_export.hpp"

#include "media/picture_writer.hpp"
#include "media/recipe.hpp"
#include "session/output_check.hpp"
#include "session/requests/output_request.hpp"
#include "session/text/number_text.hpp"
#include "studio/live/exposure_of.hpp"
#include "studio/live/live_view.hpp"

namespace nutik::studio {

Jobs::Work exporting(const Document& document, std::shared_ptr<Session> session, const CommandFiles& files,
                     const QString& picture, std::function<void(const QString&)> told) {
  const std::filesystem::path path = picture.toStdString();
  std::vector<std::string> inputs{document.facts()->path.toStdString()};
  if (document.mode() == ExposureMode::functions) {
    inputs.push_back(files.functions.toStdString());
    if (document.state().mask) inputs.push_back(files.mask.toStdString());
  }
  check_output(path, OutputKind::picture, inputs);
  return [state = document.state(), sources = recipe_sources(document, files), session = std::move(session),
          path, told = std::move(told)](const Job& job) -> Jobs::Finish {
    const auto mask = state.mask && state.mode == ExposureMode::functions
                          ? std::optional(LiveView::feathered_mask(state))
                          : std::nullopt;
    RenderControl control;
    control.stop = job.stop;
    PictureRecipe recipe(sources);
    const ExposedPicture exposed =
        session->render(exposure_of(state, mask), output_format({}, path, session->format()), control);
    write_picture(path, exposed.picture, recipe.text(std::string(to_text(exposed.precision))),
                  file_wishes({}));
    const QString line = Jobs::tr("%1: %2, %3")
                             .arg(QString::fromStdString(path.string()),
                                  QString::fromStdString(shape_text(exposed.picture.shape)),
                                  QString::fromStdString(saturated_text(exposed.saturation)));
    return [told, line] { told(line); };
  };
}

}  // namespace nutik::studio
