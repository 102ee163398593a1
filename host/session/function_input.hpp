// The functions of a function file, for requests.
#pragma once

#include <string>
#include <string_view>

#include "render/render_plan.hpp"
#include "session/shared.hpp"

namespace nutik {

struct FunctionInput {
  Shared<FunctionSet> functions;
  std::string warnings;  // of the text, with its lines; empty where there are none
};

// Throws InputError with all mistakes of the text; `title` names it there and in warnings.
[[nodiscard]] FunctionInput read_functions(std::string_view text, const std::string& title);

}  // namespace nutik
