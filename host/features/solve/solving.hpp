// Gains and times of functions that make a picture as it is wished: what is asked, and what came of it.
//
//   in:      gain functions with names in place of numbers, wishes about the light of regions, what else an exposure is
//            made of
//   out:     the function file with the numbers that come nearest, and what each wish got, told from an exposure with
//            that very file
//   always:  the capture is read once for all candidates; besides for a plate, where a wish is about one, and for the
//            exposure at the end
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "align/alignment.hpp"
#include "capture/memory_needs.hpp"
#include "features/solve/wish.hpp"
#include "render/output_format.hpp"
#include "session/requests/exposure_request.hpp"
#include "session/session.hpp"
#include "system/interruption.hpp"

namespace nutik {

// Functions with the mistakes of their text said, as those of a function file are. Throws InputError with all of them;
// UsageError where no number is named.
struct TemplateInput {
  FunctionTemplate functions;
  std::string warnings;
};
[[nodiscard]] TemplateInput read_template(std::string_view text, const std::string& title);
// The same of an input. Throws InputError where it cannot be read, too.
[[nodiscard]] TemplateInput read_template_input(const std::string& name);

struct SolveRequest {
  FunctionTemplate functions;
  ExposureRequest exposure;         // whose functions are those of the template, whatever it says
  std::vector<StatedFreedom> free;  // gains without one have no bounds
  std::vector<StatedWish> wishes;
  std::optional<Shared<Mask>> marks;  // of regions, R0 … R255

  [[nodiscard]] bool needs_plate() const;
};

struct SolvedWish {
  std::string text;
  WishedLight light;           // told from the exposure
  std::vector<double> missed;  // by channel, or of brightness alone
  double cost = 0.0;           // weight · Σ missed²

  // Whether what is missed is no more than half a code of 8 bits, as screens show it.
  [[nodiscard]] bool is_kept() const;
};

struct SolvedExposure {
  NamedNumbers numbers;
  std::string text;  // the function file
  std::vector<SolvedWish> wishes;
  std::vector<std::string> at_ends;  // names of the gains and times that came to an end of their range
  std::vector<std::size_t> untold;  // gains that no wish depends on
  std::size_t open_count = 0;       // by how many gains the others are more than wishes tell
  std::uint64_t tried = 0;          // candidate exposures
  Saturation saturation;            // of the picture as screens show it
  std::optional<MovedCamera> moved;  // looked for where a wish is about the plate
  std::vector<std::string> warnings;

  [[nodiscard]] bool is_kept() const;
  [[nodiscard]] double cost() const;
};

// Functions that are 1 everywhere, for the template's tags.
[[nodiscard]] FunctionSet tags_of(const FunctionTemplate& functions);

// Held beside rendering.
[[nodiscard]] NeedsOfFormat solve_needs(const SolveRequest& request);

// `capture_name` is for messages. Throws UsageError where a wish, a range or the whole request makes no sense for the
// capture, InputError where mask and functions do not fit or the capture is damaged, MemoryTooLittle.
[[nodiscard]] SolvedExposure solve(Session& session, const std::string& capture_name,
                                   const SolveRequest& request, const ReportedProgress& reading = {},
                                   const ReportedProgress& searching = {});

}  // namespace nutik
