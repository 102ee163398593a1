#include "studio/regions/selections.hpp"

#include <algorithm>
#include <utility>

#include "session/making/mask_making.hpp"
#include "studio/regions/region_edits.hpp"
#include "studio/time/typed_numbers.hpp"

namespace nutik::studio {
namespace {

constexpr double kSmooth = 1;          // pixels: narrower parts are noise
constexpr std::uint8_t kInside = 255;  // of the mask that is made

// `what` names it for undo; `found` begins what is said of it: "12 pixels …".
Jobs::Work selecting(Document& document, std::shared_ptr<Session> session, MaskStep step, const QString& what,
                     const QString& found, ToldSelection told) {
  step.name.text = what.toStdString();
  step.tag = kInside;
  step.changes.push_back({RegionChange::Kind::smooth, kSmooth, {}});
  return [&document, session = std::move(session), step = std::move(step), what, found,
          told = std::move(told), tag = document.selected_tag()](const Job&) -> Jobs::Finish {
    MaskRequest request;
    request.steps = {step};
    const MadeMask made = make_mask(request, &session->capture(), session->source().path.string());
    auto region = std::make_shared<Region>(Region::none(made.mask.width, made.mask.height));
    std::ranges::transform(made.mask.tags, region->inside.begin(),
                           [](std::uint8_t of) { return static_cast<std::uint8_t>(of == kInside); });
    const StepReport& report = made.steps.front();
    QString line = Document::tr("%1 pixels %2").arg(report.pixel_count).arg(found);
    if (report.by_codes) line += Document::tr(", by more than %1 codes").arg(*report.by_codes);
    return [&document, region, tag, what, line, told, is_empty = report.pixel_count == 0] {
      if (!document.functions().contains(tag)) return;  // it was taken away meanwhile
      if (!is_empty) paint_region(document, *region, tag, what);
      told(is_empty ? Document::tr("%1: the region stays as it is.").arg(line) : line + ".");
    };
  };
}

}  // namespace

Jobs::Work selecting_motion(Document& document, std::shared_ptr<Session> session, ToldSelection told) {
  MaskStep step;
  step.selection = select::Motion();
  return selecting(document, std::move(session), std::move(step), Document::tr("Select what moves"),
                   Document::tr("move within the capture"), std::move(told));
}

Jobs::Work selecting_difference(Document& document, std::shared_ptr<Session> session,
                                const Difference& difference, ToldSelection told) {
  MaskStep step;
  step.selection = select::Difference{StatedTime::of_nanoseconds(difference.from_ns),
                                      StatedTime::of_nanoseconds(difference.to_ns)};
  step.by_codes = difference.by_codes;
  if (difference.is_largest_part) step.changes.push_back({RegionChange::Kind::largest, 0, {}});
  return selecting(document, std::move(session), std::move(step), Document::tr("Select what differs"),
                   Document::tr("differ between %1 and %2")
                       .arg(exact_time_text(difference.from_ns), exact_time_text(difference.to_ns)),
                   std::move(told));
}

}  // namespace nutik::studio
