#include "studio/regions/difference_dialog.hpp"

#include <QCheckBox>
#include <QDialog>
#include <QDialogButtonBox>
#include <QFormLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSpinBox>
#include <algorithm>
#include <utility>

#include "features/masks/mask_making.hpp"
#include "studio/live/opening.hpp"
#include "studio/regions/region_edits.hpp"
#include "studio/regions/region_list.hpp"
#include "studio/time/times.hpp"

namespace nutik::studio {
namespace {

constexpr double kSmooth = 1;          // pixels: narrower parts are noise
constexpr std::uint8_t kInside = 255;  // of the mask that is made

// `what` names it for undo; `found` begins what is said of it: "12 pixels …".
Jobs::Work selecting(Document& document, std::shared_ptr<Session> session, const Marks& marks, MaskStep step,
                     const QString& what, const QString& found, Told told) {
  step.name = what.toStdString();
  step.tag = kInside;
  step.changes.push_back({RegionChange::Kind::smooth, kSmooth, {}});
  return [&document, session = std::move(session), marks, step = std::move(step), what, found,
          told = std::move(told), tag = document.selected_tag()](const Job& job) -> Jobs::Finish {
    MaskRequest request;
    request.steps = {step};
    const Stretch stretch = stretch_between(marks, session, job);
    const MadeMask made = make_mask(request, &stretch.session->capture(), session->source().path.string());
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

Jobs::Work selecting_motion(Document& document, std::shared_ptr<Session> session, Told told) {
  MaskStep step;
  step.selection = select::Motion();
  const Marks& marks = document.marks();
  return selecting(
      document, std::move(session), marks, std::move(step), Document::tr("Select what moves"),
      marks == Marks() ? Document::tr("move within the capture") : Document::tr("move between the marks"),
      std::move(told));
}

Jobs::Work selecting_difference(Document& document, std::shared_ptr<Session> session,
                                const Difference& difference, Told told) {
  MaskStep step;
  step.selection = select::Difference{StatedTime::of_nanoseconds(difference.from_ns),
                                      StatedTime::of_nanoseconds(difference.to_ns)};
  step.by_codes = difference.by_codes;
  if (difference.is_largest_part) step.changes.push_back({RegionChange::Kind::largest, 0, {}});
  return selecting(document, std::move(session), {}, std::move(step), Document::tr("Select what differs"),
                   Document::tr("differ between %1 and %2")
                       .arg(exact_time_text(difference.from_ns), exact_time_text(difference.to_ns)),
                   std::move(told));
}

void ask_difference(QWidget* parent, const Timeline& timeline, const Difference& first,
                    std::function<void(const Difference&)> use) {
  auto* dialog = new QDialog(parent);
  dialog->setWindowTitle(Document::tr("Select what differs"));
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  auto* told = new QLabel(
      Document::tr("The selected region gets the pixels in which the capture's pictures at two moments differ."));
  auto* form = new QFormLayout(dialog);
  form->addRow(told);
  const auto add = [&](const QString& label, auto* field, const char* object, const QString& name, const QString& tip) {
    describe(*field, object, name, tip);
    form->addRow(label, field);
    return field;
  };
  const QString times = typed_time_help();
  auto* from = add(Document::tr("&From"), new QLineEdit(exact_time_text(first.from_ns)), "difference_from",
                   Document::tr("The one moment"), times);
  auto* to = add(Document::tr("&To"), new QLineEdit(exact_time_text(first.to_ns)), "difference_to",
                 Document::tr("The other moment"), times);
  auto* codes = add(
      Document::tr("&More than"), new QSpinBox, "difference_codes",
      Document::tr("How many codes a difference has to exceed"),
      Document::tr("Smaller differences are none. 0: what the sensor's noise explains, told from the pictures"));
  codes->setRange(0, 65534);
  codes->setSpecialValueText(Document::tr("as the noise is"));
  codes->setSuffix(Document::tr(" codes"));
  auto* largest = new QCheckBox(Document::tr("Only the &largest part"));
  largest->setObjectName("difference_largest");
  auto* mistake = new QLabel;
  mistake->setObjectName("difference_mistake");
  // Labels that wrap know their height by their width alone.
  constexpr int kTextPixels = 380;
  for (QLabel* text : {told, mistake}) {
    text->setWordWrap(true);
    text->setFixedWidth(kTextPixels);
  }
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel);
  buttons->setObjectName("difference_buttons");
  buttons->button(QDialogButtonBox::Ok)->setText(Document::tr("Select"));
  for (QWidget* row : std::initializer_list<QWidget*>{largest, mistake, buttons}) form->addRow(row);
  mistake->hide();
  form->setSizeConstraint(QLayout::SetFixedSize);
  from->selectAll();
  const auto read = [mistake, timeline](QLineEdit& field) -> std::optional<std::int64_t> {
    const auto typed = read_typed_time(field.text(), timeline);
    const std::int64_t last_ns = timeline.duration_ns() - 1;
    if (typed.value && *typed.value >= 0 && *typed.value <= last_ns) return typed.value;
    mistake->setText(typed.value ? Document::tr("The capture has pictures from 0 s to %1: %2 is not within")
                                       .arg(exact_time_text(last_ns), exact_time_text(*typed.value))
                                 : typed.mistake);
    mistake->show();
    field.setAccessibleDescription(mistake->text());
    field.setFocus();
    field.selectAll();
    return std::nullopt;
  };
  QObject::connect(buttons, &QDialogButtonBox::rejected, dialog, &QDialog::reject);
  QObject::connect(buttons, &QDialogButtonBox::accepted, dialog, [=, use = std::move(use)] {
    const auto from_ns = read(*from);
    if (!from_ns) return;
    const auto to_ns = read(*to);
    if (!to_ns) return;
    const auto least = static_cast<std::uint32_t>(codes->value());
    dialog->accept();
    use({*from_ns, *to_ns, least > 0 ? std::optional(least) : std::nullopt, largest->isChecked()});
  });
  dialog->open();
}

}  // namespace nutik::studio
