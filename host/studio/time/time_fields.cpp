#include "studio/time/time_fields.hpp"

#include <QEvent>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>

#include "studio/time/time_axis.hpp"
#include "studio/time/time_strip.hpp"
#include "studio/time/time_view.hpp"
#include "studio/time/times.hpp"

namespace nutik::studio {
namespace {

void show_in(QLineEdit& field, const QString& text) {
  if (field.isModified() || field.text() == text) return;
  field.setText(text);
  field.setCursorPosition(0);
}

QString mark_text(const std::optional<std::int64_t>& mark) {
  return mark ? exact_time_text(*mark) : QString();
}

}  // namespace

TimeFields::TimeFields(Document& document, QWidget* parent)
    : QWidget(parent), document_(document), said_(new QLabel(this)) {
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(8, 2, TimeAxis::kRight, 2);
  row->setSpacing(6);
  const QString time = typed_time_help();
  const QString length = tr("A number and its unit: 0.4 s, 10 ms, 250 us, 1/100 s, or 37f for 37 pictures");
  start_ = add_field("start", tr("S&tart"), tr("Where the exposed interval begins. %1").arg(time),
                     [this](const QString& text) { return take_start(text); });
  length_ = add_field("width", tr("&Width"), tr("How long the exposed interval is. %1").arg(length),
                      [this](const QString& text) { return take_length(text); });
  in_ = add_field("in", tr("&In"), tr("Where work begins, or nothing. %1").arg(time),
                  [this](const QString& text) { return take_mark(text, &Document::set_mark_in); });
  out_ = add_field("out", tr("&Out"), tr("Where work ends, or nothing. %1").arg(time),
                   [this](const QString& text) { return take_mark(text, &Document::set_mark_out); });
  said_->setObjectName("said");
  said_->setAccessibleDescription(tr("Exposed pictures"));
  said_->setTextFormat(Qt::PlainText);
  said_->setMinimumWidth(0);
  said_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  row->addWidget(said_, 1);
  connect(&document_, &Document::changed, this, &TimeFields::show_values);
  connect(&document_, &Document::capture_changed, this, [this] {
    for (QLineEdit* field : {start_, length_, in_, out_}) accept(*field);
  });
  connect(&document_, &Document::marks_changed, this, &TimeFields::show_values);
  show_values();
}

void TimeFields::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) show_values();
  if (event->type() == QEvent::EnabledChange) said_->setVisible(isEnabled());
  QWidget::changeEvent(event);
}

void TimeFields::resizeEvent(QResizeEvent*) { show_values(); }

QLineEdit* TimeFields::add_field(const char* object, const QString& name, const QString& help, Take take) {
  auto* label = new QLabel(name, this);
  auto* field = new QLineEdit(this);
  label->setBuddy(field);
  field->setToolTip(help);
  field->setAccessibleName(QString(name).remove('&'));
  field->setAccessibleDescription(help);
  field->setObjectName(object);
  field->setFixedWidth(field->fontMetrics().horizontalAdvance("888.888888 ms") + 18);
  layout()->addWidget(label);
  layout()->addWidget(field);
  // Pressed Return or left: both mean it.
  connect(field, &QLineEdit::editingFinished, this, [this, field, take = std::move(take)] {
    if (!field->isModified()) return;
    const QString mistake = take(field->text());
    mistake.isEmpty() ? accept(*field) : refuse(*field, mistake);
  });
  return field;
}

void TimeFields::show_values() {
  const CaptureFacts* facts = document_.facts();
  for (QLineEdit* field : {start_, length_, in_, out_}) field->setEnabled(facts != nullptr);
  if (facts == nullptr) return;
  show_in(*start_, exact_time_text(document_.boxcar().start_ns));
  show_in(*length_, exact_time_text(document_.boxcar().length_ns));
  show_in(*in_, mark_text(document_.mark_in()));
  show_in(*out_, mark_text(document_.mark_out()));
  for (const QLineEdit* field : {start_, length_, in_, out_})
    if (field->isModified()) return;  // what is said about it stays
  QPalette normal = palette();
  normal.setColor(QPalette::WindowText, TimeColours::of(palette()).label);
  said_->setPalette(normal);
  const QString text = interval_text(document_.boxcar(), facts->timeline);
  said_->setText(said_->fontMetrics().elidedText(text.mid(text.lastIndexOf(", ") + 2), Qt::ElideRight,
                                                 said_->width()));
  said_->setToolTip(text);
}

void TimeFields::refuse(QLineEdit& field, const QString& mistake) {
  QPalette warning = palette();
  warning.setColor(QPalette::WindowText, TimeColours::of(palette()).warning);
  said_->setPalette(warning);
  const QString text = tr("%1: %2").arg(field.accessibleName(), mistake);
  said_->setToolTip(text);
  field.setAccessibleDescription(mistake);
  QPalette wrong = palette();
  wrong.setColor(QPalette::Text, TimeColours::of(palette()).warning);
  field.setPalette(wrong);
  const bool has_room = said_->fontMetrics().horizontalAdvance(text) <= said_->width();
  said_->setText(has_room ? text : QString());
  if (!has_room) Q_EMIT refused(text);
}

void TimeFields::accept(QLineEdit& field) {
  field.setText(field.text());  // from here on undoing it is the window's
  field.setPalette({});
  Q_EMIT refused({});
  field.setAccessibleDescription(field.toolTip());
  show_values();
}

QString TimeFields::take_start(const QString& text) {
  const auto typed = read_typed_time(text, document_.facts()->timeline);
  if (!typed.value) return typed.mistake;
  const std::int64_t last_ns = document_.duration_ns() - document_.boxcar().length_ns;
  if (*typed.value < 0 || *typed.value > last_ns)
    return tr("An interval of this width lies within the capture if it starts between 0 s and %1")
        .arg(exact_time_text(last_ns));
  document_.set_boxcar({*typed.value, document_.boxcar().length_ns}, tr("Set start"));
  return {};
}

QString TimeFields::take_length(const QString& text) {
  const auto typed = read_typed_length(text, document_.facts()->timeline);
  if (!typed.value) return typed.mistake;
  if (*typed.value > document_.duration_ns())
    return tr("The capture lasts %1: the width can be no more").arg(exact_time_text(document_.duration_ns()));
  document_.set_boxcar({document_.boxcar().start_ns, *typed.value}, tr("Set width"));
  return {};
}

QString TimeFields::take_mark(const QString& text, void (Document::*set)(std::optional<std::int64_t>)) {
  std::optional<std::int64_t> time_ns;
  if (!text.trimmed().isEmpty()) {
    const auto typed = read_typed_time(text, document_.facts()->timeline);
    if (!typed.value) return typed.mistake;
    if (*typed.value < 0 || *typed.value > document_.duration_ns())
      return tr("Marks lie within the capture, between 0 s and %1").arg(exact_time_text(document_.duration_ns()));
    time_ns = typed.value;
  }
  (document_.*set)(time_ns);
  return {};
}

}  // namespace nutik::studio
