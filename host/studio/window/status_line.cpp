#include "studio/window/status_line.hpp"

#include <QAccessible>
#include <QHBoxLayout>
#include <QLabel>
#include <QProgressBar>
#include <QToolButton>
#include <cmath>

namespace nutik::studio {
namespace {

QString light_text(int code) {
  // White may stand for any light from there on.
  const double light = Transfer::srgb().light_of(code / 255.0);
  return code == 255 ? QStringLiteral("≥ 1") : QString::number(light, 'f', 3);
}

}  // namespace

Notice::Notice(QWidget* parent) : QFrame(parent), text_(new QLabel(this)), way_out_(new QToolButton(this)) {
  setAutoFillBackground(true);
  setFrameShape(QFrame::NoFrame);
  text_->setWordWrap(true);
  text_->setTextFormat(Qt::PlainText);
  text_->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  way_out_->setObjectName("way_out");
  connect(way_out_, &QToolButton::clicked, this, [this] {
    const auto act = std::move(act_);
    clear();
    act();
  });
  auto* close = new QToolButton(this);
  close->setText(tr("Close"));
  close->setAutoRaise(true);
  close->setAccessibleName(tr("Close the message"));
  connect(close, &QToolButton::clicked, this, &Notice::clear);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(12, 6, 6, 6);
  row->addWidget(text_, 1);
  row->addWidget(way_out_, 0, Qt::AlignTop);
  row->addWidget(close, 0, Qt::AlignTop);
  hide();
}

void Notice::say(Kind kind, const QString& text, const QString& label, std::function<void()> way_out) {
  const QColor ground = kind == Kind::error ? QColor(122, 46, 40) : QColor(52, 76, 104);
  QPalette colours = palette();
  for (const auto role : {QPalette::Window, QPalette::Button}) colours.setColor(role, ground);
  for (const auto role : {QPalette::WindowText, QPalette::ButtonText, QPalette::Text})
    colours.setColor(role, QColor(240, 240, 240));
  colours.setColor(QPalette::Highlight, QColor(240, 240, 240));  // what has the focus is framed by it, too
  colours.setColor(QPalette::HighlightedText, ground);
  setPalette(colours);
  text_->setText(text);
  way_out_->setText(label);
  way_out_->setVisible(!label.isEmpty());
  act_ = std::move(way_out);
  setVisible(!text.isEmpty());
  if (text.isEmpty()) return;
  QAccessibleEvent said(text_, QAccessible::Alert);  // a screen reader reads the label, whose text is its name
  QAccessible::updateAccessibility(&said);
}

void Notice::clear() { say(Kind::note, {}); }

QString Notice::text() const { return text_->text(); }

StatusLine::StatusLine(const std::vector<Jobs*>& jobs, QWidget* parent)
    : QStatusBar(parent),
      zoom_(new QLabel(this)),
      pixel_(new QLabel(this)),
      saturated_(new QLabel(this)),
      arithmetic_(new QLabel(this)),
      milliseconds_(new QLabel(this)),
      work_(new QLabel(this)),
      progress_(new QProgressBar(this)),
      cancel_(new QToolButton(this)),
      shown_(jobs.front()) {
  pixel_->setObjectName("pixel");
  pixel_->setAccessibleDescription(tr("Pixel under the pointer"));
  arithmetic_->setObjectName("arithmetic");
  saturated_->setObjectName("saturated");
  milliseconds_->setObjectName("milliseconds");
  saturated_->setToolTip(tr("Pixels brighter than white or darker than black: the picture cannot show how much"));
  milliseconds_->setToolTip(tr("How long it took from the last change to the picture"));
  progress_->setMaximumWidth(160);
  progress_->setMaximumHeight(14);
  progress_->setTextVisible(false);
  cancel_->setText(tr("Cancel"));
  cancel_->setObjectName("cancel");
  addWidget(pixel_, 1);
  work_->setTextFormat(Qt::PlainText);
  addWidget(work_);
  addWidget(progress_);
  addWidget(cancel_);
  zoom_->setObjectName("zoom");
  zoom_->setToolTip(tr("How large the picture is shown: 100 % is pixel for pixel (Ctrl+1), Ctrl+0 shows all of it"));
  for (QLabel* label : {zoom_, saturated_, arithmetic_, milliseconds_}) {
    label->setContentsMargins(4, 0, 4, 0);
    addPermanentWidget(label);
  }
  const auto show_work = [this](bool is_shown) {
    for (QWidget* widget : std::initializer_list<QWidget*>{work_, progress_, cancel_}) widget->setVisible(is_shown);
  };
  show_work(false);
  for (Jobs* each : jobs) {
    connect(each, &Jobs::progressed, this,
            [this, each, show_work](const QString& what, quint64 done, quint64 total) {
              if (shown_ != each && shown_->is_busy()) return;
              shown_ = each;
              work_->setText(what);
              progress_->setRange(0, total > 0 ? 1000 : 0);
              if (total > 0) progress_->setValue(static_cast<int>(1000 * done / total));
              progress_->setAccessibleName(what);
              show_work(true);
            });
    connect(each, &Jobs::ended, this, [this, each, show_work] {
      if (shown_ == each && !each->is_busy()) show_work(false);
    });
  }
  connect(cancel_, &QToolButton::clicked, this, [this] { shown_->cancel_current(); });
}

void StatusLine::tell(const ShownPicture& picture) {
  arithmetic_->setText(picture.codes_off ? tr("exact to %1 codes").arg(std::ceil(*picture.codes_off * 100) / 100)
                      : picture.is_full  ? picture.arithmetic
                                         : tr("preview"));
  arithmetic_->setToolTip(tr("What rounding may change at most, of 255 codes from black to white. Computed in %1")
                              .arg(picture.arithmetic));
  milliseconds_->setText(tr("after %1 ms").arg(picture.milliseconds, 0, 'f', 0));
  if (!picture.is_of_all_seen) return;
  const std::uint64_t saturated = picture.pixels_above + picture.pixels_below;
  saturated_->setText(saturated == 0 ? QString() : tr("%1 px clipped").arg(saturated));
}

void StatusLine::tell_zoom(double screen_pixels) {
  zoom_->setText(screen_pixels == 0 ? QString() : tr("Zoom %1 %").arg(100 * screen_pixels, 0, 'f', 0));
}

void StatusLine::tell(std::optional<QPoint> pixel, const QImage& image) {
  if (!pixel || !image.rect().contains(*pixel)) return pixel_->clear();
  const QRgb codes = image.pixel(*pixel);
  pixel_->setText(tr("x %1, y %2   light %3  %4  %5 (white: 1)   code %6  %7  %8 (of 255)")
                      .arg(pixel->x())
                      .arg(pixel->y())
                      .arg(light_text(qRed(codes)), light_text(qGreen(codes)), light_text(qBlue(codes)))
                      .arg(qRed(codes))
                      .arg(qGreen(codes))
                      .arg(qBlue(codes)));
}

}  // namespace nutik::studio
