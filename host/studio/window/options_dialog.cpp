#include "studio/window/options_dialog.hpp"

#include <QCheckBox>
#include <QComboBox>
#include <QCoreApplication>
#include <QDialog>
#include <QDialogButtonBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QMessageBox>
#include <QPushButton>
#include <QRegularExpression>
#include <algorithm>

#include "features/schema/option.hpp"
#include "studio/live/jobs.hpp"

namespace nutik::studio {
namespace {

QString text(std::string_view words) { return QString::fromUtf8(words.data(), static_cast<qsizetype>(words.size())); }

// The texts are in translations/options_de.ts.
QString translated(const char* context, std::string_view words) {
  return QCoreApplication::translate(context, std::string(words).c_str());
}

QString help_of(const Option& option) { return translated("Option", option.help); }

// How help begins, before it goes into details.
QString label_of(const Option& option) {
  return sentence(help_of(option).section(QRegularExpression(": | \\(|; "), 0, 0).toStdString());
}

// `24` of `… (default: 24)`.
QString default_of(const Option& option) {
  return help_of(option).section(Document::tr("(default: "), 1).section(QRegularExpression("[;)]"), 0, 0);
}

struct Field {
  QWidget* widget;
  std::function<QString()> value;  // null: not stated
};

Field field_of(const Option& option, const QString& stated, const std::map<std::string, QString>& words,
               QWidget* parent) {
  if (option.is_flag()) {
    auto* box = new QCheckBox(label_of(option), parent);
    box->setChecked(!stated.isNull());
    return {box, [box] { return box->isChecked() ? QString("") : QString(); }};
  }
  const std::vector<std::string> choices = option.choices();
  const bool is_open = std::ranges::any_of(choices, [](const std::string& word) { return word.ends_with(':'); });
  const auto typed = [&](QLineEdit* line) {
    line->setText(stated);
    line->setPlaceholderText(default_of(option));
    return [line] {
      static const QRegularExpression kDecimalComma("(?<=\\d),(?=\\d)");
      return line->text().trimmed().isEmpty() ? QString() : line->text().trimmed().replace(kDecimalComma, ".");
    };
  };
  if (choices.empty()) {
    auto* line = new QLineEdit(parent);
    return {line, typed(line)};
  }
  auto* box = new QComboBox(parent);
  if (is_open) {
    for (const std::string& word : choices)
      if (!word.ends_with(':')) box->addItem(text(word));
    box->setEditable(true);
    return {box, typed(box->lineEdit())};
  }
  const auto said = [&](const std::string& word, const QString& otherwise) {
    const auto found = words.find(word);
    return found == words.end() ? otherwise : found->second;
  };
  const QString usual = default_of(option).isEmpty() ? Document::tr("as is usual") : default_of(option);
  box->addItem(said(std::string(option.long_name), usual), QString());
  for (const std::string& word : choices) box->addItem(said(word, translated("Choice", word)), text(word));
  box->setCurrentIndex(std::max(box->findData(stated), 0));
  box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  box->setMinimumContentsLength(24);
  return {box, [box] { return box->currentIndex() == 0 ? QString() : box->currentData().toString(); }};
}

}  // namespace

bool is_wanted(QWidget* parent, const QString& title, const QString& question) {
  QMessageBox box(QMessageBox::Question, title, question, QMessageBox::Yes | QMessageBox::No, parent);
  box.setTextFormat(Qt::PlainText);
  return box.exec() == QMessageBox::Yes;
}

Options options_in(CommandId command, const Stated& stated) {
  Options options;
  for (const auto& [name, value] : stated) {
    const Option& option = *option_of(command, name);
    const std::string label = label_of(option).toStdString() + ":";  // as the dialog has it
    option.state(options, label, option.is_flag() ? std::vector<std::string>() : std::vector{value});
  }
  return options;
}

std::optional<Wanted> ask_options(QWidget* parent, const Asked& asked) {
  QDialog dialog(parent);
  dialog.setWindowTitle(asked.title);
  auto* form = new QFormLayout(&dialog);
  auto* why = new QLabel(asked.why, &dialog);
  why->setWordWrap(true);
  why->setTextFormat(Qt::PlainText);
  why->setVisible(!asked.why.isEmpty());
  if (!asked.why.isEmpty()) form->addRow(why);
  auto* path = new QLineEdit(asked.first.path, &dialog);
  path->setObjectName("path");
  path->setVisible(!asked.first.path.isEmpty());
  if (!asked.first.path.isEmpty()) {
    path->setMinimumWidth(380);
    path->setToolTip(Document::tr("Its ending says which kind of file it is: %1").arg(asked.filter));
    auto* browse = new QPushButton(Document::tr("&Browse…"), &dialog);
    auto* row = new QHBoxLayout;
    row->addWidget(path, 1);
    row->addWidget(browse);
    auto* label = new QLabel(Document::tr("&File"), &dialog);
    label->setBuddy(path);
    form->addRow(label, row);
    QObject::connect(browse, &QPushButton::clicked, &dialog, [&] {
      const QString chosen = QFileDialog::getSaveFileName(&dialog, asked.title, path->text(), asked.filter, nullptr,
                                                          QFileDialog::DontConfirmOverwrite);
      if (!chosen.isEmpty()) path->setText(chosen);
    });
  }
  std::vector<std::pair<std::string, Field>> fields;
  for (const char* name : asked.options) {
    const Option& option = *option_of(asked.command, name);
    const auto stated = asked.first.options.find(name);
    const bool is_stated = stated != asked.first.options.end();
    Field field = field_of(option, is_stated ? text(stated->second) + QString("") : QString(), asked.words, &dialog);
    field.widget->setObjectName(name);
    field.widget->setToolTip(help_of(option));
    if (option.is_flag()) {
      form->addRow(field.widget);
    } else {
      field.widget->setAccessibleName(label_of(option));
      form->addRow(label_of(option), field.widget);
    }
    fields.emplace_back(name, std::move(field));
  }
  auto* mistake = new QLabel(&dialog);
  mistake->setObjectName("mistake");
  mistake->setWordWrap(true);
  mistake->setTextFormat(Qt::PlainText);
  mistake->hide();
  form->addRow(mistake);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, &dialog);
  form->addRow(buttons);
  Wanted wanted;
  QObject::connect(buttons, &QDialogButtonBox::rejected, &dialog, &QDialog::reject);
  QObject::connect(buttons, &QDialogButtonBox::accepted, &dialog, [&] {
    wanted = {path->text().trimmed(), asked.first.options};
    const QFileInfo first(asked.first.path);
    if (!wanted.path.isEmpty() && QFileInfo(wanted.path).suffix().isEmpty()) wanted.path += "." + first.suffix();
    if (!wanted.path.isEmpty()) wanted.path = first.dir().absoluteFilePath(wanted.path);
    for (const auto& [name, field] : fields) {
      wanted.options.erase(name);
      if (const QString value = field.value(); !value.isNull()) wanted.options.emplace(name, value.toStdString());
    }
    try {
      const Options options = options_in(asked.command, wanted.options);
      if (asked.check) asked.check(wanted, options);
    } catch (...) {
      mistake->setText(sentence_of(std::current_exception()));
      mistake->show();
      return dialog.resize(dialog.width(), std::max(dialog.height(), form->totalHeightForWidth(dialog.width())));
    }
    const bool is_there = !wanted.path.isEmpty() && QFileInfo::exists(wanted.path);
    const QString question = Document::tr("%1 is there already. Replace it?").arg(wanted.path);
    if (!is_there || is_wanted(&dialog, asked.title, question)) dialog.accept();
  });
  if (dialog.exec() != QDialog::Accepted) return std::nullopt;
  return wanted;
}

}  // namespace nutik::studio
