#include "features/masks/mask_request.hpp"

#include <algorithm>

#include "session/requests/named_inputs.hpp"

namespace nutik {
namespace {

// The pictures and times that a selection names.
std::vector<const PictureSource*> sources_of(const Selection& selection) {
  if (const auto* threshold = std::get_if<select::Threshold>(&selection)) return {&threshold->picture};
  if (const auto* difference = std::get_if<select::Difference>(&selection)) {
    return {&difference->before, &difference->after};
  }
  return {};
}

}  // namespace

bool MaskStep::compares() const {
  return std::holds_alternative<select::Difference>(selection) ||
         std::holds_alternative<select::Motion>(selection) || needs_plate() ||
         std::holds_alternative<select::Stillness>(selection);
}

std::uint8_t MaskStep::last_tag() const {
  const auto* grid = std::get_if<select::Grid>(&selection);
  return grid == nullptr ? tag : static_cast<std::uint8_t>(tag + grid->columns * grid->rows - 1);
}

bool MaskStep::reads_capture() const {
  const auto sources = sources_of(selection);
  return sources.empty() ? compares() : pictures().size() < sources.size();
}

std::vector<const NamedPicture*> MaskStep::pictures() const {
  std::vector<const NamedPicture*> pictures;
  for (const PictureSource* source : sources_of(selection)) {
    if (const auto* picture = std::get_if<NamedPicture>(source)) pictures.push_back(picture);
  }
  return pictures;
}

void read_named_pictures(MaskRequest& request) {
  const auto read = [](PictureSource& source) {
    auto* picture = std::get_if<NamedPicture>(&source);
    if (picture == nullptr) return;
    ReadPicture read_in = read_picture(picture->name);
    picture->picture = Shared(std::move(read_in.codes));
    picture->holds_light = read_in.holds_light;
    picture->says_primaries = read_in.says_primaries;
  };
  for (MaskStep& step : request.steps) {
    if (auto* threshold = std::get_if<select::Threshold>(&step.selection)) read(threshold->picture);
    if (auto* difference = std::get_if<select::Difference>(&step.selection)) {
      read(difference->before);
      read(difference->after);
    }
  }
}

bool MaskRequest::tells_by_rest() const {
  return std::ranges::any_of(steps, [](const MaskStep& step) {
    return step.needs_plate() || std::holds_alternative<select::Motion>(step.selection) ||
           std::holds_alternative<select::Stillness>(step.selection);
  });
}

}  // namespace nutik
