#include <algorithm>

#include "app/output/console.hpp"
#include "app/requests/requests.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "session/requests/function_input.hpp"

namespace nutik::app {

SolveRequest solve_request(const Options& options) {
  if (!options.functions) {
    throw UsageError("solve needs gain functions, with names in place of what is to be found: -k named.fn");
  }
  SolveRequest request;
  // Wishes first: they are read faster than files.
  for (const Said& said : options.said) {
    if (said.option == "wish") request.wishes.push_back(StatedWish::parse(said.words.front()));
  }
  if (request.wishes.empty()) {
    throw UsageError("what is wished? Add --wish 'M0 = background', or --wish '300,150,60,60 gone' for example");
  }
  for (const StatedWish& wish : request.wishes) {
    const auto fail = [&](std::string_view letter, std::string_view what) {
      throw UsageError(format("--wish '{}': {} and a number is a value of {}", wish.text, letter, what));
    };
    if (wish.has_tag() && !options.mask) fail("M", "the mask; add -m mask.pgm");
    if (wish.has_mark() && !options.regions) fail("R", "a second mask; add --regions mask.pgm");
  }
  TemplateInput input = read_template_input(*options.functions);
  if (!input.warnings.empty()) print_note(input.warnings);
  request.functions = std::move(input.functions);
  for (const Said& said : options.said) {
    if (said.option != "free") continue;
    StatedFreedom free = StatedFreedom::parse(said.words.front(), request.functions);
    for (const StatedFreedom& other : request.free) {
      if (other.name == free.name) throw UsageError(format("--free states {} twice", free.name));
    }
    request.free.push_back(std::move(free));
  }
  for (const std::string& time : request.functions.times) {
    const bool is_stated =
        std::ranges::any_of(request.free, [&](const StatedFreedom& free) { return free.name == time; });
    if (!is_stated) {
      throw UsageError(format("{} stands for a time; say when it may be: --free {}=0.6s..0.8s", time, time));
    }
  }
  request.exposure = exposure_request(options, Shared(tags_of(request.functions)));
  if (options.regions) request.marks = Shared(read_mask_input(*options.regions, options.operands.front()));
  return request;
}

}  // namespace nutik::app
