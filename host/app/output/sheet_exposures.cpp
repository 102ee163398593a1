#include "app/output/sheet_exposures.hpp"

#include "app/output/output_name.hpp"
#include "app/requests/output_words.hpp"
#include "app/text/number_text.hpp"
#include "session/pictures.hpp"
#include "session/sheets.hpp"

namespace nutik::app {

sheet::SheetWishes sheet_wishes(const Options& options) {
  sheet::SheetWishes wishes;
  if (options.columns) wishes.columns = parse_whole_number(*options.columns, "--columns", 1, 1000);
  if (options.width) wishes.width = parse_whole_number(*options.width, "--width", 100, plot::kLargestSide);
  return wishes;
}

void check_sheet_output(const std::filesystem::path& output, std::span<const std::string> inputs) {
  check_output(output, OutputKind::picture, inputs);
  constexpr std::uint32_t kColour = 3;
  static_cast<void>(value_type_for(output, Depth::bits8, ValueType::code8, kColour));
}

std::filesystem::path sheet_output(const Options& options, const std::string& command,
                                   const std::string& suffix) {
  const auto stated = stated_output(options.output, options.operands, command);
  return stated.value_or(sequence_name(options.operands.front()) + "-" + suffix + ".png");
}

SheetExposures::SheetExposures(const Options& options, Session& session, Mask mask, PlanOptions plan_options)
    : session_(session),
      mask_(std::move(mask)),
      plan_options_(std::move(plan_options)),
      transfer_(session.format().transfer) {
  const CaptureFormat& format = session.format();
  format_.type = code_type(format);
  format_.white_code = format.white_code;
  format_.negative = negative_light(output_request(options), format_.type, {});
  if (options.transfer) plan_options_.transfer = transfer_ = Transfer::parse(*options.transfer);
}

ExposedPicture SheetExposures::expose(const FunctionSet& functions) {
  ExposedPicture exposed = session_.render(functions, mask_, plan_options_, format_);
  tally_.add(exposed);
  return exposed;
}

}  // namespace nutik::app
