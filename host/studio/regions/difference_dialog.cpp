#include "studio/regions/difference_dialog.hpp"

#include <QCheckBox>
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
#include "studio/time/times.hpp"

namespace nutik::studio {
namespace {

constexpr double kSmooth = 1;          // pixels: narrower parts are noise
constexpr std::uint8_t kInside = 255;  // of the mask that is made

// `what` names it for undo; `found` begins what is said of it: "12 pixels …".
Jobs::Work selecting(Document& document, std::shared_ptr<Session> session, const Marks& marks, MaskStep step,
                     const QString& what, const QString& found, Told told) {
  step.name.text = what.toStdString();
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

DifferenceDialog::DifferenceDialog(const Timeline& timeline, std::int64_t from_ns, std::int64_t to_ns,
                                   QWidget* parent)
    : QDialog(parent),
      timeline_(timeline),
      from_(new QLineEdit(exact_time_text(from_ns), this)),
      to_(new QLineEdit(exact_time_text(to_ns), this)),
      codes_(new QSpinBox(this)),
      largest_(new QCheckBox(tr("Only the &largest part"), this)),
      mistake_(new QLabel(this)) {
  setWindowTitle(tr("Select what differs"));
  setAttribute(Qt::WA_DeleteOnClose);
  const QString times = tr("A number and its unit: 0.4 s, 10 ms, 250 us, 1/100 s, or 37f for sample 37");
  for (QLineEdit* field : {from_, to_}) field->setToolTip(times);
  from_->setObjectName("difference_from");
  to_->setObjectName("difference_to");
  codes_->setObjectName("difference_codes");
  codes_->setRange(0, 65534);
  codes_->setSpecialValueText(tr("as the noise is"));
  codes_->setSuffix(tr(" codes"));
  codes_->setToolTip(
      tr("Smaller differences are none. 0: what the sensor's noise explains, told from the pictures"));
  largest_->setObjectName("difference_largest");
  mistake_->setObjectName("difference_mistake");
  mistake_->hide();
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, this);
  buttons->setObjectName("difference_buttons");
  buttons->button(QDialogButtonBox::Ok)->setText(tr("Select"));
  connect(buttons, &QDialogButtonBox::accepted, this, &DifferenceDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &DifferenceDialog::reject);
  auto* told = new QLabel(
      tr("The selected region gets the pixels in which the capture's pictures at two moments differ."), this);
  // Labels that wrap know their height by their width alone.
  constexpr int kTextPixels = 380;
  for (QLabel* text : {told, mistake_}) {
    text->setWordWrap(true);
    text->setFixedWidth(kTextPixels);
  }
  auto* form = new QFormLayout(this);
  form->addRow(told);
  form->addRow(tr("&From"), from_);
  form->addRow(tr("&To"), to_);
  form->addRow(tr("&More than"), codes_);
  form->addRow(largest_);
  form->addRow(mistake_);
  form->addRow(buttons);
  form->setSizeConstraint(QLayout::SetFixedSize);
  for (const auto& [widget, name] : {std::pair<QWidget*, QString>{from_, tr("The one moment")},
                                     {to_, tr("The other moment")},
                                     {codes_, tr("How many codes a difference has to exceed")}}) {
    widget->setAccessibleName(name);
    widget->setAccessibleDescription(widget->toolTip());
  }
  from_->selectAll();
}

std::optional<std::int64_t> DifferenceDialog::read(QLineEdit& field, const QString& what) {
  const auto typed = read_typed_time(field.text(), what, timeline_);
  const std::int64_t last_ns = timeline_.duration_ns() - 1;
  if (typed.value && *typed.value >= 0 && *typed.value <= last_ns) return typed.value;
  mistake_->setText(typed.value ? tr("The capture has pictures from 0 s to %1: %2 is not within")
                                      .arg(exact_time_text(last_ns), exact_time_text(*typed.value))
                                : typed.mistake);
  mistake_->show();
  field.setAccessibleDescription(mistake_->text());
  field.setFocus();
  field.selectAll();
  return std::nullopt;
}

void DifferenceDialog::accept() {
  const auto from_ns = read(*from_, "from");
  if (!from_ns) return;
  const auto to_ns = read(*to_, "to");
  if (!to_ns) return;
  chosen_ = {*from_ns, *to_ns, std::nullopt, largest_->isChecked()};
  if (codes_->value() > 0) chosen_.by_codes = static_cast<std::uint32_t>(codes_->value());
  QDialog::accept();
}

}  // namespace nutik::studio
