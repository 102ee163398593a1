// The colours of the time strip and the curve editor, from the window's palette: dark windows have dark ones.
#pragma once

#include <QColor>
#include <QPalette>

namespace nutik::studio {

// `share` of b, the rest of a.
[[nodiscard]] QColor mixed(const QColor& a, const QColor& b, double share);
[[nodiscard]] QColor with_opacity(QColor colour, double opacity);

struct TimeColours {
  QColor ground;   // behind everything
  QColor outside;  // before the capture's start and after its end
  QColor grid, axis;
  QColor label, text;
  QColor activity, waveform;
  QColor negative;  // what takes light away
  QColor boxcar;    // the interval that is exposed, marks
  QColor guide;     // what a drag snapped to
  QColor warning;
  QColor tip, tip_text;  // coordinates

  // A region's colour as a line that can be seen on the ground.
  [[nodiscard]] QColor line(const QColor& region) const;

  static TimeColours of(const QPalette& palette);
};

}  // namespace nutik::studio
