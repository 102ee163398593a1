#include "studio/document/texts.hpp"

#include "session/below/format.hpp"

namespace nutik::studio {

std::string feather_text(const Feather& feather) {
  std::string text;
  if (feather.everywhere != 0 || feather.of_tag.empty()) text = format("{}px", feather.everywhere / 100.0);
  for (const auto& [tag, reach] : feather.of_tag)
    text += format("{}M{}={}px", text.empty() ? "" : ",", tag, reach / 100.0);
  return text;
}

std::string functions_text(const FunctionSet& functions) {
  std::string text;
  for (const auto& [tag, function] : functions) text += function_text(tag, function) + "\n";
  return text;
}

}  // namespace nutik::studio
