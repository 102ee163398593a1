// What the views of time answer alike.
#pragma once

#include <QEvent>
#include <QHelpEvent>
#include <QKeyEvent>
#include <QToolTip>
#include <QWidget>

namespace nutik::studio {

// Keeps a view's own keys from shortcuts, and shows its tooltips: `text_at(place)`, none where that is empty. True if the
// event was one of these.
template <typename View>
bool answers_event(View& view, QEvent& event, bool (*is_own_key)(const QKeyEvent&)) {
  if (event.type() == QEvent::ShortcutOverride && is_own_key(static_cast<QKeyEvent&>(event))) {
    event.accept();
    return true;
  }
  if (event.type() != QEvent::ToolTip) return false;
  const auto& help = static_cast<QHelpEvent&>(event);
  const QString text = view.text_at(help.pos());
  if (text.isEmpty()) QToolTip::hideText();
  if (!text.isEmpty()) QToolTip::showText(help.globalPos(), text, &view);
  return true;
}

}  // namespace nutik::studio
