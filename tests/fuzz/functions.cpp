// Function files; what is read from one is read again, identically, from what is written of it.
#include "exposure/function_file.hpp"
#include "exposure/function_text.hpp"
#include "fuzz/target.hpp"

namespace nutik::fuzz {
namespace {

void read(Bytes input) {
  const FunctionFile file = parse_functions(as_text(input));
  static_cast<void>(file.report("input.fn"));
  for (const auto& [tag, entry] : file.functions) {
    const FunctionFile again = parse_functions(function_text(tag, entry.function));
    demand(!again.has_errors() && again.functions.at(tag).function == entry.function,
           "a function is read from its text as it was");
  }
}

}  // namespace

// A mistake takes two bytes of text and is kept as a few lines, with the line that it is in.
const Target kTarget{{1 << 22, 2000}, read};

}  // namespace nutik::fuzz
