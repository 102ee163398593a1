// Functions and masks as requests hold them, from what a person names: a file, or `-` for standard input.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "exposure/mask.hpp"
#include "render/render_plan.hpp"
#include "session/shared.hpp"

namespace nutik {

struct FunctionInput {
  Shared<FunctionSet> functions;
  std::string warnings;  // of the text, with its lines; empty where there are none
};

// Throws InputError with all mistakes of the text; `title` names it there and in warnings.
[[nodiscard]] FunctionInput read_functions(std::string_view text, const std::string& title);
// The same of an input. Throws InputError where it cannot be read, too.
[[nodiscard]] FunctionInput read_function_input(const std::string& name);

// Throws InputError that says what was found and what is needed (media/mask_reader.hpp).
// Where it is for a `capture` whose size costs nothing to know, a .tik, another size is refused before it is read.
[[nodiscard]] Mask read_mask_input(const std::string& name, const std::optional<std::string>& capture = {});

}  // namespace nutik
