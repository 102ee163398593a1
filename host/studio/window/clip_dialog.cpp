#include "studio/window/clip_dialog.hpp"

#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QDialogButtonBox>
#include <QFormLayout>
#include <QLabel>
#include <QLineEdit>
#include <algorithm>
#include <string>

#include "features/schema/option.hpp"

namespace nutik::studio {
namespace {

// The option's own words of help are its field's tip.
template <typename Field>
Field* named(Field* field, const char* option) {
  field->setObjectName(option);
  field->setToolTip(QString::fromStdString(std::string(option_of(CommandId::encode, option)->help)));
  return field;
}

void state(Stated& stated, const QWidget& field, const QString& value) {
  const std::string option = field.objectName().toStdString();
  stated.erase(option);
  if (!value.isEmpty()) stated.emplace(option, value.toStdString());
}

}  // namespace

std::optional<Stated> ask_how_to_read(QWidget* parent, const QString& why, Stated stated) {
  const auto tr = [](const char* text) { return Document::tr(text); };
  const auto said = [&](const char* option) {
    const auto found = stated.find(option);
    return found == stated.end() ? QString() : QString::fromStdString(found->second);
  };
  QDialog dialog(parent);
  dialog.setWindowTitle(tr("How the clip is read"));
  auto* form = new QFormLayout(&dialog);
  auto* reason = new QLabel(why, &dialog);
  reason->setWordWrap(true);
  form->addRow(reason);

  auto* rate = named(new QLineEdit(said("fps"), &dialog), "fps");
  rate->setPlaceholderText(tr("as the file says; 120 or 30000/1001"));
  form->addRow(tr("Filmed at, pictures a &second"), rate);
  auto* align = named(new QComboBox(&dialog), "align");
  align->addItem(tr("no: it stood still"), "");
  align->addItem(tr("it shifted"), "translation");
  align->addItem(tr("it shifted and turned"), "rigid");
  align->addItem(tr("it tilted, too"), "homography");
  align->setCurrentIndex(std::max(align->findData(said("align")), 0));
  form->addRow(tr("&Undo how the camera moved"), align);
  auto* deflicker = named(new QCheckBox(tr("&Even out flicker of the light"), &dialog), "deflicker");
  deflicker->setChecked(stated.contains("deflicker"));
  form->addRow(deflicker);
  auto* between = named(new QCheckBox(tr("Make samples &between pictures, along the motion"), &dialog), "between");
  between->setChecked(stated.contains("between"));
  form->addRow(between);

  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, &dialog);
  QObject::connect(buttons, &QDialogButtonBox::accepted, &dialog, &QDialog::accept);
  QObject::connect(buttons, &QDialogButtonBox::rejected, &dialog, &QDialog::reject);
  form->addRow(buttons);
  if (dialog.exec() != QDialog::Accepted) return std::nullopt;

  state(stated, *rate, rate->text().trimmed());
  state(stated, *align, align->currentData().toString());
  state(stated, *between, between->isChecked() ? "auto" : "");
  stated.erase("deflicker");
  if (deflicker->isChecked()) stated.emplace("deflicker", "");  // a flag has no value
  return stated;
}

}  // namespace nutik::studio
