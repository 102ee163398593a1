#include "app/command_line/option_groups.hpp"

namespace nutik::app {
namespace {

constexpr std::string_view kGroup = "Validation";

}  // namespace

std::vector<Option> validation_options() {
  return {
      valued(0, "source", "CLIP", kGroup,
             "also compare the capture with the clip that it was made from, picture by picture",
             bit(CommandId::validate), &Options::source),
      valued(0, "runs", "N", kGroup, "renders that are timed in each arithmetic, in turns (default: 5)",
             bit(CommandId::validate), &Options::runs),
  };
}

}  // namespace nutik::app
