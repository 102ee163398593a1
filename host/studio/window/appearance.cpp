#include "studio/window/appearance.hpp"

#include <QApplication>
#include <QLibraryInfo>
#include <QPainter>
#include <QPalette>
#include <QProxyStyle>
#include <QSettings>
#include <QStyle>
#include <QStyleOption>
#include <QTranslator>

namespace nutik::studio {
namespace {

constexpr const char* kKey = "appearance";

QPalette palette_of(int window, int base, int button, int text, int dim) {
  const auto grey = [](int value) { return QColor(value, value, value); };
  const QColor accent(76, 132, 190);
  QPalette palette;
  palette.setColor(QPalette::Window, grey(window));
  palette.setColor(QPalette::WindowText, grey(text));
  palette.setColor(QPalette::Base, grey(base));
  palette.setColor(QPalette::AlternateBase, grey((base + window) / 2));
  palette.setColor(QPalette::Text, grey(text));
  palette.setColor(QPalette::PlaceholderText, grey(dim));
  palette.setColor(QPalette::Button, grey(button));
  palette.setColor(QPalette::ButtonText, grey(text));
  palette.setColor(QPalette::BrightText, Qt::white);
  palette.setColor(QPalette::ToolTipBase, grey(window));
  palette.setColor(QPalette::ToolTipText, grey(text));
  palette.setColor(QPalette::Highlight, accent);
  palette.setColor(QPalette::HighlightedText, Qt::white);
  palette.setColor(QPalette::Mid, grey((text + dim) / 2));
  palette.setColor(QPalette::Link, accent.lighter(130));
  for (const QPalette::ColorRole role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText})
    palette.setColor(QPalette::Disabled, role, grey(dim));
  return palette;
}

// Fusion, whose boxes to check cannot be told from a dark ground, and whose shadows double texts that are disabled
// there.
class Style : public QProxyStyle {
 public:
  Style() : QProxyStyle(QStringLiteral("Fusion")) {}

  int styleHint(StyleHint hint, const QStyleOption* option, const QWidget* widget,
                QStyleHintReturn* answer) const override {
    return hint == SH_EtchDisabledText ? 0 : QProxyStyle::styleHint(hint, option, widget, answer);
  }

  void drawPrimitive(PrimitiveElement element, const QStyleOption* option, QPainter* painter,
                     const QWidget* widget) const override {
    if (element != PE_IndicatorItemViewItemCheck && element != PE_IndicatorCheckBox)
      return QProxyStyle::drawPrimitive(element, option, painter, widget);
    const QRectF box = QRectF(option->rect).adjusted(0.5, 0.5, -0.5, -0.5);
    painter->save();
    painter->setRenderHint(QPainter::Antialiasing);
    painter->setPen(option->palette.color(QPalette::Mid));
    painter->drawRoundedRect(box, 2, 2);
    if ((option->state & State_On) != 0) {
      painter->setPen(QPen(option->palette.color(QPalette::Text), 1.6));
      const double left = box.left(), top = box.top(), side = box.width();
      painter->drawPolyline(QPolygonF({{left + 0.2 * side, top + 0.5 * side},
                                       {left + 0.43 * side, top + 0.74 * side},
                                       {left + 0.82 * side, top + 0.24 * side}}));
    }
    painter->restore();
  }
};

}  // namespace

void set_appearance(Appearance appearance) {
  QApplication::setStyle(new Style);
  switch (appearance) {
    case Appearance::dark: QApplication::setPalette(palette_of(45, 33, 60, 220, 120)); break;
    case Appearance::light: QApplication::setPalette(palette_of(222, 245, 232, 25, 140)); break;
    case Appearance::system: QApplication::setPalette(QApplication::style()->standardPalette()); break;
  }
}

Appearance kept_appearance() {
  const int kept = QSettings().value(kKey, static_cast<int>(Appearance::dark)).toInt();
  return kept >= 0 && kept <= static_cast<int>(Appearance::system) ? static_cast<Appearance>(kept)
                                                                   : Appearance::dark;
}

void keep_appearance(Appearance appearance) { QSettings().setValue(kKey, static_cast<int>(appearance)); }

void use_language(const QStringList& languages) {
  const auto use = [](const QString& file) {
    auto* translator = new QTranslator(QCoreApplication::instance());
    return translator->load(file) && QCoreApplication::installTranslator(translator);
  };
  for (const QString& language : languages) {
    const QString code = language.section('-', 0, 0);
    if (code != "en" && !use(":/translations/nutik_studio_" + code)) continue;
    use(QLibraryInfo::path(QLibraryInfo::TranslationsPath) + "/qtbase_" + code);
    return;
  }
}

}  // namespace nutik::studio
