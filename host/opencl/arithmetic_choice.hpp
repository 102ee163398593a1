// The arithmetic of a picture, on one device or several: the fastest that is right enough and computed rightly.
//
//   in:      a plan, the picture's format, what the devices have in common, whoever tests an arithmetic on them
//   out:     the arithmetic, why, and what is doubtful about it
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "render/renderer.hpp"

namespace nutik {

// What is wrong with pictures of an arithmetic, for a person to read; empty: nothing.
using FaultOf = std::function<std::string(Precision precision)>;

// Sets the arithmetic, the choice, the self-test and warnings of `rendered`. `available` are the fastest first; `asked`
// is taken as it is named, a wrong one only if control.takes_wrong. `device` is what a person calls what computes.
// Throws DeviceError where what is asked for, or all that are available, are computed wrongly; ImpreciseError if
// control.strict and the picture may err by too much.
void choose_arithmetic(const RenderPlan& plan, const OutputFormat& output,
                       std::span<const Precision> available, std::optional<Precision> asked,
                       const std::string& device, const RenderControl& control, const FaultOf& fault_of,
                       Rendered& rendered);

}  // namespace nutik
