// Makes a sheet: exposures of one capture with ever other functions, one after another, with labels.
//
//   always:  every picture is what expose would write at the capture's own depth; the sheet has square pixels and sRGB
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "exposure/mask.hpp"
#include "session/requests/output_request.hpp"
#include "session/session.hpp"
#include "sheet/contact_sheet.hpp"

namespace nutik {

struct SheetRequest {
  struct Exposed {
    std::string label;
    FunctionSet functions;
  };

  std::string heading;
  std::vector<Exposed> exposures;
  Mask mask;
  PlanOptions plan;
  sheet::SheetWishes wishes;
  OutputRequest codes;  // of the pictures, at the capture's own depth
};

struct Sheet {
  Picture picture;  // 8-bit colour
  sheet::SheetLayout layout;
};

// What a sheet takes while it is drawn, if it is no higher than wide.
[[nodiscard]] NeedsOfFormat sheet_needs(const sheet::SheetWishes& wishes);

// `add` is told each picture as it was exposed, and its number. Throws UsageError where the sheet cannot be laid out,
// and as Session::render() does.
[[nodiscard]] Sheet make_sheet(
    Session& session, const SheetRequest& request, const ReportedProgress& progress,
    const std::function<void(std::size_t number, const ExposedPicture& exposed)>& add);

}  // namespace nutik
