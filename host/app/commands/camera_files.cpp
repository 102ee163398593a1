#include "app/commands/camera_files.hpp"

#include "app/output/output_name.hpp"
#include "media/writers/picture_writer.hpp"
#include "media/writers/recipe.hpp"
#include "system/output_file.hpp"

namespace nutik::app {

CameraFiles::CameraFiles(const Options& options, const std::filesystem::path& capture,
                         std::vector<std::string> inputs)
    : folder_(options.align_report),
      table_(options.camera_path),
      plot_(options.camera_plot),
      coverage_(options.coverage) {
  if (folder_) {
    const std::filesystem::path folder = *folder_;
    if (!table_) table_ = (folder / "path.csv").string();
    if (!plot_) plot_ = (folder / "plot.png").string();
    if (!coverage_) coverage_ = (folder / "coverage.png").string();
  }
  constexpr std::uint32_t kColour = 3;
  inputs.push_back(capture.string());  // no two outputs of one name either
  if (table_) check_output(*table_, OutputKind::table, inputs, replacing(options));
  if (plot_) check_picture_output(*plot_, kColour, inputs, replacing(options));
  if (plot_) inputs.push_back(*plot_);
  if (coverage_) check_picture_output(*coverage_, 1, inputs, replacing(options));
}

void CameraFiles::write(const CameraPath& path, const Timeline& timeline, const std::string& heading,
                        Answer& answer) const {
  const std::string named[] = {table_.value_or(""), plot_.value_or(""), coverage_.value_or("")};
  std::error_code error;
  if (folder_) std::filesystem::create_directory(*folder_, error);  // what is written there says where it is not
  if (table_) write_text(*table_, camera_path_text(path));
  if (plot_) write_picture(*plot_, camera_chart(heading, path, timeline));
  if (coverage_) write_picture(*coverage_, coverage_of(path));
  const CameraPath::Step furthest = path.step(path.furthest());
  answer.json["camera"] = {{"motion", to_text(path.motion)},
                           {"reference", path.reference},
                           {"furthest_picture", path.furthest()},
                           {"furthest_pixels", {furthest.x, furthest.y}},
                           {"turned_degrees", path.step(path.max_turned()).degrees},
                           {"residual_pixels", path.residual_pixels()}};
  const char* const keys[] = {"path", "plot", "coverage"};
  for (std::size_t i = 0; i < std::size(keys); ++i) {
    if (!named[i].empty()) answer.json["camera"][keys[i]] = named[i];
  }
}

}  // namespace nutik::app
