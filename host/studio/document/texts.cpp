#include "studio/document/texts.hpp"

#include "session/below/format.hpp"

namespace nutik::studio {

std::string feather_text(int feather) { return format("{}px", feather / 100.0); }

std::string functions_text(const FunctionSet& functions) {
  std::string text;
  for (const auto& [tag, function] : functions) text += function_text(tag, function) + "\n";
  return text;
}

}  // namespace nutik::studio
