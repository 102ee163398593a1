#include "studio/canvas/light_histogram.hpp"

#include <QPainter>
#include <algorithm>
#include <cmath>

#include "render/code_scale.hpp"
#include "studio/live/live_view.hpp"

namespace nutik::studio {

MeasuredLight measured_light(Session& session, const DocumentState& state, const Job& job) {
  const bool has_mask = state.mask && state.mode == ExposureMode::functions;
  const auto mask = has_mask ? std::optional(LiveView::feathered_mask(state)) : std::nullopt;
  RenderControl control;
  control.stop = job.stop;
  OutputFormat as_light;
  as_light.type = ValueType::light64;
  Picture picture = session.render(exposure_of(state, mask), as_light, control).picture;
  const CodeMaking making = CodeMaking::of(session.format(), screen_format());
  to_shown_light(picture, making);
  const CodeScale scale(making.transfer, screen_format());
  const auto bin_of = [&](double light) {
    if (light <= 1) return static_cast<int>(scale.code_of(light));
    const double parts = std::log2(light) * MeasuredLight::kPartsOfStop;
    return std::min(MeasuredLight::kCodes + static_cast<int>(std::min(parts, 1e6)), MeasuredLight::kBins - 1);
  };
  const Shape& shape = picture.shape;
  MeasuredLight measured;
  measured.channels.resize(shape.channels);
  measured.marks = QImage(static_cast<int>(shape.width), static_cast<int>(shape.height),
                          QImage::Format_ARGB32_Premultiplied);
  measured.marks.fill(0);
  const std::uint8_t* tag = state.mask ? (*state.mask)->mask.tags.data() : nullptr;
  const std::uint8_t everywhere = state.functions.begin()->first;  // without a mask there is one
  const double* light = picture.values<double>().data();
  for (std::uint32_t y = 0; y < shape.height; ++y) {
    auto* mark = reinterpret_cast<QRgb*>(measured.marks.scanLine(static_cast<int>(y)));
    for (std::uint32_t x = 0; x < shape.width; ++x, light += shape.channels) {
      bool is_below = false, is_above = false;
      for (std::uint32_t channel = 0; channel < shape.channels; ++channel) {
        ++measured.channels[channel][static_cast<std::size_t>(bin_of(light[channel]))];
        is_below = is_below || scale.saturates_below(light[channel]);
        is_above = is_above || scale.saturates_above(light[channel]);
      }
      const std::uint8_t region = tag == nullptr ? everywhere : *tag++;
      const double brightest = *std::max_element(light, light + shape.channels);
      ++measured.regions[region][static_cast<std::size_t>(bin_of(brightest))];
      if (!is_below && !is_above) continue;
      measured.saturated[region] += {is_below, is_above};
      mark[x] = is_above ? qRgb(255, 40, 30) : qRgb(50, 90, 255);
    }
  }
  return measured;
}

LightHistogram::LightHistogram(Document& document, QWidget* parent) : QWidget(parent), document_(document) {
  setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Fixed);
  setObjectName("histogram");
  setAccessibleName(tr("Histogram"));
  connect(&document_, &Document::selection_changed, this, [this] { update(); });
}

void LightHistogram::show_light(std::shared_ptr<const MeasuredLight> light) {
  light_ = std::move(light);
  QStringList lines{tr("How many pixels have which brightness, from black to white and %1 stops beyond. The line is "
                       "the selected region's brightest channel.")
                        .arg(MeasuredLight::kStops)};
  if (light_) {
    const auto& looks = document_.state().looks;
    for (const auto& [tag, pixels] : light_->saturated) {
      const auto look = looks.find(tag);
      lines += tr("%1: %2 px beyond white, %3 px below 0")
                   .arg(look == looks.end() ? QString("M%1").arg(tag) : look->second.name,
                        QString::number(pixels.above), QString::number(pixels.below));
    }
  }
  setToolTip(lines.join('\n'));
  setAccessibleDescription(lines.join('\n'));
  update();
}

// The ends, where everything may lie, do not flatten the rest.
QPolygonF LightHistogram::outline(const MeasuredLight::Counts& counts) const {
  const double most = std::max<double>(*std::max_element(counts.begin() + 1, counts.begin() + 255), 1);
  QPolygonF line{QPointF(0, height())};
  for (std::size_t bin = 0; bin < counts.size(); ++bin) {
    const double share = std::min(counts[bin] / most, 1.0);
    line += QPointF(static_cast<double>(bin) * width() / MeasuredLight::kBins, height() - share * (height() - 4));
  }
  return line += QPointF(width(), height());
}

void LightHistogram::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), QColor(28, 28, 28));  // dark, so that colours add up
  const double white = 1.0 * width() * MeasuredLight::kCodes / MeasuredLight::kBins;
  painter.fillRect(QRectF(white, 0, width() - white, height()), QColor(60, 30, 28));
  if (!light_) return;
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setCompositionMode(QPainter::CompositionMode_Plus);
  painter.setPen(Qt::NoPen);
  const bool is_grey = light_->channels.size() == 1;
  for (std::size_t channel = 0; channel < light_->channels.size(); ++channel) {
    painter.setBrush(is_grey ? QColor(130, 130, 130)
                             : QColor(channel == 0 ? 150 : 20, channel == 1 ? 150 : 20, channel == 2 ? 150 : 20));
    painter.drawPolygon(outline(light_->channels[channel]));
  }
  painter.setCompositionMode(QPainter::CompositionMode_SourceOver);
  painter.setBrush(Qt::NoBrush);
  const std::uint8_t tag = document_.selected_tag();
  if (const auto region = light_->regions.find(tag); region != light_->regions.end() && light_->regions.size() > 1) {
    painter.setPen(QPen(document_.colour(tag), 1.5));
    painter.drawPolyline(outline(region->second));
  }
}

}  // namespace nutik::studio
