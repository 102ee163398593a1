#include "opencl/arithmetic_choice.hpp"

#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik {
namespace {

// Said only of what the program chose: a person who asks for an arithmetic gets it.
void warn(Rendered& rendered, const OutputFormat& output, const std::string& device) {
  if (rendered.choice->is_right_enough()) return;
  rendered.warnings.push_back(
      format("no arithmetic of {} is sure to be right to {} of a code here; {} is the closest: {}", device,
             kMaxSteps, to_text(rendered.precision), error_text(rendered.choice->bound.worst, output)));
}

}  // namespace

void choose_arithmetic(const RenderPlan& plan, const OutputFormat& output,
                       std::span<const Precision> available, std::optional<Precision> asked,
                       const std::string& device, bool takes_wrong, const FaultOf& fault_of, Rendered& rendered) {
  std::vector<Precision> left(available.begin(), available.end());
  if (asked) left = {*asked};
  std::string faults;
  while (!left.empty()) {
    rendered.choice = choose_precision(plan, output, left);
    rendered.precision = rendered.choice->precision();
    const std::string fault = fault_of(rendered.precision);
    rendered.passed_self_test = fault.empty();
    if (asked && !fault.empty() && !takes_wrong) {
      throw DeviceError(format("{}: this driver computes `{}` wrongly (self-test: {}); use auto or another arithmetic, "
                               "another device or the reference",
                               device, to_text(*asked), fault),
                        {Setting::precision, Setting::renderer});
    }
    if (!asked && fault.empty()) warn(rendered, output, device);
    if (asked || fault.empty()) return;
    faults += format("\n  {}: {}", to_text(rendered.precision), fault);
    std::erase(left, rendered.precision);
  }
  throw DeviceError(
      format("{} computes every arithmetic wrongly (self-test):{}\nuse another device or the reference",
             device, faults),
      {Setting::renderer});
}

}  // namespace nutik
