#include "opencl/arithmetic_choice.hpp"

#include <utility>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik {
namespace {

// An arithmetic that was asked for is taken, however coarse it is; of codes that is said. Strictly none is.
void doubt(Rendered& rendered, const OutputFormat& output, bool is_asked, const RenderControl& control,
           const std::string& device) {
  if (rendered.choice->is_right_enough()) return;
  if (is_asked && !control.strict && (control.is_chosen || !holds_codes(output.type))) return;
  const std::string name = to_text(rendered.precision), error = error_text(rendered.choice->bound.worst, output);
  std::string text =
      is_asked ? format("{}: {}; auto takes an arithmetic that is sure, where there is one",
                        not_sure_text(name, output), error)
               : format("no arithmetic of {} is sure to be right to {} here; {} is the closest: {}", device,
                        half_step_text(output), name, error);
  if (control.strict) throw ImpreciseError(text);
  rendered.warnings.push_back(std::move(text));
}

}  // namespace

void choose_arithmetic(const RenderPlan& plan, const OutputFormat& output,
                       std::span<const Precision> available, std::optional<Precision> asked,
                       const std::string& device, const RenderControl& control, const FaultOf& fault_of,
                       Rendered& rendered) {
  std::vector<Precision> left(available.begin(), available.end());
  if (asked) left = {*asked};
  std::string faults;
  measure_tables(plan, control.stop);
  while (!left.empty()) {
    rendered.choice = choose_precision(plan, output, left);
    rendered.precision = rendered.choice->precision();
    const std::string fault = fault_of(rendered.precision);
    rendered.passed_self_test = fault.empty();
    if (asked && !fault.empty() && !control.takes_wrong) {
      throw DeviceError(format("{}: this driver computes `{}` wrongly (self-test: {}); use auto or another arithmetic, "
                               "another device or the reference",
                               device, to_text(*asked), fault),
                        {Setting::precision, Setting::renderer});
    }
    if (asked || fault.empty()) return doubt(rendered, output, asked.has_value(), control, device);
    faults += format("\n  {}: {}", to_text(rendered.precision), fault);
    std::erase(left, rendered.precision);
  }
  throw DeviceError(format("{} computes every arithmetic wrongly (self-test):{}", device, faults),
                    Advice{"\nuse another device or the reference (`renderer`)"});
}

}  // namespace nutik
