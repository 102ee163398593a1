#include "features/sheets/sheet_making.hpp"

#include "capture/picture.hpp"

namespace nutik {

NeedsOfFormat sheet_needs(const sheet::SheetWishes& wishes) {
  constexpr std::uint64_t kPixelBytes = 8;  // on the canvas and in the picture
  const std::uint64_t width = wishes.width.value_or(sheet::kDefaultWidth);
  return [bytes = kPixelBytes * width * width](const CaptureFormat&) {
    return MemoryNeeds{{"the sheet", bytes}};
  };
}

Sheet make_sheet(Session& session, const SheetRequest& request, const ReportedProgress& progress,
                 const std::function<void(std::size_t number, const ExposedPicture& exposed)>& add) {
  const CaptureFormat& capture = session.format();
  const std::size_t count = request.exposures.size();
  const sheet::SheetLayout layout =
      sheet::lay_out(capture.shown_shape(), static_cast<std::uint32_t>(count), request.wishes);
  const OutputFormat output = output_format(request.codes, {}, code_type(capture), capture);

  sheet::ContactSheet sheet(layout, request.heading);
  for (std::size_t i = 0; i < count; ++i) {
    if (progress) progress(i, count);
    const auto& [label, functions] = request.exposures[i];
    const ExposedPicture exposed = session.render(functions, request.mask, request.plan, output);
    sheet.add(label, exposed.picture);
    add(i, exposed);
  }
  return {sheet.finished(), layout};
}

}  // namespace nutik
