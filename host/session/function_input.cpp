#include "session/function_input.hpp"

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/function_file.hpp"
#include "media/mask_reader.hpp"
#include "system/input_bytes.hpp"

namespace nutik {

FunctionInput read_functions(std::string_view text, const std::string& title) {
  const FunctionFile file = parse_functions(text);
  std::string report = file.report(title);
  if (file.has_errors()) throw InputError(format("{} has mistakes:\n{}", title, report));
  FunctionSet functions;
  for (const auto& [tag, read] : file.functions) functions.emplace(tag, read.function);
  return {Shared(std::move(functions)), std::move(report)};
}

FunctionInput read_function_input(const std::string& name) {
  return read_functions(InputBytes(name).text(), input_title(name));
}

Mask read_mask_input(const std::string& name) {
  return Mask::from_picture(read_mask(InputBytes(name).bytes(), input_title(name)));
}

}  // namespace nutik
