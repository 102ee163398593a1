// Function files; what is read from one is read again, identically, from what is written of it. The same text as one
// with names in place of numbers: with numbers it is a function file.
#include <algorithm>

#include "exposure/function_file.hpp"
#include "exposure/function_template.hpp"
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
  const FunctionTemplate named = parse_template(as_text(input));
  const NamedNumbers numbers{std::vector<double>(named.gains.size(), 1.5),
                             std::vector<std::int64_t>(named.times.size(), 1'000'000)};
  const bool is_ordered = std::ranges::all_of(named.functions, [&](const auto& entry) {
    return FunctionTemplate::points(entry.second, numbers.times_ns).has_value();
  });
  demand(named.has_errors() || !is_ordered || !parse_functions(named.text_with(numbers)).has_errors(),
         "a file with names is a function file with numbers");
}

}  // namespace

// A mistake takes two bytes of text and is kept as a few lines, with the line that it is in.
const Target kTarget{{1 << 22, 2000}, read};

}  // namespace nutik::fuzz
