#include "session/function_input.hpp"

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/function_file.hpp"
#include "exposure/mask_check.hpp"
#include "media/mask_reader.hpp"
#include "session/clip_source.hpp"
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

Mask read_mask_input(const std::string& name, const std::optional<std::string>& capture) {
  const InputBytes input(name);
  const auto shape = capture ? known_shape(*capture) : std::nullopt;
  return Mask::from_picture(
      read_mask(input.bytes(), input_title(name), [&](std::uint32_t width, std::uint32_t height) {
        const std::string mistake = shape ? size_mistake({width, height, {}}, *shape) : std::string();
        if (!mistake.empty()) throw InputError(mistake);
      }));
}

}  // namespace nutik
